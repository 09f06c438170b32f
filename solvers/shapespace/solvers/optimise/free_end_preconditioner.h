#ifndef SHAPESPACE_SOLVERS_OPTIMISE_FREE_END_PRECONDITIONER_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_FREE_END_PRECONDITIONER_H_

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>
#include <shapespace/solvers/optimise/cholesky.h>

namespace shapespace::internal {

/// What holds a path whose last shape is free: vertices that do not move, and pulls.
struct Grip {
  std::vector<int> carried;  ///< vertices whose place is given in all shapes
  std::vector<int> landed;   ///< vertices whose place is given in the last shape
  /// Of each vertex, how strongly the last shape is pulled at there: what is minimised is
  ///   E(P) + (1 / n) sum_p pull_p |p_n - target_p|^2
  /// over paths of n segments. 0 where the place is given.
  Eigen::VectorXd pull;
};

/// The factors of a free end's preconditioner, which serve any number of shapes.
///
/// In the differences y_t = p_t - p_{t-1} of neighbouring shapes the energy's Hessian is about the
/// scalar metric S (preconditioner.h) for each t, and the last shape is their sum. So all
/// combinations of the y_t that leave the last shape where it is see S alone, and the one that
/// moves it evenly sees S + 2 pull: two factors are an inverse, whatever is given or pulled at.
class FreeEndFactors {
 public:
  /// \throw SolverError if the scalar metric is not definite.
  FreeEndFactors(std::shared_ptr<const Metric> metric, Shape rest, Grip grip);

  const Shape& Rest() const { return rest_; }
  const Grip& GetGrip() const { return grip_; }

  /// For each tangent of `ways`, which says how vertices that are given or pulled at shall move in
  /// a shape, a motion of all vertices that takes the others along, and is least in the scalar
  /// metric.
  std::vector<Tangent> Spread(const std::vector<Tangent>& ways) const;

  /// Moves each of `shapes` so that the surface is, in the sense of the scalar metric, as near as
  /// can be to the rest shape's with every neighbourhood transformed by its `gradients` (one matrix
  /// a vertex, for each shape). What is given stays, what is pulled at is held.
  void Integrate(const std::vector<std::vector<Eigen::Matrix3d>>& gradients,
                 std::vector<Shape>* shapes) const;

 private:
  friend class FreeEndPreconditioner;
  // Solves with the end's factor for each of the right-hand sides, m x 3, and adds to `shapes`.
  void SolveAndAdd(const std::vector<Eigen::MatrixXd>& rights, std::vector<Tangent>* shapes) const;

  std::shared_ptr<const Metric> metric_;
  Shape rest_;
  Grip grip_;
  std::vector<char> given_;  // of each vertex: in the last shape
  Eigen::SparseMatrix<double> scalar_;
  std::shared_ptr<const CholeskyFactor<float>> between_;  // of S
  std::shared_ptr<const CholeskyFactor<float>> end_;      // of S + 2 pull
};

/// What makes a gradient a step, as `Preconditioner` does between two ends that are fixed.
class FreeEndPreconditioner {
 public:
  /// Both are kept by reference.
  FreeEndPreconditioner(const FreeEndFactors& factors, const PathEnergy& energy);

  /// result = (about the inverse of the Hessian) gradient; arrays of PathEnergy::Size(), which may
  /// be the same. What is given does not move. `unit` as in Preconditioner::Apply.
  void Apply(const double* gradient, double unit, double* result);

 private:
  const FreeEndFactors& factors_;
  const PathEnergy& energy_;
  int between_width_, end_width_;
  std::vector<int> between_place_, end_place_;  // of each vertex: its row in the factor
  std::vector<char> carried_;
  std::vector<float> between_work_, end_work_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_FREE_END_PRECONDITIONER_H_
