#ifndef SHAPESPACE_OUTPUT_DETAIL_LEGEND_H_
#define SHAPESPACE_OUTPUT_DETAIL_LEGEND_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/output/picture.h>

namespace shapespace::internal {

/// The value at the end of the colour scale: the 99th percentile of `values`, rounded up to 1, 2 or
/// 5 times a power of ten; their maximum if that percentile is 0; 1 % if all are 0.
double EndOfScale(const std::vector<Eigen::VectorXd>& values);

/// A bar of the value colours with numbers in per cent, and `title` beside it, as a separate
/// picture on the strip's background, with text of this size. `largest` is stated if it exceeds the
/// scale.
RgbImage DrawLegend(double end_of_scale, double largest, const std::string& title, int size);

/// The same for groups: the colours of the first `groups`, at most 24, with numbers from 1.
RgbImage DrawGroupLegend(int groups, const std::string& title, int size);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_LEGEND_H_
