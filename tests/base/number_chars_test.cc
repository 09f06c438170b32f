#include <shapespace/base/internal/number_chars.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

template <typename Number>
std::string Text(Number number) {
  char text[32];
  return {text, ToChars(text, text + sizeof text, number)};
}

// What a text begins with, if it is a number, and how many characters that takes.
std::optional<double> Parsed(const std::string& text, size_t* taken = nullptr) {
  double value = 0;
  const auto [stop, error] = FromChars(text.data(), text.data() + text.size(), &value);
  if (taken != nullptr) *taken = stop - text.data();
  if (error != std::errc()) return std::nullopt;
  return value;
}

TEST(NumberChars, NumbersAreReadBackExactly) {
  using Limits = std::numeric_limits<double>;
  std::vector<double> numbers = {0.0,
                                 -0.0,
                                 1.0,
                                 0.1,
                                 1.0 / 3,
                                 1e5,
                                 123456789,
                                 1e22,
                                 1e23,
                                 -2,
                                 Limits::max(),
                                 Limits::min(),
                                 Limits::denorm_min()};
  std::mt19937_64 random(7);
  while (numbers.size() < 2000) {
    const std::uint64_t bits = random();
    double number;
    std::memcpy(&number, &bits, sizeof number);
    if (std::isfinite(number)) numbers.push_back(number);
  }
  for (const double number : numbers) {
    EXPECT_EQ(Parsed(Text(number)), number);
    EXPECT_EQ(std::signbit(*Parsed(Text(number))), std::signbit(number));
    const float single = static_cast<float>(number);
    if (!std::isfinite(single)) continue;
    EXPECT_EQ(static_cast<float>(*Parsed(Text(single))), single);
    EXPECT_LE(Text(single).size(), 15u);
  }
}

TEST(NumberChars, TextsHaveNoMoreDigitsThanNecessary) {
  EXPECT_EQ(Text(0.1), "0.1");
  EXPECT_EQ(Text(-2.5), "-2.5");
  EXPECT_EQ(Text(0.1f), "0.1");
  EXPECT_EQ(Text(17), "17");
}

TEST(NumberChars, WhatIsNoNumberIsRefused) {
  for (const char* text : {"", "-", "+1", " 1", "\t1", "x", "--1", "-+1", "e5", ".", "- 1"}) {
    EXPECT_FALSE(Parsed(text).has_value()) << text;
  }
}

TEST(NumberChars, ReadingEndsBehindTheNumber) {
  size_t taken;
  EXPECT_EQ(Parsed("1.5abc", &taken), 1.5);
  EXPECT_EQ(taken, 3u);
  EXPECT_EQ(Parsed("0x10", &taken), 0);  // hexadecimal numbers are none
  EXPECT_EQ(taken, 1u);
  EXPECT_EQ(Parsed("1e", &taken), 1);
  EXPECT_EQ(taken, 1u);
}

TEST(NumberChars, SpecialValuesAreNumbers) {
  EXPECT_EQ(Parsed("inf"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Parsed("-Infinity"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(*Parsed("nan")));
  // What is too large for a double is either refused or infinite, and what is too small 0.
  EXPECT_TRUE(std::isinf(Parsed("1e999").value_or(1 / 0.0)));
  EXPECT_EQ(Parsed("1e-999").value_or(0), 0);
}

}  // namespace
}  // namespace shapespace::internal
