#include <shapespace/hierarchy/internal/decimate.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <string>
#include <tuple>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/hierarchy/internal/quadric.h>
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

class Decimator {
 public:
  Decimator(const Connectivity& connectivity, const std::vector<Shape>& poses,
            const std::vector<int>& pinned)
      : triangles_(connectivity.Triangles()),
        alive_(triangles_.cols(), 1),
        num_alive_(static_cast<int>(triangles_.cols())),
        num_poses_(static_cast<int>(poses.size())),
        head_(connectivity.NumVertices(), -1),
        next_(triangles_.size(), -1),
        fan_size_(connectivity.NumVertices(), 0),
        mark_(connectivity.NumVertices(), 0),
        fixed_(connectivity.NumVertices(), 0),
        boundary_(connectivity.NumVertices(), 0),
        version_(connectivity.NumVertices(), 0) {
    const int num_vertices = connectivity.NumVertices();
    for (int corner = static_cast<int>(triangles_.size()) - 1; corner >= 0; --corner) {
      const int v = triangles_(corner % 3, corner / 3);
      next_[corner] = head_[v];
      head_[v] = corner;
      ++fan_size_[v];
    }
    PlacePoses(poses);
    for (int v : pinned) fixed_[v] = 1;
    for (int v = 0; v < num_vertices; ++v) ExamineFan(v);
    BuildQuadrics();
  }

  std::vector<Collapse> Run(int target, Progress* progress) {
    // Often enough for a person who wants to stop: so many take a few hundredths of a second.
    constexpr int kBetweenReports = 1000;
    const int total = num_alive_ - target;
    int looks = 0;
    const auto report = [&] {
      if (looks++ % kBetweenReports == 0) {
        ReportProgress(progress, "decimating", total + target - num_alive_, total);
      }
    };
    for (size_t v = 0; v < head_.size(); ++v) {
      report();
      Push(static_cast<int>(v));
    }
    std::vector<Collapse> result;
    while (num_alive_ > target && !queue_.empty()) {
      report();
      const auto [cost, from, to, version] = queue_.top();
      queue_.pop();
      if (version != version_[from]) continue;
      if (!Legal(from, to)) {  // something changed nearby
        Push(from);
        continue;
      }
      Apply(from, to);
      result.push_back({from, to, num_alive_});
    }
    return result;
  }

 private:
  using Entry = std::tuple<double, int, int, int>;  // cost, from, to, version of from

  // The poses' coordinates, scaled to area 1 and interleaved: pose p of vertex v is column v
  // num_poses + p.
  void PlacePoses(const std::vector<Shape>& poses) {
    position_.resize(3, static_cast<Eigen::Index>(head_.size()) * num_poses_);
    for (int p = 0; p < num_poses_; ++p) {
      double area = 0;
      for (int f = 0; f < triangles_.cols(); ++f) {
        area += internal::TriangleArea(poses[p], triangles_.col(f));
      }
      const double scale = area > 0 ? 1 / std::sqrt(area) : 1;
      const Eigen::Vector3d centre = poses[p].rowwise().mean();
      for (size_t v = 0; v < head_.size(); ++v) {
        position_.col(v * num_poses_ + p) = scale * (poses[p].col(v) - centre);
      }
    }
  }

  Eigen::Vector3d At(int v, int pose) const { return position_.col(v * num_poses_ + pose); }

  // Calls body(a, b) for every triangle (v, a, b) of v, and removes collapsed ones from its list.
  template <typename Body>
  void ForFan(int v, const Body& body) {
    int* link = &head_[v];
    while (*link >= 0) {
      const int corner = *link, f = corner / 3, k = corner % 3;
      if (alive_[f]) {
        body(triangles_((k + 1) % 3, f), triangles_((k + 2) % 3, f));
        link = &next_[corner];
      } else {
        *link = next_[corner];
      }
    }
  }

