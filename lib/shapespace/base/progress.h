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
  /// Returns false to stop: the call then returns the best that it has so far, and its summary says
  /// so, or throws `Cancelled` if there is nothing worth returning yet. It reports no more then.
  virtual bool Report(const std::string& stage, int done, int total) = 0;

  /// About this share of the call's work, 0 to 1, is done: for an estimate of the time that is
  /// left. The first is 0, and told when the work begins that the later ones are shares of; a share
  /// may be less than the one before when more turns out to be to do. Calls that cannot tell do not
  /// call it.
  virtual void ReportShare(double /*share*/) {}
};

/// Reports to `progress`, which may be null.
/// \throw Cancelled if it asked to stop.
inline void ReportProgress(Progress* progress, const std::string& stage, int done, int total) {
  if (progress != nullptr && !progress->Report(stage, done, total)) throw Cancelled();
}

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_PROGRESS_H_
