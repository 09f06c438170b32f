// Prints the contents of meshes, paths and spaces, and whether meshes correspond.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <gflags/gflags.h>
#include <Eigen/Geometry>

#include <shapespace/analysis/intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/printable.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/mesh/seams.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/align.h>
#include <shapespace/path/energy.h>
#include <shapespace/statistics/modes_file.h>
#include <shapespace/summary/internal/json_of.h>

#include "support/error_message.h"
#include "support/inspect_path.h"
#include "support/mesh_flags.h"
#include "support/metric_flags.h"
#include "support/report.h"
#include "support/stdin_mesh.h"
#include "support/telling.h"
#include "support/tool.h"

namespace shapespace::tools {
namespace {

constexpr int kMaxModes = 6;  // of which coordinates are printed

const char* Name(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kNonManifold:
      return "non-manifold";
    case Severity::kMirrored:
      return "mirrored";
    case Severity::kDoubtful:
      return "doubtful";
    case Severity::kFatal:
      break;
  }
  return "fatal";
}

// Prints findings and adds them to `list`. Returns whether none is worse than a warning.
bool Print(const std::vector<Finding>& findings, Json* list, Telling* told) {
  bool good = true;
  for (const Finding& finding : findings) {
    const bool acceptable = !IsRefused(finding, MeshOptionsFromFlags());
    const Severity severity =
        acceptable ? std::min(finding.severity, Severity::kWarning) : finding.severity;
    told->Say("  %-12s %-24s %s%s\n", Name(severity), finding.kind.c_str(),
              internal::Printable(finding.message).c_str(),
              acceptable ? "" : InFlags(finding.option).c_str());
    list->push_back(
        {{"severity", Name(severity)}, {"kind", finding.kind}, {"message", finding.message}});
    good = good && acceptable;
  }
  return good;
}

std::string NameOf(const Soup& soup) {
  return internal::Printable(soup.name.empty() ? soup.file : soup.file + ":" + soup.name);
}

Json PrintContent(const Soup& soup, Telling* told) {
  Json json = {{"file", soup.file},
               {"kind", "mesh"},
               {"name", soup.name},
               {"vertices", soup.NumVertices()},
               {"polygons", soup.NumPolygons()},
               {"segments", soup.segments.size()}};
  told->Say("%s\n  %d vertices, %d polygons, %d segments", NameOf(soup).c_str(), soup.NumVertices(),
            soup.NumPolygons(), static_cast<int>(soup.segments.size()));
  if (soup.NumVertices() > 0) {
    const Eigen::Vector3d size =
        soup.vertices.rowwise().maxCoeff() - soup.vertices.rowwise().minCoeff();
    told->Say(", extent %.6g x %.6g x %.6g", size.x(), size.y(), size.z());
    json["extent"] = ListOf(size);
  }
  told->Say("\n");
  json["not_kept"] = soup.dropped;
  for (const std::string& what : soup.dropped) {
    told->Say("  %-12s %-24s %s\n", Name(Severity::kNote), "not-kept",
              internal::Printable(what).c_str());
  }
  return json;
}

// The connectivity with the seams that are closed in all poses, unless --open_seams.
std::shared_ptr<const Connectivity> WholeSurface(const Soup& soup,
                                                 const std::vector<Shape>& poses) {
  Seams seams;
  if (!FLAGS_open_seams) seams = FindSeams(soup.polygon_begin, soup.corners, poses);
  return ConnectivityOf(soup, poses, {}, seams.representatives);
}

// Of more self-intersections nobody wants the number, which would take minutes to find.
constexpr std::int64_t kMostIntersections = 10000;

// Prints self-intersections of a usable mesh, and returns their number, at most the above.
std::int64_t PrintIntersections(const Soup& soup, Telling* told) {
  ShowProgress("self-intersections of " + NameOf(soup));
  const auto connectivity = WholeSurface(soup, {soup.vertices});
  const std::int64_t pairs = CountIntersections(*connectivity, soup.vertices, kMostIntersections);
  const std::string message =
      std::to_string(pairs) + (pairs == kMostIntersections ? " pairs of triangles cross, or more"
                                                           : " pairs of triangles cross");
  told->Say("  %-12s %-24s %s\n", Name(Severity::kNote), "self-intersections",
            pairs == 0 ? "none" : message.c_str());
  return pairs;
}

// Prints the difference of a pose from the first, up to rigid motion.
Json PrintDistance(const Soup& reference, const Soup& pose, Telling* told) {
  const std::vector<Shape> pair = {reference.vertices, pose.vertices};
  const auto connectivity = WholeSurface(reference, pair);
  CheckMetricFlags(*connectivity);
  const auto metric = FreezeMetric(MetricFromFlags(), connectivity, pair);
  const AlignedPoses aligned = AlignPoses(*metric, pair);
  const Shape &first = aligned.shapes[0], &other = aligned.shapes[1];
  const Eigen::RowVectorXd squared = (other - first).colwise().squaredNorm();
  std::vector<double> stretch;
  for (int e = 0; e < connectivity->NumEdges(); ++e) {
    const Eigen::Vector2i v = connectivity->Edges().col(e);
    const double length = (first.col(v(1)) - first.col(v(0))).norm();
    if (length > 0) {
      stretch.push_back(std::abs((other.col(v(1)) - other.col(v(0))).norm() / length - 1));
    }
  }
  std::sort(stretch.begin(), stretch.end());
  const auto quantile = [&](double share) {
    return stretch.empty() ? 0 : stretch[static_cast<size_t>(share * (stretch.size() - 1))];
  };
  const double turned = Eigen::AngleAxisd(aligned.motions[1].rotation).angle() * 180 / M_PI;
  const double rms =
      metric->unit * std::sqrt(squared.dot(metric->vertex_area) / metric->vertex_area.sum());
  const double most = metric->unit * std::sqrt(squared.maxCoeff());
  told->Say("%s against %s\n", NameOf(pose).c_str(), NameOf(reference).c_str());
  told->Say("  turned by            %.4g degrees\n", turned);
  told->Say("  vertices apart       rms %.4g, max %.4g (user's units, once aligned)\n", rms, most);
  told->Say("  edges stretched by   median %.3g%%, 99th percentile %.3g%%, max %.3g%%\n",
            100 * quantile(.5), 100 * quantile(.99), 100 * quantile(1));
  Json json = {{"pose", NameOf(pose)},
               {"against", NameOf(reference)},
               {"turned_by", turned},
               {"apart_rms", rms},
               {"apart_max", most},
               {"stretch_median", quantile(.5)},
               {"stretch_p99", quantile(.99)},
               {"stretch_max", quantile(1)}};
  const double bound = ScaledEnergy(EnergyLowerBound(*metric, first, other, 1000), 1000);
  if (std::isfinite(bound)) {
    const std::string under = DescribeMetric(metric->options);
    told->Say("  distance             at least %.6g (%s)\n", std::sqrt(bound), under.c_str());
    json["distance_at_least"] = std::sqrt(bound);
    json["metric"] = under;
  }
  return json;
}

Json PrintSpace(const std::string& file, Telling* told) {
  const PoseSpace space = ReadSpace(file);
  told->Say("%s\n", internal::Printable(file).c_str());
  if (!space.provenance.empty())
    told->Say("  made by      %s\n", internal::Printable(space.provenance).c_str());
  told->Say("  mesh         %d vertices, %d triangles\n", space.metric->connectivity->NumVertices(),
            space.metric->connectivity->NumTriangles());
  told->Say("  metric       %s; unit of length %.6g\n",
            internal::Printable(DescribeMetric(space.metric->options)).c_str(), space.metric->unit);
  told->Say("  nodes        %d, of which %d are poses; %d triangles, %d segments\n",
            space.NumNodes(), space.NumPoses(), static_cast<int>(space.triangles.cols()),
            static_cast<int>(space.segments.cols()));
  told->Say("  distances    up to %.4g; stress of the plane %.3g\n", space.distances.maxCoeff(),
            space.stress);
  Json json = {{"file", file},
               {"kind", "space"},
               {"made_by", space.provenance},
               {"vertices", space.metric->connectivity->NumVertices()},
               {"triangles", space.metric->connectivity->NumTriangles()},
               {"metric", DescribeMetric(space.metric->options)},
               {"unit", space.metric->unit},
               {"nodes", space.NumNodes()},
               {"largest_distance", space.distances.maxCoeff()},
               {"stress", space.stress},
               {"poses", Json::array()}};
  for (int i = 0; i < space.NumPoses(); ++i) {
    told->Say("  pose         at %12.6g %12.6g  %s\n", space.points(0, i), space.points(1, i),
              internal::Printable(space.names[i]).c_str());
    json["poses"].push_back(
        {{"name", space.names[i]}, {"at", {space.points(0, i), space.points(1, i)}}});
  }
  return json;
}

Json PrintModes(const std::string& file, Telling* told) {
  const PoseModes modes = ReadModes(file);
  told->Say("%s\n", internal::Printable(file).c_str());
  told->Say("  made by      %s\n", internal::Printable(modes.provenance).c_str());
  told->Say("  mesh         %d vertices, %d triangles\n", modes.metric->connectivity->NumVertices(),
            modes.metric->connectivity->NumTriangles());
  told->Say("  metric       %s; unit of length %.6g\n",
            internal::Printable(DescribeMetric(modes.metric->options)).c_str(), modes.metric->unit);
  told->Say("  poses        %d%s\n", modes.NumPoses(),
            modes.size == PoseSize::kRemove ? ", scaled to the same area" : "");
  told->Say("  modes        %d, with %.3g%% of the variance\n", modes.NumModes(),
            100 * modes.Share(modes.NumModes()));
  const Eigen::MatrixXd coordinates = modes.Coordinates();
  Json json = {{"file", file},
               {"kind", "modes"},
               {"made_by", modes.provenance},
               {"vertices", modes.metric->connectivity->NumVertices()},
               {"triangles", modes.metric->connectivity->NumTriangles()},
               {"metric", DescribeMetric(modes.metric->options)},
               {"unit", modes.metric->unit},
               {"scaled", modes.size == PoseSize::kRemove},
               {"modes", modes.NumModes()},
               {"share", modes.Share(modes.NumModes())},
               {"poses", Json::array()}};
  for (int i = 0; i < modes.NumPoses(); ++i) {
    told->Say("  pose         at");
    Json at = Json::array();
    for (int k = 0; k < modes.NumModes(); ++k) {
      if (k < kMaxModes) told->Say(" %7.3f", coordinates(i, k));
      at.push_back(coordinates(i, k));
    }
    told->Say("%s  %s\n", modes.NumModes() > kMaxModes ? " ..." : "",
              internal::Printable(modes.names[i]).c_str());
    json["poses"].push_back({{"name", modes.names[i]}, {"at", at}});
  }
  return json;
}

/// The meshes of the command line.
class Meshes {
 public:
  // Prints a pose, and compares it with the first one.
  Json Add(Soup read, Telling* told) {
    soups_.push_back(std::move(read));
    Soup& soup = soups_.back();
    Json json = PrintContent(soup, told);
    json["findings"] = Json::array();
    const bool usable = Print(CheckSoup(soup, FLAGS_open_seams), &json["findings"], told);
    const char axis = MirrorFromFlags();
    if (usable && soups_.size() > 1 && axis != 0 && MirrorBack(soups_.front(), axis, &soup)) {
      told->Say("  %-12s %-24s mirrored; its %c has changed sign\n", Name(Severity::kNote),
                "mirrored", axis);
    }
    const bool corresponds = soups_.size() == 1 || Corresponds(&json["findings"], told);
    // Last, because it takes longest; of a mesh whose vertices are in another order it tells
    // nothing.
    if (usable && corresponds) json["intersections"] = PrintIntersections(soup, told);
    json["usable"] = usable && corresponds;
    all_usable_ = all_usable_ && usable && corresponds;
    return json;
  }

