#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_SHELL_FIT_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_SHELL_FIT_H_

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <shapespace/correspondence/detail/smooth_stretch.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/metric.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// A closest-point term: the penalty of a point of a body, given by barycentric coordinates in a
/// triangle, and a point of the target. It is `weight` times the squared distance from the tangent
/// plane at the target's point, plus `along` times the squared distance from that point. By default
/// this is little, so that the body can slide along the target to reduce strain. With a normal of
/// zero it is a spring.
struct PointToPlaneTerm {
  Eigen::Vector3i vertices;
  Eigen::Vector3d barycentric;
  Eigen::Vector3d point, normal;  ///< of length 1, or 0
  double weight;
  double along = 0.02;
};

/// A body under the metric of strain and bending, fitted to a surface: minimises
///   |Phi(X) - Phi*|^2 + sum of the closest-point terms
/// by the Gauss-Newton method. Phi* are the dihedral angles at rest and the smoothed strains of the
/// body itself (`SmoothStretch`), so that a smooth change of proportions costs nothing, and only
/// strains that vary over short distances do. Held vertices stay where they are.
class ShellFit {
 public:
  /// `rest` must not be a single point; `held` are indices of vertices.
  ShellFit(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
           const std::vector<int>& held, double bending, double proportions);

  /// The areas A_p, scaled to sum 1.
  const Eigen::VectorXd& VertexAreas() const { return metric_->vertex_area; }

  /// One iteration: updates the smoothed strains from `*shape` and takes a step that decreases the
  /// sum; `*shape` is unchanged if there is none. \return the root mean square motion of the
  /// vertices in a full step, as a share of the square root of the area; a full step, so that a
  /// shortened step is not mistaken for convergence.
  double Step(const std::vector<PointToPlaneTerm>& terms, Shape* shape);

  /// The sum that a step decreases.
  double Energy(const std::vector<PointToPlaneTerm>& terms, const Shape& shape);

 private:
  // Terms of which the points are in the metric's unit.
  std::vector<PointToPlaneTerm> InOwnUnit(std::vector<PointToPlaneTerm> terms) const;
  double TermEnergy(const std::vector<PointToPlaneTerm>& terms, const Shape& shape) const;
  // Adds them to the matrix and the gradient.
  void AddTerms(const std::vector<PointToPlaneTerm>& terms, const Shape& shape, Tangent* gradient);
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

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_SHELL_FIT_H_
