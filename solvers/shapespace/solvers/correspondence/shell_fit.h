#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_SHELL_FIT_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_SHELL_FIT_H_

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/metric.h>
#include <shapespace/solvers/correspondence/smooth_stretch.h>
#include <shapespace/solvers/optimise/cholesky.h>

// Private.

namespace shapespace::internal {

/// A point of a body, as barycentric coordinates in a triangle, that is pulled to a point of the
/// target: by `weight` times the squared distance from the tangent plane there, and a little of the
/// squared distance from the point itself.
struct Pull {
  Eigen::Vector3i vertices;
  Eigen::Vector3d barycentric;
  Eigen::Vector3d point, normal;  ///< unit
  double weight;
};

/// A body under the metric of strain and bending, pulled onto a surface: minimises
///   |Phi(X) - Phi*|^2 + sum of pulls
/// by Gauss and Newton's method, where Phi* are the dihedral angles at rest and strains that the
/// body takes on smoothly (`SmoothStretch`): to have other proportions costs nothing, to change
/// them from one place to the next does. Held vertices stay where they are.
class ShellFit {
 public:
  /// `rest` has an extent; `held` are vertices.
  ShellFit(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
           const std::vector<int>& held, double bending, double proportions);

  /// A_p of sum 1.
  const Eigen::VectorXd& VertexAreas() const { return metric_->vertex_area; }

  /// One iteration: proportions are taken anew from `*shape`, then it takes a step that lowers the
  /// sum, or stays as it is if there is none.
  /// \return the root mean square of the vertices' motion in a whole step, as a share of the root
  /// of the area, so that a step that had to be cut short is not taken for rest.
  double Step(const std::vector<Pull>& pulls, Shape* shape);

 private:
  double PullEnergy(const std::vector<Pull>& pulls, const Shape& shape) const;
  // To the matrix and the gradient.
  void AddPulls(const std::vector<Pull>& pulls, const Shape& shape, Tangent* gradient);
  void SetWanted(const Shape& shape);

  const std::shared_ptr<const Metric> metric_;
  const FeatureMap map_;
  const SmoothStretch stretch_;
  std::vector<bool> is_held_;
  Eigen::VectorXd wanted_;
  Eigen::SparseMatrix<double> matrix_;
  std::unique_ptr<Cholesky> factor_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_SHELL_FIT_H_
