#include <shapespace/base/internal/within_folder.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include <shapespace/base/internal/system.h>

namespace shapespace::internal {

namespace fs = std::filesystem;

bool IsWithinFolder(const std::string& folder, const std::string& file) {
  std::error_code error;
  const fs::path base = PlaceOf(folder.empty() ? "." : folder, &error);
  if (error) return false;
  const fs::path place = PlaceOf(file, &error);
  if (error) return false;
  return std::mismatch(base.begin(), base.end(), place.begin(), place.end()).first == base.end();
}

}  // namespace shapespace::internal
