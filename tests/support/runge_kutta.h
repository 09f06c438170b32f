#ifndef SHAPESPACE_TESTS_SUPPORT_RUNGE_KUTTA_H_
#define SHAPESPACE_TESTS_SUPPORT_RUNGE_KUTTA_H_

#include <memory>
#include <vector>

#include <Eigen/SparseCholesky>

#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/metric.h>

namespace shapespace::testing {

/// The geodesic from `shape` with `velocity` (user's unit), at `steps` + 1 times from 0 to 1: the
/// classical Runge-Kutta scheme of order 4 for G(P) P'' = -J^T Phi''(P', P'). It is computed from
/// the second derivatives of features, and so in a way that is independent of Extrapolate's.
inline std::vector<Shape> RungeKutta(const std::shared_ptr<const Metric>& metric,
                                     const Shape& shape, const Tangent& velocity, int steps) {
  const FeatureMap map(metric);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  const auto acceleration = [&](const Shape& p, const Tangent& v) -> Tangent {
    const FeatureDerivative derivative = map.Derivative(p);
    solver.compute(derivative.MetricMatrix());
    const Tangent force = derivative.TransposeTimes(map.SecondDerivative(p, v));
    return -solver.solve(force.reshaped()).reshaped(3, force.cols());
  };
  Shape p = shape / metric->unit;
  Tangent v = velocity / (metric->unit * steps);
  std::vector<Shape> shapes = {shape};
  for (int i = 0; i < steps; ++i) {
    const Tangent v1 = v, a1 = acceleration(p, v1);
    const Tangent v2 = v + 0.5 * a1, a2 = acceleration(p + 0.5 * v1, v2);
    const Tangent v3 = v + 0.5 * a2, a3 = acceleration(p + 0.5 * v2, v3);
    const Tangent v4 = v + a3, a4 = acceleration(p + v3, v4);
    p += (v1 + 2 * v2 + 2 * v3 + v4) / 6;
    v += (a1 + 2 * a2 + 2 * a3 + a4) / 6;
    shapes.push_back(metric->unit * p);
  }
  return shapes;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_RUNGE_KUTTA_H_
