#ifndef SHAPESPACE_GEODESIC_INTERNAL_RESIDUAL_BLOCKS_H_
#define SHAPESPACE_GEODESIC_INTERNAL_RESIDUAL_BLOCKS_H_

#include <vector>

#include <Eigen/Core>

#include <ceres/problem.h>

#include <shapespace/cost/path_energy.h>
#include <shapespace/metric/metric.h>
#include <shapespace/minimise/internal/minimise.h>

namespace shapespace::internal {

/// A Ceres problem in the shapes of a path. Each vertex of each shape is a parameter block of three
/// numbers, stored in the shape. Ceres' cost is a quarter of the objective.
class ResidualBlocks {
 public:
  /// Adds the energy of the path `shapes` (metric's unit), automatically differentiated; quartic
  /// weight as in PathEnergy.
  /// \throw InvalidOptions if the metric has a volume feature, whose rows are dense, and more than
  ///        cost::kMaxDenseVertices vertices.
  void AddPathEnergy(const Metric& metric, double quartic_weight, std::vector<Shape>* shapes);
  /// Adds weight |vertex - target|^2.
  void AddPenalty(double weight, const Eigen::Vector3d& target, double* vertex);

  /// Keeps vertices constant.
  void Fix(double* vertex);
  void Fix(Shape* shape) { cost::SetConstant(shape, &problem_); }

  /// Minimises by the Levenberg-Marquardt method with sparse Cholesky factors; the result is in
  /// `shapes`.
  MinimiseResult Minimise(const MinimiseOptions& options);

 private:
  ceres::Problem problem_;
  cost::RigidMotions motions_;
};

/// Ceres' Levenberg-Marquardt with sparse Cholesky factors on automatically differentiated residual
/// blocks: for small problems, and as an independent reference for the other methods. `shapes` are
/// in the metric's unit; the first and the last stay.
/// \throw InvalidOptions if the metric has a volume feature, whose rows are dense, and more than
///        cost::kMaxDenseVertices vertices.
MinimiseResult MinimiseTrustRegion(const Metric& metric, double quartic_weight,
                                   const MinimiseOptions& options, std::vector<Shape>* shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_INTERNAL_RESIDUAL_BLOCKS_H_
