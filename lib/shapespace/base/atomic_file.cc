#include <shapespace/base/atomic_file.h>

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>

#include <shapespace/base/error.h>

namespace shapespace {
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

}  // namespace

void WriteFileAtomically(const std::string& file, const std::function<void(std::ostream&)>& body) {
  const fs::path target(file);
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  if (error) throw FileError(file + ": cannot make its folder: " + error.message());

  const std::string temporary = file + ".part" + std::to_string(getpid());
  auto& [mutex, temporaries] = TheUnfinished();
  try {
    std::ofstream stream;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      temporaries.insert(temporary);
      stream.open(temporary, std::ios::binary | std::ios::trunc);
    }
    if (!stream) throw FileError(file + ": cannot be written: " + std::strerror(errno));
    body(stream);
    stream.close();
    if (!stream) throw FileError(file + ": writing failed (is the disk full?)");
    const std::lock_guard<std::mutex> lock(mutex);
    fs::rename(temporary, target, error);
    if (error) throw FileError(file + ": cannot be replaced: " + error.message());
    temporaries.erase(temporary);
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex);
    fs::remove(temporary, error);
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

}  // namespace shapespace
