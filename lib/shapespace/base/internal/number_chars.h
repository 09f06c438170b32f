#ifndef SHAPESPACE_BASE_INTERNAL_NUMBER_CHARS_H_
#define SHAPESPACE_BASE_INTERNAL_NUMBER_CHARS_H_

#include <charconv>
#include <type_traits>

// std::from_chars and std::to_chars, of which Clang's library had those of floating-point numbers
// late, in versions 20 and 14: second definitions are for it (SHAPESPACE_PORTABLE).

namespace shapespace::internal {

std::from_chars_result FromChars(const char* begin, const char* end, double* value);

/// Writes the fewest digits from which exactly the same number is read back. \return the end of
/// what was written; 32 characters suffice.
char* ToChars(char* begin, char* end, double value);
char* ToChars(char* begin, char* end, float value);
template <typename Integer, typename = std::enable_if_t<std::is_integral_v<Integer>>>
char* ToChars(char* begin, char* end, Integer value) {
  return std::to_chars(begin, end, value).ptr;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_NUMBER_CHARS_H_
