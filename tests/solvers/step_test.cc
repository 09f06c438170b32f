#include <shapespace/exponential/internal/step.h>

#include <memory>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/skinned.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/motions.h"
#include "support/own_features.h"
#include "support/paths.h"

namespace shapespace::internal {
namespace {

using testing::Diameter;
using testing::Distance;
using testing::kNeverCancelled;

// A metric, and a step that continues from two shapes (in the metric's unit).
struct StepCase {
  std::shared_ptr<const Metric> metric;
  InitialState departure;
  FeatureMap map{metric};
  MetricSolver solver;
  ExponentialSummary::Step row;

  StepCase(std::shared_ptr<const Metric> of, InitialState from)
      : metric(std::move(of)), departure(std::move(from)) {}

  double SpeedBefore() const {
    return (map.Values(departure.shape) - map.Values(departure.previous)).norm();
  }
  double SpeedTo(const Shape& shape) const {
    return (map.Values(shape) - map.Values(departure.shape)).norm();
  }
  Step Make() { return Step(map, &solver, departure, kNeverCancelled); }
};

StepCase BendingBar() {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0)});
  return {metric, {bar.pose(10) / metric->unit, bar.pose(5) / metric->unit, {}, 0}};
}

// A step beyond an animal's last pose, of half the distance between the poses: slivers rotate fast
// there.
StepCase LongStep(const MetricOptions& metric, int steps_before) {
  const SkinnedBody animal = MakeSkinnedBody("quadruped", 1000);
  GeodesicOptions options;
  options.metric = metric;
  options.shapes = 1;
  options.tolerance = 1e-6;
  Path path =
      Interpolate(animal.connectivity, {animal.pose("stand"), animal.pose("sit")}, options).path;
  if (steps_before > 0) path = Extrapolate(path, steps_before).path;
  const int last = path.NumShapes() - 1;
  return {path.metric, {path.shapes[last], path.shapes[last - 1], {}, 0}};
}

// The matrix includes features that are added up over the whole mesh, whose squares are dense.
TEST(MetricSolver, InvertsTheWholeMetric) {
  testing::RegisterOwnFeatures();
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  std::vector<MetricOptions> metrics(4);
  metrics[1].volume = 1;
  metrics[2].volume = 1e4;
  metrics[3].volume = 3;
  metrics[3].features = {{"spread", 5}, {"own volume", 100}};
  for (const MetricOptions& options : metrics) {
    SCOPED_TRACE(DescribeMetric(options));
    const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(60)});
    const FeatureMap map(metric);
    const FeatureDerivative derivative = map.Derivative(bar.pose(30) / metric->unit);
    const auto times = [&](const Tangent& x) -> Tangent {
      return derivative.TransposeTimes(derivative.Times(x));
    };
    const int vertices = static_cast<int>(bar.pose(0).cols());
    MetricSolver solver;
    solver.Factor(derivative);
    for (const double precision : {1e-2, 1e-8}) {
      for (unsigned seed : {1u, 2u}) {
        const Tangent x = testing::Noise(vertices, 1, seed);
        const Tangent image = times(x);
        const double length = derivative.Times(x).norm();
        EXPECT_LT(derivative.Times(solver.Approximate(image) - x).norm(), precision * length);
        EXPECT_NEAR(solver.DualNorm(image), length, precision * length);
        // GMRES has hardly anything left to do.
        Tangent solved;
        EXPECT_LE(solver.Solve(derivative, derivative, image, 1e-2, 20, &solved).iterations, 2);
      }
      solver.UseDoublePrecision();
    }
  }
}

TEST(Step, KeepsTheSpeedOfTheSegmentBefore) {
  StepCase bar = BendingBar();
  Shape root;
  ASSERT_TRUE(bar.Make().Solve({}, &bar.row, &root));
  EXPECT_TRUE(bar.row.converged);
  EXPECT_EQ(bar.row.increments, 1);
  EXPECT_NEAR(bar.SpeedTo(root) / bar.SpeedBefore(), 1, 1e-2);
}

// A change by a tenth is permitted from step to step, but must not accumulate since the geodesic's
// beginning.
TEST(Step, RefusesRootsThatAreATenthOffTheSpeedAtTheStart) {
  for (const double share : {0.85, 0.95, 1.05, 1.15}) {
    SCOPED_TRACE(share);
    StepCase bar = BendingBar();
    bar.departure.speed = share * bar.SpeedBefore();
    Shape root;
    const bool expected = share > 0.9 && share < 1.1;
    EXPECT_EQ(bar.Make().Solve({}, &bar.row, &root), expected);
    EXPECT_EQ(bar.row.converged, expected);
  }
}

