#include <shapespace/exploration/detail/records.h>

#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/read_file.h>

namespace shapespace::internal {
namespace {

namespace fs = std::filesystem;

constexpr char kExtension[] = ".geodesic";

}  // namespace

std::string Records::File(const std::string& digest) const {
  return (fs::u8path(folder_) / (digest + kExtension)).u8string();
}

std::optional<std::string> Records::Find(const std::string& digest) const {
  std::error_code error;
  if (folder_.empty() || !fs::exists(fs::u8path(File(digest)), error)) return {};
  try {
    return ReadFile(File(digest));
  } catch (const FileError&) {
    return {};
  }
}

void Records::Keep(const std::string& digest, const std::string& bytes) const {
  if (folder_.empty()) return;
  // Another run with the same folder, which is done before this one, removes the folder and what is
  // being written there. While the system removes a folder, it is still found, but nothing can be
  // created in it, so that an attempt at once would fail again.
  constexpr int kAttempts = 1000;
  constexpr auto kPause = std::chrono::milliseconds(1);
  for (int attempt = 1;; ++attempt) {
    try {
      return WriteFileAtomically(File(digest), [&](std::ostream& out) { out << bytes; });
    } catch (const FileError& error) {
      if (attempt == kAttempts || error.cause() != std::errc::no_such_file_or_directory) throw;
      std::this_thread::sleep_for(kPause);
    }
  }
}

void Records::Remove() const {
  std::error_code error;
  const fs::path folder = fs::u8path(folder_);
  if (folder_.empty() || !fs::is_directory(folder, error)) return;
  // Another run may remove them at the same time.
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    // Temporary files have a suffix after the extension (WriteFileAtomically).
    const std::string name = entry->path().filename().u8string();
    std::error_code ignored;
    if (name.find(kExtension) != std::string::npos) fs::remove(entry->path(), ignored);
  }
  fs::remove(folder, error);  // fails if it is not empty
}

}  // namespace shapespace::internal
