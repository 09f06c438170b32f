#include <shapespace/base/internal/read_file.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include <shapespace/base/error.h>

namespace shapespace::internal {

std::string ReadFile(const std::string& file, std::int64_t most_bytes) {
  const std::filesystem::path path = std::filesystem::u8path(file);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw FileError(file + ": is a folder; name a file",
                    std::make_error_code(std::errc::is_a_directory));
  }
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) {
    const std::error_code cause(errno, std::generic_category());
    throw FileError(file + ": cannot be opened: " + cause.message(), cause);
  }
  const std::streamoff size = stream.tellg();
  if (size < 0) throw FileError(file + ": is not a regular file");
  if (size == 0) throw FileError(file + ": is empty");
  if (size > most_bytes) {
    throw FileError(file + ": is larger than the " + std::to_string(most_bytes) +
                    " bytes that such a file may have");
  }
  std::string content(static_cast<size_t>(size), '\0');
  stream.seekg(0);
  stream.read(content.data(), size);
  if (stream.gcount() != size) throw FileError(file + ": cannot be read to its end");
  // The part of a text that is there so far may look like a whole one.
  if (stream.peek() != std::ifstream::traits_type::eof()) {
    throw FileError(file + ": has grown while it was read; wait until it is written");
  }
  return content;
}

}  // namespace shapespace::internal
