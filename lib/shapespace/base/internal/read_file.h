#ifndef SHAPESPACE_BASE_INTERNAL_READ_FILE_H_
#define SHAPESPACE_BASE_INTERNAL_READ_FILE_H_

#include <cstdint>
#include <limits>
#include <string>

namespace shapespace::internal {

/// All bytes of a file.
/// \throw FileError naming it if it is a folder or not a regular file, is missing, empty, not
///        permitted, larger than `most_bytes`, cannot be read completely, or grows meanwhile.
std::string ReadFile(const std::string& file,
                     std::int64_t most_bytes = std::numeric_limits<std::int64_t>::max());

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_READ_FILE_H_
