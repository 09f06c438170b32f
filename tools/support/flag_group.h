#ifndef SHAPESPACE_TOOLS_SUPPORT_FLAG_GROUP_H_
#define SHAPESPACE_TOOLS_SUPPORT_FLAG_GROUP_H_

#include <string>
#include <vector>

#include <gflags/gflags.h>

namespace shapespace::tools {

/// The flags that one source file defines, under a name by which programs take or refuse them. Made
/// by FLAG_GROUP beside these flags.
class FlagGroup {
 public:
  /// `heading` is that of --help, which several groups may share; `file` is `__FILE__`.
  FlagGroup(const char* name, const char* heading, const char* file);
};

#define FLAG_GROUP(name, heading) \
  static const ::shapespace::tools::FlagGroup flag_group_##name(#name, heading, __FILE__)

/// The flags of a group, in the order of their names.
/// \throw std::logic_error if the program has no group of this name.
std::vector<gflags::CommandLineFlagInfo> FlagsOf(const std::string& group);

/// Prints all flags of these groups to stdout, heading by heading.
void PrintFlags(const std::vector<std::string>& groups);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_FLAG_GROUP_H_
