#ifndef SHAPESPACE_BASE_INTERNAL_RANGES_H_
#define SHAPESPACE_BASE_INTERNAL_RANGES_H_

#include <algorithm>

#include <shapespace/base/parallel.h>

// Loops whose bodies take too little time for a task each.

namespace shapespace::internal {

/// Indices per task, for bodies of some hundred nanoseconds.
inline constexpr int kPerTask = 512;

/// Calls body(begin, end) for consecutive ranges of [0, count) of `per_task` indices, on all
/// threads. The ranges do not depend on the number of threads: sums over each, kept at
/// begin / per_task and added in order, do not either.
template <typename Body>
void ForRanges(int count, const Body& body, int per_task = kPerTask) {
  ParallelFor((count + per_task - 1) / per_task,
              [&](int task) { body(task * per_task, std::min(count, (task + 1) * per_task)); });
}

/// Calls body(i) for every i in [0, count), on all threads.
template <typename Body>
void ForIndices(int count, const Body& body, int per_task = kPerTask) {
  ForRanges(
      count,
      [&](int begin, int end) {
        for (int i = begin; i < end; ++i) body(i);
      },
      per_task);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_RANGES_H_
