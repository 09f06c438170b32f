#include "support/solve_progress.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/base/internal/system.h>

#include "support/console.h"
#include "support/files.h"

namespace shapespace::tools {
namespace {

// No estimate is shown before this time and this share of the work.
constexpr double kMinSeconds = 2, kMinShare = 0.05;

// Rounded to the precision of such an estimate.
std::string InWords(double seconds) {
  const auto rounded = [](double value, int unit) {
    return std::to_string(unit * std::max(1L, std::lround(value / unit)));
  };
  if (seconds < 55) return rounded(seconds, seconds < 10 ? 1 : 5) + " s";
  if (seconds < 100 * 60) return rounded(seconds / 60, 1) + " min";
  return rounded(seconds / 3600, 1) + " h";
}

}  // namespace

SolveProgress::SolveProgress(const std::vector<std::string>& outputs, std::string next)
    : next_(std::move(next)) {
  for (const std::string& output : outputs) {
    if (!IsPathFile(output)) continue;
    waits_.emplace([output] {
      if (!internal::StderrTakesText()) return;
      Err() << "stopping: writing the best path so far to " + output +
                   "; Ctrl-C again ends immediately\n";
    });
    return;
  }
}

SolveProgress::~SolveProgress() { ClearProgress(); }

bool SolveProgress::Report(const std::string& stage, int done, int total) {
  std::string line = stage;
  if (total > 0) {
    line += ": " + std::to_string(done) + " of " + std::to_string(total);
  } else if (done > 0) {
    line += ": iteration " + std::to_string(done);
  }
  ShowProgress(line + TimeLeft(), working_ ? std::optional(share_) : std::nullopt);
  return !Interrupted();
}

void SolveProgress::ReportShare(double share) {
  if (share == 0) working_.emplace();
  if (share == share_ || !working_) return;  // the estimated end does not change
  share_ = share;
  const double now = working_->Seconds();
  end_ = now < kMinSeconds || share < kMinShare ? 0 : now / share;
}

std::string SolveProgress::TimeLeft() const {
  const double left = working_ ? end_ - working_->Seconds() : 0;
  if (left <= 0) return {};
  return "; about " + InWords(left) + " left" + (next_.empty() ? "" : ", then " + next_);
}

}  // namespace shapespace::tools
