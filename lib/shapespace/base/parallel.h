#ifndef SHAPESPACE_BASE_PARALLEL_H_
#define SHAPESPACE_BASE_PARALLEL_H_

#include <functional>

namespace shapespace {

/// Sets the number of threads that `ParallelFor` uses from now on; 0 (the default) means one per
/// core that the process may use; quotas of containers (cgroup v2) count too. Up to 256, which may
/// be more than cores (useful in tests); TBB then uses as many in the rest of the process too.
/// \throw InvalidOptions if negative or too large.
void SetThreads(int threads);

/// Threads in use, at least 1.
int NumThreads();

/// Calls `body(i)` once for every i in [0, count), in any order and on several threads.
/// Bodies must write to disjoint memory. There is no reduction, so results do not depend on the
/// number of threads. The first exception thrown by a body is rethrown.
void ParallelFor(int count, const std::function<void(int)>& body);

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_PARALLEL_H_
