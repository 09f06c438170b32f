#include <shapespace/sparse/internal/gradient_integrator.h>

#include <algorithm>
#include <utility>

#include <Eigen/SparseCore>

#include <shapespace/mesh/internal/sides.h>
#include <shapespace/sparse/internal/solve.h>

namespace shapespace::internal {
namespace {

constexpr double kPlace = 1e-4;
// Weight of a tie. Sides of triangles have weights near 1, and places, together, kPlace.
constexpr double kTieWeight = 1e-2;

Eigen::SparseMatrix<double> Matrix(int num_vertices,
                                   const std::vector<GradientIntegrator::Side>& sides,
                                   double place) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < num_vertices; ++v) entries.emplace_back(v, v, place);
  for (const auto& [a, b, weight] : sides) {
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
  }
  Eigen::SparseMatrix<double> matrix(num_vertices, num_vertices);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

GradientIntegrator::GradientIntegrator(int num_vertices, std::vector<Side> sides)
    : sides_(std::move(sides)),
      place_(kPlace / num_vertices),
      factor_(Matrix(num_vertices, sides_, place_)) {}

std::vector<GradientIntegrator::Side> GradientIntegrator::SidesWithoutTriangles(
    const Connectivity& connectivity) {
  const auto is_loose = [&](int v) { return connectivity.TrianglesOfVertices()[v].size() == 0; };
  std::vector<Side> sides;
  for (int e = connectivity.NumTriangleEdges(); e < connectivity.NumEdges(); ++e) {
    const int a = connectivity.Edges()(0, e), b = connectivity.Edges()(1, e);
    if (is_loose(a) || is_loose(b)) sides.push_back({a, b, 1});
  }
  return sides;
}

std::vector<GradientIntegrator::Side> GradientIntegrator::Ties(const Connectivity& connectivity) {
  UnionFind pieces(connectivity.NumVertices());
  for (int e = 0; e < connectivity.NumTriangleEdges(); ++e) {
    pieces.Join(connectivity.Edges()(0, e), connectivity.Edges()(1, e));
  }
  const auto on_surface = [&](int v) { return connectivity.TrianglesOfVertices()[v].size() > 0; };
  std::vector<Side> ties;
  for (int e = connectivity.NumTriangleEdges(); e < connectivity.NumEdges(); ++e) {
    const int a = connectivity.Edges()(0, e), b = connectivity.Edges()(1, e);
    if (on_surface(a) && on_surface(b) && pieces.Find(a) != pieces.Find(b)) {
      ties.push_back({a, b, kTieWeight});
    }
  }
  return ties;
}

Shape GradientIntegrator::Integrate(const Eigen::Matrix3Xd& wanted, const Shape& places) const {
  Shape right = place_ * places;
  for (size_t i = 0; i < sides_.size(); ++i) {
    const auto& [a, b, weight] = sides_[i];
    const Eigen::Vector3d side = wanted.col(static_cast<Eigen::Index>(i));
    right.col(b) += weight * side;
    right.col(a) -= weight * side;
  }
  return Solve(factor_, right.transpose()).transpose();
}

}  // namespace shapespace::internal
