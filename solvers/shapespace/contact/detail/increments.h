#ifndef SHAPESPACE_CONTACT_DETAIL_INCREMENTS_H_
#define SHAPESPACE_CONTACT_DETAIL_INCREMENTS_H_

#include <memory>
#include <vector>

#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

/// What turns the energy of a path P into the deviation of its increments from those of another
/// path Q with the same ends,
///   2 sum_i |(Phi(P_{i+1}) - Phi(P_i)) - (Phi(Q_{i+1}) - Phi(Q_i))|^2.
/// The two differ by 4 sum_i <Phi(P_i), Phi(Q_{i-1}) - 2 Phi(Q_i) + Phi(Q_{i+1})> and a number that
/// does not depend on P; by E(A, B, C), the energy of a path of three shapes, that sum is
///   sum_i E(Q_i, P_i, Q_i) - E(Q_{i-1}, P_i, Q_{i+1})
/// but for another such number, so that angles are compared with those of near shapes.
class Increments {
 public:
  /// `energy` is that of P, kept by reference; `guide` is Q.
  Increments(const std::shared_ptr<const Metric>& metric, const PathEnergy& energy,
             std::vector<Shape> guide);

  /// The difference, so that the deviation is zero at Q. Its derivatives are added to `gradient`
  /// unless this is null.
  double Evaluate(const double* unknowns, double* gradient);

 private:
  // The part of inner shape i, P_i, between two shapes, times `factor`.
  double Between(const Shape& before, int i, const Shape& after, double factor, double* gradient);

  const PathEnergy& energy_;
  PathEnergy single_;
  const std::vector<Shape> guide_;
  std::vector<Shape> path_;  // P, and then scratch
  std::vector<double> unknowns_, gradient_;
  double at_guide_ = 0;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_DETAIL_INCREMENTS_H_
