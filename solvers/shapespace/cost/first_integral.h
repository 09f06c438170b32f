#ifndef SHAPESPACE_COST_FIRST_INTEGRAL_H_
#define SHAPESPACE_COST_FIRST_INTEGRAL_H_

#include <ceres/problem.h>
#include <Eigen/SparseCore>

#include <shapespace/mesh/shape.h>

namespace shapespace::cost {

/// Adds the paper's equation (7) as automatically differentiated residual blocks
/// (FirstIntegralRows): for every coordinate j of a velocity x, scale (2 a_j - 2 x_j (G x)_j). The
/// parameter blocks are velocity->col(v).data(). `matrix` is G with both triangles, 3 m x 3 m
/// (FeatureDerivative::MetricMatrix has the lower one only); `constants` contains a, 3 x m.
/// `velocity` must outlive the problem.
void AddFirstIntegral(const Eigen::SparseMatrix<double>& matrix, const Tangent& constants,
                      double scale, Tangent* velocity, ceres::Problem* problem);

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_FIRST_INTEGRAL_H_
