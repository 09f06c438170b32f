#include "support/summary.h"

#include <gflags/gflags.h>

#include "support/console.h"
#include "support/flag_group.h"

DEFINE_bool(strict, false,
            "exit with code 1 if a solve did not converge; outputs are written nevertheless");
FLAG_GROUP(summary, "Output", "");

namespace shapespace::tools {

void PrintSummary(const std::string& brief, const std::vector<std::string>& warnings,
                  bool converged) {
  for (const std::string& warning : warnings) Warn(warning);
  Out() << brief << '\n';
  if (FLAGS_strict && !converged) Complain("not converged, which is a failure with --strict");
}

}  // namespace shapespace::tools
