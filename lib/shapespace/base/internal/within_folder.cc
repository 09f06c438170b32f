#include <shapespace/base/internal/within_folder.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace shapespace::internal {

namespace fs = std::filesystem;

bool IsWithinFolder(const std::string& folder, const std::string& file) {
  std::error_code error;
  const fs::path base = fs::canonical(folder.empty() ? fs::path(".") : fs::u8path(folder), error);
  if (error) return false;
  const fs::path place = fs::weakly_canonical(fs::absolute(fs::u8path(file), error), error);
  if (error) return false;
  return std::mismatch(base.begin(), base.end(), place.begin(), place.end()).first == base.end();
}

}  // namespace shapespace::internal
