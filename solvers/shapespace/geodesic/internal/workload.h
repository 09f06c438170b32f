#ifndef SHAPESPACE_GEODESIC_INTERNAL_WORKLOAD_H_
#define SHAPESPACE_GEODESIC_INTERNAL_WORKLOAD_H_

#include <limits>
#include <string>

#include <shapespace/base/progress.h>

namespace shapespace::internal {

/// Estimates the completed share of a sequence of solves, and asks whether to continue. The cost of
/// a solve is its number of vertices times inner shapes, and more for an accurate solve, which
/// needs more iterations.
class Workload {
 public:
  Workload(Progress* progress, double tolerance, int max_iterations)
      : progress_(progress), tolerance_(tolerance), max_iterations_(max_iterations) {}

  /// Adds a solve to the known work. `last` is true if it goes down to the tolerance.
  void Plan(int vertices, int shapes, bool last) { planned_ += Work(vertices, shapes, last); }

  /// Begins one of the planned solves.
  void Begin(const std::string& stage, int vertices, int shapes, bool last);

  /// To be called before the first and after every iteration, with the energy in any unit. Returns
  /// false to stop.
  bool GoOn(int iteration, double energy);
  bool Stopped() const { return stopped_; }

  /// Ends the solve.
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

#endif  // SHAPESPACE_GEODESIC_INTERNAL_WORKLOAD_H_
