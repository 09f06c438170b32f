#ifndef SHAPESPACE_CONTACT_INTERNAL_SLIDE_H_
#define SHAPESPACE_CONTACT_INTERNAL_SLIDE_H_

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// What came of `SlideAtContact`; fields of a summary with these names.
struct SlideResult {
  int uncertified_segments = 0;
  double contact_distance = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> warnings;
};

/// If `path`, shapes in the metric's unit, passes through itself, replaces each but the first by
/// the nearest one to it, in the metric, that can be reached from the shape before without anything
/// touching on the way. That way may be longer than the straight motion between the two, which then
/// is not certified.
/// \throw Cancelled; the shapes are as before then.
SlideResult SlideAtContact(const std::shared_ptr<const Metric>& metric, Progress* progress,
                           std::vector<Shape>* path);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_INTERNAL_SLIDE_H_
