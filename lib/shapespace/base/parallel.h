#ifndef SHAPESPACE_BASE_PARALLEL_H_
#define SHAPESPACE_BASE_PARALLEL_H_

#include <functional>

namespace shapespace {

/// Sets the number of threads that `ParallelFor` and `ParallelTasks` use from now on; 0 (the
/// default) means one per core that the process may use: its affinity and quotas of containers
/// (cgroups) count too. Up to 256, which may be more than cores (useful in tests); TBB then uses as
/// many in the rest of the process too.
/// \throw InvalidOptions if negative or too large.
void SetThreads(int threads);

/// Threads in use, at least 1.
int NumThreads();

/// Calls `body(i)` once for every i in [0, count), in any order and on several threads.
/// Bodies must write to disjoint memory. There is no reduction, so results do not depend on the
/// number of threads. When bodies throw, what the one with the lowest index threw is rethrown, and
/// those behind it may not have been called.
void ParallelFor(int count, const std::function<void(int)>& body);

/// Calls `body(i)` once for every i in [0, count), for bodies that take long and use `ParallelFor`
/// themselves, such as whole solves. They begin in ascending order, and at most `at_once` of them
/// (and no more than there are threads) run at the same time. While a body runs on every thread,
/// the loops of all of them are serial; threads that have no body left help with the loops of the
/// others. When a body throws, no other begins; when those that run have ended, what the one with
/// the lowest index threw is rethrown.
///
/// Meanwhile, loops and tasks of other threads of the program are serial, so that such a thread may
/// be waited for in a body.
void ParallelTasks(int count, int at_once, const std::function<void(int)>& body);

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_PARALLEL_H_
