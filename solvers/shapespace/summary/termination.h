#ifndef SHAPESPACE_SUMMARY_TERMINATION_H_
#define SHAPESPACE_SUMMARY_TERMINATION_H_

namespace shapespace {

/// Why a solve ended. If it consists of several (levels, pieces of a path), the worst of their
/// ends.
enum class Termination {
  kConverged,      ///< every solve reached the tolerance
  kMaxIterations,  ///< one ran out of iterations; the result is the best so far
  kStalled,        ///< a line search found no better point; the result is the best so far
  kCancelled,      ///< `progress` asked to stop; the result is the best so far
};

}  // namespace shapespace

#endif  // SHAPESPACE_SUMMARY_TERMINATION_H_
