#include <shapespace/base/internal/atomic_file.h>

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
#include <shapespace/base/internal/system.h>

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

// Creates a file beside `file` and opens it for writing. In a folder where others may write, a file
// that is there already could lead anywhere.
// \throw FileError
std::unique_ptr<internal::FileBuffer> CreateBeside(const std::string& file, std::string* name) {
  constexpr int kMaxAttempts = 100;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    *name = RandomName(file);
    const int descriptor = CreateNewFile(name->c_str());
    if (descriptor >= 0) {
      try {
        return std::make_unique<internal::FileBuffer>(descriptor);
      } catch (...) {  // no memory
        close(descriptor);
        RemoveFile(name->c_str());
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
  if (const std::string problem = ProblemWithName(file); !problem.empty()) {
    throw FileError(file + ": " + problem);
  }
  const fs::path target = fs::u8path(file);
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
      RemoveFile(temporary.c_str());
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
    fs::rename(fs::u8path(temporary), target, error);
    if (error) throw FileError(file + ": cannot be replaced: " + error.message(), error);
    temporaries.erase(temporary);
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex);
    RemoveFile(temporary.c_str());  // takes no memory, which may be what is missing
    temporaries.erase(temporary);
    throw;
  }
}

void AbandonUnfinishedFiles() {
  auto& [mutex, temporaries] = TheUnfinished();
  mutex.lock();  // never unlocked
  for (const std::string& temporary : temporaries) RemoveFile(temporary.c_str());
}

}  // namespace shapespace::internal
