#ifndef SHAPESPACE_BASE_INTERNAL_QUOTED_H_
#define SHAPESPACE_BASE_INTERNAL_QUOTED_H_

#include <string>
#include <string_view>

namespace shapespace::internal {

/// A word prepared for a message: shortened, and without bytes that a terminal cannot show.
inline std::string Quoted(std::string_view word) {
  constexpr size_t kLongest = 40;
  std::string result = "'";
  for (char c : word.substr(0, kLongest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (word.size() > kLongest ? "...'" : "'");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_QUOTED_H_
