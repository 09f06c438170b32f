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
FLAG_GROUP(report, "Output", "report");

namespace shapespace::tools {

FlagOutputs ReportFromFlag() {
  if (FLAGS_report == "-") ClaimStdout("report");
  if (FLAGS_report.empty() || FLAGS_report == "-") return {"report", {}};
  const std::string extension = internal::FileExtension(FLAGS_report);
  if (extension != ".json" && extension != ".txt") {
    throw UsageError("--report " + FLAGS_report + ": must end in .json or .txt, or be -");
  }
  CheckCanBeWritten(FLAGS_report);
  return {"report", {FLAGS_report}};
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
