#ifndef SHAPESPACE_TOOLS_SUPPORT_REPORT_H_
#define SHAPESPACE_TOOLS_SUPPORT_REPORT_H_

#include <string>
#include <vector>

#include "support/outputs.h"

namespace shapespace::tools {

/// For the usage text of tools that solve.
inline constexpr char kHowASolveEnds[] =
    "\n\nA solve that does not converge is reported; its outputs are written, and the exit code is "
    "0, or 1\nwith --strict. Ctrl-C ends the program. If --output has a .path, it contains the "
    "best path so far,\nmarked as not converged.";

/// The file named by --report, if any. To be called before the solve.
/// \throw UsageError, FileError if it cannot be written.
FlagOutputs ReportFromFlag();

/// Prints a solve's warnings to stderr and its one-line summary. With --strict, a solve that did
/// not converge is an error.
void PrintSummary(const std::string& brief, const std::vector<std::string>& warnings,
                  bool converged);

/// Writes the report of --report, if any: `text` or `json`, by its extension. Not after
/// `Interrupted`.
void WriteReport(const std::string& text, const std::string& json);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_REPORT_H_
