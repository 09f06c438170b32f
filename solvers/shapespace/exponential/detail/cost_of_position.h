#ifndef SHAPESPACE_EXPONENTIAL_DETAIL_COST_OF_POSITION_H_
#define SHAPESPACE_EXPONENTIAL_DETAIL_COST_OF_POSITION_H_

#include <memory>

#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// The metric itself if it has a cost of position; otherwise the metric with a very small one added
/// (lambda 1e-6). Without it rigid motions cost nothing, so that the next shape of a geodesic is
/// determined only up to one. With it, however small, linear and angular momentum are conserved as
/// for a free body.
std::shared_ptr<const Metric> WithCostOfPosition(const std::shared_ptr<const Metric>& metric);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_DETAIL_COST_OF_POSITION_H_
