#include <shapespace/matching/internal/check_body.h>

#include <shapespace/base/error.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {

bool HasArea(const Connectivity& connectivity, const Shape& shape) {
  const double extent = (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).maxCoeff();
  double area = 0;
  for (int f = 0; f < connectivity.NumTriangles() && extent > 0; ++f) {
    const auto triangle = connectivity.Triangles().col(f);
    const Eigen::Vector3d a = shape.col(triangle(0));
    area += TriangleArea(Eigen::Vector3d::Zero(), (shape.col(triangle(1)) - a) / extent,
                         (shape.col(triangle(2)) - a) / extent);
  }
  return area > 0;
}

void CheckBody(const std::string& name, const Connectivity& connectivity, const Shape& shape) {
  if (connectivity.NumTriangles() == 0) {
    throw MeshError("the " + name + " has no triangles; correspondence needs a surface");
  }
  if (shape.cols() != connectivity.NumVertices()) {
    throw MeshError("the " + name + " has " + std::to_string(connectivity.NumVertices()) +
                    " vertices, its shape " + std::to_string(shape.cols()));
  }
  if (!shape.allFinite() || shape.cwiseAbs().maxCoeff() > kLargestCoordinate) {
    throw MeshError("the " + name + " has a coordinate that is enormous or not finite");
  }
  if (!HasArea(connectivity, shape)) throw MeshError("the " + name + " has no area");
}

}  // namespace shapespace::internal
