#include <shapespace/hierarchy/hierarchy.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/hierarchy/detail/decimate.h>
#include <shapespace/hierarchy/internal/detail.h>

namespace shapespace {
namespace {

// A level has this many times the triangles of the next coarser one.
constexpr int kRatio = 4;
// If decimation stopped early, a last level with more than this share of the next finer one's
// triangles is omitted, because it would cost nearly as much.
constexpr double kLargestShare = 0.75;

// Numbers of triangles of the coarser levels, descending to about `coarsest`.
std::vector<int> Targets(int triangles, int coarsest) {
  std::vector<int> targets;
  while (triangles / 2 >= coarsest) {
    triangles = triangles / kRatio / 2 >= coarsest ? triangles / kRatio : coarsest;
    targets.push_back(triangles);
  }
  return targets;
}

// The mesh after collapses that moved vertex v to `place[v]`; `number` gives the remaining vertices
// their index.
std::shared_ptr<const Connectivity> Collapsed(const Connectivity& mesh,
                                              const std::vector<int>& representative,
                                              const std::vector<int>& number, int num_vertices) {
  std::vector<int> corners;
  for (int f = 0; f < mesh.NumTriangles(); ++f) {
    const Eigen::Vector3i t = mesh.Triangles().col(f);
    const int a = representative[t(0)], b = representative[t(1)], c = representative[t(2)];
    if (a != b && b != c && c != a)
      corners.insert(corners.end(), {number[a], number[b], number[c]});
  }
  std::vector<int> begin(corners.size() / 3 + 1);
  for (size_t f = 0; f < begin.size(); ++f) begin[f] = static_cast<int>(3 * f);
  std::vector<std::pair<int, int>> segments, extra;  // segments form curves, and touch others
  for (const auto& [from, to] : mesh.Segments()) {
    const int a = representative[mesh.Representative(from)],
              b = representative[mesh.Representative(to)];
    if (a != b) segments.emplace_back(number[a], number[b]);
  }
  for (int e = mesh.NumTriangleEdges(); e < mesh.NumEdges(); ++e) {
    const int a = representative[mesh.Edges()(0, e)], b = representative[mesh.Edges()(1, e)];
    if (a != b) extra.emplace_back(number[a], number[b]);
  }
  return Connectivity::Make(num_vertices, std::move(begin), std::move(corners), segments, extra);
}

}  // namespace

void HierarchyOptions::Validate() const {
  if (coarsest < 4) throw InvalidOptions("coarsest", "must be 4 triangles or more");
}

Hierarchy::Hierarchy(const std::shared_ptr<const Connectivity>& connectivity,
                     const std::vector<Shape>& poses, const HierarchyOptions& options,
                     Progress* progress) {
  options.Validate();
  if (poses.empty()) throw MeshError("a hierarchy needs at least one pose");
  const int num_vertices = connectivity->NumVertices();
  Level finest;
  finest.connectivity = connectivity;
  finest.vertices.resize(num_vertices);
  std::iota(finest.vertices.begin(), finest.vertices.end(), 0);
  levels_.push_back(std::move(finest));

  const int num_triangles = connectivity->NumTriangles();
  const std::vector<int> targets = Targets(num_triangles, options.coarsest);
  const int fewest = targets.empty() ? num_triangles : targets.back();
  std::vector<int> pinned = options.pinned;
  for (int& v : pinned) {
    if (v >= 0 && v < num_vertices) v = connectivity->Representative(v);
  }
  const std::vector<internal::Collapse> collapses =
      internal::PlanCollapses(*connectivity, poses, fewest, pinned, progress);
  stopped_early_ = !targets.empty() && (collapses.empty() || collapses.back().triangles > fewest);

  // To which every vertex of the mesh has collapsed.
  std::vector<int> representative = levels_[0].vertices;
  for (const int v : connectivity->Twins()) representative[v] = connectivity->Representative(v);
  size_t next = 0;
  int left = num_triangles;
  for (int target : targets) {
    const int before = left;
    for (; next < collapses.size() && left > target; ++next) {
      representative[collapses[next].from] = collapses[next].to;
      left = collapses[next].triangles;
    }
    if (left > kLargestShare * before) break;
    // Chains of collapses end at a remaining vertex. Chains of later levels continue earlier ones,
    // so each vertex is followed to the end.
    for (int v = 0; v < num_vertices; ++v) {
      int end = v;
      while (representative[end] != end) end = representative[end];
      for (int at = v; at != end;) at = std::exchange(representative[at], end);
    }

    const Level& finer = levels_.back();
    Level level;
    std::vector<int> number(num_vertices, -1);
    for (size_t i = 0; i < finer.vertices.size(); ++i) {
      const int v = finer.vertices[i];
      if (representative[v] != v) continue;
      number[v] = static_cast<int>(level.vertices.size());
      level.vertices.push_back(v);
      level.kept.push_back(static_cast<int>(i));
    }
    level.connectivity =
        Collapsed(*connectivity, representative, number, static_cast<int>(level.vertices.size()));
    std::vector<int> near;
    for (int v : finer.vertices) near.push_back(number[representative[v]]);
    std::vector<Shape> finer_poses;
    for (const Shape& pose : poses) finer_poses.push_back(pose(Eigen::all, finer.vertices));
    internal::Carriers carriers =
        internal::FindCarriers(*level.connectivity, level.kept, near, finer_poses);
    level.carrier = std::move(carriers.vertices);
    level.weights = std::move(carriers.weights);
    levels_.push_back(std::move(level));
  }
  std::reverse(levels_.begin(), levels_.end());
}

Shape Hierarchy::Restrict(const Shape& shape, int level) const {
  return shape(Eigen::all, levels_[level].vertices);
}

Shape Hierarchy::RestrictOnce(const Shape& shape, int level) const {
  return shape(Eigen::all, levels_[level - 1].kept);
}

Eigen::VectorXd Hierarchy::RestrictField(const Eigen::VectorXd& field, int level) const {
  // Per vertex, the number of the mesh's vertices that have collapsed to it, and the sum of their
  // logarithms.
  Eigen::MatrixX2d sums(field.size(), 2);
  sums << Eigen::VectorXd::Ones(field.size()), field.array().log().matrix();
  for (const int twin : levels_.back().connectivity->Twins()) sums.row(twin).setZero();
  for (int at = NumLevels() - 2; at >= level; --at) {
    const Level& here = levels_[at];
    Eigen::MatrixX2d coarse = sums(here.kept, Eigen::all);
    std::vector<char> is_kept(sums.rows(), 0);
    for (const int v : here.kept) is_kept[v] = 1;
    for (int v = 0; v < sums.rows(); ++v) {
      if (is_kept[v]) continue;
      for (int k = 0; k < 3; ++k) {
        coarse.row(here.carrier(k, v)) += here.weights(k, v) * sums.row(v);
      }
    }
    sums = std::move(coarse);
  }
  Eigen::VectorXd result = (sums.col(1).array() / sums.col(0).array()).exp();
  levels_[level].connectivity->CopyToTwins(&result);
  return result;
}

Shape Hierarchy::Lift(const Shape& coarse, int level, const Shape& from_base, const Shape& from,
                      const Shape& to_base, const Shape& to, double t) const {
  const Level& here = levels_[level];
  Shape result = Shape::Zero(3, here.carrier.cols());
  const auto add = [&](const Shape& base, const Shape& known, double share) {
    if (share == 0) return;
    const std::vector<Eigen::Matrix3d> rotations =
        internal::VertexRotations(*here.connectivity, base, coarse);
    for (int v = 0; v < result.cols(); ++v) {
      for (int k = 0; k < 3; ++k) {
        const double weight = here.weights(k, v);
        if (weight == 0) continue;
        const int c = here.carrier(k, v);
        result.col(v) +=
            share * weight * (coarse.col(c) + rotations[c] * (known.col(v) - base.col(c)));
      }
    }
  };
  add(from_base, from, 1 - t);
  add(to_base, to, t);
  levels_[level + 1].connectivity->CopyToTwins(&result);
  return result;
}

std::vector<Eigen::Matrix3d> Hierarchy::LiftGradients(const Shape& coarse, int level,
                                                      const Shape& base) const {
  const Level& here = levels_[level];
  const std::vector<Eigen::Matrix3d> gradients =
      internal::VertexGradients(*here.connectivity, base, coarse);
  std::vector<Eigen::Matrix3d> result(here.carrier.cols(), Eigen::Matrix3d::Zero());
  for (size_t v = 0; v < result.size(); ++v) {
    for (int k = 0; k < 3; ++k) {
      result[v] += here.weights(k, v) * gradients[here.carrier(k, v)];
    }
  }
  return result;
}

}  // namespace shapespace
