#include <shapespace/deformation/standing.h>

#include <algorithm>
#include <cmath>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/json.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/mesh/internal/selection_json.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/mesh/seams.h>
#include <shapespace/mesh/topology.h>
#include <shapespace/path/internal/velocity.h>

namespace shapespace {
namespace {

// The poses of a path, and when a part is at them.
class GroundPath {
 public:
  GroundPath(const Path& whole, const StandingPart& part, bool is_cycle)
      : whole_(whole), part_(part), is_cycle_(is_cycle), stands_(whole.poses.size() - 1, false) {
    for (const auto& [first, last] : part.poses) {
      std::fill(stands_.begin() + first, stands_.begin() + last, true);
    }
    for (const int pose : whole.poses) {
      places_.push_back(whole.Placed(pose)(Eigen::all, part.vertices));
    }
    if (whole.smooth) FindVelocities();
  }

  bool Stands(size_t interval) const { return stands_[interval]; }

  // Whether the part is at rest at a pose. The first pose of a cycle is the last, too.
  bool Rests(size_t pose) const {
    const size_t last = stands_.size();
    const bool at_end = pose == 0 || pose == last;
    if (at_end && is_cycle_) return stands_[0] || stands_[last - 1];
    return (pose > 0 && stands_[pose - 1]) || (pose < last && stands_[pose]);
  }

  // Whether the part's course in an interval is not that of the path.
  bool Changes(size_t interval) const {
    return Stands(interval) || (whole_.smooth && (Rests(interval) || Rests(interval + 1)));
  }

  // Where the part is to be at s of an interval if it is at `own` on the path.
  Shape At(size_t interval, double s, const Shape& own) const {
    if (Stands(interval)) {
      return places_[interval] + s * s * (3 - 2 * s) * (places_[interval + 1] - places_[interval]);
    }
    if (!whole_.smooth) return own;
    Shape wanted = own;
    const internal::EndSlopes slopes(s);
    if (Rests(interval)) wanted -= slopes.first * velocities_[interval].first;
    if (Rests(interval + 1)) wanted -= slopes.last * velocities_[interval].last;
    return wanted;
  }

  // The way from a pose to the next, on which the part stands.
  double Drift(size_t interval) const {
    return (places_[interval + 1] - places_[interval]).colwise().norm().maxCoeff();
  }

 private:
  struct Velocities {
    Shape first, last;  // per interval
  };

  void FindVelocities() {
    for (size_t i = 0; i < stands_.size(); ++i) {
      const int begin = whole_.poses[i], end = whole_.poses[i + 1];
      const double length = whole_.parameters[end] - whole_.parameters[begin];
      const auto velocity = [&](int at, int step) -> Shape {
        return length * internal::OneSidedVelocity(whole_, at, step)(Eigen::all, part_.vertices);
      };
      velocities_.push_back({velocity(begin, 1), velocity(end, -1)});
    }
  }

