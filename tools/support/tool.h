#ifndef SHAPESPACE_TOOLS_SUPPORT_TOOL_H_
#define SHAPESPACE_TOOLS_SUPPORT_TOOL_H_

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/console.h"

namespace shapespace::tools {

/// The command line is wrong: printed with a hint at --help, exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Program {
  const char* name;
  const char* summary;  ///< one line
  std::string usage;    ///< arguments and an example
  /// Folders or files of this project whose flags the program takes, e.g. "tools/support/metric".
  std::vector<std::string> flag_sources;
};

/// What main() of every tool is: reads gflags, answers --help and --version, runs `body` with the
/// arguments that are no flags. Returns the exit code: 0, 1 after an error or a `Complain`, 2 after
/// a usage error; Ctrl-C ends the process by its signal. Messages go to stderr.
int RunTool(int argc, char** argv, const Program& program,
            const std::function<void(const std::vector<std::string>& arguments)>& body);

/// Whether the command line gave this flag.
bool IsGiven(const char* flag);

/// So that nobody believes that a flag did anything which did not: `flags`, and all of `sources`,
/// which are some of `flag_sources`, do nothing here, for `reason`.
/// \throw UsageError "--flag: reason" if the command line gave one of them.
void RefuseFlags(const std::vector<std::string>& sources, const std::vector<std::string>& flags,
                 const std::string& reason);

/// A flag as messages name it, with its value as it was typed: "--unit 1e-3"; without value if the
/// command line did not give it.
std::string AsTyped(const std::string& flag);

/// Which flags set the fields of an options struct, where their names differ: field, flag.
using FlagNames = std::vector<std::pair<std::string, std::string>>;

/// Runs `body`. Messages of InvalidOptions begin with a field's name: they become those of a
/// UsageError that begin with the flag `AsTyped`. What `names` does not list has a flag of its
/// name.
void NamingFlags(const FlagNames& names, const std::function<void()>& body);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_TOOL_H_
