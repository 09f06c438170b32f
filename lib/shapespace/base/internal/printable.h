#ifndef SHAPESPACE_BASE_INTERNAL_PRINTABLE_H_
#define SHAPESPACE_BASE_INTERNAL_PRINTABLE_H_

#include <cstdio>
#include <string>
#include <string_view>

namespace shapespace::internal {

/// A text from a file, such as a name, prepared for a terminal: control characters, with which it
/// could move the cursor, change colours or hide what is printed, become "\x1b". `kept` are those
/// that remain. Everything else, in UTF-8, is unchanged.
inline std::string Printable(std::string_view text, std::string_view kept = "") {
  std::string result;
  const auto escape = [&result](unsigned char byte) {
    char digits[5];
    std::snprintf(digits, sizeof digits, "\\x%02x", byte);
    result += digits;
  };
  for (size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if ((byte < 0x20 || byte == 0x7f) && kept.find(text[i]) == kept.npos) {
      escape(byte);
    } else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {  // U+0080 to U+009F
      escape(next);
      ++i;
    } else {
      result += text[i];
    }
  }
  return result;
}

/// Those of messages, which may have several lines.
inline constexpr std::string_view kOfMessages = "\n\t";

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_PRINTABLE_H_
