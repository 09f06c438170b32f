#ifndef SHAPESPACE_TOOLS_SUPPORT_REPORT_H_
#define SHAPESPACE_TOOLS_SUPPORT_REPORT_H_

#include <string>
#include <vector>

#include "support/outputs.h"

namespace shapespace::tools {

/// The file named by --report, if any. To be called before the solve.
/// \throw UsageError, FileError if it cannot be written.
FlagOutputs ReportFromFlag();

/// Writes the report of --report, if any: `text` or `json`, by its extension. Not after
/// `Interrupted`.
void WriteReport(const std::string& text, const std::string& json);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_REPORT_H_
