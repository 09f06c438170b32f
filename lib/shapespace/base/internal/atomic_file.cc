#include <shapespace/base/internal/atomic_file.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <string>

#include <shapespace/base/detail/file_buffer.h>
#include <shapespace/base/error.h>

namespace shapespace::internal {
namespace {

namespace fs = std::filesystem;

// The existing temporaries. They are created, renamed and removed only under the lock.
struct Unfinished {
  std::mutex mutex;
  std::set<std::string> temporaries;
};

Unfinished& TheUnfinished() {
  static Unfinished* const unfinished = new Unfinished;  // other threads may outlive it
  return *unfinished;
}

// A name beside `file` that nobody can foresee.
std::string RandomName(const std::string& file) {
  constexpr char kDigits[] = "0123456789abcdef";
  constexpr int kLength = 16;
  std::random_device random;
  std::string name = file + ".part";
  for (int i = 0; i < kLength; ++i) name += kDigits[random() % 16];
  return name;
}

// Creates a file beside `file` and opens it for writing. Whatever has its name already, a link in
// particular, is left alone: in a folder where others may write, it could lead anywhere.
// \throw FileError
std::unique_ptr<internal::FileBuffer> CreateBeside(const std::string& file, std::string* name) {
  constexpr int kMaxAttempts = 100;
  constexpr mode_t kPermissions = 0666;  // less those of the umask, as for all new files
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    *name = RandomName(file);
    const int descriptor =
        open(name->c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kPermissions);
    if (descriptor >= 0) {
      try {
        return std::make_unique<internal::FileBuffer>(descriptor);
      } catch (...) {  // no memory
        close(descriptor);
        unlink(name->c_str());
        throw;
      }
    }
    if (errno != EEXIST) break;
  }
  const std::error_code cause(errno, std::generic_category());
  throw FileError(file + ": cannot be written: " + cause.message(), cause);
}

}  // namespace

void WriteFileAtomically(const std::string& file, const std::function<void(std::ostream&)>& body) {
  const fs::path target(file);
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  if (error) throw FileError(file + ": cannot make its folder: " + error.message(), error);

  auto& [mutex, temporaries] = TheUnfinished();
  std::string temporary;
  std::unique_ptr<internal::FileBuffer> buffer;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    buffer = CreateBeside(file, &temporary);
    try {
      temporaries.insert(temporary);
    } catch (...) {  // no memory
      unlink(temporary.c_str());
      throw;
    }
  }
  try {
    std::ostream stream(buffer.get());
    body(stream);
    if (!buffer->Close()) stream.setstate(std::ios::badbit);
    if (buffer->Error() != 0) {
      const std::error_code cause(buffer->Error(), std::generic_category());
      throw FileError(file + ": writing failed: " + cause.message(), cause);
    }
    if (!stream) throw FileError(file + ": writing failed");
    const std::lock_guard<std::mutex> lock(mutex);
    fs::rename(temporary, target, error);
    if (error) throw FileError(file + ": cannot be replaced: " + error.message(), error);
    temporaries.erase(temporary);
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex);
    unlink(temporary.c_str());  // takes no memory, which may be what is missing
    temporaries.erase(temporary);
    throw;
  }
}

void AbandonUnfinishedFiles() {
  auto& [mutex, temporaries] = TheUnfinished();
  mutex.lock();  // never unlocked
  std::error_code error;
  for (const std::string& temporary : temporaries) fs::remove(temporary, error);
}

}  // namespace shapespace::internal
