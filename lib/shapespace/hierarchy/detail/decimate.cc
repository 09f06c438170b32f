#include <shapespace/hierarchy/detail/decimate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/ranges.h>
#include <shapespace/base/parallel.h>
#include <shapespace/hierarchy/detail/quadric.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

// Weight of the plane through a boundary edge, perpendicular to the surface, relative to a triangle
// with the edge's length.
constexpr double kBoundaryWeight = 10;
// Weight of the squared length of the collapsed edge in the cost: distributes vertices evenly where
// the surface is flat and the quadrics are zero.
constexpr double kLengthWeight = 1e-2;
// Least cosine of the angle by which a triangle's normal may turn in one collapse.
constexpr double kMinCosine = 0.5;
// The quality of a triangle, 4 sqrt(3) area / sum of squared sides, is 1 if it is equilateral. No
// triangle may become worse than this, or than the worst that it replaces.
constexpr double kMinQuality = 0.2;
// Vertices of more triangles, such as the poles of a globe, are kept until collapses of their
// neighbours have reduced the number, and no vertex collapses onto them: otherwise, after every
// collapse nearby, each neighbour would be tested against all triangles again, in time cubic in
// their number. A flat fan of triangles that are not slivers has up to 54.
constexpr int kLargestFan = 54;
// Two triangles on the same side of their edge lie on each other if the cosine of the angle between
// them is above this: to a thousandth of a radian.
constexpr double kFoldedCosine = 1 - 5e-7;

// In a round one vertex in so many, the cheapest, are candidates, and those of their collapses that
// are independent of each other are made together. With fewer candidates the order is closer to
// that of a queue, and there are more rounds.
constexpr int kCandidateShare = 8;
// The last vertices collapse in the order of a queue: it takes a few milliseconds, and paths on the
// coarsest levels, which the order decides, end in poor local minima less often.
constexpr int kInOrder = 200;

constexpr int kDecimatedPerTask = 256;
// Vertices between two reports, so that a person who wants to stop waits a few hundredths of a
// second.
constexpr int kVerticesPerReport = 1 << 15;

constexpr double kImpossible = std::numeric_limits<double>::infinity();

class Decimator {
 public:
  Decimator(const Connectivity& connectivity, const std::vector<Shape>& poses,
            const std::vector<int>& pinned)
      : triangles_(connectivity.Triangles()),
        num_alive_(static_cast<int>(triangles_.cols())),
        num_vertices_(connectivity.NumVertices()),
        num_poses_(static_cast<int>(poses.size())),
        head_(num_vertices_, -1),
        next_(triangles_.size(), -1),
        fixed_(num_vertices_, 0),
        boundary_(num_vertices_, 0),
        cost_(num_vertices_, 0),
        target_(num_vertices_, -1),
        stale_(num_vertices_, 1),
        end_in_(num_vertices_, 0),
        touched_in_(num_vertices_, 0) {
    for (int corner = static_cast<int>(triangles_.size()) - 1; corner >= 0; --corner) {
      const int v = triangles_(corner % 3, corner / 3);
      next_[corner] = head_[v];
      head_[v] = corner;
    }
    PlacePoses(poses);
    for (int v : pinned) fixed_[v] = 1;
    ForRanges(
        num_vertices_, [&](int begin, int end) { ExamineFans(begin, end); }, kDecimatedPerTask);
    quadrics_.resize(positions_.cols());
    ForIndices(
        num_vertices_, [&](int v) { BuildQuadrics(v); }, kDecimatedPerTask);
  }

  std::vector<Collapse> Run(int target, Progress* progress) {
    const int total = num_alive_ - target;
    const auto report = [&] {
      ReportProgress(progress, "decimating", total + target - num_alive_, total);
    };
    for (int v = 0; v < num_vertices_; ++v) {
      if (!fixed_[v]) live_.push_back(v);
    }
    std::vector<Collapse> result;
    while (true) {
      FindCandidates(report);
      if (live_costs_.empty()) return result;
      ChooseIndependent();
      removed_.resize(chosen_.size());
      ForIndices(
          static_cast<int>(chosen_.size()), [&](int i) { removed_[i] = Apply(chosen_[i]); },
          kDecimatedPerTask);
      ForIndices(
          static_cast<int>(touched_.size()), [&](int i) { RemoveDead(touched_[i]); },
          kDecimatedPerTask);
      for (size_t i = 0; i < chosen_.size(); ++i) {
        num_alive_ -= removed_[i];
        result.push_back({chosen_[i], target_[chosen_[i]], num_alive_});
        if (num_alive_ <= target) return result;
      }
    }
  }

