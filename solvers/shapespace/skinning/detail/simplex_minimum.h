#ifndef SHAPESPACE_SKINNING_DETAIL_SIMPLEX_MINIMUM_H_
#define SHAPESPACE_SKINNING_DETAIL_SIMPLEX_MINIMUM_H_

#include <array>

#include <Eigen/Core>

namespace shapespace::internal {

/// Coordinates of a point of the simplex (not negative, with sum 1) of which few are not zero. Has
/// a fixed size, because there is one in the inner loop of a skinning.
struct SimplexPoint {
  static constexpr int kMost = 12;

  int count = 0;
  std::array<int, kMost> index;      ///< of each coordinate that is not zero
  std::array<double, kMost> weight;  ///< its value

  void Append(int i, double w);
  /// Removes the coordinate at a position and scales the others to sum 1; if all are zero, they
  /// become equal. There must be another one.
  void Remove(int position);
};

/// w^T G w of the point w, for a symmetric and positive semidefinite matrix G.
double ValueAt(const Eigen::MatrixXd& gram, const SimplexPoint& point);

/// The minimum of w^T G w over the simplex among points with no other coordinates than those of
/// `point`, which must have one at least; the value does not rise. By the inner loop of the method
/// of active sets (C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems", 1974, chapter 23).
void MinimiseOnSupport(const Eigen::MatrixXd& gram, SimplexPoint* point);

/// The same over the whole simplex, beginning at `point`: coordinates are added one at a time,
/// until none lowers the value or there are `SimplexPoint::kMost`. `gradient` is working memory.
void MinimiseOnSimplex(const Eigen::MatrixXd& gram, SimplexPoint* point, Eigen::VectorXd* gradient);

/// Removes coordinates, each time the one without which the minimum over the others is least, until
/// `most` are left.
void RemoveLeastUseful(const Eigen::MatrixXd& gram, int most, SimplexPoint* point);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_SIMPLEX_MINIMUM_H_
