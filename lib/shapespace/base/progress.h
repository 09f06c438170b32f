#ifndef SHAPESPACE_BASE_PROGRESS_H_
#define SHAPESPACE_BASE_PROGRESS_H_

#include <string>

#include <shapespace/base/error.h>

namespace shapespace {

/// Hears how far a long call is, and may stop it. Called from the thread that made the call.
class Progress {
 public:
  virtual ~Progress() = default;

  /// `done` of `total` units of `stage` are finished; `total` is 0 where it is not known.
  /// Returns false to cancel: the call then throws `Cancelled`.
  virtual bool Report(const std::string& stage, int done, int total) = 0;
};

/// Reports to `progress`, which may be null.
/// \throw Cancelled if it asked to stop.
inline void ReportProgress(Progress* progress, const std::string& stage, int done, int total) {
  if (progress != nullptr && !progress->Report(stage, done, total)) throw Cancelled();
}

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_PROGRESS_H_
