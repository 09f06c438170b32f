#ifndef SHAPESPACE_BASE_NOT_COMPUTED_H_
#define SHAPESPACE_BASE_NOT_COMPUTED_H_

#include <limits>

namespace shapespace {

/// The value of a figure until it is computed: not a number, and null in JSON. A zero would look
/// like the best of results.
inline constexpr double kNotComputed = std::numeric_limits<double>::quiet_NaN();

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_NOT_COMPUTED_H_
