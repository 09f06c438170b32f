#include <shapespace/base/internal/number_chars.h>

namespace shapespace::internal {

std::from_chars_result FromChars(const char* begin, const char* end, double* value) {
  return std::from_chars(begin, end, *value);
}

char* ToChars(char* begin, char* end, double value) { return std::to_chars(begin, end, value).ptr; }

char* ToChars(char* begin, char* end, float value) { return std::to_chars(begin, end, value).ptr; }

}  // namespace shapespace::internal
