#include <shapespace/base/internal/core_quota.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace shapespace::internal {
namespace {

// The path of the process's group, from a line `0::/path`; empty if there is none.
std::string GroupOf(const std::string& file) {
  std::ifstream lines(file);
  const std::string begin = "0::/";
  for (std::string line; std::getline(lines, line);) {
    if (line.compare(0, begin.size(), begin) == 0) return line.substr(begin.size());
  }
  return {};
}

// Of one group: the file has microseconds, or `max`, in each period of so many microseconds.
std::optional<double> OwnQuota(const std::filesystem::path& group) {
  std::ifstream file(group / "cpu.max");
  double time, period;
  if (!(file >> time >> period) || !(time > 0) || !(period > 0)) return {};
  return time / period;
}

}  // namespace

std::optional<double> CoreQuota(const std::string& group_file, const std::string& root) {
  std::optional<double> least = OwnQuota(root);
  std::filesystem::path group = root;
  for (const std::filesystem::path& part : std::filesystem::path(GroupOf(group_file))) {
    group /= part;
    const std::optional<double> quota = OwnQuota(group);
    if (quota) least = std::min(*quota, least.value_or(*quota));
  }
  return least;
}

}  // namespace shapespace::internal
