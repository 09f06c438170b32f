#include <shapespace/metric/feature.h>

namespace shapespace {

void Feature::GatherCoordinates(int begin, int end, const Shape& shape, double* x) const {
  const int* const last = stencils_ + vertices_ * end;
  for (const int* v = stencils_ + vertices_ * begin; v != last; ++v, x += 3) {
    Eigen::Map<Eigen::Vector3d> vertex(x);
    vertex = shape.col(*v);
  }
}

}  // namespace shapespace
