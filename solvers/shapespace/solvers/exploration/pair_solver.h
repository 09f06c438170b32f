#ifndef SHAPESPACE_SOLVERS_EXPLORATION_PAIR_SOLVER_H_
#define SHAPESPACE_SOLVERS_EXPLORATION_PAIR_SOLVER_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/solvers/exploration/crew.h>
#include <shapespace/solvers/exploration/records.h>
#include <shapespace/solvers/geodesic.h>

// Private: the geodesics that everything about a space is made of.

namespace shapespace::internal {

/// Two shapes of a space: centred, turned onto the first pose, in the metric's unit.
struct Pair {
  const Shape* from = nullptr;
  const Shape* to = nullptr;
  double t = 0.5;  ///< where on the geodesic a shape is wanted; negative: none
};

/// The geodesic from the one to the other.
struct PairResult {
  double length = 0;        ///< a pure number
  double blend_length = 0;  ///< of the straight line, the linear blends of the two
  bool converged = true;
  Shape shape;  ///< at t, turned onto the linear blend; empty if none was wanted
};

/// What was done, and what was there already.
struct PairCounts {
  int solved = 0, found = 0, damaged = 0, not_converged = 0;
};

/// Solves pairs, each on one process of a crew, and keeps what it has found on disk.
class PairSolver {
 public:
  /// `crew` must outlive it. \throw as Interpolator.
  PairSolver(const std::shared_ptr<const Connectivity>& connectivity,
             const std::vector<Shape>& poses, const GeodesicOptions& options, Crew* crew,
             const std::string& records);

  const std::shared_ptr<const Metric>& GetMetric() const { return interpolator_.GetMetric(); }
  const PairCounts& Counts() const { return counts_; }

  /// All `pairs`, in their order. The result is the same to the last bit for any crew, and whatever
  /// was on disk. \throw as Interpolator::Between; FileError; Cancelled.
  std::vector<PairResult> Solve(const std::vector<Pair>& pairs, const std::string& stage,
                                Progress* progress);

 private:
  std::string Digest(const Pair& pair) const;
  PairResult SolveOne(const Pair& pair, Progress* progress);

  Interpolator interpolator_;
  Crew& crew_;
  const Records records_;
  std::string digest_;  // of all that pairs share
  PairCounts counts_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_EXPLORATION_PAIR_SOLVER_H_
