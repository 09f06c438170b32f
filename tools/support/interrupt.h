#ifndef SHAPESPACE_TOOLS_SUPPORT_INTERRUPT_H_
#define SHAPESPACE_TOOLS_SUPPORT_INTERRUPT_H_

#include <functional>
#include <string>

namespace shapespace::tools {

/// After this call, Ctrl-C (SIGINT), SIGTERM and SIGHUP still end the process, but temporaries of
/// files that are being written are removed. `before_the_end` is called first.
void HandleInterrupts(const std::function<void()>& before_the_end);

/// While an object of this class exists, the first such signal does not end the process:
/// `Interrupted` becomes true, so that a solve can be stopped and its result be written, and
/// `notice` is called from another thread. A second signal ends the process.
class FirstInterruptWaits {
 public:
  explicit FirstInterruptWaits(const std::function<void()>& notice);
  ~FirstInterruptWaits();
  FirstInterruptWaits(const FirstInterruptWaits&) = delete;
  FirstInterruptWaits& operator=(const FirstInterruptWaits&) = delete;
};

/// Whether there was a signal that has not ended the process yet.
bool Interrupted();

/// If there was a signal, ends the process by it.
void EndIfInterrupted();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_INTERRUPT_H_
