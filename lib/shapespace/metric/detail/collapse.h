#ifndef SHAPESPACE_METRIC_DETAIL_COLLAPSE_H_
#define SHAPESPACE_METRIC_DETAIL_COLLAPSE_H_

#include <Eigen/Core>

#include <shapespace/metric/metric_basis.h>

namespace shapespace::internal {

/// The share of its weight that the triangle (a, b, c) of the basis' mesh keeps: half if its strain
/// changes by e^3 = 20 times the length from one pose to the next, and next to nothing beyond, so
/// that a triangle that collapses costs less than one that is stretched strongly, although its
/// logarithm has no limit. Where lids close, or vertices are merged in one pose, everything else
/// would move otherwise to make the collapse cheaper, and no path could be relaxed. If all pairs of
/// poses count, the change is the diagonal of the box around all strains. `collapsed_squared` is
/// the basis' CollapsedSquared(), which takes the time of all edges; `rest` is what RestNumbers
/// returns.
double KeptInCollapse(const MetricBasis& basis, double collapsed_squared,
                      const Eigen::Vector4d& rest, int a, int b, int c);

/// The same for an edge that is no side of a triangle, of the logarithm of its length.
double KeptInCollapse(const MetricBasis& basis, double collapsed_squared, int a, int b);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_METRIC_DETAIL_COLLAPSE_H_
