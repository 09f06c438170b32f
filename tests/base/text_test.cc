#include <shapespace/base/internal/text.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/internal/csv.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/quoted.h>

#include "support/message_of.h"

namespace shapespace {
namespace {

using internal::CsvCells;
using internal::ParseDouble;
using internal::ParseInteger;
using internal::Quoted;
using testing::MessageOf;
using testing::Names;
using testing::Refuses;

TEST(LinesTest, EndWithAnyLineBreakAndAreCountedFromOne) {
  internal::Lines lines("one\r\ntwo\rthree\n\n\r\nsix");
  const std::vector<std::pair<std::string, size_t>> expected = {
      {"one", 16}, {"two", 12}, {"three", 6}, {"", 5}, {"", 3}, {"six", 0}};
  std::string_view line;
  for (size_t i = 0; i < expected.size(); ++i) {
    ASSERT_TRUE(lines.Next(&line));
    EXPECT_EQ(line, expected[i].first);
    EXPECT_EQ(lines.Number(), static_cast<int>(i + 1));
    EXPECT_EQ(lines.BytesLeft(), expected[i].second) << line;
  }
  EXPECT_FALSE(lines.Next(&line));
  EXPECT_EQ(lines.Number(), 6);
}

TEST(LineWordsTest, AreSeparatedByAnyBlanksAndTabs) {
  internal::LineWords words(" \tfirst\t second third \t");
  EXPECT_EQ(words.Next(), "first");
  EXPECT_EQ(words.Rest(), "second third");
  EXPECT_EQ(words.Next(), "second");
  EXPECT_FALSE(words.Done());
  EXPECT_EQ(words.Next(), "third");
  EXPECT_TRUE(words.Done());
  EXPECT_EQ(words.Next(), "");
  EXPECT_TRUE(internal::LineWords(" \t ").Done());
  EXPECT_EQ(internal::WithoutComment("v 1 # 2 # 3"), "v 1 ");
  EXPECT_EQ(internal::WithoutComment("v 1"), "v 1");
  EXPECT_EQ(internal::WithoutComment("v 1.# 2"), "v 1.");
  EXPECT_EQ(internal::WithoutComment("1.#IND -1.#QNAN # 1.#INF"), "1.#IND -1.#QNAN ");
}

TEST(TextTest, AByteOrderMarkBecomesBlanksAtTheBeginningOnly) {
  std::string text = "\xEF\xBB\xBFply \xEF\xBB\xBF";
  internal::BlankByteOrderMark(&text);
  EXPECT_EQ(text, "   ply \xEF\xBB\xBF");
  internal::BlankByteOrderMark(&text);
  EXPECT_EQ(text, "   ply \xEF\xBB\xBF");
  EXPECT_EQ(internal::WithoutByteOrderMark("\xEF\xBB\xBFply"), "ply");
  EXPECT_EQ(internal::WithoutByteOrderMark("ply"), "ply");
}

TEST(ParseTest, NumbersAreWholeWords) {
  EXPECT_EQ(ParseDouble("-1.25e2"), -125);
  EXPECT_EQ(ParseDouble("+.5"), 0.5);
  for (const char* wrong : {"", "+", "++1", "+-1", "1x", "x", "1 2", "0x10"}) {
    EXPECT_FALSE(ParseDouble(wrong)) << wrong;
    EXPECT_FALSE(ParseInteger(wrong)) << wrong;
  }
  EXPECT_TRUE(std::isnan(ParseDouble("nan").value_or(0)));
  EXPECT_EQ(ParseInteger("+17"), 17);
  EXPECT_EQ(ParseInteger("-17"), -17);
  EXPECT_FALSE(ParseInteger("1.0"));
  EXPECT_EQ(ParseInteger("9223372036854775807"), INT64_MAX);
  EXPECT_FALSE(ParseInteger("9223372036854775808"));
}

// By programs of Microsoft's compilers, of all ages.
TEST(ParseTest, WhatPrintfWritesInPlaceOfANumberIsNotFinite) {
  for (const char* word :
       {"1.#QNAN", "-1.#IND", "+1.#INF", "1.#SNAN", "1.#QNAN0", "-1.#IND00", "1.#INF000e+000",
        "1.#J", "-nan(ind)", "nan(snan)", "-inf", "Infinity"}) {
    const std::optional<double> number = ParseDouble(word);
    ASSERT_TRUE(number) << word;
    EXPECT_FALSE(std::isfinite(*number)) << word;
  }
  for (const char* wrong : {"2.#QNAN", "1.#", "1.#1", "-1.#"}) EXPECT_FALSE(ParseDouble(wrong));
}

TEST(ParseTest, DecimalCommasAreToldFromOtherWords) {
  for (const char* word : {"1,5", "-0,25e-3", "+,5", "12345,0"}) {
    EXPECT_TRUE(internal::HasDecimalComma(word)) << word;
    EXPECT_NE(internal::NotANumber(word).find("comma"), std::string::npos) << word;
  }
  for (const char* word : {"", "1", "1,", ",", "1,2,3", "1,234.5", "a,5", "1.5"}) {
    EXPECT_FALSE(internal::HasDecimalComma(word)) << word;
    EXPECT_EQ(internal::NotANumber(word).find("comma"), std::string::npos) << word;
  }
}

TEST(ParseTest, WhatIsTooSmallIsZeroAndWhatIsTooLargeInfinite) {
  EXPECT_EQ(ParseDouble("1e-999"), 0);
  EXPECT_EQ(ParseDouble("-3E-999"), 0);
  EXPECT_EQ(ParseDouble("1e999"), HUGE_VAL);
  EXPECT_EQ(ParseDouble("1E+999"), HUGE_VAL);
  EXPECT_EQ(ParseDouble("0." + std::string(400, '0') + "1"), 0);
  EXPECT_EQ(ParseDouble("-0." + std::string(400, '0') + "1"), 0);
  EXPECT_EQ(ParseDouble("1" + std::string(400, '0')), HUGE_VAL);
}

TEST(FiniteNumberTest, MessagesNameFileLineElementAndWord) {
  const auto message = [](const char* word, int line, size_t number) {
    return MessageOf<FileError>([&] {
      internal::FiniteNumber(word, "x", "a.obj", line, {"vertex", number});
    });
  };
  const std::string again = "; is the file damaged? Export the mesh again";
  EXPECT_TRUE(Names(message("", 7, 3), {"a.obj:7:", "vertex 3"}));
  EXPECT_TRUE(Names(message("one", 7, 0), {"a.obj:7:", "'one'"}));
  EXPECT_TRUE(Names(message("inf", 1, 1), {"a.obj:1:", "vertex 1", "'inf'"}));
  EXPECT_TRUE(Names(message("nan", 0, 2), {"a.obj:", "vertex 2", "'nan'"}));
  EXPECT_EQ(internal::FiniteNumber("2.5", "x", "a.obj", 1, {"vertex", 1}), 2.5);
}

TEST(QuotedTest, LongWordsAreShortenedAndOtherBytesReplaced) {
  EXPECT_EQ(Quoted("a~ b\x7f\t\xc3"), "'a~ b" + std::string(3, '?') + "'");
  EXPECT_EQ(Quoted(std::string(40, 'a')), "'" + std::string(40, 'a') + "'");
  EXPECT_EQ(Quoted(std::string(41, 'a')), "'" + std::string(40, 'a') + "...'");
}

TEST(CsvCellsTest, AreSeparatedByCommasAndMayBeQuoted) {
  const auto cells = [](const char* line) { return CsvCells(line, "t.csv", 3); };
  using Cells = std::vector<std::string>;
  EXPECT_EQ(cells("a, b c\t,,d"), (Cells{"a", "b c", "", "d"}));
  EXPECT_EQ(cells(""), Cells{""});
  EXPECT_EQ(cells("a,"), (Cells{"a", ""}));
  EXPECT_EQ(cells(" \"a, b\" ,\"say \"\"no\"\"\",\"\",z"), (Cells{"a, b", "say \"no\"", "", "z"}));
  EXPECT_EQ(cells("a\"b,c"), (Cells{"a\"b", "c"}));
  EXPECT_TRUE(Refuses<FileError>([&] { cells("a,\"b"); }, {"t.csv:3:"}));
  EXPECT_TRUE(Refuses<FileError>([&] { cells("\"a\" b,c"); }, {"t.csv:3:"}));
  EXPECT_TRUE(Refuses<FileError>([&] { cells("x,\"a\"b"); }, {"t.csv:3:"}));
}

TEST(CheckRangeTest, TheEndsBelongToTheRange) {
  internal::CheckRange("levels", 2, 2, 5);
  internal::CheckRange("levels", 5, 2, 5);
  for (const int wrong : {1, 6}) {
    EXPECT_TRUE(Refuses<InvalidOptions>([&] { internal::CheckRange("levels", wrong, 2, 5); },
                                        {"levels:", "2", "5"}));
  }
  EXPECT_THROW(internal::CheckRange("share", std::nan(""), 0.0, 1.0), InvalidOptions);
  internal::CheckCount("times", 0, 4, "poses");
  internal::CheckCount("times", 4, 4, "poses");
  EXPECT_TRUE(Refuses<InvalidOptions>([] { internal::CheckCount("times", 3, 4, "poses"); },
                                      {"times:", "3", "4"}));
}

TEST(FileExtensionTest, IsInSmallLettersAndOfTheNameOnly) {
  EXPECT_EQ(internal::FileExtension("a.b/c.d.OBJ"), ".obj");
  EXPECT_EQ(internal::FileExtension("a.b/c"), "");
}

}  // namespace
}  // namespace shapespace
