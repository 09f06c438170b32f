#include <shapespace/output/detail/utf8.h>

namespace shapespace::internal {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

// The character that begins at `at`, which moves behind it.
char32_t NextCharacter(std::string_view text, size_t* at) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte((*at)++);
  if (first < 0x80) return first;
  if (first < 0xC2 || first > 0xF4) return kReplacement;
  const int more = first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
  char32_t character = first & (0x3Fu >> more);
  for (int i = 0; i < more; ++i) {
    if (*at == text.size()) return kReplacement;
    const unsigned next = byte(*at);
    unsigned low = 0x80, high = 0xBF;
    if (i == 0) {
      // Without characters in more bytes than they need, surrogates, and what is beyond U+10FFFF.
      if (first == 0xE0) low = 0xA0;
      if (first == 0xED) high = 0x9F;
      if (first == 0xF0) low = 0x90;
      if (first == 0xF4) high = 0x8F;
    }
    if (next < low || next > high) return kReplacement;
    character = character << 6 | (next & 0x3F);
    ++*at;
  }
  return character;
}

}  // namespace

std::u32string DecodeUtf8(std::string_view text) {
  std::u32string characters;
  for (size_t at = 0; at < text.size();) characters += NextCharacter(text, &at);
  return characters;
}

}  // namespace shapespace::internal