  // Pins non-manifold vertices and vertices without triangles, and marks boundary vertices. In a
  // closed fan each neighbour is followed and preceded by a triangle; at a boundary one neighbour
  // has no triangle before it and another none after it.
  void ExamineFan(int v) {
    fan_.clear();
    ring_.clear();
    ForFan(v, [&](int a, int b) {
      fan_.emplace_back(a, b);
      ring_.push_back(b);
    });
    std::sort(fan_.begin(), fan_.end());
    std::sort(ring_.begin(), ring_.end());
    int begins = 0, start = fan_.empty() ? -1 : fan_[0].first;
    bool manifold = !fan_.empty();
    for (size_t i = 0; i < fan_.size(); ++i) {
      const auto [a, b] = fan_[i];
      if (a == b || a == v || b == v || (i > 0 && fan_[i - 1].first == a)) manifold = false;
      if (!std::binary_search(ring_.begin(), ring_.end(), a)) {
        ++begins;
        start = a;
      }
    }
    if (begins > 1) manifold = false;
    if (manifold) {  // in a manifold a walk around the vertex visits every triangle once
      size_t steps = 0;
      int at = start;
      do {
        const auto found = std::lower_bound(fan_.begin(), fan_.end(), std::make_pair(at, -1));
        if (found == fan_.end() || found->first != at) break;
        at = found->second;
        ++steps;
      } while (at != start && steps <= fan_.size());
      manifold = steps == fan_.size();
    }
    if (!manifold) fixed_[v] = 1;
    boundary_[v] = begins > 0;
  }

  void BuildQuadrics() {
    quadrics_.resize(position_.cols());
    for (int f = 0; f < triangles_.cols(); ++f) {
      for (int p = 0; p < num_poses_; ++p) {
        Eigen::Vector3d x[3];
        for (int k = 0; k < 3; ++k) x[k] = At(triangles_(k, f), p);
        Eigen::Vector3d normal = internal::AreaNormal(x[0], x[1], x[2]);
        const double twice_area = normal.norm();
        if (!(twice_area > 0)) continue;
        normal /= twice_area;
        for (int k = 0; k < 3; ++k) {
          Quadric(triangles_(k, f), p).AddPlane(normal, x[0], twice_area / 6);
          const int a = triangles_(k, f), b = triangles_((k + 1) % 3, f);
          if (!boundary_[a] || !boundary_[b] || SharedTriangles(a, b) != 1) continue;
          const Eigen::Vector3d edge = x[(k + 1) % 3] - x[k];
          const Eigen::Vector3d upright = edge.cross(normal);
          const double length = edge.norm();
          if (!(length > 0)) continue;
          for (int v : {a, b}) {
            Quadric(v, p).AddPlane(upright / length, x[k], kBoundaryWeight * length * length / 2);
          }
        }
      }
    }
  }

  internal::Quadric& Quadric(int v, int pose) { return quadrics_[v * num_poses_ + pose]; }

  int SharedTriangles(int a, int b) {
    if (fan_size_[a] > fan_size_[b]) std::swap(a, b);
    int count = 0;
    ForFan(a, [&](int x, int y) { count += x == b || y == b; });
    return count;
  }

  double Cost(int from, int to) {
    double cost = 0;
    for (int p = 0; p < num_poses_; ++p) {
      const Eigen::Vector3d target = At(to, p);
      internal::Quadric sum = Quadric(from, p);
      sum += Quadric(to, p);
      const double squared_length = (target - At(from, p)).squaredNorm();
      cost += std::abs(sum(target)) + kLengthWeight * squared_length * squared_length;
    }
    return cost;
  }

