#include <shapespace/base/internal/bytes.h>

#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

template <typename T>
std::string Little(T number) {
  std::string bytes = "<";
  AppendLittleEndian(number, &bytes);
  return bytes.substr(1);
}

template <typename T>
std::string Big(T number) {
  std::string bytes = ">";
  AppendBigEndian(number, &bytes);
  return bytes.substr(1);
}

TEST(BytesTest, NumbersOfEverySizeHaveTheirOrder) {
  EXPECT_EQ(Little<std::uint8_t>(0x12), "\x12");
  EXPECT_EQ(Little<std::uint16_t>(0x1234), "\x34\x12");
  EXPECT_EQ(Little<std::uint32_t>(0x12345678), "\x78\x56\x34\x12");
  EXPECT_EQ(Little<std::uint64_t>(0x123456789abcdef1), "\xf1\xde\xbc\x9a\x78\x56\x34\x12");
  EXPECT_EQ(Little<std::int32_t>(-2), "\xfe\xff\xff\xff");
  EXPECT_EQ(Little(-1.5f), std::string("\0\0\xc0\xbf", 4));
  EXPECT_EQ(Little(-1.5), std::string("\0\0\0\0\0\0\xf8\xbf", 8));
  EXPECT_EQ(Big<std::uint8_t>(0x12), "\x12");
  EXPECT_EQ(Big<std::uint16_t>(0x1234), "\x12\x34");
  EXPECT_EQ(Big<std::uint32_t>(0x12345678), "\x12\x34\x56\x78");
  EXPECT_EQ(Big<std::uint64_t>(0x123456789abcdef1), "\x12\x34\x56\x78\x9a\xbc\xde\xf1");
  EXPECT_EQ(Big(-1.5f), std::string("\xbf\xc0\0\0", 4));
}

template <typename T>
void ExpectReadsWhatItWrites(T number) {
  const std::string bytes = "ab" + Little(number);
  EXPECT_EQ(ReadLittleEndian<T>(bytes.data() + 2), number);
}

TEST(BytesTest, AreReadFromAnyPlace) {
  EXPECT_EQ(ReadLittleEndian<std::uint16_t>("\x34\xf2"), 0xf234);
  EXPECT_EQ(ReadLittleEndian<std::uint32_t>("\xf8\x56\x34\x92"), 0x923456f8);
  ExpectReadsWhatItWrites<std::int8_t>(-100);
  ExpectReadsWhatItWrites<std::int16_t>(-12345);
  ExpectReadsWhatItWrites<std::int32_t>(-1234567890);
  ExpectReadsWhatItWrites<std::int64_t>(-1234567890123456789);
  ExpectReadsWhatItWrites<std::uint64_t>(0x8182838485868788);
  ExpectReadsWhatItWrites(-1.234567e-30f);
  ExpectReadsWhatItWrites(-1.23456789012345e300);
  ExpectReadsWhatItWrites(std::numeric_limits<double>::denorm_min());
}

}  // namespace
}  // namespace shapespace::internal
