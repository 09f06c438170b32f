#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/parallel.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/path/energy.h>
#include <shapespace/spline/spline.h>
#include <shapespace/statistics/average.h>
#include <shapespace/statistics/shape_model.h>
#include <shapespace/transfer/transfer.h>

#include "solvers/exploration/spaces.h"
#include "support/motions.h"
#include "support/path_of.h"
#include "support/paths.h"
#include "support/remeshed.h"
#include "support/threads.h"

namespace shapespace {
namespace {

// With more than 1024 vertices, which are several blocks of rows and of elements.
ShapeFamily Bar() { return MakeBar(6, 1, 1, 48, 8, 8); }

TEST(ThreadedLbfgs, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 60, 10, 10);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(70)});
  const std::vector<Shape> shapes =
      testing::NoisyBlend(bar.pose(0) / metric->unit, bar.pose(70) / metric->unit, 5, 2e-3);
  PathEnergy energy(metric, 5);
  std::vector<double> start(energy.Size());
  energy.Load(shapes, start.data());
  const internal::Cholesky factor(
      internal::ScalarMetric(*metric, {shapes.front(), shapes.back()}, 0));
  const internal::CholeskyFactor<float> single(factor);
  internal::Preconditioner preconditioner(single, energy);
  internal::MinimiseOptions options;
  options.tolerance = 1e-6;
  options.rank = 4;
  const auto results = testing::OnThreads([&] {
    std::vector<double> unknowns = start;
    internal::MinimiseThreadedLbfgs(&energy, &preconditioner, options, &unknowns);
    return unknowns;
  });
  EXPECT_FALSE(results[0] == start);
  for (const std::vector<double>& unknowns : results) EXPECT_TRUE(unknowns == results[0]);
}

// With branches, and with fronts of several tiles.
TEST(Cholesky, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 60, 10, 10);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(70)});
  const Eigen::SparseMatrix<double> sparse =
      internal::ScalarMetric(*metric, {bar.pose(0) / metric->unit}, 0);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 700; ++i) {
    for (int j = 0; j < i; ++j) entries.emplace_back(i, j, 1 / (1.0 + i + j));
    entries.emplace_back(i, i, 700);
  }
  Eigen::SparseMatrix<double> dense(700, 700);
  dense.setFromTriplets(entries.begin(), entries.end());
  for (const Eigen::SparseMatrix<double>& matrix : {sparse, dense}) {
    const auto results = testing::OnThreads([&] {
      const internal::Cholesky factor(matrix);
      Eigen::VectorXd x = Eigen::VectorXd::Ones(factor.WorkRows());
      factor.SolveLower(x.data());
      return x.head(factor.Size()).eval();
    });
    for (const Eigen::VectorXd& x : results) EXPECT_TRUE(x == results[0]);
  }
}

// Blocks with this much fill are ordered by METIS, whose random numbers come from a generator that
// all threads share.
TEST(Cholesky, IsTheSameWhileOthersAreAnalysed) {
  const int n = 32, size = n * n * n;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 7);
    if (i % n < n - 1) entries.emplace_back(i + 1, i, -1);
    if (i / n % n < n - 1) entries.emplace_back(i + n, i, -1);
    if (i + n * n < size) entries.emplace_back(i + n * n, i, -1);
  }
  Eigen::SparseMatrix<double> block(size, size);
  block.setFromTriplets(entries.begin(), entries.end());
  const std::vector<int> alone = internal::Cholesky(block).Permutation();
  std::vector<std::vector<int>> together(4);
  ParallelTasks(4, 4, [&](int i) { together[i] = internal::Cholesky(block).Permutation(); });
  for (const std::vector<int>& order : together) EXPECT_TRUE(order == alone);
}

TEST(Correspond, IsTheSameForAnyNumberOfThreads) {
  const testing::Remeshed bodies("sit");
  const auto results = testing::OnThreads([&] { return bodies.Fit(); });
  for (const CorrespondenceResult& result : results) {
    EXPECT_TRUE(result.fitted == results[0].fitted);
    EXPECT_TRUE(result.map.to_template.triangle == results[0].map.to_template.triangle);
    EXPECT_TRUE(result.map.round_trip == results[0].map.round_trip);
  }
}

TEST(Interpolate, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 60, 10, 10);
  GeodesicOptions options;
  options.shapes = 7;
  const auto paths = testing::OnThreads([&] {
    return Interpolate(bar.connectivity, {bar.pose(0), bar.pose(80)}, options).path;
  });
  for (const Path& path : paths) EXPECT_TRUE(path.shapes == paths[0].shapes);
}

TEST(Deform, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 24, 4, 4);
  const Shape rest = bar.pose(0);
  DeformationHandle left, right;
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(0, v) < -2.7) left.vertices.push_back(v);
    if (rest(0, v) > 2.7) right.vertices.push_back(v);
  }
  right.positions = rest(Eigen::all, right.vertices).colwise() + Eigen::Vector3d(0, 1, 0);
  right.hard = false;
  const auto paths = testing::OnThreads([&] {
    return Deform(bar.connectivity, rest, {left, right}).path;
  });
  for (const Path& path : paths) EXPECT_TRUE(path.shapes == paths[0].shapes);
}

TEST(Exponential, IsTheSameForAnyNumberOfThreads) {
  const testing::Motion motion = testing::Turning(Bar(), 30, 20, {});
  ExponentialOptions options;
  options.tolerance = 1e-9;
  const auto ends = testing::OnThreads(
      [&] { return Exponential(motion.metric, motion.shape, motion.velocity, 2, options); });
  for (const Shape& end : ends) EXPECT_TRUE(end == ends[0]);
}

