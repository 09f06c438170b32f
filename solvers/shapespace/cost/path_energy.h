#ifndef SHAPESPACE_COST_PATH_ENERGY_H_
#define SHAPESPACE_COST_PATH_ENERGY_H_

#include <vector>

#include <ceres/problem.h>
#include <Eigen/Core>

#include <shapespace/cost/shape_features.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

/// The room cost/ is what this project promises: the paper's energies, and its own schemes for
/// initial values and transport, as cost functions of Ceres that are differentiated automatically.
/// Kernels and solvers that are faster stand beside them, held equal by tests.
namespace shapespace::cost {

/// Metrics with a sum feature, whose rows are dense, are refused above this number of vertices.
inline constexpr int kMaxDenseVertices = 2000;

/// The rigid metric's (c, c_bar), a parameter block of six numbers for each segment of a path.
using RigidMotions = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Adds the energy of a path to `problem` as automatically differentiated residual blocks: one for
/// every element of every feature in every segment (segment_cost.h). Every vertex of every shape is
/// a parameter block of three numbers, (*shapes)[i].col(v).data(); the caller sets blocks constant,
/// such as those of the ends. Ceres' cost is a quarter of `PathEnergy`'s energy: the scaled energy,
/// E n / 2 for n segments, is 2 n times the cost.
///
/// `shapes` are in the metric's unit (Metric::unit). They and `motions` must outlive the problem,
/// and must not be resized while it exists. `motions` is used for the rigid metric only and is
/// resized here. `quartic_weight` as in PathEnergy::SetQuarticWeight. `features` may be those of
/// the same metric and shapes that the problem evaluates; they must outlive it.
/// \throw MeshError if there are fewer than two shapes, or one has another number of vertices
///        than the metric; InvalidOptions if the metric has a sum feature (volume) and more than
///        kMaxDenseVertices vertices, or a rigid part and there are no `motions`.
void AddPathEnergy(const Metric& metric, std::vector<Shape>* shapes, ceres::Problem* problem,
                   RigidMotions* motions = nullptr, double quartic_weight = 1,
                   const ShapeFeatures* features = nullptr);

/// Sets all vertices of `shape`, which are parameter blocks of `problem`, constant.
void SetConstant(Shape* shape, ceres::Problem* problem);

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_PATH_ENERGY_H_
