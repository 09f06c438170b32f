#ifndef SHAPESPACE_TOOLS_SUPPORT_REPORT_H_
#define SHAPESPACE_TOOLS_SUPPORT_REPORT_H_

#include <string>
#include <vector>

namespace shapespace::tools {

/// So that a wrong --report is told before the solve. \throw UsageError, FileError.
void CheckReportFlag();

/// Writes the report that --report asks for, if any: `text` or `json`, by its extension.
void WriteReport(const std::string& text, const std::string& json);

/// Tells stderr the warnings of a solve, and the user the line that sums it up: on stdout, unless
/// the report stands there.
void PrintSummary(const std::string& brief, const std::vector<std::string>& warnings);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_REPORT_H_
