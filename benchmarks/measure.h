#ifndef SHAPESPACE_BENCHMARKS_MEASURE_H_
#define SHAPESPACE_BENCHMARKS_MEASURE_H_

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <shapespace/base/stopwatch.h>

namespace shapespace {

/// Median time of one call of `body` over a fifth of a second, and at least five calls after a
/// first one that warms up.
template <typename Body>
double MedianSeconds(const Body& body) {
  body();
  std::vector<double> seconds;
  const internal::Stopwatch total;
  while (seconds.size() < 5 || total.Seconds() < 0.2) {
    const internal::Stopwatch stopwatch;
    body();
    seconds.push_back(stopwatch.Seconds());
  }
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

/// Forgets the peak of what came before, such as the making of a body. Where the kernel does not
/// let a process do that, PeakMegabytes() includes it.
inline void ResetPeakMemory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// The most memory that was resident since; not a number where there is no Linux to say so.
inline double PeakMegabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024 / 1e6;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace shapespace

#endif  // SHAPESPACE_BENCHMARKS_MEASURE_H_
