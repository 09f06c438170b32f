#include "support/report.h"

#include <filesystem>
#include <iostream>

#include <gflags/gflags.h>

#include <shapespace/base/atomic_file.h>

#include "support/outputs.h"
#include "support/tool.h"

DEFINE_string(report, "", "write a report: .json, or .txt for reading; - prints JSON on stdout");

namespace shapespace::tools {
namespace {

std::string Extension() { return std::filesystem::path(FLAGS_report).extension().string(); }

}  // namespace

void CheckReportFlag() {
  if (FLAGS_report.empty() || FLAGS_report == "-") return;
  if (Extension() != ".json" && Extension() != ".txt") {
    throw UsageError("--report " + FLAGS_report + ": must end in .json or .txt, or be -");
  }
  CheckCanBeWritten(FLAGS_report);
}

void WriteReport(const std::string& text, const std::string& json) {
  if (FLAGS_report.empty()) return;
  if (FLAGS_report == "-") {
    std::cout << json << std::flush;
    return;
  }
  const std::string& report = Extension() == ".txt" ? text : json;
  WriteFileAtomically(FLAGS_report, [&](std::ostream& out) { out << report; });
}

void PrintSummary(const std::string& brief, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << '\n';
  (FLAGS_report == "-" ? std::cerr : std::cout) << brief << '\n';
}

}  // namespace shapespace::tools