TEST(Transport, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily bar = Bar();
  const Path path = testing::PathOf(bar.connectivity, {bar.pose(10), bar.pose(25), bar.pose(40)});
  const int num_vertices = bar.connectivity->NumVertices();
  const std::vector<Tangent> tangents = {Tangent::Constant(3, num_vertices, 0.1),
                                         testing::Noise(num_vertices, 0.5, 3)};
  const auto results = testing::OnThreads([&] { return Transport(path, tangents).tangents; });
  for (const std::vector<Tangent>& there : results) EXPECT_TRUE(there == results[0]);
}

TEST(CorrectPath, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily bar = Bar();
  const Tangent way = bar.pose(10) - bar.pose(0);
  std::vector<Shape> shapes;  // on a straight line, which stretches the bar
  for (int i = 0; i <= 8; ++i) shapes.push_back(bar.pose(0) + i * way);
  Path given = testing::PathOf(bar.connectivity, shapes);
  given.poses = {0};
  given.extrapolated = 8;
  CorrectionOptions options;
  options.max_iterations = 20;
  const auto paths = testing::OnThreads([&] { return CorrectPath(given, options).path; });
  for (const Path& path : paths) EXPECT_TRUE(path.shapes == paths[0].shapes);
}

TEST(Transfer, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily thick = MakeBar(6, 1, 1, 40, 7, 7);
  const Path source = testing::PathOf(thick.connectivity, {thick.pose(0), thick.pose(20)});
  const Shape thin = MakeBar(8, 1.6, 0.6, 40, 7, 7).pose(0);
  ASSERT_GT(thin.cols(), 1024);  // several blocks of rows
  for (const TransferMethod method : {TransferMethod::kFeatures, TransferMethod::kLadder}) {
    TransferOptions options;
    options.method = method;
    options.hybrids = true;
    options.ladder.rung_shapes = 1;
    options.ladder.tolerance = 1e-3;
    const auto results = testing::OnThreads([&] { return Transfer(source, thin, options); });
    for (const TransferResult& result : results) {
      EXPECT_TRUE(result.path.shapes == results[0].path.shapes);
      EXPECT_TRUE(result.hybrids.shapes == results[0].hybrids.shapes);
    }
  }
}

TEST(Spline, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily tube = MakeTube(3000);
  const std::vector<Shape> poses = {tube.pose(0), tube.pose(40), tube.pose(20)};
  std::vector<int> end(40);
  std::iota(end.begin(), end.end(), 0);
  SplineOptions options;
  options.geodesic.shapes = 3;
  const auto paths = testing::OnThreads([&] {
    Path path = Spline(tube.connectivity, poses, options).path;
    HoldStandingParts(path, {{"", end, {{0, 1}}}}, StandingDefaults(), &path);
    return path;
  });
  for (const Path& path : paths) {
    for (int i = 0; i < path.NumShapes(); ++i) EXPECT_EQ(path.Placed(i), paths[0].Placed(i)) << i;
  }
}

TEST(Average, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily tube = MakeTube(3000);
  const auto shapes = testing::OnThreads([&] {
    return Average(tube.connectivity, {tube.pose(0), tube.pose(40), tube.pose(90)}).shape;
  });
  for (const Shape& shape : shapes) EXPECT_EQ(shape, shapes[0]);
}

TEST(ShapeModel, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily tube = MakeTube(3000);
  const auto shapes = testing::OnThreads([&] {
    const ShapeModel model(
        MakeShapeModel(tube.connectivity, {tube.pose(0), tube.pose(40), tube.pose(90)}, {}).modes);
    const Eigen::Vector2d at(1.5, -0.5);
    return std::vector<Shape>{model.At(at).shape, model.Preview(at),
                              model.Coordinates(tube.pose(60), true).shape};
  });
  for (const std::vector<Shape>& each : shapes) EXPECT_EQ(each, shapes[0]);
}

TEST(Explore, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily tube = testing::SmallTube();
  const std::vector<Shape> poses = testing::TubePoses(tube);
  for (const auto discretization : {Discretization::kMidpoint, Discretization::kTrapezoid}) {
    ExploreOptions options;
    options.geodesic.metric.discretization = discretization;
    options.depth = 1;
    const auto results = testing::OnThreads(
        [&] { return Explore(tube.connectivity, poses, {}, options).space.nodes; });
    for (const std::vector<Shape>& nodes : results) EXPECT_EQ(nodes, results[0]);
  }
}

TEST(Interpolator, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily tube = MakeTube(1500);
  const std::vector<Shape> poses = testing::TubePoses(tube);
  GeodesicOptions options;
  options.shapes = 3;
  options.assess = false;  // the thread sanitizer does not see how Embree's threads synchronise
  const auto results = testing::OnThreads([&] {
    const Interpolator interpolator(tube.connectivity, poses, options);
    std::vector<GeodesicResult> paths(6);
    ParallelTasks(6, interpolator.MostAtOnce(), [&](int i) {
      paths[i] = interpolator.Between(poses[i % 4], poses[(i + 1 + i / 4) % 4]);
    });
    return paths;
  });
  for (const std::vector<GeodesicResult>& paths : results) {
    for (int i = 0; i < 6; ++i) {
      EXPECT_TRUE(paths[i].path.shapes == results[0][i].path.shapes);
      EXPECT_EQ(paths[i].summary.energy, results[0][i].summary.energy);
    }
  }
}

}  // namespace
}  // namespace shapespace
