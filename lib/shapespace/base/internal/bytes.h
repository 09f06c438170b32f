#ifndef SHAPESPACE_BASE_INTERNAL_BYTES_H_
#define SHAPESPACE_BASE_INTERNAL_BYTES_H_

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

// Numbers in binary files, whose byte order is independent of the machine's.

namespace shapespace::internal {

template <size_t kSize>
using UnsignedOfSize = std::conditional_t<
    kSize == 1, std::uint8_t,
    std::conditional_t<kSize == 2, std::uint16_t,
                       std::conditional_t<kSize == 4, std::uint32_t, std::uint64_t>>>;

/// Appends the bytes of a number, the least significant one first.
template <typename T>
void AppendLittleEndian(T number, std::string* bytes) {
  UnsignedOfSize<sizeof(T)> bits;
  std::memcpy(&bits, &number, sizeof bits);
  for (size_t i = 0; i < sizeof bits; ++i) *bytes += static_cast<char>(bits >> (8 * i) & 0xff);
}

/// The same with the most significant byte first.
template <typename T>
void AppendBigEndian(T number, std::string* bytes) {
  UnsignedOfSize<sizeof(T)> bits;
  std::memcpy(&bits, &number, sizeof bits);
  for (size_t i = sizeof bits; i > 0; --i) *bytes += static_cast<char>(bits >> (8 * i - 8) & 0xff);
}

/// The number whose bytes, the least significant one first, begin at `bytes`.
template <typename T>
T ReadLittleEndian(const char* bytes) {
  UnsignedOfSize<sizeof(T)> bits = 0;
  for (size_t i = sizeof bits; i > 0; --i) {
    bits = static_cast<UnsignedOfSize<sizeof(T)>>(bits << 8 |
                                                  static_cast<unsigned char>(bytes[i - 1]));
  }
  T number;
  std::memcpy(&number, &bits, sizeof number);
  return number;
}

/// The same with the most significant byte first.
template <typename T>
T ReadBigEndian(const char* bytes) {
  char reversed[sizeof(T)];
  std::reverse_copy(bytes, bytes + sizeof(T), reversed);
  return ReadLittleEndian<T>(reversed);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_BYTES_H_
