#ifndef SHAPESPACE_TOOLS_SUPPORT_TOOL_H_
#define SHAPESPACE_TOOLS_SUPPORT_TOOL_H_

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/console.h"

namespace shapespace::tools {

/// The command line is invalid: printed with a hint at --help, exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Program {
  const char* name;
  const char* summary;                   ///< one line
  std::string usage;                     ///< arguments and an example
  std::vector<std::string> flag_groups;  ///< of its flags, by name (`FLAG_GROUP`)
};

/// Implements main() of every tool: parses the command line, handles --help, --help-all and
/// --version, and runs `body` with the arguments that are not flags. Returns the exit code: 0; 1
/// after an error or a `Complain`; 2 after a usage error. Ctrl-C ends the process by its signal.
/// Messages go to stderr.
int RunTool(int argc, char** argv, const Program& program,
            const std::function<void(const std::vector<std::string>& arguments)>& body);

/// Whether this flag was given on the command line.
bool IsGiven(const char* flag);

/// Reserves stdout for what --`flag` - writes: results that would be printed there go to stderr.
/// \throw UsageError if another flag has it.
void ClaimStdout(const std::string& flag);

/// Refuses flags without effect: `flags`, and all of some `groups` `but` one, for `reason`.
/// \throw UsageError "--flag: reason" if the command line gave one of them.
void RefuseFlags(const std::vector<std::string>& groups, const std::vector<std::string>& flags,
                 const std::string& reason, const std::string& but = "");

/// Names of flags that set fields of an options struct with other names: field, flag.
using FlagNames = std::vector<std::pair<std::string, std::string>>;

/// The flag of an option that `Error::option` or `Finding::option` names, as the end of a message:
/// " (--allow_nonmanifold)". Empty if there is none.
std::string InFlags(const std::string& option);

/// Runs `body` and converts InvalidOptions to UsageErrors that begin with the flags `AsTyped`
/// instead of the fields. A field that is not in `names` has the name of its flag.
void NamingFlags(const FlagNames& names, const std::function<void()>& body);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_TOOL_H_
