#include <shapespace/base/atomic_file.h>

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <shapespace/base/error.h>

namespace shapespace {

void WriteFileAtomically(const std::string& file, const std::function<void(std::ostream&)>& body) {
  namespace fs = std::filesystem;
  const fs::path target(file);
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  if (error) throw FileError(file + ": cannot make its folder: " + error.message());

  const std::string temporary = file + ".part" + std::to_string(getpid());
  try {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    if (!stream) throw FileError(file + ": cannot be written: " + std::strerror(errno));
    body(stream);
    stream.close();
    if (!stream) throw FileError(file + ": writing failed (is the disk full?)");
    fs::rename(temporary, target, error);
    if (error) throw FileError(file + ": cannot be replaced: " + error.message());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

}  // namespace shapespace
