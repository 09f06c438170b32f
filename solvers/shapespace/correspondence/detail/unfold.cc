#include <shapespace/correspondence/detail/unfold.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

// What is farther than this from the target, a share of the root of its area, is missing there:
// over a hole nothing is turned over, and a search for what matches would look at the whole target.
constexpr double kMissing = 0.15;
// Number of rounds, in each of which patches grow by a ring of vertices, and of averagings per
// round.
constexpr int kRings = 6, kAverages = 8;
// Number of passes; three passes leave a fifth fewer folds than one.
constexpr int kPasses = 3;

}  // namespace

MeanValueWeights::MeanValueWeights(const Connectivity& connectivity, const Shape& rest)
    : connectivity_(connectivity), weights_(connectivity.NumEdges(), {0, 0}) {
  const auto add = [&](int from, int to, double weight) {
    for (const int e : connectivity.EdgesOfVertices()[from]) {
      if (connectivity.OtherEnd(e, from) == to) weights_[e][from < to ? 0 : 1] += weight;
    }
  };
  for (const Eigen::Vector3i triangle : connectivity.Triangles().colwise()) {
    for (int k = 0; k < 3; ++k) {
      const int v = triangle(k), a = triangle((k + 1) % 3), b = triangle((k + 2) % 3);
      const Eigen::Vector3d p = rest.col(a) - rest.col(v), q = rest.col(b) - rest.col(v);
      const double lengths = p.norm() * q.norm();
      // The tangent of half the angle, at least kMin for collapsed triangles.
      constexpr double kMin = 1e-3;
      const double tangent = std::max(kMin * lengths, p.cross(q).norm()) /
                             std::max(kMin * lengths, lengths + p.dot(q));
      if (!(lengths > 0)) continue;
      add(v, a, tangent / p.norm());
      add(v, b, tangent / q.norm());
    }
  }
}

namespace {

// Labels the connected patches of `inside` from 0; -1 outside.
std::vector<int> PatchesOf(const std::vector<bool>& inside, const MeanValueWeights& neighbours,
                           int* count) {
  std::vector<int> patch(inside.size(), -1);
  *count = 0;
  std::vector<int> open;
  for (size_t seed = 0; seed < inside.size(); ++seed) {
    if (!inside[seed] || patch[seed] >= 0) continue;
    open.assign(1, static_cast<int>(seed));
    patch[seed] = *count;
    while (!open.empty()) {
      const int v = open.back();
      open.pop_back();
      neighbours.ForEach(v, [&](int w, double) {
        if (!inside[w] || patch[w] >= 0) return;
        patch[w] = *count;
        open.push_back(w);
      });
    }
    ++*count;
  }
  return patch;
}

// The number of turned triangles with a corner in each patch.
std::vector<int> CountTurned(const std::vector<bool>& turned, const Eigen::Matrix3Xi& triangles,
                             const std::vector<int>& patch, int num_patches) {
  std::vector<int> counts(num_patches, 0);
  for (int f = 0; f < triangles.cols(); ++f) {
    if (!turned[f]) continue;
    for (int k = 0; k < 3; ++k) {
      const int p = patch[triangles(k, f)];
      // A triangle with several corners in a patch counts once.
      const bool counted =
          (k > 0 && patch[triangles(0, f)] == p) || (k > 1 && patch[triangles(1, f)] == p);
      if (p >= 0 && !counted) ++counts[p];
    }
  }
  return counts;
}

// The vertices of turned triangles that are not held, with `rings` of neighbours around them.
std::vector<bool> Around(const std::vector<bool>& turned, const Eigen::Matrix3Xi& triangles,
                         const MeanValueWeights& neighbours, const std::vector<bool>& is_held,
                         int rings) {
  std::vector<bool> inside(is_held.size(), false);
  for (int f = 0; f < triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (turned[f] && !is_held[triangles(k, f)]) inside[triangles(k, f)] = true;
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<bool> before = inside;
    for (size_t v = 0; v < before.size(); ++v) {
      if (!before[v]) continue;
      neighbours.ForEach(static_cast<int>(v),
                         [&](int w, double) { inside[w] = inside[w] || !is_held[w]; });
    }
  }
  return inside;
}

// Moves each vertex `inside` to the mean of its neighbours, several times. The mean is projected
// onto the target where its normal agrees with those at the neighbours' closest points.
Shape Averaged(const Level& level, const MeanValueWeights& neighbours, const Target& target,
               const std::vector<ClosestPoint>& closest, const std::vector<bool>& inside,
               Shape shape) {
  Shape facing(3, shape.cols());
  for (int v = 0; v < shape.cols(); ++v) facing.col(v) = target.NormalAt(closest[v]);
  for (int average = 0; average < kAverages; ++average) {
    for (int v = 0; v < shape.cols(); ++v) {
      if (!inside[v]) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
      double weights = 0;
      neighbours.ForEach(v, [&](int w, double weight) {
        sum += weight * shape.col(w);
        normal += weight * facing.col(w);
        weights += weight;
      });
      const Eigen::Vector3d mean = sum / weights;
      const ClosestPoint on_target =
          target.Nearest(mean, normal.stableNormalized(), level.vertices[v], kMissing);
      if (on_target.triangle < 0) continue;
      shape.col(v) = on_target.point;
      facing.col(v) = target.NormalAt(on_target);
    }
  }
  return shape;
}

ClosestPoint MapVertex(const Level& level, const Shape& shape, const Shape& normals,
                       const Target& target, int v) {
  const int vertex = level.vertices[v];
  ClosestPoint closest = target.Nearest(shape.col(v), normals.col(v), vertex, kMissing);
  if (closest.triangle >= 0) return closest;
  ClosestPoint other = target.GetSurface().Nearest(
      shape.col(v),
      [&](int f) {
        return target.Distances().MayMatch(vertex, target.GetConnectivity().Triangles()(0, f));
      },
      kMissing);
  return other.triangle >= 0 ? other : target.GetSurface().Nearest(shape.col(v));
}

// Updates the result `closest` of MapVertices for a shape in which only the vertices `moved` have
// changed; the normals of their neighbours have changed too.
std::vector<ClosestPoint> MapAnew(const Level& level, const Shape& shape, const Target& target,
                                  const std::vector<bool>& moved,
                                  const MeanValueWeights& neighbours,
                                  std::vector<ClosestPoint> closest) {
  const Shape normals = VertexNormals(*level.connectivity, shape);
  ParallelFor(static_cast<int>(shape.cols()), [&](int v) {
    bool is_affected = moved[v];
    neighbours.ForEach(v, [&](int w, double) { is_affected = is_affected || moved[w]; });
    if (is_affected) closest[v] = MapVertex(level, shape, normals, target, v);
  });
  return closest;
}

// The result of MapVertices for `shape`, in which of the vertices `inside`, which all had moved in
// the shape that belongs to `flat`, those that have not `moved` are restored to where they were
// for `closest`. Only what is beside both needs to be searched anew.
std::vector<ClosestPoint> Combined(const Level& level, const Shape& shape, const Target& target,
                                   const std::vector<bool>& inside, const std::vector<bool>& moved,
                                   const MeanValueWeights& neighbours,
                                   std::vector<ClosestPoint> closest,
                                   const std::vector<ClosestPoint>& flat) {
  const Shape normals = VertexNormals(*level.connectivity, shape);
  ParallelFor(static_cast<int>(shape.cols()), [&](int v) {
    bool is_affected = moved[v], is_restored = inside[v] && !moved[v];
    neighbours.ForEach(v, [&](int w, double) {
      is_affected = is_affected || moved[w];
      is_restored = is_restored || (inside[w] && !moved[w]);
    });
    if (!is_affected) return;
    closest[v] = is_restored ? MapVertex(level, shape, normals, target, v) : flat[v];
  });
  return closest;
}

}  // namespace