  bool AllUsable() const { return all_usable_; }

  // \throw MeshError, DifferentMeshes
  void RequireUsable() const {
    const std::string problem = "not usable as it is: see the findings";
    if (!other_.empty()) throw DifferentMeshes(problem, NameOf(soups_.front()), other_);
    if (!all_usable_) throw MeshError(problem);
  }

  // Prints how far each is from the first.
  Json Compare(Telling* told) const {
    Json comparisons = Json::array();
    for (size_t i = 1; i < soups_.size(); ++i) {
      comparisons.push_back(PrintDistance(soups_[0], soups_[i], told));
    }
    return comparisons;
  }

 private:
  // Whether the last mesh corresponds to the first one.
  bool Corresponds(Json* json, Telling* told) {
    const std::vector<Finding> findings = CheckSameMesh(soups_.front(), soups_.back());
    const bool other = std::any_of(findings.begin(), findings.end(),
                                   [](const Finding& found) { return found.different_meshes; });
    if (other && other_.empty()) other_ = NameOf(soups_.back());
    return Print(findings, json, told);
  }

  std::vector<Soup> soups_;
  bool all_usable_ = true;
  std::string other_;  // the first mesh that is none of the first one's poses
};

bool IsMesh(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  return extension != ".path" && extension != ".space" && extension != ".modes";
}

Json InspectOther(const std::string& file, Telling* told) {
  const std::string extension = internal::FileExtension(file);
  if (extension == ".path") return InspectPath(file, told);
  return extension == ".space" ? PrintSpace(file, told) : PrintModes(file, told);
}

void Run(const std::vector<std::string>& arguments) {
  std::vector<std::string> files = arguments;
  if (files.empty()) throw UsageError("name one or more files: meshes, .path, .space or .modes");
  CheckNothingIsOverwritten(files, {ReportFromFlag()});
  // Meshes last, because the comparison of poses follows after them.
  std::stable_partition(files.begin(), files.end(), [](const auto& file) { return !IsMesh(file); });
  Telling told;
  Json contents = Json::array();
  Meshes meshes;
  for (const std::string& file : files) {
    try {
      if (IsMesh(file)) {
        for (Soup& pose : ReadSoupsOrStdin(file))
          contents.push_back(meshes.Add(std::move(pose), &told));
      } else {
        contents.push_back(InspectOther(file, &told));
      }
    } catch (const Error& error) {
      Complain(MessageOf(error));
      contents.push_back({{"file", file}, {"error", error.what()}});
    }
  }
  Json report = {{"files", contents}};
  report["comparisons"] = meshes.AllUsable() ? meshes.Compare(&told) : Json::array();
  WriteReport(told.Text(), internal::TextOf(report));
  meshes.RequireUsable();
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(argc, argv,
                 {"shape-inspect",
                  "contents of files, correspondence of meshes, differences between poses",
                  R"(  shape-inspect a.obj b.obj walk.path poses.space herd.modes

Exit code 1 if a file cannot be read, a mesh cannot be used as it is, or meshes do not
correspond.)",
                  {"metric", "mesh", "report", "outside_files"}},
                 Run);
}
