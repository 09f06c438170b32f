#include <shapespace/files/detail/vtp_bytes.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include <zlib.h>

#include <shapespace/base/error.h>
#include <shapespace/files/detail/number_type.h>

namespace shapespace::internal {
namespace {

constexpr char kTooMuch[] = "it would take far more memory than the file's size accounts for";

int Base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Takes bytes from the front of a text, as they are or from base64. Several base64 texts may
/// follow each other: writers pad the end of the header, and go on with the data.
class VtpBytes {
 public:
  VtpBytes(std::string_view text, bool base64) : text_(text), base64_(base64) {}

  /// An upper bound of the bytes that are left.
  size_t Left() const { return base64_ ? text_.size() / 4 * 3 + ready_.size() : text_.size(); }

  std::string Take(std::uint64_t wanted) {
    if (wanted > Left()) throw FileError("it is longer than the file");
    const auto count = static_cast<size_t>(wanted);
    std::string bytes;
    if (!base64_) {
      bytes = text_.substr(0, count);
      text_.remove_prefix(count);
      return bytes;
    }
    bytes.reserve(count);
    while (bytes.size() < count) {
      if (ready_.empty()) DecodeQuad();
      const size_t taken = std::min(count - bytes.size(), ready_.size());
      bytes.append(ready_, 0, taken);
      ready_.erase(0, taken);
    }
    return bytes;
  }

 private:
  /// Three bytes, or less in front of padding.
  void DecodeQuad() {
    std::uint32_t bits = 0;
    int digits = 0, read = 0;
    while (read < 4) {
      const size_t next = text_.find_first_not_of(" \t\r\n");
      if (next == std::string_view::npos) throw FileError("it is longer than the file");
      const char c = text_[next];
      text_.remove_prefix(next + 1);
      const int digit = Base64Digit(c);
      if (digit < 0 ? c != '=' || read < 2 : digits < read) throw FileError("it is not base64");
      if (digit >= 0) ++digits;
      bits = bits << 6 | static_cast<std::uint32_t>(std::max(digit, 0));
      ++read;
    }
    for (int i = 0; i < digits - 1; ++i) ready_ += static_cast<char>(bits >> (16 - 8 * i) & 0xff);
  }

  std::string_view text_;
  const bool base64_;
  std::string ready_;
};

class VtpArrayDecoder {
 public:
  VtpArrayDecoder(std::string_view encoded, bool base64, const VtpEncoding& encoding, size_t most)
      : source_(encoded, base64), encoding_(encoding), most_(most) {}

  std::string Decode() {
    const std::uint64_t first = Header();
    if (!encoding_.compressed) {
      // Several arrays may have the same place in the file.
      if (first > most_ && first <= source_.Left()) throw FileError(kTooMuch);
      return source_.Take(first);
    }
    const std::uint64_t blocks = first, block_size = Header(), last_size = Header();
    if (blocks == 0) return {};
    if (blocks > source_.Left() / encoding_.header_size) {
      throw FileError("it has more blocks than the file has room for");
    }
    if (block_size == 0 || block_size > most_ / blocks || last_size > block_size) {
      throw FileError(kTooMuch);
    }
    std::vector<std::uint64_t> sizes(blocks);
    for (std::uint64_t& size : sizes) size = Header();
    std::string bytes;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const bool is_short = i + 1 == blocks && last_size > 0;
      bytes +=
          Inflated(source_.Take(sizes[i]), static_cast<size_t>(is_short ? last_size : block_size));
    }
    return bytes;
  }

 private:
  // Of a hostile file it may exceed any memory, also that of a machine of 32 bits.
  std::uint64_t Header() {
    const std::string bytes = source_.Take(encoding_.header_size);
    std::uint64_t number = 0;
    for (size_t i = 0; i < bytes.size(); ++i) {
      const size_t at = MachineIsBigEndian() == encoding_.swap ? bytes.size() - 1 - i : i;
      number = number << 8 | static_cast<unsigned char>(bytes[at]);
    }
    return number;
  }

  static std::string Inflated(const std::string& compressed, size_t size) {
    std::string bytes(size, '\0');
    uLongf length = size;
    const int result =
        uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                   reinterpret_cast<const Bytef*>(compressed.data()), compressed.size());
    if (result != Z_OK || length != size) throw FileError("a block cannot be decompressed by zlib");
    return bytes;
  }

  VtpBytes source_;
  const VtpEncoding encoding_;
  const size_t most_;
};

}  // namespace

std::string DecodeVtpArray(std::string_view encoded, bool base64, const VtpEncoding& encoding,
                           size_t most) {
  return VtpArrayDecoder(encoded, base64, encoding, most).Decode();
}

}  // namespace shapespace::internal
