#ifndef SHAPESPACE_TOOLS_SUPPORT_INTERRUPT_H_
#define SHAPESPACE_TOOLS_SUPPORT_INTERRUPT_H_

#include <functional>
#include <string>

namespace shapespace::tools {

/// From now on Ctrl-C (SIGINT), SIGTERM and SIGHUP end the process as they would without this, but
/// remove the temporaries of files that are being written. `before_the_end` is called first.
void HandleInterrupts(const std::function<void()>& before_the_end);

/// While one of these lives the first such signal does not end the process: `Interrupted` is true
/// from then on, so that a solve can be stopped and what it has found be kept. `notice` is called
/// then, from another thread. A second signal ends the process.
class FirstInterruptWaits {
 public:
  explicit FirstInterruptWaits(const std::function<void()>& notice);
  ~FirstInterruptWaits();
  FirstInterruptWaits(const FirstInterruptWaits&) = delete;
  FirstInterruptWaits& operator=(const FirstInterruptWaits&) = delete;
};

/// Whether a signal came that has not ended the process yet.
bool Interrupted();

/// Ends the process by the signal that came, if one did.
void EndIfInterrupted();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_INTERRUPT_H_
