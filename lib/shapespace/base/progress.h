#ifndef SHAPESPACE_BASE_PROGRESS_H_
#define SHAPESPACE_BASE_PROGRESS_H_

#include <string>

#include <shapespace/base/error.h>

namespace shapespace {

/// Receives the progress of a long call, and can stop it. Called by any thread, one at a time.
class Progress {
 public:
  virtual ~Progress() = default;

  /// `done` of `total` units of `stage` are finished; `total` is 0 if unknown. Return false to
  /// stop: the call then returns its best result so far, and says so in its summary, or throws
  /// `Cancelled` if there is no usable result. There are no reports after that.
  virtual bool Report(const std::string& stage, int done, int total) = 0;

  /// Estimated share of the call's work that is done, 0 to 1, for an estimate of the remaining
  /// time. The first report is 0, at the beginning of that work. A share may be less than the one
  /// before if more work turns out to be necessary. Calls without an estimate do not report it.
  virtual void ReportShare(double /*share*/) {}
};

/// Reports to `progress`, which may be null.
/// \throw Cancelled if it asked to stop.
inline void ReportProgress(Progress* progress, const std::string& stage, int done, int total) {
  if (progress != nullptr && !progress->Report(stage, done, total)) throw Cancelled();
}

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_PROGRESS_H_
