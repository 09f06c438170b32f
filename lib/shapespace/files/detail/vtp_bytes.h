#ifndef SHAPESPACE_FILES_DETAIL_VTP_BYTES_H_
#define SHAPESPACE_FILES_DETAIL_VTP_BYTES_H_

#include <cstddef>
#include <string>
#include <string_view>

namespace shapespace::internal {

/// How a .vtp file stores its binary arrays.
struct VtpEncoding {
  bool swap = false;        ///< the byte order is not that of this machine
  size_t header_size = 4;   ///< bytes of each number in front of the data
  bool compressed = false;  ///< by zlib, in blocks
};

/// The bytes of the array that begins `encoded`, which may be followed by others: raw or in base64.
/// `most` is the largest number of bytes that it may have.
/// \throw FileError with the problem alone.
std::string DecodeVtpArray(std::string_view encoded, bool base64, const VtpEncoding& encoding,
                           size_t most);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_DETAIL_VTP_BYTES_H_
