#ifndef SHAPESPACE_TOOLS_SUPPORT_SOLVE_PROGRESS_H_
#define SHAPESPACE_TOOLS_SUPPORT_SOLVE_PROGRESS_H_

#include <optional>
#include <string>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/base/stopwatch.h>

#include "support/interrupt.h"

namespace shapespace::tools {

/// Shows how far a solve is and, once that can be told, how long it still takes (`ShowProgress`); a
/// temporary of the call that it is for: Interpolate(poses, options, SolveProgress(outputs).get()).
/// If one of the outputs is a .path, Ctrl-C makes it ask the solver to stop, so that the best so
/// far can be written there; otherwise Ctrl-C ends the program at once.
class SolveProgress final : public Progress {
 public:
  /// `next` is what else there will be to wait for, if anything.
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
  double end_ = 0;  // when all will be done, as it looked when the share was told; 0: not known
};

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_SOLVE_PROGRESS_H_
