#ifndef SHAPESPACE_FILES_DETAIL_NUMBER_TYPE_H_
#define SHAPESPACE_FILES_DETAIL_NUMBER_TYPE_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

// Numbers in files, whose type is known when the file is read.

namespace shapespace::internal {

enum class NumberType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble
};

inline bool IsInteger(NumberType type) { return type < NumberType::kFloat; }

/// Bytes of a number.
inline size_t Size(NumberType type) {
  static constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

inline bool MachineIsBigEndian() {
  const std::uint16_t one = 1;
  unsigned char first;
  std::memcpy(&first, &one, 1);
  return first == 0;
}

template <typename T>
double Decode(const char* bytes, bool swap) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (swap) std::reverse(copy, copy + sizeof(T));
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return static_cast<double>(value);
}

/// The number whose bytes begin at `bytes`, in the machine's order or, if `swap`, in the other one.
/// Integers above 2^53 are rounded.
inline double Decode(const char* bytes, NumberType type, bool swap) {
  switch (type) {
    case NumberType::kInt8:
      return Decode<std::int8_t>(bytes, swap);
    case NumberType::kUint8:
      return Decode<std::uint8_t>(bytes, swap);
    case NumberType::kInt16:
      return Decode<std::int16_t>(bytes, swap);
    case NumberType::kUint16:
      return Decode<std::uint16_t>(bytes, swap);
    case NumberType::kInt32:
      return Decode<std::int32_t>(bytes, swap);
    case NumberType::kUint32:
      return Decode<std::uint32_t>(bytes, swap);
    case NumberType::kInt64:
      return Decode<std::int64_t>(bytes, swap);
    case NumberType::kUint64:
      return Decode<std::uint64_t>(bytes, swap);
    case NumberType::kFloat:
      return Decode<float>(bytes, swap);
    case NumberType::kDouble:
      break;
  }
  return Decode<double>(bytes, swap);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_DETAIL_NUMBER_TYPE_H_
