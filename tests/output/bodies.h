#ifndef TESTS_OUTPUT_BODIES_H_
#define TESTS_OUTPUT_BODIES_H_

#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

struct SimpleBody {
  std::shared_ptr<const Connectivity> connectivity;
  Shape shape;
};

/// A sphere of circles of latitude, oriented outwards; its poles are on the y axis.
inline SimpleBody Sphere(double radius, int circles = 40, int around = 80) {
  SimpleBody body;
  body.shape.resize(3, circles * around);
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i < circles; ++i) {
    const double latitude = EIGEN_PI * i / (circles - 1);
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * EIGEN_PI * j / around;
      body.shape.col(i * around + j) =
          radius * Eigen::Vector3d(std::sin(latitude) * std::sin(angle), std::cos(latitude),
                                   std::sin(latitude) * std::cos(angle));
      if (i + 1 == circles) continue;
      const int a = i * around + j, b = i * around + (j + 1) % around;
      triangles.push_back({a, a + around, b + around});
      triangles.push_back({a, b + around, b});
    }
  }
  Eigen::Matrix3Xi faces(3, triangles.size());
  for (size_t f = 0; f < triangles.size(); ++f) faces.col(f) = triangles[f];
  body.connectivity = Connectivity::FromTriangles(static_cast<int>(body.shape.cols()), faces);
  return body;
}

/// A box centred at the origin, oriented outwards.
inline SimpleBody Box(double x, double y, double z) {
  SimpleBody body;
  body.shape.resize(3, 8);
  for (int v = 0; v < 8; ++v) {
    body.shape.col(v) << (v & 1 ? x : -x) / 2, (v & 2 ? y : -y) / 2, (v & 4 ? z : -z) / 2;
  }
  body.connectivity =
      Connectivity::Make(8, {0, 4, 8, 12, 16, 20, 24},
                         {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5});
  return body;
}

/// The same triangles with opposite orientation.
inline std::shared_ptr<const Connectivity> Reversed(const Connectivity& connectivity) {
  Eigen::Matrix3Xi triangles = connectivity.Triangles();
  triangles.row(1).swap(triangles.row(2));
  return Connectivity::FromTriangles(connectivity.NumVertices(), triangles);
}

}  // namespace shapespace

#endif  // TESTS_OUTPUT_BODIES_H_
