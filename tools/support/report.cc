#include "support/report.h"

#include <iostream>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/extension.h>

#include "support/flag_group.h"
#include "support/interrupt.h"
#include "support/tool.h"

DEFINE_string(
    report, "",
    "write a report: .json, or .txt for reading; - prints JSON on stdout, and everything else on "
    "stderr");
DEFINE_bool(strict, false,
            "exit with code 1 if a solve did not converge; outputs are written nevertheless");
FLAG_GROUP(report, "Output");

namespace shapespace::tools {

FlagOutputs ReportFromFlag() {
  if (FLAGS_report == "-") ResultsToStderr();
  if (FLAGS_report.empty() || FLAGS_report == "-") return {"report", {}};
  const std::string extension = internal::FileExtension(FLAGS_report);
  if (extension != ".json" && extension != ".txt") {
    throw UsageError("--report " + FLAGS_report + ": must end in .json or .txt, or be -");
  }
  CheckCanBeWritten(FLAGS_report);
  return {"report", {FLAGS_report}};
}

void PrintSummary(const std::string& brief, const std::vector<std::string>& warnings,
                  bool converged) {
  for (const std::string& warning : warnings) Err() << "warning: " << warning << '\n';
  Out() << brief << '\n';
  if (FLAGS_strict && !converged) Complain("not converged, which is a failure with --strict");
}

void WriteReport(const std::string& text, const std::string& json) {
  if (FLAGS_report.empty() || Interrupted()) return;
  if (FLAGS_report == "-") {
    std::cout << json << std::flush;
    return;
  }
  try {
    internal::WriteFileAtomically(FLAGS_report, [&](std::ostream& out) {
      out << (internal::FileExtension(FLAGS_report) == ".txt" ? text : json);
    });
    Out() << "wrote " << FLAGS_report << '\n';
  } catch (const Error& error) {
    Complain(error.what());
  }
}

}  // namespace shapespace::tools
