#ifndef SHAPESPACE_BODIES_DETAIL_CHECKS_H_
#define SHAPESPACE_BODIES_DETAIL_CHECKS_H_

#include <cstdint>
#include <sstream>
#include <string>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/bodies/body.h>

namespace shapespace::internal {

/// About 2 GB of connectivity; a larger number is taken for a typing error.
constexpr std::int64_t kMaxBodyTriangles = 20'000'000;

/// Powers of lengths in this range, from the third to the minus third, do not overflow or
/// underflow.
/// \throw InvalidOptions unless `value` is in [1e-100, 1e100].
inline void CheckLength(const char* field, double value) {
  if (value >= 1e-100 && value <= 1e100) return;
  std::ostringstream message;
  message << value << " is not a length; it must be positive and finite";
  throw InvalidOptions(field, message.str());
}

/// \throw InvalidOptions if `value` is below `least`.
inline void CheckCount(const char* field, int value, int least) {
  if (value >= least) return;
  std::ostringstream message;
  message << value << " is too few; at least " << least << " are needed";
  throw InvalidOptions(field, message.str());
}

/// \throw InvalidOptions if `triangles` is more than `most`.
inline void CheckTriangles(std::int64_t triangles, std::int64_t most = kMaxBodyTriangles) {
  if (triangles >= 0 && triangles <= most) return;
  std::ostringstream message;
  message << triangles << " is outside 0 .. " << most;
  throw InvalidOptions("triangles", message.str());
}

/// `body` with a `pose` that rejects values outside of [begin, end]. Values outside by rounding
/// only, as in steps computed from the ends, are replaced by the ends.
inline ShapeFamily WithCheckedRange(ShapeFamily body) {
  body.pose = [pose = std::move(body.pose), begin = body.begin, end = body.end, name = body.name,
               parameter = body.parameter](double value) {
    const double rounding = 1e-12 * (end - begin);
    if (!(value >= begin - rounding && value <= end + rounding)) {
      std::ostringstream message;
      message << value << " is outside " << begin << " .. " << end << ", the " << parameter
              << ", of body '" << name << "'";
      throw InvalidOptions("parameter", message.str());
    }
    return pose(value < begin ? begin : value > end ? end : value);
  };
  return body;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_CHECKS_H_
