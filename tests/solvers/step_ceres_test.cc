#include <shapespace/exponential/detail/step_ceres.h>

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/cost/path_energy.h>

#include "support/message_of.h"
#include "support/paths.h"
#include "support/stiffened.h"

namespace shapespace::internal {
namespace {

using testing::MessageOf;
using testing::Noise;

// Two shapes of a motion, in the metric's unit; the step of the geodesic continues from the second.
struct Case {
  std::string name;
  std::shared_ptr<const Metric> metric;
  Shape previous, at;

  Shape Predicted() const { return 2 * at - previous; }
  Eigen::VectorXd Target(const FeatureMap& map) const {
    return 2 * map.Values(at) - map.Values(previous);
  }
};

Case Moving(const std::string& name, const ShapeFamily& body, const MetricOptions& options,
            double from, double to) {
  const auto metric =
      FreezeMetric(options, body.connectivity, {body.pose(body.begin), body.pose(to)});
  return {name, metric, body.pose(from) / metric->unit, body.pose(to) / metric->unit};
}

std::vector<Case> Cases() {
  MetricOptions volume;
  volume.volume = 0.3;
  return {Moving("bar", MakeBar(6, 1, 1, 12, 2, 2), {}, 20, 30),
          Moving("bar, volume", MakeBar(6, 1, 1, 6, 1, 1), volume, 20, 30),
          Moving("sheet", MakeSheet(2, 1, 8, 4), {}, 30, 45),
          Moving("bricard", MakeBricard(), {}, 10, 14),
          Moving("bar, triangle strain", testing::Stiffened(MakeBar(6, 1, 1, 6, 1, 1)),
                 MetricOptions::Strain(), 20, 30)};
}

// |J(at)^T [Phi(P) - target]| as a share of its value at `at`.
double Residual(const FeatureMap& map, const Shape& at, const Eigen::VectorXd& target,
                const Shape& shape) {
  const FeatureDerivative derivative = map.Derivative(at);
  return derivative.TransposeTimes(map.Values(shape) - target).norm() /
         derivative.TransposeTimes(map.Values(at) - target).norm();
}

TEST(SolveStepWithCeres, FindsARootOfTheDiscreteEulerLagrangeEquation) {
  for (const Case& test : Cases()) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    const Eigen::VectorXd target = test.Target(map);
    Shape shape = test.Predicted();
    EXPECT_GT(Residual(map, test.at, target, shape), 1e-3);  // the straight line is not a solution
    const StepResult result = SolveStepWithCeres(map, test.at, target, 1e-10, 20, &shape);
    EXPECT_TRUE(result.converged);
    EXPECT_LE(result.residual, 1e-10);
    EXPECT_GT(result.iterations, 0);
    EXPECT_NEAR(Residual(map, test.at, target, shape), result.residual, 1e-12);
    const double step = (test.at - test.previous).norm();
    EXPECT_LT((shape - test.Predicted()).norm(), 0.5 * step);  // not another, distant root

    // If the start is the root, no bit changes.
    Shape again = shape;
    const StepResult stay = SolveStepWithCeres(map, test.at, target, 1e-10, 20, &again);
    EXPECT_TRUE(stay.converged);
    EXPECT_EQ(stay.iterations, 0);
    EXPECT_TRUE(again == shape);
  }
}

// If the target is Phi of a shape, that shape is a root.
TEST(SolveStepWithCeres, FindsTheShapeWhoseFeaturesAreTheTarget) {
  for (const Case& test : Cases()) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    const Shape root = test.at + Noise(static_cast<int>(test.at.cols()), 1e-3, 1);
    Shape shape = test.at;
    const StepResult result = SolveStepWithCeres(map, test.at, map.Values(root), 1e-12, 30, &shape);
    EXPECT_TRUE(result.converged);
    // The condition number of the step is about 1e6.
    EXPECT_LT((shape - root).norm(), 1e-6 * (root - test.at).norm());
  }
}

