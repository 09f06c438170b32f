#ifndef SHAPESPACE_MATCHING_DETAIL_ASSIGNMENTS_H_
#define SHAPESPACE_MATCHING_DETAIL_ASSIGNMENTS_H_

#include <utility>
#include <vector>

#include <Eigen/Core>

namespace shapespace::internal {

/// What is known of the landmarks of two bodies: the extremities, and pairs of points that are
/// known to correspond.
struct LandmarkDistances {
  /// Distances along each body between its extremities (rows) and all of its landmarks (columns):
  /// the extremities, then the points that are known.
  Eigen::MatrixXd on_template, on_target;
  /// How different extremities are by themselves, template x target.
  Eigen::MatrixXd difference;
};

/// Which extremity of the template is which of the target: a partial one-to-one assignment.
struct Assignment {
  double cost = 0;
  std::vector<std::pair<int, int>> pairs;  ///< of the template and of the target, in that order
};

struct Assignments {
  std::vector<Assignment> best;  ///< cheapest first
  int tried = 0;                 ///< partial assignments that were looked at
};

/// The cheapest `count` assignments that have at least `fewest` landmarks, together with the known
/// pairs. The cost of an assignment is
///   sum over pairs of pairs |d - d'| / (min(d, d') + 0.1) + weight * sum over pairs of difference,
/// d and d' the distances between the landmarks of the two pairs, plus a constant for each pair of
/// pairs that an extremity without partner would have formed; all divided by the number of pairs of
/// extremities of the body that has fewer. Found depth first, leaving out what cannot be
/// among the best. The search ends when a million partial assignments have been looked at, which
/// is more than there are of nine extremities on each body.
Assignments AssignExtremities(const LandmarkDistances& distances, int count, int fewest);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_ASSIGNMENTS_H_
