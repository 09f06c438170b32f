#include <shapespace/output/internal/text.h>

#include <algorithm>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/output/detail/utf8.h>

namespace shapespace {
namespace {

using internal::DecodeUtf8;

TEST(DecodeUtf8Test, DecodesCharactersOfEveryLength) {
  EXPECT_EQ(DecodeUtf8("B\xC3\xA4r"), U"B\u00E4r");
  EXPECT_EQ(
      DecodeUtf8("\x7F\xC2\x80\xDF\xBF\xE0\xA0\x80\xEF\xBF\xBF\xF0\x90\x80\x80\xF4\x8F\xBF\xBF"),
      (std::u32string{0x7F, 0x80, 0x7FF, 0x800, 0xFFFF, 0x10000, 0x10FFFF}));
}

// The example of the Unicode standard, table 3-8, and what UTF-8 excludes: characters in more bytes
// than they need, surrogates, and numbers beyond the last character.
TEST(DecodeUtf8Test, ReplacesWhatIsNoCharacter) {
  EXPECT_EQ(DecodeUtf8("a\xF1\x80\x80\xE1\x80\xC2"
                       "b\x80"
                       "c\x80\xBF"
                       "d"),
            U"a\uFFFD\uFFFD\uFFFDb\uFFFDc\uFFFD\uFFFDd");
  EXPECT_EQ(DecodeUtf8("\xC0\xAF"), U"\uFFFD\uFFFD");
  EXPECT_EQ(DecodeUtf8("\xE0\x80\xAF"), U"\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(DecodeUtf8("\xED\xA0\x80"), U"\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(DecodeUtf8("\xF4\x90\x80\x80"), U"\uFFFD\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(DecodeUtf8("\xF0\x9F\x90"), U"\uFFFD");
}

// Half-open box of the pixels of a white picture that are no longer white; and their number.
struct InkBox {
  int left = 1 << 20, right = 0, top = 1 << 20, bottom = 0, ink = 0;
};

constexpr int kMargin = 30;

InkBox Draw(const std::string& text, int size) {
  RgbImage image{
      internal::TextWidth(text, size) + 2 * kMargin, internal::LineHeight(size) + 2 * kMargin, {}};
  image.pixels.assign(3 * static_cast<size_t>(image.width) * image.height, 255);
  internal::DrawText(&image, kMargin, kMargin, text, size);
  InkBox box;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int dark = 255 - image.pixels[3 * (static_cast<size_t>(y) * image.width + x)];
      if (dark == 0) continue;
      box = {std::min(box.left, x), std::max(box.right, x + 1), std::min(box.top, y),
             std::max(box.bottom, y + 1), box.ink + dark};
    }
  }
  return box;
}

TEST(DrawTextTest, FillsTheBoxThatItSaysAndLosesNothing) {
  // The highest capitals and the longest descenders.
  const std::string text = "\u00C5\u0164\u00D1Hxgj\u00E7\u0119p";
  for (const int size : {12, 20, 61}) {
    const InkBox box = Draw(text, size);
    const int height = internal::LineHeight(size), width = internal::TextWidth(text, size);
    EXPECT_GE(box.top, kMargin) << size;
    EXPECT_LE(box.bottom, kMargin + height) << size;
    EXPECT_GT(box.bottom - box.top, 0.9 * height) << size;
    EXPECT_GE(box.left, kMargin) << size;
    EXPECT_LE(box.right, kMargin + width) << size;
    EXPECT_GT(box.right - box.left, 0.9 * width) << size;
    // A letter alone has as much ink as in the line, so that nothing of it was cut off.
    int ink = 0;
    for (const char* letter :
         {"\u00C5", "\u0164", "\u00D1", "H", "x", "g", "j", "\u00E7", "\u0119", "p"}) {
      ink += Draw(letter, size).ink;
    }
    EXPECT_NEAR(ink, box.ink, 0.05 * box.ink) << size;
  }
}

TEST(DrawTextTest, GrowsInProportionToItsSize) {
  const InkBox small = Draw("walk", 20), large = Draw("walk", 60);
  EXPECT_NEAR(large.right - large.left, 3 * (small.right - small.left), 6);
  EXPECT_NEAR(large.bottom - large.top, 3 * (small.bottom - small.top), 6);
  EXPECT_NEAR(large.ink, 9 * small.ink, 0.04 * large.ink);
}

TEST(DrawTextTest, AccentsStandOverLettersAlsoAsCharactersOfTheirOwn) {
  for (const auto& [one, two] : {std::pair{"\u00E4", "a\u0308"}, std::pair{"\u00E9", "e\u0301"}}) {
    const InkBox whole = Draw(one, 60), parts = Draw(two, 60);
    EXPECT_EQ(internal::TextWidth(one, 60), internal::TextWidth(two, 60));
    EXPECT_NEAR(whole.ink, parts.ink, 0.05 * whole.ink);
    EXPECT_NEAR(whole.top, parts.top, 3);
  }
}

TEST(DrawTextTest, ShowsABoxForWhatTheFontDoesNotHave) {
  const InkBox box = Draw("\u65E5", 40);  // Chinese
  EXPECT_GT(box.ink, 0);
  for (const char* text : {"\n", "\x07", "\U0001F40E"}) {
    EXPECT_EQ(Draw(text, 40).ink, box.ink);
    EXPECT_EQ(Draw(text, 40).right, box.right);
  }
  const InkBox replacement = Draw("\uFFFD", 40);
  EXPECT_EQ(Draw("\xE4", 40).ink, replacement.ink);
  EXPECT_NE(replacement.ink, box.ink);
}

TEST(DrawTextTest, LeavesTheRestOfAPictureAlone) {
  RgbImage image{40, 10, std::vector<unsigned char>(3 * 40 * 10, 200)};
  for (const int left : {-200, -10, 30, 100}) {
    for (const int top : {-100, -7, 5, 100}) {
      internal::DrawText(&image, left, top, "outside", 20);
      internal::DrawRimmedText(&image, left, top, "outside", 20, 2);
    }
  }
  EXPECT_EQ(image.pixels.size(), 3u * 40 * 10);
}

TEST(ShortenedTest, KeepsWhatFitsAndWholeCharacters) {
  const std::string text = "B\u00E4renh\u00FCter";
  const int width = internal::TextWidth(text, 20);
  EXPECT_EQ(internal::Shortened(text, width, 20), text);
  size_t before = text.size() + 1;
  for (int shorter = width - 1; shorter > 20; shorter -= 7) {
    const std::string part = internal::Shortened(text, shorter, 20);
    EXPECT_LE(internal::TextWidth(part, 20), shorter);
    const std::u32string characters = DecodeUtf8(part);
    EXPECT_EQ(characters.back(), U'\u2026');
    EXPECT_EQ(characters.find(U'\uFFFD'), characters.npos);
    EXPECT_EQ(text.rfind(part.substr(0, part.size() - 3), 0), 0u);
    EXPECT_LE(part.size(), before);
    before = part.size();
  }
}

TEST(CheckTextTest, CountsCharactersAndNotBytes) {
  std::string text;
  for (int i = 0; i < 120; ++i) text += "\u00E4";
  EXPECT_NO_THROW(internal::CheckText("title", text));
  EXPECT_THROW(internal::CheckText("title", text + "a"), InvalidOptions);
}

}  // namespace
}  // namespace shapespace
