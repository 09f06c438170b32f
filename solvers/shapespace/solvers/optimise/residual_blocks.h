#ifndef SHAPESPACE_SOLVERS_OPTIMISE_RESIDUAL_BLOCKS_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_RESIDUAL_BLOCKS_H_

#include <vector>

#include <Eigen/Core>

#include <ceres/problem.h>

#include <shapespace/metric/metric.h>
#include <shapespace/solvers/cost/path_energy.h>
#include <shapespace/solvers/optimise/minimise.h>

namespace shapespace::internal {

/// A problem of Ceres about the shapes of a path, every vertex of every shape a parameter block of
/// three numbers where the shape has it. Ceres' cost is a quarter of what is minimised.
class ResidualBlocks {
 public:
  /// The energy of the path `shapes` (metric's unit), differentiated automatically; quartic weight
  /// as in PathEnergy. \throw InvalidOptions if the metric has a volume feature and more than
  ///        cost::kMaxDenseVertices vertices: its rows are dense.
  void AddPathEnergy(const Metric& metric, double quartic_weight, std::vector<Shape>* shapes);
  /// weight |vertex - target|^2.
  void AddPull(double weight, const Eigen::Vector3d& target, double* vertex);

  /// Vertices that stay as they are.
  void Fix(double* vertex);
  void Fix(Shape* shape);

  /// Levenberg and Marquardt's method with sparse Cholesky factors; `shapes` have the result.
  MinimiseResult Minimise(const MinimiseOptions& options);

 private:
  ceres::Problem problem_;
  cost::RigidMotions motions_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_RESIDUAL_BLOCKS_H_
