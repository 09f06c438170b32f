#ifndef SHAPESPACE_BASE_INTERNAL_CHECK_RANGE_H_
#define SHAPESPACE_BASE_INTERNAL_CHECK_RANGE_H_

#include <cstddef>
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

/// \throw InvalidOptions unless a field that may be empty has one entry for each of `expected`
///        `things`.
inline void CheckCount(const std::string& field, size_t count, size_t expected,
                       const std::string& things) {
  if (count == 0 || count == expected) return;
  throw InvalidOptions(field, "given for " + std::to_string(count) + " " + things +
                                  ", but there are " + std::to_string(expected));
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_CHECK_RANGE_H_
