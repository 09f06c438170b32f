#include <shapespace/base/detail/core_quota.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace shapespace::internal {
namespace {

namespace fs = std::filesystem;

// The path of the process's group, from a line `number:controllers:/path`; empty if there is none.
// `controller` is empty for cgroup v2.
fs::path GroupOf(const std::string& file, const std::string& controller) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const size_t first = line.find(':'), second = line.find(":/", first + 1);
    if (first == line.npos || second == line.npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    if (controllers.find("," + controller + ",") != line.npos) return line.substr(second + 2);
  }
  return {};
}

// Of one group: microseconds, which are not a number or negative without a limit, in each period of
// so many microseconds. They are in one file in cgroup v2, and in two in v1.
std::optional<double> OwnQuota(const fs::path& group) {
  std::ifstream both(group / "cpu.max");
  std::ifstream quota(group / "cpu.cfs_quota_us"), length(group / "cpu.cfs_period_us");
  double time, period;
  if (!(both >> time >> period) && !(quota >> time && length >> period)) return {};
  if (!(time > 0) || !(period > 0)) return {};
  return time / period;
}

// The least of a group and those that it is in, up to `root`.
std::optional<double> LeastQuota(const fs::path& root, const fs::path& group) {
  std::optional<double> least = OwnQuota(root);
  fs::path within = root;
  for (const fs::path& part : group) {
    within /= part;
    const std::optional<double> quota = OwnQuota(within);
    if (quota) least = std::min(*quota, least.value_or(*quota));
  }
  return least;
}

}  // namespace

std::optional<double> CoreQuota(const std::string& group_file, const std::string& root) {
  const std::optional<double> v2 = LeastQuota(root, GroupOf(group_file, ""));
  return v2 ? v2 : LeastQuota(fs::path(root) / "cpu", GroupOf(group_file, "cpu"));
}

}  // namespace shapespace::internal
