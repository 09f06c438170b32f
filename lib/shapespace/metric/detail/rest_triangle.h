#ifndef SHAPESPACE_METRIC_DETAIL_REST_TRIANGLE_H_
#define SHAPESPACE_METRIC_DETAIL_REST_TRIANGLE_H_

#include <Eigen/Core>

#include <shapespace/metric/metric_basis.h>

namespace shapespace::internal {

/// The numbers of `TriangleStrain` for the triangle (a, b, c) of the basis' mesh.
/// `collapsed_squared` is the basis' CollapsedSquared(), which takes the time of all edges.
Eigen::Vector4d RestNumbers(const MetricBasis& basis, double collapsed_squared, int a, int b,
                            int c);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_METRIC_DETAIL_REST_TRIANGLE_H_
