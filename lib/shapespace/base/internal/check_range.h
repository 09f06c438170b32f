#ifndef SHAPESPACE_BASE_INTERNAL_CHECK_RANGE_H_
#define SHAPESPACE_BASE_INTERNAL_CHECK_RANGE_H_

#include <sstream>
#include <string>

#include <shapespace/base/error.h>

namespace shapespace::internal {

/// \throw InvalidOptions unless `value` is in [least, most].
template <typename Number>
void CheckRange(const std::string& field, Number value, Number least, Number most) {
  if (value >= least && value <= most) return;
  std::ostringstream message;
  message << "must be from " << least << " to " << most;
  throw InvalidOptions(field, message.str());
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_CHECK_RANGE_H_
