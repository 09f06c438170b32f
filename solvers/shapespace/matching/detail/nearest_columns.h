#ifndef SHAPESPACE_MATCHING_DETAIL_NEAREST_COLUMNS_H_
#define SHAPESPACE_MATCHING_DETAIL_NEAREST_COLUMNS_H_

#include <vector>

#include <Eigen/Core>

namespace shapespace::internal {

/// For each column of `queries`, the nearest column of `points`, of equally near ones the first.
/// All pairs are compared, which in 30 dimensions and more is faster than any tree. `points` must
/// not be empty. On all threads.
std::vector<int> NearestColumns(const Eigen::Ref<const Eigen::MatrixXf>& queries,
                                const Eigen::Ref<const Eigen::MatrixXf>& points);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_NEAREST_COLUMNS_H_