  const Path& whole_;
  const StandingPart& part_;
  const bool is_cycle_;
  std::vector<bool> stands_;            // in each interval between two poses
  std::vector<Shape> places_;           // at the poses
  std::vector<Velocities> velocities_;  // of a smooth path, in each interval
};

std::string NameOf(const std::vector<StandingPart>& parts, size_t i) {
  const std::string number = "part " + std::to_string(i + 1);
  return parts[i].name.empty() ? number : number + " (" + parts[i].name + ")";
}

// Makes the path's shape k the one given in the user's frame, keeping its rotation.
void SetShape(const Shape& placed, int k, Path* path) {
  RigidMotion& motion = path->motions[k];
  Shape shape = motion.rotation.transpose() * (placed.colwise() - motion.translation).eval();
  const Eigen::Vector3d centre = Centroid(shape, path->metric->vertex_area);
  path->shapes[k] = (shape.colwise() - centre) / path->metric->unit;
  motion.translation += motion.rotation * centre;
}

// A connected component of the mesh.
struct Component {
  std::vector<int> vertices, of_parts;
};

std::vector<Component> ComponentsOf(const Connectivity& connectivity,
                                    const std::vector<StandingPart>& parts) {
  const Topology topology = ComputeTopology(connectivity);
  std::vector<Component> components(topology.components);
  for (size_t v = 0; v < topology.component.size(); ++v) {
    const int c = topology.component[v];
    if (c >= 0) components[c].vertices.push_back(static_cast<int>(v));
  }
  for (const StandingPart& part : parts) {
    for (const int v : part.vertices) {
      if (topology.component[v] >= 0) components[topology.component[v]].of_parts.push_back(v);
    }
  }
  return components;
}

// Says which components have no part.
std::vector<std::string> WarningsOfFree(const std::vector<Component>& components) {
  constexpr size_t kNamed = 3;
  std::vector<std::string> warnings;
  size_t more = 0;
  for (const Component& component : components) {
    if (!component.of_parts.empty()) continue;
    if (warnings.size() == kNamed) {
      ++more;
      continue;
    }
    warnings.push_back("the connected component of " + std::to_string(component.vertices.size()) +
                       " vertices that begins with vertex " +
                       std::to_string(component.vertices.front() + 1) +
                       " (counted from 1) has no standing part; it moves as on the path");
  }
  if (more > 0) {
    warnings.push_back(std::to_string(more) +
                       " further connected components have no standing part and move as on the "
                       "path too");
  }
  return warnings;
}

// Holds the parts in one shape after the other.
class Holder {
 public:
  Holder(const Path& whole, const std::vector<StandingPart>& parts,
         const DeformationOptions& options)
      : whole_(whole),
        options_(options),
        components_(ComponentsOf(*whole.metric->connectivity, parts)) {
    const bool is_cycle = internal::IsCycle(whole);
    for (const StandingPart& part : parts) {
      paths_.emplace_back(whole, part, is_cycle);
      DeformationHandle& handle = handles_.emplace_back();
      handle.name = part.name;
      handle.vertices = part.vertices;
      vertices_.insert(vertices_.end(), part.vertices.begin(), part.vertices.end());
    }
    // What has no part is a handle too, which stays, so that the rest is deformed alone.
    for (const Component& component : components_) {
      if (component.of_parts.empty()) {
        free_.vertices.insert(free_.vertices.end(), component.vertices.begin(),
                              component.vertices.end());
      }
    }
    const Shape first = whole.Placed(0);
    diagonal_ = (first.rowwise().maxCoeff() - first.rowwise().minCoeff()).norm();
    summary_.termination = Termination::kConverged;
    summary_.parts = static_cast<int>(parts.size());
    for (size_t i = 0; i + 1 < whole.poses.size(); ++i) {
      for (const GroundPath& path_of_part : paths_) {
        if (path_of_part.Stands(i)) {
          summary_.drift = std::fmax(summary_.drift, path_of_part.Drift(i));
        }
      }
    }
    summary_.drift /= diagonal_;
  }

  // Deforms shape k of the path, at s of an interval.
  void Hold(int k, size_t interval, double s, Path* path) {
    if (std::none_of(paths_.begin(), paths_.end(), [&](const GroundPath& path_of_part) {
          return path_of_part.Changes(interval);
        })) {
      return;
    }
    const Shape own = path->Placed(k);
    Shape wanted(3, vertices_.size());
    Eigen::Index begin = 0;
    for (size_t i = 0; i < paths_.size(); ++i) {
      const Shape part = own(Eigen::all, handles_[i].vertices);
      wanted.middleCols(begin, part.cols()) = paths_[i].At(interval, s, part);
      begin += part.cols();
    }
    Shape goal = own;
    goal(Eigen::all, vertices_) = wanted;
    const Shape moved = MoveComponents(own, goal);
    std::vector<DeformationHandle> handles = handles_;
    if (!free_.vertices.empty()) handles.push_back(free_);
    for (DeformationHandle& handle : handles) handle.positions = goal(Eigen::all, handle.vertices);
    const DeformationResult deformed =
        Deformer(whole_.metric->connectivity, moved, options_).DeformFrom(moved, handles);
    const Shape shape = deformed.path.Placed(deformed.path.NumShapes() - 1);
    SetShape(shape, k, path);
    Tell(deformed.summary);
    begin = 0;
    for (size_t i = 0; i < paths_.size(); ++i) {
      const auto& vertices = handles_[i].vertices;
      const auto place = wanted.middleCols(begin, static_cast<Eigen::Index>(vertices.size()));
      begin += place.cols();
      if (!paths_[i].Stands(interval)) continue;
      const auto slide = [&](const Shape& x) {
        return (x(Eigen::all, vertices) - place).colwise().norm().maxCoeff() / diagonal_;
      };
      summary_.slide_before = std::fmax(summary_.slide_before, slide(own));
      summary_.slide = std::fmax(summary_.slide, slide(path->Placed(k)));
    }
  }

