#ifndef SHAPESPACE_METRIC_INTERNAL_COLLAPSE_H_
#define SHAPESPACE_METRIC_INTERNAL_COLLAPSE_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/metric/metric_basis.h>

namespace shapespace::internal {

/// The share of its weight that an element keeps whose strain changes by `change` from one pose to
/// another: half at e^3 = 20 times the length, and next to nothing beyond, so that an element that
/// collapses costs less than one that is stretched strongly, although its logarithm has no limit.
/// Where lids close, or vertices are merged in one pose, everything else would move otherwise to
/// make the collapse cheaper, and no path could be relaxed.
double KeptInCollapse(double change);

/// The same for the triangle (a, b, c) of the basis' mesh: of the greatest change between
/// consecutive poses or, if all pairs count, of the diagonal of the box around all its strains.
double KeptInCollapse(const MetricBasis& basis, int a, int b, int c);

/// The same for an edge that is no side of a triangle, of the logarithm of its length.
double KeptInCollapse(const MetricBasis& basis, int a, int b);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_METRIC_INTERNAL_COLLAPSE_H_