  static double Quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c) {
    const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return sides > 0 ? 4 * std::sqrt(3.0) * internal::TriangleArea(a, b, c) / sides : 0;
  }

  bool Legal(int from, int to) { return KeepsTopology(from, to) && KeepsGeometry(from, to); }

  // The link condition (Dey, Edelsbrunner, Guha and Nekhayev, "Topology Preserving Edge
  // Contraction", 1999): the only neighbours that the two vertices have in common are the third
  // corners of the triangles at their edge. Neighbours of `to` are marked; those that are also
  // neighbours of `from` are counted, and their marks removed, so that each counts once.
  bool KeepsTopology(int from, int to) {
    if (fan_size_[to] > kLargestFan) return false;
    const int stamp = ++stamp_;
    int opposite[2], shared = 0;
    ForFan(to, [&](int a, int b) {
      mark_[a] = mark_[b] = stamp;
      if (a == from || b == from) {
        if (shared < 2) opposite[shared] = a == from ? b : a;
        ++shared;
      }
    });
    if (shared < 1 || shared > 2) return false;
    // A boundary vertex may only move along its boundary.
    if (boundary_[from] && (shared != 1 || !boundary_[to])) return false;
    int common = 0;
    bool closes = false;
    ForFan(from, [&](int a, int b) {
      for (int x : {a, b}) {
        if (x != to && mark_[x] == stamp) {
          mark_[x] = 0;
          ++common;
        }
      }
      // A triangle that would coincide with another one of `to`.
      if (shared == 2 && a != to && b != to && (a == opposite[0] || a == opposite[1]) &&
          (b == opposite[0] || b == opposite[1])) {
        ForFan(to, [&](int c, int d) {
          closes = closes || ((c == a || c == b) && (d == a || d == b));
        });
      }
    });
    if (common != shared || closes) return false;
    if (fan_size_[from] > 1) return true;
    // The last triangle of `from` may only be removed if its third side is in the interior of a
    // surface; otherwise a component, a bridge between two components or a fin would be lost.
    int first = 0, second = 0;
    ForFan(to, [&](int a, int b) {
      first += a == opposite[0];
      second += b == opposite[0];
    });
    return first == 1 && second == 1;
  }

  bool KeepsGeometry(int from, int to) {
    for (int p = 0; p < num_poses_; ++p) {
      const Eigen::Vector3d old_place = At(from, p), new_place = At(to, p);
      double worst_before = 1, worst_after = 1;
      bool flips = false;
      ForFan(from, [&](int a, int b) {
        const Eigen::Vector3d xa = At(a, p), xb = At(b, p);
        worst_before = std::min(worst_before, Quality(old_place, xa, xb));
        if (a == to || b == to || flips) return;
        worst_after = std::min(worst_after, Quality(new_place, xa, xb));
        const Eigen::Vector3d before = internal::AreaNormal(old_place, xa, xb);
        const Eigen::Vector3d after = internal::AreaNormal(new_place, xa, xb);
        // `<` on purpose: a triangle without area before has no orientation.
        flips = before.dot(after) < kMinCosine * before.norm() * after.norm();
      });
      if (flips || worst_after < std::min(kMinQuality, worst_before)) return false;
    }
    return true;
  }

  // The neighbours of v.
  void FindRing(int v, std::vector<int>* ring) {
    ring->clear();
    const int stamp = ++stamp_;
    ForFan(v, [&](int a, int b) {
      for (int x : {a, b}) {
        if (mark_[x] != stamp) {
          mark_[x] = stamp;
          ring->push_back(x);
        }
      }
    });
  }

  // Enqueues the cheapest possible collapse of `from`, if there is one.
  void Push(int from) {
    ++version_[from];
    if (fixed_[from] || fan_size_[from] > kLargestFan) return;
    FindRing(from, &ring_);
    candidates_.clear();
    for (int to : ring_) candidates_.emplace_back(Cost(from, to), to);
    std::sort(candidates_.begin(), candidates_.end());
    for (const auto& [cost, to] : candidates_) {
      if (Legal(from, to)) {
        queue_.emplace(cost, from, to, version_[from]);
        return;
      }
    }
  }

  void Apply(int from, int to) {
    // The triangles of `from` become triangles of `to`, except those at their edge.
    int last = -1;
    for (int corner = head_[from]; corner >= 0; corner = next_[corner]) {
      const int f = corner / 3;
      last = corner;
      if (!alive_[f]) continue;
      if ((triangles_.col(f).array() == to).any()) {
        alive_[f] = 0;
        --num_alive_;
        for (int v : triangles_.col(f)) --fan_size_[v];
      } else {
        triangles_(corner % 3, f) = to;
        ++fan_size_[to];
      }
    }
    if (last >= 0) {
      next_[last] = head_[to];
      head_[to] = head_[from];
    }
    head_[from] = -1;
    ++version_[from];
    for (int p = 0; p < num_poses_; ++p) Quadric(to, p) += Quadric(from, p);

    FindRing(to, &touched_);
    Push(to);
    for (int v : touched_) Push(v);
  }

  Eigen::Matrix3Xi triangles_;
  std::vector<char> alive_;
  int num_alive_, num_poses_;
  std::vector<int> head_, next_;  // per vertex, its corners as a linked list
  std::vector<int> fan_size_;     // per vertex, its number of triangles
  Eigen::Matrix3Xd position_;
  std::vector<internal::Quadric> quadrics_;  // like position_
  std::vector<int> mark_;
  int stamp_ = 0;
  std::vector<char> fixed_, boundary_;
  std::vector<int> version_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue_;
  std::vector<std::pair<int, int>> fan_;
  std::vector<int> ring_, touched_;
  std::vector<std::pair<double, int>> candidates_;
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
