#ifndef SHAPESPACE_COST_TANGENT_PROJECTION_H_
#define SHAPESPACE_COST_TANGENT_PROJECTION_H_

#include <ceres/problem.h>
#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::cost {

/// Adds |J(at) Y - change|^2 to `problem`: the tangent Y at the shape `at` (metric's unit) whose
/// change of the features is nearest to `change`, which has the layout of FeatureMap::Values. This
/// is the orthogonal projection onto the range of J, of which Levi-Civita transport consists
/// (docs/mathematics.md, section 10). One linear residual block per element; the parameter blocks
/// are y->col(v).data(). `y` must outlive the problem.
/// \throw InvalidOptions if the metric has a sum feature (volume), whose rows are dense, or a rigid
///        part; MeshError if `change` has another size.
void AddTangentProjection(const Metric& metric, const Shape& at, const Eigen::VectorXd& change,
                          Tangent* y, ceres::Problem* problem);

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_TANGENT_PROJECTION_H_