  StandingSummary Summary() && {
    if (summary_.shapes > 0) {
      for (std::string& warning : WarningsOfFree(components_)) {
        summary_.warnings.push_back(std::move(warning));
      }
    }
    return std::move(summary_);
  }

 private:
  // Moves each component that has a part rigidly, such that the vertices of its parts fit `goal`.
  Shape MoveComponents(const Shape& shape, const Shape& goal) const {
    Shape moved = shape;
    for (const Component& component : components_) {
      if (component.of_parts.empty()) continue;
      const Eigen::VectorXd weights = whole_.metric->vertex_area(component.of_parts);
      const RigidMotion motion = FitRigidMotion(shape(Eigen::all, component.of_parts),
                                                goal(Eigen::all, component.of_parts), weights);
      moved(Eigen::all, component.vertices) = motion(shape(Eigen::all, component.vertices));
    }
    return moved;
  }

  void Tell(const DeformationSummary& one) {
    ++summary_.shapes;
    summary_.edge_rms = std::fmax(summary_.edge_rms, one.error.edge_rms);
    if (!one.Converged()) summary_.termination = one.termination;
    for (const std::string& warning : one.warnings) {
      auto& all = summary_.warnings;
      if (std::find(all.begin(), all.end(), warning) == all.end()) all.push_back(warning);
    }
  }

