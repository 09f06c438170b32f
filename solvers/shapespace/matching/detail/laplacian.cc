#include <shapespace/matching/detail/laplacian.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace shapespace::internal {
namespace {

// By how much two sides of a triangle must be longer than the third, as a share of the mean edge:
// the value of Sharp and Crane.
constexpr double kSlack = 1e-5;

// Lengths of the sides opposite to each corner, 3 x T.
Eigen::Matrix3Xd SideLengths(const Connectivity& connectivity, const Shape& shape) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  Eigen::Matrix3Xd lengths(3, triangles.cols());
  for (int f = 0; f < triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      lengths(k, f) =
          (shape.col(triangles((k + 1) % 3, f)) - shape.col(triangles((k + 2) % 3, f))).norm();
    }
  }
  const double slack = kSlack * lengths.mean();
  double missing = 0;
  for (const auto& sides : lengths.colwise()) {
    missing = std::max(missing, slack - (sides.sum() - 2 * sides.maxCoeff()));
  }
  lengths.array() += missing;
  return lengths;
}

// The area of a triangle with such sides, by Heron's formula in the form of W. Kahan, which is
// accurate for needles.
double AreaOfSides(const Eigen::Vector3d& sides) {
  double a = sides(0), b = sides(1), c = sides(2);
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);
  if (b < c) std::swap(b, c);
  return 0.25 * std::sqrt((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)));
}

}  // namespace

Laplacian MakeLaplacian(const Connectivity& connectivity, const Shape& shape) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  const int num_vertices = connectivity.NumVertices();
  const Eigen::Matrix3Xd lengths = SideLengths(connectivity, shape);
  Laplacian laplacian;
  laplacian.areas = Eigen::VectorXd::Zero(num_vertices);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * static_cast<size_t>(triangles.cols()));
  for (int f = 0; f < triangles.cols(); ++f) {
    const Eigen::Vector3d sides = lengths.col(f);
    const double area = AreaOfSides(sides);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const int a = triangles(i, f), b = triangles(j, f);
      const double cotangent =
          (sides(i) * sides(i) + sides(j) * sides(j) - sides(k) * sides(k)) / (4 * area);
      entries.emplace_back(a, b, -0.5 * cotangent);
      entries.emplace_back(b, a, -0.5 * cotangent);
      entries.emplace_back(a, a, 0.5 * cotangent);
      entries.emplace_back(b, b, 0.5 * cotangent);
      laplacian.areas(triangles(k, f)) += area / 3;
    }
  }
  laplacian.stiffness.resize(num_vertices, num_vertices);
  laplacian.stiffness.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

}  // namespace shapespace::internal
