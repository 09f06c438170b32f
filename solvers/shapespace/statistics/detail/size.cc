#include <shapespace/statistics/detail/size.h>

#include <cmath>

#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {

double Size(const Connectivity& connectivity, const Shape& shape) {
  double area = 0, length = 0;
  for (const auto& triangle : connectivity.Triangles().colwise()) {
    area += TriangleArea(shape, triangle);
  }
  if (connectivity.NumTriangles() > 0) return std::sqrt(area);
  for (const auto& edge : connectivity.Edges().colwise()) {
    length += (shape.col(edge(1)) - shape.col(edge(0))).norm();
  }
  return length;
}

void ScaleToMeanSize(const Connectivity& connectivity, std::vector<Shape>* shapes) {
  double mean = 0;
  for (const Shape& shape : *shapes) mean += Size(connectivity, shape) / shapes->size();
  for (Shape& shape : *shapes) {
    const double size = Size(connectivity, shape);
    if (!(size > 0)) continue;  // FreezeMetric refuses it, and names it
    const Eigen::Vector3d middle = shape.rowwise().mean();
    shape = (mean / size * (shape.colwise() - middle)).colwise() + middle;
  }
}

}  // namespace shapespace::internal
