#ifndef SHAPESPACE_STATISTICS_DETAIL_WEIGHTED_POSES_H_
#define SHAPESPACE_STATISTICS_DETAIL_WEIGHTED_POSES_H_

#include <string>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Those of some poses that have a positive weight: others are as if they had not been given.
struct WeightedPoses {
  std::vector<Shape> poses;
  std::vector<double> weights;  ///< of these; any sum
  std::vector<size_t> which;    ///< their numbers among those given

  /// Without any `all_weights` all are 1. \throw InvalidOptions if they are not one for each pose.
  WeightedPoses(const std::vector<Shape>& all, std::vector<double> all_weights) {
    if (all_weights.empty()) all_weights.assign(all.size(), 1);
    if (all_weights.size() != all.size()) {
      throw InvalidOptions("weights", "must be " + std::to_string(all.size()) +
                                          ", one for each pose, not " +
                                          std::to_string(all_weights.size()));
    }
    for (size_t i = 0; i < all.size(); ++i) {
      if (all_weights[i] == 0) continue;
      poses.push_back(all[i]);
      weights.push_back(all_weights[i]);
      which.push_back(i);
    }
  }
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_WEIGHTED_POSES_H_
