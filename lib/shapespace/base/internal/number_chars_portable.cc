#include <shapespace/base/internal/number_chars.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <system_error>

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
  const std::string text(begin, end);
  // strtod takes leading white space, a plus and hexadecimal numbers as well.
  const size_t first = text.substr(0, 1) == "-" ? 1 : 0;
  const std::string starts = text.substr(first, 1);
  if (starts.empty() || starts.find_first_not_of("0123456789.iInN") != std::string::npos) {
    return {begin, std::errc::invalid_argument};
  }
  const bool hexadecimal = starts == "0" && text.find_first_of("xX") == first + 1;
  if (hexadecimal) {
    *value = first == 1 ? -0.0 : 0.0;
    return {begin + first + 1, {}};
  }
  char* stop = nullptr;
  errno = 0;
  const double number = std::strtod(text.c_str(), &stop);
  if (stop == text.c_str()) return {begin, std::errc::invalid_argument};
  const char* const at = begin + (stop - text.c_str());
  // What is below the least normal number is none the less a number.
  if (errno == ERANGE && (number == 0 || std::isinf(number))) {
    return {at, std::errc::result_out_of_range};
  }
  *value = number;
  return {at, {}};
}

char* ToChars(char* begin, char* end, double value) {
  return ShortestDigits(begin, end, value, std::strtod);
}

char* ToChars(char* begin, char* end, float value) {
  return ShortestDigits(begin, end, value, std::strtof);
}

}  // namespace shapespace::internal
