#include <shapespace/bodies/detail/marching_tetrahedra.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

class Marcher {
 public:
  Marcher(const std::vector<RoundCone>& cones, double cell) : cones_(cones), cell_(cell) {
    Eigen::AlignedBox3d box;
    for (const RoundCone& cone : cones) {
      for (const auto& [centre, radius] :
           {std::pair(cone.begin, cone.begin_radius), std::pair(cone.end, cone.end_radius)}) {
        // Fillets add less than their width.
        const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius + cone.blend + cell);
        box.extend(centre - reach).extend(centre + reach);
      }
    }
    origin_ = box.min();
    for (int k = 0; k < 3; ++k) nodes_[k] = static_cast<int>(box.sizes()(k) / cell) + 2;
  }

  TriangleMesh Run() {
    values_.resize(std::size_t{1} * nodes_[0] * nodes_[1] * nodes_[2]);
    ParallelFor(nodes_[0], [&](int i) {
      for (int j = 0; j < nodes_[1]; ++j) {
        for (int k = 0; k < nodes_[2]; ++k) {
          const int node = Node(i, j, k);
          values_[node] = Evaluate(cones_, Point(node)).value;
        }
      }
    });
    for (int i = 0; i + 1 < nodes_[0]; ++i) {
      for (int j = 0; j + 1 < nodes_[1]; ++j) {
        for (int k = 0; k + 1 < nodes_[2]; ++k) AddCell({i, j, k});
      }
    }
    return std::move(mesh_);
  }

 private:
  int Node(int i, int j, int k) const { return (i * nodes_[1] + j) * nodes_[2] + k; }

  Eigen::Vector3d Point(int node) const {
    const int k = node % nodes_[2], j = node / nodes_[2] % nodes_[1];
    const int i = node / nodes_[2] / nodes_[1];
    return origin_ + cell_ * Eigen::Vector3d(i, j, k);
  }

  /// Six tetrahedra, one for each order of the three axes on the way from a corner to the opposite
  /// one, so that neighbouring cells divide their common face in the same way.
  void AddCell(const std::array<int, 3>& corner) {
    static constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                          {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : kOrders) {
      std::array<int, 3> at = corner;
      std::vector<int> inside, outside;
      for (int step = 0; step < 4; ++step) {
        if (step > 0) ++at[order[step - 1]];
        const int node = Node(at[0], at[1], at[2]);
        (values_[node] < 0 ? inside : outside).push_back(node);
      }
      if (inside.size() == 1) {
        AddTriangle(Crossing(inside[0], outside[0]), Crossing(inside[0], outside[1]),
                    Crossing(inside[0], outside[2]), inside, outside);
      } else if (inside.size() == 3) {
        AddTriangle(Crossing(inside[0], outside[0]), Crossing(inside[1], outside[0]),
                    Crossing(inside[2], outside[0]), inside, outside);
      } else if (inside.size() == 2) {
        const int a = Crossing(inside[0], outside[0]), b = Crossing(inside[0], outside[1]);
        const int c = Crossing(inside[1], outside[1]), d = Crossing(inside[1], outside[0]);
        AddTriangle(a, b, c, inside, outside);
        AddTriangle(a, c, d, inside, outside);
      }
    }
  }

  /// The vertex on the edge between two nodes.
  int Crossing(int inside, int outside) {
    const std::int64_t key = std::int64_t{inside} << 32 | outside;
    const auto [at, is_new] = vertices_.try_emplace(key, static_cast<int>(mesh_.points.size()));
    if (is_new) {
      // At a distance from the nodes, so that no triangle has zero area.
      const double part = values_[inside] / (values_[inside] - values_[outside]);
      mesh_.points.push_back(Point(inside) +
                             std::clamp(part, 0.05, 0.95) * (Point(outside) - Point(inside)));
    }
    return at->second;
  }

  void AddTriangle(int a, int b, int c, const std::vector<int>& inside,
                   const std::vector<int>& outside) {
    const Eigen::Vector3d& p = mesh_.points[a];
    const Eigen::Vector3d normal = AreaNormal(p, mesh_.points[b], mesh_.points[c]);
    // All inner nodes are on one side of the triangle, all outer ones on the other.
    const double side = normal.dot(Point(outside[0]) - p) - normal.dot(Point(inside[0]) - p);
    mesh_.triangles.push_back(side > 0 ? Eigen::Vector3i(a, b, c) : Eigen::Vector3i(a, c, b));
  }

  const std::vector<RoundCone>& cones_;
  const double cell_;
  Eigen::Vector3d origin_;
  std::array<int, 3> nodes_;
  std::vector<double> values_;
  std::unordered_map<std::int64_t, int> vertices_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh March(const std::vector<RoundCone>& cones, double cell) {
  return Marcher(cones, cell).Run();
}

}  // namespace shapespace::internal
