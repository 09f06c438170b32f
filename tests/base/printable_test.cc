#include <shapespace/base/internal/printable.h>

#include <gtest/gtest.h>

namespace shapespace {
namespace {

using internal::Printable;

TEST(PrintableTest, ControlCharactersAreEscapedAndNothingElse) {
  EXPECT_EQ(Printable("a\x1b[2Jb\r\x07\x7f"), "a\\x1b[2Jb\\x0d\\x07\\x7f");
  EXPECT_EQ(Printable("one\ntwo\tthree"), "one\\x0atwo\\x09three");
  EXPECT_EQ(Printable("one\ntwo\tthree\r", "\n\t"), "one\ntwo\tthree\\x0d");
  const std::string utf8 = "h\xc3\xa9 \xe4\xb8\xad \xf0\x9f\x90\x88 \xc2\xa0\xc2\xbf";
  EXPECT_EQ(Printable(utf8), utf8);
  // Terminals take U+009B for the beginning of a sequence, as ESC [.
  EXPECT_EQ(Printable("a\xc2\x9b"
                      "2Jb"),
            "a\\x9b2Jb");
  EXPECT_EQ(Printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(Printable("a\xc2"), "a\xc2");
}

}  // namespace
}  // namespace shapespace
