#ifndef SHAPESPACE_BASE_PARALLEL_H_
#define SHAPESPACE_BASE_PARALLEL_H_

#include <functional>

namespace shapespace {

/// Threads that `ParallelFor` may use from now on; 0 (at the start) means one for each core. There
/// may be more than cores, up to 256: they take turns, which is of use in tests, and TBB makes as
/// many for the rest of the process, too.
/// \throw InvalidOptions if negative or too large.
void SetThreads(int threads);

/// Threads in use, at least 1.
int Threads();

/// Calls `body(i)` once for every i in [0, count), in any order and on several threads.
/// Bodies must write to disjoint memory; nothing here sums, so that a result cannot depend on the
/// number of threads. The first exception thrown by a body is rethrown.
void ParallelFor(int count, const std::function<void(int)>& body);

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_PARALLEL_H_
