#ifndef SHAPESPACE_TOOLS_SUPPORT_REPORT_H_
#define SHAPESPACE_TOOLS_SUPPORT_REPORT_H_

#include <string>
#include <vector>

#include "support/outputs.h"

namespace shapespace::tools {

/// For the usage of tools that solve: how they end.
inline constexpr char kHowASolveEnds[] =
    "\n\nWhat did not converge says so, its outputs are written, and the exit code is 0, or with "
    "--strict 1.\nCtrl-C ends the program. If --output has a .path, that holds the best so far, "
    "marked as not\nconverged.";

/// The file that --report names, if any. \throw UsageError, FileError if it cannot be one: before
/// the solve, not after.
FlagOutputs ReportFromFlag();

/// Tells stderr the warnings of a solve, and the user the line that sums it up. What has not
/// converged is a failure with --strict.
void PrintSummary(const std::string& brief, const std::vector<std::string>& warnings,
                  bool converged);

/// Writes the report that --report asks for, if any: `text` or `json`, by its extension. Not once
/// `Interrupted`.
void WriteReport(const std::string& text, const std::string& json);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_REPORT_H_
