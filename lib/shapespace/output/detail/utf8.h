#ifndef SHAPESPACE_OUTPUT_DETAIL_UTF8_H_
#define SHAPESPACE_OUTPUT_DETAIL_UTF8_H_

#include <string>
#include <string_view>

namespace shapespace::internal {

/// The characters of a text in UTF-8. Each longest part that begins a character and does not
/// complete it, and each byte that begins none, becomes U+FFFD, as the Unicode standard recommends
/// (chapter 3.9).
std::u32string DecodeUtf8(std::string_view text);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_UTF8_H_
