#ifndef SHAPESPACE_BENCHMARKS_MEASURE_H_
#define SHAPESPACE_BENCHMARKS_MEASURE_H_

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <shapespace/base/internal/stopwatch.h>

namespace shapespace {

/// Median time of one call of `body` during a fifth of a second, with at least five calls after one
/// for warming up.
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

/// Resets the peak memory, for instance after making a body. If the kernel does not permit this,
/// PeakMegabytes() includes the earlier peak.
inline void ResetPeakMemory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// The peak of resident memory since then; NaN on systems other than Linux.
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
