#include <shapespace/output/detail/normals.h>

#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

// Cosine of 55 degrees: an eight-sided tube (45) still looks round, a box (90) does not.
constexpr float kCreaseCosine = 0.5735764f;

}  // namespace

Eigen::Matrix3Xf CornerNormals(const Connectivity& connectivity, const Shape& shape) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  Eigen::Matrix3Xf unit(3, triangles.cols());
  Eigen::VectorXf area(triangles.cols());
  for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
    const Eigen::Vector3d normal = AreaNormal(shape, triangles.col(f));
    area[f] = static_cast<float>(normal.norm());
    unit.col(f) = normal.stableNormalized().cast<float>();
  }
  Eigen::Matrix3Xf normals(3, triangles.size());
  for (Eigen::Index i = 0; i < triangles.size(); ++i) {
    const Eigen::Vector3f own = unit.col(i / 3);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const int f : connectivity.TrianglesOfVertices()[triangles.data()[i]]) {
      const Eigen::Vector3f other = unit.col(f);
      if (own.dot(other) >= kCreaseCosine) sum += area[f] * other;
    }
    normals.col(i) = sum.stableNormalized();
  }
  return normals;
}

}  // namespace shapespace::internal
