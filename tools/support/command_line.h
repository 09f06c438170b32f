#ifndef SHAPESPACE_TOOLS_SUPPORT_COMMAND_LINE_H_
#define SHAPESPACE_TOOLS_SUPPORT_COMMAND_LINE_H_

#include <string>
#include <vector>

namespace shapespace::tools {

/// Sets the flags of the groups `groups`, and --help, --help-all and --version, as the command line
/// says, and returns the other arguments. A flag begins with one or two hyphens; its value follows
/// after '=' or as the next argument, if that is not one of these flags itself. Hyphens in its name
/// stand for underscores. A boolean is given as --flag, --noflag or --flag=true. `-o` stands for
/// --output, `-h` for --help; '-' alone is an argument, and '--' ends the flags. Other flags that
/// libraries define, such as those of glog, are unknown.
/// \throw UsageError for an unknown flag, and a value that is missing or not of the flag's type.
std::vector<std::string> ParseCommandLine(int argc, char** argv,
                                          const std::vector<std::string>& groups);

/// A flag in messages, with its value as typed: "--unit 1e-3"; without value if it was not given.
std::string AsTyped(const std::string& flag);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_COMMAND_LINE_H_
