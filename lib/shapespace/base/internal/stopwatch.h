#ifndef SHAPESPACE_BASE_INTERNAL_STOPWATCH_H_
#define SHAPESPACE_BASE_INTERNAL_STOPWATCH_H_

#include <chrono>

namespace shapespace::internal {

/// Measures the time since its construction.
class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_STOPWATCH_H_
