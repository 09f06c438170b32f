#ifndef SHAPESPACE_EXPLORATION_PROCESS_POOL_H_
#define SHAPESPACE_EXPLORATION_PROCESS_POOL_H_

#include <functional>
#include <string>
#include <vector>

#include <shapespace/base/parallel.h>

namespace shapespace {

/// Processes that share work (a process pool). All of them run the same program and make the same
/// calls in the same order. This implementation is for a single process; tools/support/mpi_crew.h
/// implements it for MPI ranks.
class ProcessPool {
 public:
  virtual ~ProcessPool() = default;

  virtual int Rank() const { return 0; }  ///< of this process, from 0
  virtual int Size() const { return 1; }

  /// Calls `body(i)` for every i in [0, count), each on the next free process, and there at most
  /// `at_once` at a time, on several threads (`ParallelTasks`). Returns all results on all
  /// processes. The caller must end all processes if an exception is thrown.
  virtual std::vector<std::string> ForEach(int count, int at_once,
                                           const std::function<std::string(int)>& body) {
    std::vector<std::string> results(count);
    ParallelTasks(count, at_once, [&](int i) { results[i] = body(i); });
    return results;
  }

  /// Broadcast: returns what the first process passes, on all processes.
  virtual std::string FromFirst(const std::string& bytes) { return bytes; }
};

}  // namespace shapespace

#endif  // SHAPESPACE_EXPLORATION_PROCESS_POOL_H_