// A reversed edge has the same length: near it there is another root, which is much farther away in
// the metric.
TEST(Step, RefusesTheRootOfAnotherGeodesic) {
  MetricOptions lengths = MetricOptions::Isometric();
  lengths.bending = 0;
  Shape edge = Shape::Zero(3, 2);
  edge.row(0) << -0.5, 0.5;
  const auto metric = FreezeMetric(lengths, testing::SingleEdge(), {edge});
  StepCase step(metric, {edge, 0.999 * edge, {}, 0});
  Shape root;
  ASSERT_TRUE(step.Make().Solve({}, &step.row, &root));
  EXPECT_LT(Distance(root, 1.001 * edge), 1e-4);
  EXPECT_TRUE(step.Make().HasTheGeodesicsSpeed(root, 1));
  const Shape turned = -root;
  EXPECT_LT(step.Make().Residual(turned), 0.1);  // though there is a root near it
  EXPECT_FALSE(step.Make().HasTheGeodesicsSpeed(turned, 1));
}

// Squared lengths and angles change linearly in sufficiently slow motions.
TEST(Step, TakesStepsAThousandMillionthOfTheBodyLong) {
  StepCase bar = BendingBar();
  const Shape velocity = bar.departure.shape - bar.departure.previous;
  bar.departure.previous = bar.departure.shape - 1e-9 * velocity;
  Shape root;
  ASSERT_TRUE(bar.Make().Solve({}, &bar.row, &root));
  EXPECT_TRUE(bar.row.converged);
  EXPECT_LT(Distance((root - bar.departure.shape) / 1e-9, velocity), 1e-3 * Diameter(velocity));
}

TEST(Step, RestsWhereThereIsNoMotion) {
  StepCase bar = BendingBar();
  bar.departure.previous = bar.departure.shape;
  Shape root;
  ASSERT_TRUE(bar.Make().Solve({}, &bar.row, &root));
  EXPECT_TRUE(root == bar.departure.shape);
  EXPECT_TRUE(bar.row.converged);
}

TEST(Step, ApproachesInIncrementsWhatNewtonsMethodDoesNotReachAtOnce) {
  StepCase step = LongStep(MetricOptions::Strain(), 5);
  const Step own = step.Make();
  Shape root;
  ASSERT_TRUE(own.Solve({}, &step.row, &root));
  EXPECT_TRUE(step.row.converged);
  EXPECT_GT(step.row.increments, 1);
  EXPECT_LT(own.Residual(root), 1e-9);
  EXPECT_NEAR(step.SpeedTo(root) / step.SpeedBefore(), 1, 1e-2);
}

// An edge that is to grow to a multiple of its length in one step. Both solvers reach the end in
// increments, which they choose differently.
TEST(Step, CeresReachesInIncrementsTheRootOfNewtonsMethod) {
  MetricOptions lengths = MetricOptions::Isometric();
  lengths.bending = 0;
  lengths.lambda = 0.3;
  Shape edge = Shape::Zero(3, 2);
  edge.row(0) << -0.5, 0.5;
  Tangent velocity = 3.5 * edge;
  velocity.row(1) << -0.5, 0.5;
  const auto metric = FreezeMetric(lengths, testing::SingleEdge(), {edge});
  StepCase step(metric, {edge / metric->unit, {}, velocity / metric->unit, 0});
  const auto solved = [&](StepSolver solver) {
    ExponentialOptions options;
    options.solver = solver;
    options.max_iterations = 500;
    Shape root = edge;
    step.row = {};
    EXPECT_TRUE(step.Make().Solve(options, &step.row, &root));
    EXPECT_TRUE(step.row.converged);
    EXPECT_GT(step.row.increments, 1);
    EXPECT_LT(step.Make().Residual(root), 1e-8);
    return root;
  };
  const Shape newtons = solved(StepSolver::kNewtonKrylov);
  EXPECT_LT(Distance(solved(StepSolver::kCeres), newtons), 1e-6 * Diameter(newtons));
}

TEST(Step, TakesNoMoreIterationsThanItMay) {
  StepCase step = LongStep(MetricOptions::Strain(), 5);
  ExponentialOptions options;
  options.max_iterations = 6;
  Shape root;
  EXPECT_FALSE(step.Make().Solve(options, &step.row, &root));
  EXPECT_FALSE(step.row.converged);
  EXPECT_EQ(step.row.iterations, options.max_iterations);
}

// Squared lengths with a constant rate of change violate the triangle inequality.
TEST(Step, SoonGivesUpWhereThereIsNoRoot) {
  StepCase step = LongStep(MetricOptions::Isometric(), 1);
  Shape root;
  EXPECT_FALSE(step.Make().Solve({}, &step.row, &root));
  EXPECT_FALSE(step.row.converged);
  EXPECT_LT(step.row.iterations, ExponentialOptions().max_iterations / 2);
}

}  // namespace
}  // namespace shapespace::internal
