#ifndef SHAPESPACE_TESTS_SUPPORT_THREADS_H_
#define SHAPESPACE_TESTS_SUPPORT_THREADS_H_

#include <chrono>
#include <vector>

#include <shapespace/base/parallel.h>

namespace shapespace::testing {

/// Keeps the calling thread busy for so many microseconds.
inline void Spin(int microseconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(microseconds);
  while (std::chrono::steady_clock::now() < end) continue;
}

/// Results of `compute` on one, two, three and eight threads, however few cores there are.
template <class Compute>
auto OnThreads(const Compute& compute) {
  struct Reset {
    ~Reset() { SetThreads(0); }
  } reset;
  std::vector<decltype(compute())> results;
  for (int threads : {1, 2, 3, 8}) {
    SetThreads(threads);
    results.push_back(compute());
  }
  return results;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_THREADS_H_
