#include <shapespace/deformation/detail/free_end_preconditioner.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>

#include "support/motions.h"
#include "support/paths.h"

namespace shapespace::internal {
namespace {

using shapespace::testing::Noise;
using shapespace::testing::Rotation;

// With a cost of position alone the energy is a quadratic form, and the scalar metric is exact: one
// step of Newton's method with the preconditioner reaches the minimum, for any constraints and
// penalties.
TEST(FreeEndPreconditioner, IsTheInverseOfAQuadraticEnergy) {
  const ShapeFamily bar = MakeBar(3, 1, 1, 6, 2, 2);
  MetricOptions options;
  options.strain = options.bending = 0;
  options.lambda = 1;
  const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0)});
  const Shape rest = bar.pose(0) / metric->unit;
  const int count = static_cast<int>(rest.cols());
  for (int n : {1, 2, 5}) {
    PositionConstraints constraints;
    constraints.prescribed = {0, 3, 8};
    constraints.prescribed_last = {1, 5};
    constraints.penalty = Eigen::VectorXd::Zero(count);
    constraints.penalty(7) = 0.3;
    constraints.penalty(20) = 2;
    const FreeEndFactors factors(metric, rest, constraints);
    std::vector<Shape> shapes = {rest};
    for (int t = 1; t <= n; ++t) shapes.push_back(rest + Noise(count, 0.1, t));
    const Shape target = rest + Noise(count, 0.2, 77);

    PathEnergy energy(metric, n, PathEnergy::End::kFree);
    std::vector<double> x(energy.Size()), gradient(energy.Size()), step(energy.Size());
    energy.Load(shapes, x.data());
    const auto at = [&](int v, int axis, int t) {
      return (3 * static_cast<size_t>(energy.Row(v)) + axis) * energy.Stride() + t;
    };
    // The gradient of the objective with respect to the free vertices.
    const auto evaluate = [&] {
      energy.Evaluate(x.data(), gradient.data());
      double largest = 0;
      for (int v = 0; v < count; ++v) {
        for (int axis = 0; axis < 3; ++axis) {
          gradient[at(v, axis, n - 1)] +=
              2 * constraints.penalty(v) / n * (x[at(v, axis, n - 1)] - target(axis, v));
          for (int t = 0; t < n; ++t) {
            const bool given = v == 0 || v == 3 || v == 8 || (t == n - 1 && (v == 1 || v == 5));
            if (given) gradient[at(v, axis, t)] = 0;
            largest = std::max(largest, std::abs(gradient[at(v, axis, t)]));
          }
        }
      }
      return largest;
    };
    const double before = evaluate();
    FreeEndPreconditioner(factors, energy).Apply(gradient.data(), 1, step.data());
    const std::vector<double> start = x;
    for (size_t k = 0; k < x.size(); ++k) x[k] -= step[k];
    EXPECT_LT(evaluate(), 1e-5 * before) << n;
    for (int t = 0; t < n; ++t) EXPECT_EQ(x[at(3, 1, t)], start[at(3, 1, t)]);
    EXPECT_EQ(x[at(5, 2, n - 1)], start[at(5, 2, n - 1)]);
  }
}

struct Held {
  ShapeFamily body = MakeBar(4, 1, 1, 12, 3, 3);
  std::shared_ptr<const Metric> metric =
      FreezeMetric(MetricOptions::Deformation(*body.connectivity, body.pose(0)), body.connectivity,
                   {body.pose(0)});
  Shape rest = body.pose(0) / metric->unit;
  PositionConstraints constraints;

  Held() {
    constraints.penalty = Eigen::VectorXd::Zero(rest.cols());
    for (int v = 0; v < rest.cols(); v += 9) constraints.prescribed.push_back(v);
  }
};

TEST(FreeEndFactors, ATranslationOfWhatIsGivenTakesTheWholeAlong) {
  const Held held;
  const FreeEndFactors factors(held.metric, held.rest, held.constraints);
  Tangent way = Tangent::Zero(3, held.rest.cols());
  for (int v : held.constraints.prescribed) way.col(v) << 0.1, -0.2, 0.3;
  const Tangent result = factors.Extend({way})[0];
  for (int v = 0; v < result.cols(); ++v) {
    EXPECT_LT((result.col(v) - Eigen::Vector3d(0.1, -0.2, 0.3)).norm(), 1e-4);
  }
}

// If all neighbourhoods rotate by the same rotation, the result is the rotated shape, whatever the
// initial positions of the free vertices.
TEST(FreeEndFactors, IntegratesARotation) {
  const Held held;
  const FreeEndFactors factors(held.metric, held.rest, held.constraints);
  const Eigen::Matrix3d turn = Rotation(130, {1, 2, 3});
  const Shape expected = turn * held.rest;
  std::vector<Shape> shapes = {held.rest};
  for (int v : held.constraints.prescribed) shapes[0].col(v) = expected.col(v);
  factors.Integrate({std::vector<Eigen::Matrix3d>(held.rest.cols(), turn)}, &shapes);
  EXPECT_LT((shapes[0] - expected).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace shapespace::internal