 private:
  // The triangles (v, a[i], b[i]) of a vertex v.
  struct Fan {
    int size = 0;
    int a[kLargestFan], b[kLargestFan];
  };

  // The poses' coordinates, scaled to area 1 and interleaved, with the error of the surface there:
  // pose p of vertex v is column v num_poses + p.
  void PlacePoses(const std::vector<Shape>& poses) {
    positions_.resize(4, static_cast<Eigen::Index>(num_vertices_) * num_poses_);
    ParallelFor(num_poses_, [&](int p) {
      double area = 0;
      for (int f = 0; f < triangles_.cols(); ++f) {
        area += TriangleArea(poses[p], triangles_.col(f));
      }
      const double scale = area > 0 ? 1 / std::sqrt(area) : 1;
      const Eigen::Vector3d centre = poses[p].rowwise().mean();
      for (int v = 0; v < num_vertices_; ++v) {
        positions_.col(Column(v, p)) << scale * (poses[p].col(v) - centre), 0;
      }
    });
  }

  Eigen::Index Column(int v, int pose) const {
    return static_cast<Eigen::Index>(v) * num_poses_ + pose;
  }
  Eigen::Vector3d At(int v, int pose) const { return positions_.col(Column(v, pose)).head<3>(); }

  // Calls body(a, b) for every triangle (v, a, b) of v.
  template <typename Body>
  void ForFan(int v, const Body& body) const {
    for (int corner = head_[v]; corner >= 0; corner = next_[corner]) {
      const int f = corner / 3, k = corner % 3;
      body(triangles_((k + 1) % 3, f), triangles_((k + 2) % 3, f));
    }
  }

  // Returns false if there are more than kLargestFan.
  bool GetFan(int v, Fan* fan) const {
    fan->size = 0;
    for (int corner = head_[v]; corner >= 0; corner = next_[corner]) {
      if (fan->size == kLargestFan) return false;
      const int f = corner / 3, k = corner % 3;
      fan->a[fan->size] = triangles_((k + 1) % 3, f);
      fan->b[fan->size++] = triangles_((k + 2) % 3, f);
    }
    return true;
  }

  // Pins non-manifold vertices and vertices without triangles, and marks boundary vertices. In a
  // closed fan each neighbour is followed and preceded by a triangle; at a boundary one neighbour
  // has no triangle before it and another none after it.
  void ExamineFans(int first, int last) {
    std::vector<std::pair<int, int>> fan;
    std::vector<int> ring;
    for (int v = first; v < last; ++v) {
      fan.clear();
      ring.clear();
      ForFan(v, [&](int a, int b) {
        fan.emplace_back(a, b);
        ring.push_back(b);
      });
      std::sort(fan.begin(), fan.end());
      std::sort(ring.begin(), ring.end());
      int begins = 0, start = fan.empty() ? -1 : fan[0].first;
      bool manifold = !fan.empty();
      for (size_t i = 0; i < fan.size(); ++i) {
        const auto [a, b] = fan[i];
        if (a == b || a == v || b == v || (i > 0 && fan[i - 1].first == a)) manifold = false;
        if (!std::binary_search(ring.begin(), ring.end(), a)) {
          ++begins;
          start = a;
        }
      }
      if (begins > 1) manifold = false;
      if (manifold) {  // in a manifold a walk around the vertex visits every triangle once
        size_t steps = 0;
        int at = start;
        do {
          const auto found = std::lower_bound(fan.begin(), fan.end(), std::make_pair(at, -1));
          if (found == fan.end() || found->first != at) break;
          at = found->second;
          ++steps;
        } while (at != start && steps <= fan.size());
        manifold = steps == fan.size();
      }
      if (!manifold) fixed_[v] = 1;
      boundary_[v] = begins > 0;
    }
  }

