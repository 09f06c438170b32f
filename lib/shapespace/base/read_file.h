#ifndef SHAPESPACE_BASE_READ_FILE_H_
#define SHAPESPACE_BASE_READ_FILE_H_

#include <cstdint>
#include <limits>
#include <string>

namespace shapespace {

/// All bytes of a file.
/// \throw FileError naming it: a folder, no ordinary file, not there, not allowed, empty, larger
///        than `most_bytes`, or not to be read to its end.
std::string ReadFile(const std::string& file,
                     std::int64_t most_bytes = std::numeric_limits<std::int64_t>::max());

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_READ_FILE_H_
