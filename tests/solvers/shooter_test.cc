#include <shapespace/exponential/detail/shooter.h>

#include <memory>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/skinned.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/motions.h"

namespace shapespace::internal {
namespace {

using testing::Diameter;
using testing::Distance;
using testing::kNeverCancelled;

// An animal that moves beyond its last pose, under a metric of edge lengths, for which the step has
// no solution on the mesh itself.
struct Beyond {
  Path path;
  InitialState from_previous, with_velocity;

  Beyond() {
    const SkinnedBody animal = MakeSkinnedBody("quadruped", 1000);
    GeodesicOptions options;
    options.metric = MetricOptions::Isometric();  // under strain every step has a solution
    options.shapes = 3;
    options.tolerance = 1e-6;
    path = Interpolate(animal.connectivity, {animal.pose("stand"), animal.pose("stride")}, options)
               .path;
    path = Extrapolate(path, 1).path;
    const int last = path.NumShapes() - 1;
    from_previous = {path.shapes[last], path.shapes[last - 1], {}, 0};
    // The same velocity according to the metric.
    const FeatureMap map(path.metric);
    const FeatureDerivative derivative = map.Derivative(path.shapes[last]);
    MetricSolver solver;
    solver.Factor(derivative);
    const Tangent velocity =
        SolveMetric(derivative,
                    derivative.TransposeTimes(map.Values(path.shapes[last]) -
                                              map.Values(path.shapes[last - 1])),
                    &solver);
    with_velocity = {path.shapes[last], {}, velocity, 0};
  }

  Shape Next(const InitialState& departure, ExponentialSummary::Step* row) const {
    return Shooter(path.metric, {path.shapes.front(), path.shapes.back()}, {}, kNeverCancelled)
        .Next(departure, row);
  }
};

// Vertices of the coarse mesh are at the solution of the coarse mesh's own step, under its own
// metric; all others are lifted from there.
TEST(Shooter, TakesTheStepOfTheCoarserMeshAndLiftsTheDetail) {
  const Beyond beyond;
  const std::vector<Shape> known = {beyond.path.shapes.front(), beyond.path.shapes.back()};
  const Hierarchy hierarchy(beyond.path.metric->connectivity, known);
  const int fine = hierarchy.NumLevels() - 1, coarse = fine - 1;
  const auto restrict = [&](const Shape& shape) {
    return shape.size() > 0 ? hierarchy.Restrict(shape, coarse) : shape;
  };
  const auto metric = FreezeMetric(beyond.path.metric->options, hierarchy.LevelConnectivity(coarse),
                                   {restrict(known[0]), restrict(known[1])}, 1);
  const FeatureMap map(metric);
  for (const InitialState* departure : {&beyond.from_previous, &beyond.with_velocity}) {
    SCOPED_TRACE(departure == &beyond.from_previous ? "from two shapes" : "with a velocity");
    ExponentialSummary::Step row;
    const Shape shape = beyond.Next(*departure, &row);
    EXPECT_EQ(row.vertices, hierarchy.LevelConnectivity(coarse)->NumVertices());
    EXPECT_FALSE(row.converged);
    EXPECT_GT(row.residual, 1e-3);

    const InitialState restricted = {restrict(departure->shape), restrict(departure->previous),
                                     restrict(departure->velocity), 0};
    MetricSolver solver;
    ExponentialSummary::Step coarse_row;
    Shape root;
    ASSERT_TRUE(Step(map, &solver, restricted, kNeverCancelled).Solve({}, &coarse_row, &root));
    const double size = Diameter(shape);
    EXPECT_GT(Distance(root, restricted.shape), 1e-2 * size);
    EXPECT_LT(Distance(restrict(shape), root), 1e-12 * size);
    EXPECT_LT(Distance(shape, hierarchy.Lift(root, coarse, departure->shape, departure->shape, 0)),
              1e-12 * size);
  }
}

// The step after a restart uses the factor by which the restart found the velocity.
TEST(Shooter, FactorsTheShapeOfARestartOnce) {
  const Beyond beyond;
  const auto make_shooter = [&] {
    return Shooter(beyond.path.metric, {beyond.path.shapes.front(), beyond.path.shapes.back()}, {},
                   kNeverCancelled);
  };
  Shooter shooter = make_shooter(), other = make_shooter();
  const FeatureMap map(beyond.path.metric);
  const double speed =
      (map.Values(beyond.from_previous.shape) - map.Values(beyond.from_previous.previous)).norm();
  ExponentialSummary::Step row;
  const Shape shape = shooter.Next(beyond.from_previous, &row);
  const InitialState state = shooter.Restart(beyond.from_previous.shape, shape, speed);
  EXPECT_NEAR(map.Derivative(shape).Times(state.velocity).norm(), speed, 1e-9 * speed);
  other.Next(beyond.from_previous, &row);
  const int before = shooter.NumFactorisations(), other_before = other.NumFactorisations();
  const Shape next = shooter.Next(state, &row), expected = other.Next(state, &row);
  EXPECT_LT(Distance(next, expected), 1e-9 * Diameter(next));
  EXPECT_EQ(shooter.NumFactorisations() - before, other.NumFactorisations() - other_before - 1);
}

TEST(Shooter, TurnsWithTheBody) {
  const Beyond beyond;
  const Eigen::Matrix3d turn = testing::Rotation(70, {1, 2, -1});
  for (const InitialState* departure : {&beyond.from_previous, &beyond.with_velocity}) {
    InitialState turned = *departure;
    for (Eigen::Matrix3Xd* x : {&turned.shape, &turned.previous, &turned.velocity}) {
      *x = turn * *x;
    }
    ExponentialSummary::Step row;
    const Shape expected = turn * beyond.Next(*departure, &row);
    EXPECT_LT(row.vertices, beyond.path.metric->connectivity->NumVertices());
    EXPECT_LT(Distance(beyond.Next(turned, &row), expected), 1e-6 * Diameter(expected));
  }
}

}  // namespace
}  // namespace shapespace::internal