  void BuildQuadrics(int v) {
    Fan fan;
    const bool may_fold = GetFan(v, &fan);
    for (int p = 0; p < num_poses_; ++p) {
      const Eigen::Vector3d origin = At(v, p);
      Quadric& quadric = quadrics_[Column(v, p)];
      ForFan(v, [&](int a, int b) {
        const Eigen::Vector3d xa = At(a, p) - origin, xb = At(b, p) - origin;
        Eigen::Vector3d normal = xa.cross(xb);
        const double twice_area = normal.norm();
        if (!(twice_area > 0)) return;
        normal /= twice_area;
        quadric.AddPlane(normal, Eigen::Vector3d::Zero(), twice_area / 6);
        for (const auto& [w, side] : {std::pair(a, xa), std::pair(b, xb)}) {
          const bool border = boundary_[v] && boundary_[w] && SharedTriangles(v, w) == 1;
          if (!border && !(may_fold && IsFolded(v, fan, w, w == a ? b : a, p))) continue;
          const double length = side.norm();
          if (!(length > 0)) continue;
          quadric.AddPlane(side.cross(normal) / length, Eigen::Vector3d::Zero(),
                           kBoundaryWeight * length * length / 2);
        }
      });
    }
  }

  // Whether the two triangles at an edge of v, of which one has the third corner `tip`, lie on each
  // other in a pose. The planes of both are then the same, and would not keep the edge in its
  // place.
  bool IsFolded(int v, const Fan& fan, int w, int tip, int pose) const {
    const Eigen::Vector3d origin = At(v, pose), edge = At(w, pose) - origin;
    const Eigen::Vector3d normal = edge.cross(At(tip, pose) - origin);
    for (int i = 0; i < fan.size; ++i) {
      const int a = fan.a[i], b = fan.b[i];
      if ((a != w && b != w) || a == tip || b == tip) continue;
      const Eigen::Vector3d other = edge.cross(At(a == w ? b : a, pose) - origin);
      if (normal.dot(other) > kFoldedCosine * normal.norm() * other.norm()) return true;
    }
    return false;
  }

  int SharedTriangles(int a, int b) const {
    int count = 0;
    ForFan(a, [&](int x, int y) { count += x == b || y == b; });
    return count;
  }

