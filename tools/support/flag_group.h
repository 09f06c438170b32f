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
  /// `heading` is that of --help, which several groups may share. Of the flags --help has those in
  /// `usual`, which are separated by commas, and --help-all has all. `file` is `__FILE__`.
  FlagGroup(const char* name, const char* heading, const char* usual, const char* file);
};

#define FLAG_GROUP(name, heading, usual) \
  static const ::shapespace::tools::FlagGroup flag_group_##name(#name, heading, usual, __FILE__)

/// The flags of a group, in the order of their names.
/// \throw std::logic_error if the program has no group of this name.
std::vector<gflags::CommandLineFlagInfo> FlagsOf(const std::string& group);

enum class FlagList { kUsual, kAll };

/// Prints flags of these groups to stdout, heading by heading.
void PrintFlags(const std::vector<std::string>& groups, FlagList list);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_FLAG_GROUP_H_
