// Solvers with user-defined features, compared with the same features of the library, which have
// kernels, bounds and preconditioners of their own.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/transfer/transfer.h>

#include "support/motions.h"
#include "support/own_features.h"
#include "support/runge_kutta.h"

namespace shapespace {
namespace {

const ShapeFamily& FineBar() {
  static const ShapeFamily bar = MakeBar(6, 1, 1, 24, 3, 3);
  return bar;
}

GeodesicResult Solve(const MetricOptions& metric, int shapes = 7) {
  GeodesicOptions options;
  options.metric = metric;
  options.shapes = shapes;
  options.tolerance = 1e-9;
  options.max_iterations = 2000;
  return Interpolate(FineBar().connectivity, {FineBar().pose(0), FineBar().pose(80)}, options);
}

TEST(OwnFeature, MakesTheSameGeodesicOnAllLevels) {
  const GeodesicResult library = Solve(testing::LibraryBlend());
  const GeodesicResult own = Solve(testing::OwnBlend());
  ASSERT_GT(own.summary.hierarchy.size(), 1u);
  EXPECT_EQ(own.summary.termination, Termination::kConverged);
  EXPECT_NEAR(own.summary.energy, library.summary.energy, 1e-6 * library.summary.energy);
  EXPECT_NEAR(own.summary.lower_bound, library.summary.lower_bound,
              1e-9 * library.summary.lower_bound);
  EXPECT_LT(testing::Distance(own.path, library.path), 2e-3);
  // Every feature's part of the energy is listed by its name.
  double strain = -1;
  for (const auto& [name, part] : own.summary.parts) {
    if (name == "own strain") strain = part;
  }
  EXPECT_GT(strain, 0);
}

TEST(OwnFeature, GoesOnAndIsTransportedAlike) {
  const Path path = Solve(testing::LibraryBlend()).path;
  Path own = path;
  own.metric = FreezeMetric(testing::OwnBlend(), FineBar().connectivity,
                            {FineBar().pose(0), FineBar().pose(80)});
  const ExponentialResult expected = Extrapolate(path, 3), longer = Extrapolate(own, 3);
  EXPECT_TRUE(longer.summary.Converged());
  EXPECT_LT(testing::Distance(longer.path, expected.path), 1e-8);

  // With second derivatives too.
  const auto end = [&](const Path& from) {
    const Tangent segment = InitialVelocity(path) / (path.NumShapes() - 1);
    return testing::RungeKutta(from.metric, path.Placed(0), segment, 1).back();
  };
  EXPECT_LT(testing::Distance(end(own), end(path)), 1e-8);

  const Tangent tangent = FineBar().pose(1) - FineBar().pose(0);
  const Tangent there = Transport(path, {tangent}).tangents[0];
  EXPECT_LT((Transport(own, {tangent}).tangents[0] - there).norm(), 1e-8 * there.norm());
}

TEST(OwnFeature, TransfersAlike) {
  const std::vector<Shape> poses = {FineBar().pose(0), FineBar().pose(40)};
  const auto metric = FreezeMetric({}, FineBar().connectivity, poses);
  Shape target = FineBar().pose(0);
  target.row(1) *= 1.5;
  TransferOptions library, own;
  library.metric.strain = 1;
  own.metric = library.metric;
  own.metric.strain = 0;
  testing::RegisterOwnFeatures();
  own.metric.features = {{"own strain", 1}};
  const Path path = MakePath(metric, poses);
  EXPECT_LT(
      testing::Distance(Transfer(path, target, own).path, Transfer(path, target, library).path),
      1e-7);
}

TEST(OwnFeature, DeformsAlike) {
  DeformationHandle held, pulled;
  const Shape rest = FineBar().pose(0);
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(0, v) < rest.row(0).minCoeff() + 0.1) held.vertices.push_back(v);
    if (rest(0, v) > rest.row(0).maxCoeff() - 0.1) pulled.vertices.push_back(v);
  }
  held.positions = rest(Eigen::all, held.vertices);
  pulled.positions = FineBar().pose(50)(Eigen::all, pulled.vertices);
  const auto last = [&](const MetricOptions& metric) {
    DeformationOptions options;
    options.metric = metric;
    options.tolerance = 1e-9;
    const Path path = Deform(FineBar().connectivity, rest, {held, pulled}, options).path;
    return path.Placed(path.NumShapes() - 1);
  };
  EXPECT_LT((last(testing::OwnBlend()) - last(testing::LibraryBlend())).cwiseAbs().maxCoeff(),
            5e-3);
}

// A stiffness field that is large on one half moves the bending to the other half, on all levels.
TEST(Stiffness, MovesStretchingToWhereItIsSoft) {
  MetricOptions options;
  options.stretching_stiffness.setOnes(FineBar().connectivity->NumVertices());
  const Shape rest = FineBar().pose(0);
  const double middle = rest.row(0).mean();
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(0, v) < middle) options.stretching_stiffness(v) = 100;
  }
  options.bending_stiffness = options.stretching_stiffness;
  Shape longer = rest;
  longer.row(0) *= 1.4;
  DeformationOptions deformation;
  deformation.metric = options;
  DeformationHandle left, right;
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(0, v) < rest.row(0).minCoeff() + 0.1) left.vertices.push_back(v);
    if (rest(0, v) > rest.row(0).maxCoeff() - 0.1) right.vertices.push_back(v);
  }
  left.positions = longer(Eigen::all, left.vertices);
  right.positions = longer(Eigen::all, right.vertices);
  const Path path = Deform(FineBar().connectivity, rest, {left, right}, deformation).path;
  const Shape last = path.Placed(path.NumShapes() - 1);
  const auto stretch = [&](bool stiff) {
    double before = 0, after = 0;
    for (int e = 0; e < FineBar().connectivity->NumEdges(); ++e) {
      const int a = FineBar().connectivity->Edges()(0, e),
                b = FineBar().connectivity->Edges()(1, e);
      const double x = 0.5 * (rest(0, a) + rest(0, b)) - middle;
      if (std::abs(x) < 0.4 || (x < 0) != stiff) continue;
      before += std::abs(rest(0, a) - rest(0, b));
      after += std::abs(last(0, a) - last(0, b));
    }
    return after / before - 1;
  };
  EXPECT_GT(stretch(false), 0.5);
  EXPECT_LT(stretch(true), 0.1);
}

}  // namespace
}  // namespace shapespace
