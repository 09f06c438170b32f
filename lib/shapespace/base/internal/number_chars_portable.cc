#include <shapespace/base/internal/number_chars.h>

#include <cstdio>
#include <cstdlib>
#include <limits>

#include <fast_float/fast_float.h>

namespace shapespace::internal {
namespace {

template <typename Number>
char* ShortestDigits(char* begin, char* end, Number value, Number (*read)(const char*, char**)) {
  int written = 0;
  for (int digits = std::numeric_limits<Number>::digits10;
       digits <= std::numeric_limits<Number>::max_digits10; ++digits) {
    written = std::snprintf(begin, end - begin, "%.*g", digits, static_cast<double>(value));
    if (read(begin, nullptr) == value) break;
  }
  return begin + written;
}

}  // namespace

std::from_chars_result FromChars(const char* begin, const char* end, double* value) {
  const auto [stop, error] = fast_float::from_chars(begin, end, *value);
  return {stop, error};
}

char* ToChars(char* begin, char* end, double value) {
  return ShortestDigits(begin, end, value, std::strtod);
}

char* ToChars(char* begin, char* end, float value) {
  return ShortestDigits(begin, end, value, std::strtof);
}

}  // namespace shapespace::internal
