#include <shapespace/base/parallel.h>

#include <shapespace/base/error.h>

// Where there are no threads: WebAssembly in a page that no server grants them.

namespace shapespace {

void SetThreads(int threads) {
  if (threads != 0 && threads != 1) {
    throw InvalidOptions("threads", "must be 0 or 1, because this program has a single thread");
  }
}

int NumThreads() { return 1; }

void ParallelFor(int count, const std::function<void(int)>& body) {
  for (int i = 0; i < count; ++i) body(i);
}

void ParallelTasks(int count, int /*at_once*/, const std::function<void(int)>& body) {
  for (int i = 0; i < count; ++i) body(i);
}

}  // namespace shapespace