  const Path& whole_;
  const DeformationOptions& options_;
  std::vector<GroundPath> paths_;
  const std::vector<Component> components_;
  std::vector<DeformationHandle> handles_;
  DeformationHandle free_;     // what has no part
  std::vector<int> vertices_;  // of all parts, one after the other
  double diagonal_ = 0;
  StandingSummary summary_;
};

// [first, last], counted from 1.
std::pair<int, int> IntervalFrom(const internal::Json& json, const std::string& field) {
  const internal::Json& ends = internal::ListFrom(json, field);
  if (ends.size() != 2) internal::FailIn(field, "must be two poses, the first and the last");
  const auto pose = [&](const internal::Json& end) {
    const double number = internal::NumberFrom(end, field);
    if (!(number >= 1 && number <= 1e6) || number != std::floor(number)) {
      internal::FailIn(field, "must be numbers of poses, counted from 1");
    }
    return static_cast<int>(number) - 1;
  };
  return {pose(ends[0]), pose(ends[1])};
}

StandingPart PartFrom(const internal::Json& entry, const Shape& shape,
                      const Connectivity& connectivity, const Appearance& appearance) {
  internal::CheckKeys(entry, "", {"name", "select", "poses"});
  StandingPart part;
  if (entry.contains("name")) part.name = internal::TextFrom(entry["name"], "name");
  const internal::Json& select = internal::Required(entry, "", "select");
  try {
    part.vertices =
        SelectVertices(internal::ParseSelection(select), shape, connectivity, appearance);
  } catch (const InvalidOptions& error) {
    internal::FailIn("select", error.what());
  }
  const internal::Json& poses = internal::ListFrom(internal::Required(entry, "", "poses"), "poses");
  if (!poses.empty() && poses[0].is_array()) {
    for (const internal::Json& interval : poses) {
      part.poses.push_back(IntervalFrom(interval, "poses"));
    }
  } else {
    part.poses.push_back(IntervalFrom(poses, "poses"));
  }
  return part;
}

}  // namespace

DeformationOptions StandingDefaults() {
  DeformationOptions options;
  options.shapes = 1;
  options.tolerance = 1e-6;
  return options;
}

void CheckStandingParts(const std::vector<StandingPart>& parts, int num_vertices, int num_poses) {
  if (parts.empty()) throw InvalidOptions("parts", "at least one is needed");
  std::vector<int> part_of(num_vertices, -1);
  for (size_t i = 0; i < parts.size(); ++i) {
    const std::string name = NameOf(parts, i);
    if (parts[i].vertices.empty()) throw InvalidOptions(name, "has no vertex");
    for (const int v : parts[i].vertices) {
      if (v < 0 || v >= num_vertices) {
        throw InvalidOptions(name, "vertex " + std::to_string(v) + " is not in 0 .. " +
                                       std::to_string(num_vertices - 1));
      }
      if (part_of[v] >= 0) {
        throw InvalidOptions(name, "vertex " + std::to_string(v + 1) + " (counted from 1) is in " +
                                       NameOf(parts, part_of[v]) + " already");
      }
      part_of[v] = static_cast<int>(i);
    }
    int before = -1;
    if (parts[i].poses.empty()) throw InvalidOptions(name, "needs the poses at which it stands");
    for (const auto& [first, last] : parts[i].poses) {
      if (first <= before || last <= first || last >= num_poses) {
        throw InvalidOptions(name, "its intervals of poses must ascend, and there are " +
                                       std::to_string(num_poses) + " poses");
      }
      before = last;
    }
  }
}

StandingSummary HoldStandingParts(const Path& whole, const std::vector<StandingPart>& parts,
                                  const DeformationOptions& options, Path* path,
                                  Progress* progress) {
  const internal::Stopwatch stopwatch;
  options.Validate();
  CheckStandingParts(parts, whole.metric->connectivity->NumVertices(),
                     static_cast<int>(whole.poses.size()));
  std::vector<StandingPart> points = parts;
  for (StandingPart& part : points) {
    part.vertices = RepresentativesOf(*whole.metric->connectivity, part.vertices);
  }
  Holder holder(whole, points, options);
  Path held = *path;
  try {
    for (int k = 0; k < path->NumShapes(); ++k) {
      ReportProgress(progress, "standing parts", k, path->NumShapes());
      if (std::binary_search(path->poses.begin(), path->poses.end(), k)) continue;
      const double time = path->parameters[k];
      for (size_t i = 0; i + 1 < whole.poses.size(); ++i) {
        const double begin = whole.parameters[whole.poses[i]];
        const double end = whole.parameters[whole.poses[i + 1]];
        if (time <= begin || time >= end) continue;
        holder.Hold(k, i, (time - begin) / (end - begin), &held);
      }
    }
  } catch (const Cancelled&) {
    StandingSummary summary;
    summary.parts = static_cast<int>(parts.size());
    summary.warnings = {"stopped: the parts that should stand are where the path has them"};
    summary.seconds = stopwatch.Seconds();
    return summary;
  }
  *path = std::move(held);
  StandingSummary summary = std::move(holder).Summary();
  path->converged = path->converged && summary.Converged();
  summary.seconds = stopwatch.Seconds();
  return summary;
}

std::vector<StandingPart> ReadStandingParts(const std::string& text, const Shape& shape,
                                            const Connectivity& connectivity,
                                            const Appearance& appearance) {
  const internal::Json json = internal::ParseJson(text);
  const internal::Json& entries = internal::ListFrom(json, "");
  std::vector<StandingPart> parts;
  for (size_t i = 0; i < entries.size(); ++i) {
    try {
      parts.push_back(PartFrom(entries[i], shape, connectivity, appearance));
    } catch (const InvalidOptions& error) {
      internal::FailIn("part " + std::to_string(i + 1), error.what());
    }
  }
  return parts;
}

}  // namespace shapespace
