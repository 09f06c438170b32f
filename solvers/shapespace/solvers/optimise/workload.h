#ifndef SHAPESPACE_SOLVERS_OPTIMISE_WORKLOAD_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_WORKLOAD_H_

#include <limits>
#include <string>

#include <shapespace/base/progress.h>

namespace shapespace::internal {

/// Estimates how much of the work of many solves, one after the other, is done, and asks whether to
/// go on. A solve costs its vertices times its inner shapes; one that is to be accurate costs more,
/// as it takes more iterations.
class Workload {
 public:
  Workload(Progress* progress, double tolerance, int max_iterations)
      : progress_(progress), tolerance_(tolerance), max_iterations_(max_iterations) {}

  /// There is this much more to do than was known so far. A solve is `last` of its kind if it goes
  /// down to the tolerance.
  void Plan(int vertices, int shapes, bool last) { planned_ += Work(vertices, shapes, last); }

  /// A solve of those that are planned begins.
  void Begin(const std::string& stage, int vertices, int shapes, bool last);

  /// After every iteration, with the energy in any unit, and before the first. False: stop.
  bool GoOn(int iteration, double energy);
  bool Stopped() const { return stopped_; }

  /// The solve has ended.
  void End();

 private:
  double Work(int vertices, int shapes, bool last) const;

  Progress* const progress_;
  const double tolerance_;
  const int max_iterations_;
  double planned_ = 0, done_ = 0, current_ = 0;  // work
  bool stopped_ = false;
  std::string stage_;
  double energy_ = std::numeric_limits<double>::infinity();
  double first_drop_ = 0, share_ = 0;  // of the current solve
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_WORKLOAD_H_
