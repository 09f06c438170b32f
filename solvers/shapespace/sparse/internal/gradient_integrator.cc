#include <shapespace/sparse/internal/gradient_integrator.h>

#include <algorithm>
#include <utility>

#include <Eigen/SparseCore>

#include <shapespace/mesh/internal/sides.h>
#include <shapespace/sparse/internal/solve.h>

namespace shapespace::internal {
namespace {

constexpr double kPositionWeight = 1e-4;
// Weight of a tie. Sides of triangles have weights near 1, and places, together, kPlace.
constexpr double kTieWeight = 1e-2;

Eigen::SparseMatrix<double> Matrix(int num_vertices,
                                   const std::vector<GradientIntegrator::Side>& sides,
                                   double position_weight) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < num_vertices; ++v) entries.emplace_back(v, v, position_weight);
  for (const auto& [a, b, weight] : sides) {
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
  }
  Eigen::SparseMatrix<double> matrix(num_vertices, num_vertices);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// All sides of triangles, then the edges with an end in no triangle, then, from `first_tie`, the
// stiffeners between components of the surface.
std::vector<GradientIntegrator::Side> SidesOf(const Connectivity& connectivity,
                                              const Eigen::Matrix3Xd& weights,
                                              Eigen::Index* first_tie) {
  std::vector<GradientIntegrator::Side> sides, ties;
  UnionFind pieces(connectivity.NumVertices());
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const Eigen::Vector3i corners = connectivity.Triangles().col(f);
    for (int k = 0; k < 3; ++k) {
      const int a = corners(k), b = corners((k + 1) % 3);
      sides.push_back({a, b, weights(k, f)});
      pieces.Join(a, b);
    }
  }
  const auto is_loose = [&](int v) { return connectivity.TrianglesOfVertices()[v].size() == 0; };
  for (int e = connectivity.NumTriangleEdges(); e < connectivity.NumEdges(); ++e) {
    const int a = connectivity.Edges()(0, e), b = connectivity.Edges()(1, e);
    if (is_loose(a) || is_loose(b)) {
      sides.push_back({a, b, 1});
    } else if (pieces.Find(a) != pieces.Find(b)) {
      ties.push_back({a, b, kTieWeight});
    }
  }
  *first_tie = static_cast<Eigen::Index>(sides.size());
  sides.insert(sides.end(), ties.begin(), ties.end());
  return sides;
}

}  // namespace

GradientIntegrator::GradientIntegrator(int num_vertices, std::vector<Side> sides)
    : sides_(std::move(sides)),
      position_weight_(kPositionWeight / num_vertices),
      factor_(Matrix(num_vertices, sides_, position_weight_)) {}

Shape GradientIntegrator::Integrate(const Eigen::Matrix3Xd& wanted, const Shape& positions) const {
  Shape right = position_weight_ * positions;
  for (size_t i = 0; i < sides_.size(); ++i) {
    const auto& [a, b, weight] = sides_[i];
    const Eigen::Vector3d side = wanted.col(static_cast<Eigen::Index>(i));
    right.col(b) += weight * side;
    right.col(a) -= weight * side;
  }
  return Solve(factor_, right.transpose()).transpose();
}

SurfaceIntegrator::SurfaceIntegrator(const Connectivity& connectivity,
                                     const Eigen::Matrix3Xd& weights)
    : connectivity_(connectivity),
      integrator_(connectivity.NumVertices(), SidesOf(connectivity, weights, &first_tie_)) {}

}  // namespace shapespace::internal
