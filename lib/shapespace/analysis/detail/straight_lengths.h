#ifndef SHAPESPACE_ANALYSIS_DETAIL_STRAIGHT_LENGTHS_H_
#define SHAPESPACE_ANALYSIS_DETAIL_STRAIGHT_LENGTHS_H_

#include <memory>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// The lengths that edges would have between two poses if every element of the metric moved on the
/// straight line between its values in the two poses. On a path that attains the lower bound of its
/// energy the edges have these lengths. Under a cost of edge lengths squared lengths are
/// interpolated. Under a cost of strain the strains of triangles are interpolated, and an edge has
/// the mean of what its triangles say; the length of an edge without a triangle is interpolated by
/// its logarithm. Under both, squared lengths are averaged with the coefficients as weights.
/// Metrics without a cost of stretching are treated as those of edge lengths.
class StraightLengths {
 public:
  /// Of poses `m` and `n`, in the metric's unit; O(edges).
  StraightLengths(std::shared_ptr<const Metric> metric, const Shape& m, const Shape& n);

  /// The square of every edge's length at `t`, 0 in the first pose and 1 in the second.
  Eigen::VectorXd SquaredAt(double t) const;

 private:
  Eigen::VectorXd ByStrainAt(double t) const;

  const std::shared_ptr<const Metric> metric_;
  double strain_share_ = 0;  // of the cost of stretching
  struct Values {
    Eigen::VectorXd squared_lengths;
    Eigen::Matrix3Xd strains;     // of triangles
    Eigen::VectorXd log_lengths;  // of edges without a triangle
  };
  Values m_, n_;
};

/// The square of every edge's length.
Eigen::VectorXd SquaredLengths(const Connectivity& connectivity, const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_ANALYSIS_DETAIL_STRAIGHT_LENGTHS_H_
