#ifndef SHAPESPACE_TOOLS_SUPPORT_TOOL_H_
#define SHAPESPACE_TOOLS_SUPPORT_TOOL_H_

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <shapespace/base/progress.h>

namespace shapespace::tools {

/// The command line is wrong: printed with a hint at --help, exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Program {
  const char* name;
  const char* summary;  ///< one line
  const char* usage;    ///< arguments and an example
  /// Folders or files of this project whose flags the program takes, e.g. "tools/support/metric".
  std::vector<std::string> flag_sources;
};

/// What main() of every tool is: reads gflags, answers --help and --version, runs `body` with the
/// arguments that are no flags. Returns the exit code: 0, 1 after an error or Ctrl-C, 2 after a
/// usage error. Messages go to stderr.
int RunTool(int argc, char** argv, const Program& program,
            const std::function<void(const std::vector<std::string>& arguments)>& body);

/// Whether the command line gave this flag.
bool IsGiven(const char* flag);

/// Those flags of one of `flag_sources` that the command line gave, by name.
std::vector<std::string> GivenFlags(const std::string& source);

/// Shows a line of progress on stderr where that is a terminal, and cancels on Ctrl-C.
Progress* TerminalProgress();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_TOOL_H_