TEST(SolveStepWithCeres, IsIndifferentToTheSizeOfTheStep) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  // The solution departs from the straight line by the square of the step.
  double departure = 0;
  for (double angle : {1.0, 1e-1, 1e-2}) {
    const Case test = Moving("", bar, {}, 30 - angle, 30);
    const FeatureMap map(test.metric);
    Shape shape = test.Predicted();
    const StepResult result = SolveStepWithCeres(map, test.at, test.Target(map), 1e-8, 20, &shape);
    EXPECT_TRUE(result.converged) << angle << " " << result.residual;
    const double now = (shape - test.Predicted()).norm();
    if (departure > 0) {
      EXPECT_NEAR(departure / now, 100, 10) << angle;
    }
    departure = now;
  }
}

// For such a small step rounding leaves few digits, and this accuracy is reached immediately.
TEST(SolveStepWithCeres, StopsWhereRoundingBegins) {
  const Case test = Moving("", MakeSheet(2, 1, 24, 12), {}, 30 - 1e-3, 30);
  const FeatureMap map(test.metric);
  Shape shape = test.Predicted();
  const StepResult result = SolveStepWithCeres(map, test.at, test.Target(map), 1e-12, 20, &shape);
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.iterations, 3);
  EXPECT_GT(result.residual, 1e-12);
  EXPECT_LT(result.residual, 1e-6);
}

TEST(SolveStepWithCeres, TranslatesAndRestsExactly) {
  for (const Case& test : Cases()) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    const Eigen::Vector3d way(0.1, -0.02, 0.05);
    const Shape before = test.at.colwise() - way, after = test.at.colwise() + way;
    Shape shape = test.at;
    const StepResult moved = SolveStepWithCeres(
        map, test.at, 2 * map.Values(test.at) - map.Values(before), 1e-10, 20, &shape);
    EXPECT_TRUE(moved.converged);
    EXPECT_LT((shape - after).cwiseAbs().maxCoeff(), 1e-8);
    // At velocity zero the equation says P = at, where all of its rows vanish.
    Shape rest = test.Predicted();
    const StepResult rested =
        SolveStepWithCeres(map, test.at, map.Values(test.at), 1e-10, 20, &rest);
    EXPECT_TRUE(rested.converged);
    EXPECT_EQ(rested.residual, 0);
    EXPECT_TRUE(rest == test.at);
  }
}

