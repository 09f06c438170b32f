#ifndef SHAPESPACE_TOOLS_SUPPORT_SUMMARY_H_
#define SHAPESPACE_TOOLS_SUPPORT_SUMMARY_H_

#include <string>
#include <vector>

namespace shapespace::tools {

/// For the usage text of tools that solve.
inline constexpr char kHowASolveEnds[] =
    "\n\nA solve that does not converge is reported; its outputs are written, and the exit code is "
    "0, or 1\nwith --strict. Ctrl-C ends the program. If --output has a .path, it contains the "
    "best path so far,\nmarked as not converged.";

/// Prints a solve's warnings to stderr and its one-line summary. With --strict, a solve that did
/// not converge is an error.
void PrintSummary(const std::string& brief, const std::vector<std::string>& warnings,
                  bool converged);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_SUMMARY_H_
