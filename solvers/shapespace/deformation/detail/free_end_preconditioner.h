#ifndef SHAPESPACE_DEFORMATION_DETAIL_FREE_END_PRECONDITIONER_H_
#define SHAPESPACE_DEFORMATION_DETAIL_FREE_END_PRECONDITIONER_H_

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// The constraints on a path whose last shape is free: prescribed vertices, and penalties.
struct PositionConstraints {
  std::vector<int> prescribed;       ///< vertices with a prescribed position in all shapes
  std::vector<int> prescribed_last;  ///< vertices with a prescribed position in the last shape only
  /// Penalty weight of each vertex in the last shape. The objective is
  ///   E(P) + (1 / n) sum_p penalty_p |p_n - target_p|^2
  /// over paths of n segments. 0 where the position is prescribed.
  Eigen::VectorXd penalty;
};

/// The factors for the preconditioner of a path with a free end, for any number of shapes.
///
/// In the differences y_t = p_t - p_{t-1} of neighbouring shapes, the energy's Hessian is
/// approximately the scalar metric S (preconditioner.h) for each t, and the last shape is the first
/// plus the sum of the y_t. So on combinations of the y_t that leave the last shape unchanged the
/// Hessian is S, and on their normalised sum it is S + 2 penalty. Two factors are therefore
/// sufficient, for any constraints and penalties.
class FreeEndFactors {
 public:
  /// \throw SolverError if the scalar metric is not definite.
  FreeEndFactors(std::shared_ptr<const Metric> metric, Shape rest, PositionConstraints constraints);

  const Shape& Rest() const { return rest_; }
  const PositionConstraints& Constraints() const { return constraints_; }

  /// Extends prescribed displacements to all vertices. Each tangent of `ways` prescribes the
  /// displacement of the vertices that are given or have penalties; the result is the displacement
  /// of all vertices that is least in the scalar metric.
  std::vector<Tangent> Extend(const std::vector<Tangent>& ways) const;

  /// Moves each of `shapes` towards the rest shape transformed by `gradients` (one matrix per
  /// vertex, for each shape): minimises in the scalar metric the deviation of each neighbourhood
  /// from its transformed one. Given vertices stay, and vertices with penalties are kept near their
  /// positions.
  void Integrate(const std::vector<std::vector<Eigen::Matrix3d>>& gradients,
                 std::vector<Shape>* shapes) const;

 private:
  friend class FreeEndPreconditioner;
  // Solves with the factor `end_` for each of the right-hand sides, m x 3, and adds to `shapes`.
  void SolveAndAdd(const std::vector<Eigen::MatrixXd>& rights, std::vector<Tangent>* shapes) const;

  std::shared_ptr<const Metric> metric_;
  Shape rest_;
  PositionConstraints constraints_;
  std::vector<char> given_;  // per vertex: prescribed in the last shape
  Eigen::SparseMatrix<double> scalar_;
  std::shared_ptr<const CholeskyFactor<float>> between_;  // of S
  std::shared_ptr<const CholeskyFactor<float>> end_;      // of S + 2 penalty
};

/// Computes steps from gradients, as `Preconditioner` does for two fixed ends.
class FreeEndPreconditioner {
 public:
  /// Both are kept by reference.
  FreeEndPreconditioner(const FreeEndFactors& factors, const PathEnergy& energy);

  /// result = (approximate inverse of the Hessian) gradient; arrays of PathEnergy::Size(), which
  /// may be identical. Prescribed vertices do not move. `unit` as in Preconditioner::Apply.
  void Apply(const double* gradient, double unit, double* result);

 private:
  const FreeEndFactors& factors_;
  const PathEnergy& energy_;
  int between_width_, end_width_;
  std::vector<int> between_place_, end_place_;  // per vertex: its row in the factor
  std::vector<char> prescribed_;
  std::vector<float> between_work_, end_work_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_DETAIL_FREE_END_PRECONDITIONER_H_
