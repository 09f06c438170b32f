#ifndef SHAPESPACE_SOLVERS_EXPLORATION_CREW_H_
#define SHAPESPACE_SOLVERS_EXPLORATION_CREW_H_

#include <functional>
#include <string>
#include <vector>

namespace shapespace {

/// Processes that share work out among themselves. All of them run the same program and make the
/// same calls in the same order. This one is for a process that is alone; tools/support/mpi_crew.h
/// has the one for ranks of MPI.
class Crew {
 public:
  virtual ~Crew() = default;

  virtual int Rank() const { return 0; }  ///< of this process, from 0
  virtual int Size() const { return 1; }

  /// Calls `body(i)` for every i in [0, count), each on whichever process is free next, and gives
  /// all results to all. Exceptions are for the caller to end the whole crew with.
  virtual std::vector<std::string> ForEach(int count, const std::function<std::string(int)>& body) {
    std::vector<std::string> results;
    for (int i = 0; i < count; ++i) results.push_back(body(i));
    return results;
  }

  /// What the first process passes, to all.
  virtual std::string FromFirst(const std::string& bytes) { return bytes; }
};

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_EXPLORATION_CREW_H_
