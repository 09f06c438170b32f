#ifndef SHAPESPACE_EXPLORATION_DETAIL_PAIR_SOLVER_H_
#define SHAPESPACE_EXPLORATION_DETAIL_PAIR_SOLVER_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/exploration/detail/records.h>
#include <shapespace/exploration/process_pool.h>
#include <shapespace/geodesic/geodesic.h>

// The geodesics from which a space is computed.

namespace shapespace::internal {

/// Version of the results, in the names of records, so that a record is found only by a solver that
/// would give the same result. To be incremented whenever the same inputs and options give another
/// result; tests/solvers/exploration/results_version_test.cc notices that.
inline constexpr int kResultsVersion = 7;

/// Two shapes of a space: centred, aligned with the first pose, in the metric's unit.
struct Pair {
  const Shape* from = nullptr;
  const Shape* to = nullptr;
  double t = 0.5;  ///< parameter of the geodesic's shape to return; negative: none
};

/// The geodesic from the one to the other.
struct PairResult {
  double length = 0;        ///< a pure number
  double blend_length = 0;  ///< length of the straight line between the two
  bool converged = true;
  Shape shape;  ///< at t, aligned with the linear blend; empty if none was requested
};

/// Counts of geodesics solved now and read from records.
struct PairCounts {
  int solved = 0, found = 0, damaged = 0, not_converged = 0;
};

/// Solves pairs, on all processes of a crew and all threads of each, and stores the results on
/// disk.
class PairSolver {
 public:
  /// `crew` must outlive it. \throw as Interpolator.
  PairSolver(const std::shared_ptr<const Connectivity>& connectivity,
             const std::vector<Shape>& poses, const GeodesicOptions& options, ProcessPool* crew,
             const std::string& records);

  const std::shared_ptr<const Metric>& GetMetric() const { return interpolator_.GetMetric(); }
  const PairCounts& Counts() const { return counts_; }

  /// Solves all `pairs`, in their order. The result is identical for any crew and any content of
  /// the records.
  /// \throw as Interpolator::Between; FileError; Cancelled.
  std::vector<PairResult> Solve(const std::vector<Pair>& pairs, const std::string& stage,
                                Progress* progress);

 private:
  std::vector<std::string> Digests(const std::vector<Pair>& pairs) const;
  PairResult SolveOne(const Pair& pair, Progress* progress) const;

  Interpolator interpolator_;
  ProcessPool& crew_;
  const Records records_;
  std::string digest_;  // of the data that all pairs share
  PairCounts counts_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPLORATION_DETAIL_PAIR_SOLVER_H_
