#ifndef SHAPESPACE_FILES_POSE_ORDER_H_
#define SHAPESPACE_FILES_POSE_ORDER_H_

#include <string>
#include <vector>

namespace shapespace {

/// A warning if poses whose order matters are named in an order that looks like that of a shell,
/// which puts pose10.obj before pose2.obj: if the names of files that follow each other differ in
/// numbers only, and these do not ascend. They may descend, unless that is the shell's order too,
/// and a name may occur again, as where a motion returns to its first pose. Empty without.
std::string OrderWarning(const std::vector<std::string>& files);

}  // namespace shapespace

#endif  // SHAPESPACE_FILES_POSE_ORDER_H_