TEST(SolveStepWithCeres, GoesStraightOnInAFlatMetric) {
  MetricOptions flat;
  flat.strain = flat.bending = 0;
  for (const ShapeFamily& body : {MakeBar(6, 1, 1, 6, 1, 1), MakeSheet(2, 1, 6, 4)}) {
    const Case test = Moving("", body, flat, 20, 30);
    const FeatureMap map(test.metric);
    Shape shape = test.Predicted();
    const StepResult stay = SolveStepWithCeres(map, test.at, test.Target(map), 1e-12, 20, &shape);
    EXPECT_TRUE(stay.converged);
    EXPECT_EQ(stay.iterations, 0);
    EXPECT_TRUE(shape == test.Predicted());
    shape = test.previous;
    EXPECT_TRUE(SolveStepWithCeres(map, test.at, test.Target(map), 1e-12, 20, &shape).converged);
    EXPECT_LT((shape - test.Predicted()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(SolveStepWithCeres, SumFeaturesPullTheirShare) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  MetricOptions stiff;
  stiff.volume = 30;
  const auto volume_error = [&](const MetricOptions& options) {
    Case test = Moving("", bar, options, 20, 30);
    const FeatureMap map(test.metric);
    Shape shape = test.Predicted();
    EXPECT_TRUE(SolveStepWithCeres(map, test.at, test.Target(map), 1e-10, 40, &shape).converged);
    // Compared with a constant rate of change of the volume, by a map with a volume feature.
    const auto metric = FreezeMetric(stiff, bar.connectivity, {bar.pose(0), bar.pose(30)});
    const FeatureMap measure(metric);
    const Eigen::VectorXd defect = measure.Values(shape) - test.Target(measure);
    return std::abs(defect(defect.size() - 1)) / std::sqrt(stiff.volume);
  };
  EXPECT_LT(volume_error(stiff), 1e-2 * volume_error({}));
}

TEST(SolveStepWithCeres, RefusesSumFeaturesOnLargeMeshes) {
  MetricOptions options;
  options.volume = 0.3;
  const Case test = Moving("", MakeBar(6, 1, 1, 100, 6, 6), options, 20, 30);
  ASSERT_GT(test.at.cols(), cost::kMaxDenseVertices);
  const FeatureMap map(test.metric);
  Shape shape = test.at;
  const std::string message = MessageOf<InvalidOptions>(
      [&] { SolveStepWithCeres(map, test.at, map.Values(test.at), 1e-9, 20, &shape); });
  EXPECT_EQ(message.rfind("volume:", 0), 0u) << message;
}

TEST(SolveStepWithCeres, SaysSoWhenItDoesNotArriveAndWhenItCannotStart) {
  const Case test = Cases().front();
  const FeatureMap map(test.metric);
  const Eigen::VectorXd target = test.Target(map);
  Shape shape = test.Predicted();
  const StepResult result = SolveStepWithCeres(map, test.at, target, 1e-14, 1, &shape);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_NEAR(Residual(map, test.at, target, shape), result.residual, 1e-12);
  EXPECT_LT(result.residual, Residual(map, test.at, target, test.Predicted()));  // the best so far
  shape(1, 3) = std::nan("");
  EXPECT_THROW(SolveStepWithCeres(map, test.at, target, 1e-9, 20, &shape), SolverError);
}

// a_j = x_j (G x)_j.
Tangent Constants(const FeatureMap& map, const Shape& at, const Tangent& x) {
  const FeatureDerivative derivative = map.Derivative(at);
  return x.cwiseProduct(derivative.TransposeTimes(derivative.Times(x)));
}

std::vector<Case> CasesWithoutSums() {
  std::vector<Case> cases;
  for (const Case& test : Cases()) {
    if (test.metric->options.volume == 0) cases.push_back(test);
  }
  return cases;
}

constexpr FirstIntegralSolver kFirstIntegralSolvers[] = {FirstIntegralSolver::kLbfgs,
                                                         FirstIntegralSolver::kLevenbergMarquardt};

std::string NameOf(FirstIntegralSolver solver) {
  return solver == FirstIntegralSolver::kLbfgs ? "L-BFGS" : "Levenberg-Marquardt";
}

// If there is a root: the accuracy of each solver after a number of iterations.
struct Accuracy {
  FirstIntegralSolver solver;
  double tolerance;
  int max_iterations;
};
constexpr Accuracy kAccuracies[] = {{FirstIntegralSolver::kLbfgs, 1e-9, 20000},
                                    {FirstIntegralSolver::kLevenbergMarquardt, 1e-11, 60}};

TEST(SolveFirstIntegral, StaysWhereTheConstantsWereTaken) {
  for (const Case& test : CasesWithoutSums()) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    for (double speed : {1.0, 0x1p-20}) {
      const Tangent x = speed * (test.at - test.previous);
      const Tangent constants = Constants(map, test.at, x);
      // The sum of (7) over all coordinates is the cost of the motion.
      const double cost = map.Derivative(test.at).Times(x).squaredNorm();
      EXPECT_NEAR(constants.sum(), cost, 1e-10 * constants.lpNorm<1>());
      for (const FirstIntegralSolver solver : kFirstIntegralSolvers) {
        SCOPED_TRACE(NameOf(solver));
        Tangent velocity = x;
        const StepResult result =
            SolveFirstIntegral(map, test.at, constants, solver, 1e-10, 20, &velocity);
        EXPECT_TRUE(result.converged);
        EXPECT_EQ(result.iterations, 0);
        EXPECT_LT(result.residual, 1e-11);
        EXPECT_TRUE(velocity == x);
      }
    }
  }
}

// With diagonal G, (7) says x_j^2 = a_j / G_jj, and signs cannot change.
TEST(SolveFirstIntegral, FindsTheRootOfTheSameSignsInAFlatMetric) {
  MetricOptions flat;
  flat.strain = flat.bending = 0;
  const Case test = Moving("", MakeSheet(2, 1, 6, 4), flat, 20, 30);
  const FeatureMap map(test.metric);
  const int num_vertices = static_cast<int>(test.at.cols());
  Tangent x = Noise(num_vertices, 1, 2);
  for (double& entry : x.reshaped()) entry += entry > 0 ? 0.5 : -0.5;
  for (const auto& [solver, tolerance, max_iterations] : kAccuracies) {
    for (double speed : {1.0, 1e-8, 1e8}) {
      SCOPED_TRACE(NameOf(solver) + ", speed " + std::to_string(speed));
      Tangent velocity = speed * x.cwiseProduct(Tangent::Constant(3, num_vertices, 1) +
                                                Noise(num_vertices, 0.05, 3));
      const StepResult result = SolveFirstIntegral(map, test.at, Constants(map, test.at, speed * x),
                                                   solver, tolerance, max_iterations, &velocity);
      EXPECT_TRUE(result.converged) << result.residual;
      EXPECT_LE(result.residual, tolerance);
      EXPECT_LT((velocity - speed * x).norm(), 10 * tolerance * speed * x.norm());
    }
  }
}

// If all coordinates move and the start is close, (7) has a root that is found.
TEST(SolveFirstIntegral, FindsARootCloseBy) {
  for (const Case& test :
       {Moving("sheet", MakeSheet(1, 1, 2, 2), MetricOptions::Isometric(), 30, 45),
        Moving("bricard", MakeBricard(), MetricOptions::Isometric(), 10, 14)}) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    const int num_vertices = static_cast<int>(test.at.cols());
    const Tangent x = Noise(num_vertices, 1, 10);
    const Tangent constants = Constants(map, test.at, x);
    for (const auto& [solver, tolerance, max_iterations] : kAccuracies) {
      SCOPED_TRACE(NameOf(solver));
      Tangent velocity = x + Noise(num_vertices, 1e-4, 11);
      const StepResult result =
          SolveFirstIntegral(map, test.at, constants, solver, tolerance, max_iterations, &velocity);
      EXPECT_TRUE(result.converged) << result.residual;
      EXPECT_LE(result.residual, tolerance);
      EXPECT_GT(result.iterations, 0);
      EXPECT_LT((velocity - x).norm(), 1e-6 * x.norm());
      // The sum of rows of that size is at most their root mean square times the square root of
      // their number.
      const double cost = map.Derivative(test.at).Times(velocity).squaredNorm();
      EXPECT_NEAR(cost, constants.sum(),
                  tolerance * constants.norm() * std::sqrt(constants.size()));
    }
  }
}

// For a step of the integrator there is no root: the constants are those of the previous shape.
TEST(SolveFirstIntegral, ReportsHowFarItGot) {
  for (const Case& test : CasesWithoutSums()) {
    SCOPED_TRACE(test.name);
    const FeatureMap map(test.metric);
    const Tangent x = test.at - test.previous;
    const Tangent constants = Constants(map, test.previous, x);
    const auto residual = [&](const Tangent& y) {
      return (constants - Constants(map, test.at, y)).norm() / constants.norm();
    };
    double other = 0;
    for (const FirstIntegralSolver solver : kFirstIntegralSolvers) {
      SCOPED_TRACE(NameOf(solver));
      Tangent velocity = x;
      const StepResult result =
          SolveFirstIntegral(map, test.at, constants, solver, 1e-8, 30, &velocity);
      EXPECT_FALSE(result.converged);
      EXPECT_TRUE(velocity.allFinite());
      EXPECT_NEAR(result.residual, residual(velocity), 1e-9 * result.residual);
      EXPECT_LT(result.residual, residual(x));
      EXPECT_NE(result.residual, other);  // the two solvers differ
      other = result.residual;
    }
  }
}

TEST(SolveFirstIntegral, FindsNoRootWhereThereIsNone) {
  const Case test = Cases().front();
  const FeatureMap map(test.metric);
  const Tangent x = test.at - test.previous;
  const Tangent negative = -Constants(map, test.at, x);  // their sum would be <x, G x> < 0
  for (const FirstIntegralSolver solver : kFirstIntegralSolvers) {
    SCOPED_TRACE(NameOf(solver));
    Tangent velocity = x;
    const StepResult result =
        SolveFirstIntegral(map, test.at, negative, solver, 1e-6, 30, &velocity);
    EXPECT_FALSE(result.converged);
    EXPECT_GT(result.residual, 1e-6);
    EXPECT_TRUE(velocity.allFinite());
  }
}

TEST(SolveFirstIntegral, RestsWhereAllConstantsVanishAndRefusesSumFeatures) {
  std::vector<Case> cases = Cases();
  const FeatureMap map(cases[0].metric);
  Tangent velocity = cases[0].at - cases[0].previous;
  const StepResult result = SolveFirstIntegral(map, cases[0].at, Tangent::Zero(3, velocity.cols()),
                                               FirstIntegralSolver::kLbfgs, 1e-9, 20, &velocity);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(velocity.norm(), 0);

  const Case& volume = cases[1];
  ASSERT_GT(volume.metric->options.volume, 0);
  const FeatureMap with_volume(volume.metric);
  velocity = volume.at - volume.previous;
  const std::string message = MessageOf<InvalidOptions>([&] {
    SolveFirstIntegral(with_volume, volume.at, Constants(with_volume, volume.at, velocity),
                       FirstIntegralSolver::kLbfgs, 1e-9, 20, &velocity);
  });
  EXPECT_EQ(message.rfind("volume:", 0), 0u) << message;
}

TEST(ProjectOntoConstraint, EqualsTheClosedForm) {
  for (int num_vertices : {1, 6, 106, 20000}) {
    const Tangent x = Noise(num_vertices, 1, 4), normal = Noise(num_vertices, 1, 5);
    for (double scale : {1e-9, 1.0, 1e9}) {
      for (double normal_scale : {1e-9, 1.0, 1e9}) {
        for (double share : {-2.0, 0.0, 1.0}) {
          SCOPED_TRACE(::testing::Message() << num_vertices << " vertices, x times " << scale
                                            << ", normal times " << normal_scale);
          const Tangent v = scale * x, n = normal_scale * normal;
          const double constant = share * v.norm() * n.norm();
          const double way = constant - v.cwiseProduct(n).sum();
          const Tangent expected = v + way / n.squaredNorm() * n;
          const Tangent y = ProjectOntoConstraint(v, n, constant);
          EXPECT_LT((y - expected).norm(), 1e-7 * v.norm());
          EXPECT_LT(std::abs(y.cwiseProduct(n).sum() - constant), 1e-7 * v.norm() * n.norm());
        }
        if (num_vertices > 1000) break;
      }
    }
  }
}

TEST(ProjectOntoConstraint, LeavesWhatMeetsTheConstraint) {
  const Tangent x = Noise(50, 1, 6), normal = Noise(50, 1, 7);
  const Tangent y = ProjectOntoConstraint(x, normal, x.cwiseProduct(normal).sum());
  EXPECT_LT((y - x).norm(), 1e-14 * x.norm());
  // The zero vector moves to the nearest point of the constraint, or stays if it satisfies it.
  const Tangent zero = Tangent::Zero(3, 50);
  EXPECT_LT((ProjectOntoConstraint(zero, normal, 2) - 2 / normal.squaredNorm() * normal).norm(),
            1e-7 / normal.norm());
  EXPECT_EQ(ProjectOntoConstraint(zero, normal, 0).norm(), 0);
}

TEST(ProjectOntoConstraint, RefusesANormalThatVanishes) {
  const Tangent x = Noise(50, 1, 8), normal = Noise(50, 1, 9);
  const double constant = x.norm() * normal.norm();
  EXPECT_THROW(ProjectOntoConstraint(x, 0 * normal, constant), SolverError);
  EXPECT_THROW(ProjectOntoConstraint(x, 0 * normal, 0), SolverError);
  EXPECT_THROW(ProjectOntoConstraint(x, 1e-17 * normal, constant), SolverError);
  // The result does not depend on the normal's length.
  EXPECT_NO_THROW(ProjectOntoConstraint(x, 1e-17 * normal, 1e-17 * constant));
}

}  // namespace
}  // namespace shapespace::internal
