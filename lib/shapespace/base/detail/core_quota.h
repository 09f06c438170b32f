#ifndef SHAPESPACE_BASE_DETAIL_CORE_QUOTA_H_
#define SHAPESPACE_BASE_DETAIL_CORE_QUOTA_H_

#include <optional>
#include <string>

namespace shapespace::internal {

/// How many cores' time a process may use, where its control group (cgroup v2 or v1, as in
/// containers) limits that; the strictest limit of the group and those that it is in. `group_file`
/// names the group, as /proc/self/cgroup does, and `root` is the folder of all groups. Nothing
/// without a limit, or if files are absent or have another form.
std::optional<double> CoreQuota(const std::string& group_file = "/proc/self/cgroup",
                                const std::string& root = "/sys/fs/cgroup");

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_DETAIL_CORE_QUOTA_H_