std::vector<bool> TurnedTriangles(const Level& level, const Shape& shape, const Target& target,
                                  const std::vector<ClosestPoint>& closest) {
  const Eigen::Matrix3Xi& triangles = level.connectivity->Triangles();
  const Eigen::Matrix3Xi& others = target.GetConnectivity().Triangles();
  const Shape& place = target.GetShape();
  std::vector<bool> turned(triangles.cols());
  for (int f = 0; f < triangles.cols(); ++f) {
    Eigen::Vector3d there = Eigen::Vector3d::Zero();
    bool missing = false;
    for (int k = 0; k < 3; ++k) {
      missing = missing || closest[triangles(k, f)].distance > kMissing;
      there += AreaNormal(place, others.col(closest[triangles(k, f)].triangle));
    }
    turned[f] = !missing && AreaNormal(shape, triangles.col(f)).dot(there) < 0;
  }
  return turned;
}

std::vector<ClosestPoint> MapVertices(const Level& level, const Shape& shape,
                                      const Target& target) {
  const Shape normals = VertexNormals(*level.connectivity, shape);
  std::vector<ClosestPoint> closest(shape.cols());
  ParallelFor(static_cast<int>(shape.cols()),
              [&](int v) { closest[v] = MapVertex(level, shape, normals, target, v); });
  return closest;
}

void Unfold(const Level& level, const Shape& rest, const Target& target,
            const std::vector<int>& held, Shape* shape) {
  const Eigen::Matrix3Xi& triangles = level.connectivity->Triangles();
  const MeanValueWeights neighbours(*level.connectivity, rest);
  std::vector<bool> is_held(shape->cols(), false);
  for (const int v : held) is_held[v] = true;
  std::vector<ClosestPoint> closest = MapVertices(level, *shape, target);
  for (int round = 0; round < kPasses * kRings; ++round) {
    const std::vector<bool> turned = TurnedTriangles(level, *shape, target, closest);
    const std::vector<bool> inside = Around(turned, triangles, neighbours, is_held, round % kRings);
    int num_patches = 0;
    const std::vector<int> patch = PatchesOf(inside, neighbours, &num_patches);
    if (num_patches == 0) return;
    const Shape flat = Averaged(level, neighbours, target, closest, inside, *shape);
    const std::vector<ClosestPoint> of_flat =
        MapAnew(level, flat, target, inside, neighbours, closest);
    const std::vector<bool> still = TurnedTriangles(level, flat, target, of_flat);
    const std::vector<int> before = CountTurned(turned, triangles, patch, num_patches);
    const std::vector<int> after = CountTurned(still, triangles, patch, num_patches);
    std::vector<bool> moved(flat.cols(), false);
    for (int v = 0; v < flat.cols(); ++v) {
      moved[v] = inside[v] && after[patch[v]] < before[patch[v]];
      if (moved[v]) shape->col(v) = flat.col(v);
    }
    closest =
        Combined(level, *shape, target, inside, moved, neighbours, std::move(closest), of_flat);
  }
}

}  // namespace shapespace::internal
