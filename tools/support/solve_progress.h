#ifndef SHAPESPACE_TOOLS_SUPPORT_SOLVE_PROGRESS_H_
#define SHAPESPACE_TOOLS_SUPPORT_SOLVE_PROGRESS_H_

#include <optional>
#include <string>
#include <vector>

#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/progress.h>

#include "support/interrupt.h"

namespace shapespace::tools {

/// Shows the progress of a solve and, if known, the remaining time (`ShowProgress`). It is used as
/// a temporary in the call: Interpolate(poses, options, SolveProgress(outputs).get()). If one of
/// the outputs is a .path, Ctrl-C asks the solver to stop, so that the best path so far can be
/// written; otherwise Ctrl-C ends the program immediately.
class SolveProgress final : public Progress {
 public:
  /// `next` names further work after this solve, if any.
  explicit SolveProgress(const std::vector<std::string>& outputs, std::string next = "");
  ~SolveProgress() override;
  bool Report(const std::string& stage, int done, int total) override;
  void ReportShare(double share) override;
  Progress* get() { return this; }

 private:
  std::string TimeLeft() const;

  const std::string next_;
  std::optional<FirstInterruptWaits> waits_;
  std::optional<internal::Stopwatch> working_;  // since the share was 0
  double share_ = 0;
  double end_ = 0;  // estimated end at the time of the last report; 0: unknown
};

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_SOLVE_PROGRESS_H_