  // Costs rise as vertices collapse nearby, so that a cost from before is a lower bound, and only
  // the cheapest have to be computed anew. Leaves in `candidates_` those that are possible and up
  // to date, in the order of cost.
  template <typename Report>
  void FindCandidates(const Report& report) {
    report();
    live_.erase(std::remove_if(live_.begin(), live_.end(), [&](int v) { return head_[v] < 0; }),
                live_.end());
    live_costs_.clear();
    for (int v : live_) {
      if (cost_[v] < kImpossible) live_costs_.push_back(cost_[v]);
    }
    candidates_.clear();
    if (live_costs_.empty()) return;
    const int spare = std::max(0, static_cast<int>(live_costs_.size()) - kInOrder);
    const auto rank = live_costs_.begin() + spare / kCandidateShare;
    std::nth_element(live_costs_.begin(), rank, live_costs_.end());
    const double most = *rank;
    stale_list_.clear();
    for (int v : live_) {
      if (!(cost_[v] <= most)) continue;
      candidates_.push_back(v);
      if (stale_[v]) stale_list_.push_back(v);
    }
    const int num_stale = static_cast<int>(stale_list_.size());
    for (int begin = 0; begin < num_stale; begin += kVerticesPerReport) {
      if (begin > 0) report();
      ForIndices(
          std::min(kVerticesPerReport, num_stale - begin),
          [&](int i) { FindCheapest(stale_list_[begin + i]); }, kDecimatedPerTask);
    }
    candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                     [&](int v) { return !(cost_[v] <= most); }),
                      candidates_.end());
    std::sort(candidates_.begin(), candidates_.end(),
              [&](int v, int w) { return cost_[v] < cost_[w] || (cost_[v] == cost_[w] && v < w); });
  }

  // Takes the candidates that are independent of cheaper ones. A collapse changes the triangles of
  // `from`, and what belongs to `from` and `to`; whether another one is possible, and its cost,
  // depend on these at neighbours of its own `from` only.
  void ChooseIndependent() {
    ++round_;
    chosen_.clear();
    touched_.clear();
    const auto touch = [&](int v) {
      if (touched_in_[v] == round_) return;
      touched_in_[v] = round_;
      touched_.push_back(v);
      stale_[v] = 1;
      if (cost_[v] == kImpossible) cost_[v] = 0;
    };
    for (int from : candidates_) {
      bool independent = true;
      ForFan(from, [&](int a, int b) {
        independent = independent && end_in_[a] != round_ && end_in_[b] != round_;
      });
      if (!independent) continue;
      chosen_.push_back(from);
      for (int end : {from, target_[from]}) {
        end_in_[end] = round_;
        ForFan(end, [&](int a, int b) {
          touch(a);
          touch(b);
        });
      }
    }
  }

  // The cheapest possible collapse of `from`.
  void FindCheapest(int from) {
    stale_[from] = 0;
    cost_[from] = kImpossible;
    Fan fan;
    if (!GetFan(from, &fan)) return;
    int ring[2 * kLargestFan], size = 0;
    double costs[2 * kLargestFan];
    for (int i = 0; i < fan.size; ++i) ring[size++] = fan.a[i];
    for (int i = 0; i < fan.size; ++i) {
      if (std::find(fan.a, fan.a + fan.size, fan.b[i]) == fan.a + fan.size) ring[size++] = fan.b[i];
    }
    const int all = size;
    std::fill_n(costs, size, 0.0);
    for (int p = 0; p < num_poses_; ++p) {
      const Quadric& quadric = quadrics_[Column(from, p)];
      const Eigen::Vector3d origin = At(from, p);
      for (int i = 0; i < size; ++i) {
        const Eigen::Vector3d shift = At(ring[i], p) - origin;
        const double squared_length = shift.squaredNorm();
        costs[i] += std::abs(quadric(shift) + positions_(3, Column(ring[i], p))) +
                    kLengthWeight * squared_length * squared_length;
      }
    }
    while (size > 0) {
      int best = 0;
      for (int i = 1; i < size; ++i) {
        if (costs[i] < costs[best] || (costs[i] == costs[best] && ring[i] < ring[best])) best = i;
      }
      if (KeepsTopology(from, fan, ring, all, ring[best]) && KeepsGeometry(from, fan, ring[best])) {
        cost_[from] = costs[best];
        target_[from] = ring[best];
        return;
      }
      --size;
      std::swap(ring[best], ring[size]);
      std::swap(costs[best], costs[size]);
    }
  }

  // The link condition (Dey, Edelsbrunner, Guha and Nekhayev, "Topology Preserving Edge
  // Contraction", 1999): the only neighbours that the two vertices have in common are the third
  // corners of the triangles at their edge. `ring` has the neighbours of `from`, in any order.
  bool KeepsTopology(int from, const Fan& fan, const int* ring, int ring_size, int to) const {
    Fan around;  // `to`
    if (!GetFan(to, &around)) return false;
    int opposite[2], shared = 0;
    for (int j = 0; j < around.size; ++j) {
      if (around.a[j] != from && around.b[j] != from) continue;
      if (shared < 2) opposite[shared] = around.a[j] == from ? around.b[j] : around.a[j];
      ++shared;
    }
    if (shared < 1 || shared > 2) return false;
    // A boundary vertex may only move along its boundary.
    if (boundary_[from] && (shared != 1 || !boundary_[to])) return false;
    int common = 0;
    for (int i = 0; i < ring_size; ++i) {
      bool both = false;
      for (int j = 0; j < around.size; ++j) {
        both = both || around.a[j] == ring[i] || around.b[j] == ring[i];
      }
      common += both && ring[i] != to;
    }
    if (common != shared) return false;
    if (shared == 2) {  // no triangle would coincide with another one of `to`
      const auto is_opposite = [&](int a, int b) {
        return (a == opposite[0] && b == opposite[1]) || (a == opposite[1] && b == opposite[0]);
      };
      bool here = false, there = false;
      for (int i = 0; i < fan.size; ++i) here = here || is_opposite(fan.a[i], fan.b[i]);
      for (int j = 0; j < around.size && here; ++j) {
        there = there || is_opposite(around.a[j], around.b[j]);
      }
      if (there) return false;
    }
    if (fan.size > 1) return true;
    // The last triangle of `from` may only be removed if its third side is in the interior of a
    // surface; otherwise a component, a bridge between two components or a fin would be lost.
    return std::count(around.a, around.a + around.size, opposite[0]) == 1 &&
           std::count(around.b, around.b + around.size, opposite[0]) == 1;
  }

  // The square of a triangle's quality, from its sides at one corner and its normal.
  static double SquaredQuality(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& normal) {
    const double sides = a.squaredNorm() + b.squaredNorm() + (b - a).squaredNorm();
    return sides > 0 ? 12 * normal.squaredNorm() / (sides * sides) : 0;
  }

  bool KeepsGeometry(int from, const Fan& fan, int to) const {
    for (int p = 0; p < num_poses_; ++p) {
      const Eigen::Vector3d old_place = At(from, p), new_place = At(to, p);
      double worst_before = kMinQuality * kMinQuality, worst_after = worst_before;
      for (int i = 0; i < fan.size; ++i) {
        const Eigen::Vector3d xa = At(fan.a[i], p), xb = At(fan.b[i], p);
        const Eigen::Vector3d a = xa - old_place, b = xb - old_place, before = a.cross(b);
        worst_before = std::min(worst_before, SquaredQuality(a, b, before));
        if (fan.a[i] == to || fan.b[i] == to) continue;
        const Eigen::Vector3d c = xa - new_place, d = xb - new_place, after = c.cross(d);
        worst_after = std::min(worst_after, SquaredQuality(c, d, after));
        // `<` on purpose: a triangle without area before has no orientation.
        if (before.dot(after) <
            kMinCosine * std::sqrt(before.squaredNorm() * after.squaredNorm())) {
          return false;
        }
      }
      if (worst_after < worst_before) return false;
    }
    return true;
  }

  // Collapses a vertex, and returns how many triangles it removes. Only lists and quadrics of
  // `from` and `to`, and triangles of `from`, are changed: chosen collapses are made at a time.
  int Apply(int from) {
    const int to = target_[from];
    int last = -1, removed = 0;
    for (int corner = head_[from]; corner >= 0; corner = next_[corner]) {
      auto triangle = triangles_.col(corner / 3);
      last = corner;
      if ((triangle.array() == to).any()) {
        triangle(0) = kDead;
        ++removed;
      } else {
        triangle(corner % 3) = to;
      }
    }
    next_[last] = head_[to];
    head_[to] = head_[from];
    head_[from] = -1;
    for (int p = 0; p < num_poses_; ++p) {
      Quadric& quadric = quadrics_[Column(to, p)];
      quadric += quadrics_[Column(from, p)].From(At(to, p) - At(from, p));
      positions_(3, Column(to, p)) = quadric.AtOrigin();
    }
    return removed;
  }

  // Removes triangles from the list of a vertex that are no more.
  void RemoveDead(int v) {
    int* link = &head_[v];
    while (*link >= 0) {
      if (triangles_(0, *link / 3) == kDead) {
        *link = next_[*link];
      } else {
        link = &next_[*link];
      }
    }
  }

  static constexpr int kDead = -1;

  Eigen::Matrix3Xi triangles_;
  int num_alive_;
  const int num_vertices_, num_poses_;
  std::vector<int> head_, next_;  // per vertex, its corners as a linked list
  Eigen::Matrix4Xd positions_;
  std::vector<Quadric> quadrics_;  // like place_, with the place as origin
  std::vector<char> fixed_, boundary_;
  // Per vertex its cheapest collapse, which is stale if something has changed since.
  std::vector<double> cost_;
  std::vector<int> target_;
  std::vector<char> stale_;
  std::vector<int> live_;  // vertices that may still collapse
  // Of a round.
  int round_ = 0;
  std::vector<int> end_in_, touched_in_;  // the last round in which a vertex was an end, or touched
  std::vector<int> candidates_, stale_list_, chosen_, removed_, touched_;
  std::vector<double> live_costs_;
};

}  // namespace

std::vector<Collapse> PlanCollapses(const Connectivity& connectivity,
                                    const std::vector<Shape>& poses, int triangles,
                                    const std::vector<int>& pinned, Progress* progress) {
  for (const Shape& pose : poses) {
    if (pose.cols() != connectivity.NumVertices()) {
      throw MeshError("a pose has the wrong number of vertices");
    }
  }
  for (int v : pinned) {
    if (v < 0 || v >= connectivity.NumVertices()) {
      throw InvalidOptions("pinned", std::to_string(v) + " is not a vertex of the mesh");
    }
  }
  if (triangles >= connectivity.NumTriangles()) return {};
  return Decimator(connectivity, poses, pinned).Run(triangles, progress);
}

}  // namespace shapespace::internal
