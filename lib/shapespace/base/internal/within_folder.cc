#include <shapespace/base/internal/within_folder.h>

#include <algorithm>
#include <system_error>

namespace shapespace::internal {

namespace fs = std::filesystem;

bool IsWithinFolder(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path base = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) return false;
  const fs::path place = fs::weakly_canonical(fs::absolute(file, error), error);
  if (error) return false;
  return std::mismatch(base.begin(), base.end(), place.begin(), place.end()).first == base.end();
}

}  // namespace shapespace::internal
