#include <shapespace/exploration/explore.h>

#include <algorithm>
#include <limits>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/hierarchy/hierarchy.h>

#include "solvers/exploration/spaces.h"
#include "support/features.h"
#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"
#include "support/temporary_file.h"

namespace shapespace {
namespace {

using testing::Distance;
using testing::Listener;
using testing::MessageOf;
using testing::Rotation;
using testing::SmallTube;
using testing::TubePoses;

// Processes tasks in reverse order, as if other processes had been faster.
class LastFirst : public ProcessPool {
 public:
  std::vector<std::string> ForEach(int count, int /*at_once*/,
                                   const std::function<std::string(int)>& body) override {
    std::vector<std::string> results(count);
    for (int i = count - 1; i >= 0; --i) results[i] = body(i);
    return results;
  }
};

TEST(InterpolatorTest, FindsWhatInterpolateFindsWhateverItFoundBefore) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  GeodesicOptions options;
  options.shapes = 3;
  Interpolator pair(tube.connectivity, {poses[0], poses[1]}, options);
  EXPECT_EQ(pair.Between(poses[0], poses[1]).path.shapes,
            Interpolate(tube.connectivity, {poses[0], poses[1]}, options).path.shapes);
  Interpolator fresh(tube.connectivity, poses, options), used(tube.connectivity, poses, options);
  used.Between(poses[3], poses[1]);
  used.Between(poses[0], poses[0]);
  const GeodesicResult result = used.Between(poses[1], poses[2]);
  EXPECT_EQ(result.path.shapes, fresh.Between(poses[1], poses[2]).path.shapes);
  EXPECT_EQ(result.summary.termination, Termination::kConverged);
  EXPECT_EQ(result.summary.poses, 2);
}

TEST(InterpolatorTest, UnderTheTrapezoidToo) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  GeodesicOptions options;
  options.metric.discretization = Discretization::kTrapezoid;
  options.shapes = 3;
  Interpolator fresh(tube.connectivity, poses, options), used(tube.connectivity, poses, options);
  used.Between(poses[3], poses[1]);
  EXPECT_EQ(used.Between(poses[1], poses[2]).path.shapes,
            fresh.Between(poses[1], poses[2]).path.shapes);
}

// Also from threads that are not the library's.
TEST(InterpolatorTest, FindsTheSameOnSeveralThreads) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  for (const auto discretization : {Discretization::kMidpoint, Discretization::kTrapezoid}) {
    GeodesicOptions options;
    options.metric.discretization = discretization;
    options.shapes = 3;
    const Interpolator alone(tube.connectivity, poses, options);
    const Interpolator shared(tube.connectivity, poses, options);
    std::vector<GeodesicResult> results(8);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&, i] {
        for (const int k : {i, i + 4}) {
          results[k] = shared.Between(poses[k % 4], poses[(k + 1 + k / 4) % 4]);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (int k = 0; k < 8; ++k) {
      const GeodesicResult expected = alone.Between(poses[k % 4], poses[(k + 1 + k / 4) % 4]);
      EXPECT_EQ(results[k].path.shapes, expected.path.shapes) << k;
      EXPECT_EQ(results[k].summary.intersections, expected.summary.intersections) << k;
    }
  }
}

TEST(InterpolatorTest, SolvesAsManyAtOnceAsThereIsMemoryFor) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  GeodesicOptions options;
  const auto most_within = [&](double limit) {
    options.memory_limit = limit;
    return Interpolator(tube.connectivity, poses, options).MostAtOnce();
  };
  options.memory_limit = 8e9;
  const Interpolator one(tube.connectivity, poses, options);
  const double bytes = one.Between(poses[0], poses[1]).summary.estimated_bytes;
  EXPECT_EQ(most_within(bytes), 1);
  EXPECT_GE(most_within(std::numeric_limits<double>::infinity()), 256);
  // The first one needs more than the others, which share the factor.
  for (const int count : {4, 16, 64}) {
    EXPECT_LE(most_within(count * bytes), 1.2 * count);
    EXPECT_GE(most_within(count * bytes), count);
  }
}

TEST(InterpolatorTest, WithoutAssessmentWhatWasNotMeasuredIsNoNumber) {
  const ShapeFamily tube = SmallTube();
  GeodesicOptions options;
  options.assess = false;
  const GeodesicSummary summary =
      Interpolate(tube.connectivity, {tube.pose(0), tube.pose(50)}, options).summary;
  EXPECT_TRUE(std::isnan(summary.quality.edge_rms));
  EXPECT_TRUE(std::isnan(summary.intersections));
  EXPECT_NEAR(summary.Ratio(), 1, 0.1);
  EXPECT_TRUE(nlohmann::json::parse(summary.ToJson())["intersections"].is_null());
}

TEST(MetricTest, FrozenOnAllPairsDoesNotDependOnTheOrderOfPoses) {
  const ShapeFamily tube = SmallTube();
  std::vector<Shape> poses = {tube.pose(0), tube.pose(75), tube.pose(150)};
  const auto weights = [&](PosePairs pairs) {
    const auto metric = FreezeMetric({}, tube.connectivity, poses, 0, pairs);
    return testing::Get<Dihedral>(*metric).weights;
  };
  const Eigen::VectorXd all = weights(PosePairs::kAll), steps = weights(PosePairs::kConsecutive);
  EXPECT_TRUE((all.array() <= steps.array()).all());
  EXPECT_LT(all.sum(), 0.999 * steps.sum());  // hinges jump most from the first to the last pose
  std::swap(poses[0], poses[1]);
  EXPECT_LT((weights(PosePairs::kAll) - all).cwiseAbs().maxCoeff(), 1e-12 * all.maxCoeff());
}

TEST(DistanceMatrixTest, IsAMetric) {
  const ShapeFamily tube = SmallTube();
  std::vector<Shape> poses = TubePoses(tube);
  poses.push_back(poses[1]);
  const Eigen::MatrixXd d = DistanceMatrix(tube.connectivity, poses);
  EXPECT_EQ(d, d.transpose());
  EXPECT_TRUE(d.diagonal().isZero(0));
  EXPECT_LT(d(1, 4), 1e-9);
  EXPECT_GT(d(0, 1), 1e-3);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) EXPECT_LE(d(i, j), (d(i, k) + d(k, j)) * (1 + 1e-3));
    }
  }
}

TEST(DistanceMatrixTest, NeitherRigidMotionNorScaleChangesIt) {
  const ShapeFamily tube = SmallTube();
  std::vector<Shape> poses = TubePoses(tube);
  const Eigen::MatrixXd d = DistanceMatrix(tube.connectivity, poses);
  for (double scale : {1e-3, 1.0, 1e3}) {
    std::vector<Shape> moved;
    for (size_t i = 0; i < poses.size(); ++i) {
      moved.emplace_back(scale * ((Rotation(40.0 * i, {1, 2, 3}) * poses[i]).colwise() +
                                  Eigen::Vector3d(3.0 * i, -5, 1)));
    }
    const Eigen::MatrixXd other = DistanceMatrix(tube.connectivity, moved);
    EXPECT_LT((other - d).cwiseAbs().maxCoeff(), 1e-4 * d.maxCoeff()) << scale;
  }
}

TEST(DistanceMatrixTest, OnACoarserMeshIsNearlyTheSameUpToAFactor) {
  const ShapeFamily tube = MakeTube(12000);
  const std::vector<Shape> poses = TubePoses(tube);
  const Eigen::MatrixXd fine = DistanceMatrix(tube.connectivity, poses);
  ExploreOptions options;
  options.resolution = 4000;
  const Eigen::MatrixXd coarse = DistanceMatrix(tube.connectivity, poses, options);
  const double factor = fine.cwiseProduct(coarse).sum() / coarse.squaredNorm();
  EXPECT_NEAR(factor, 1, 0.15);
  EXPECT_LT((factor * coarse - fine).cwiseAbs().maxCoeff(), 0.05 * fine.maxCoeff());
  EXPECT_GT((coarse - fine).cwiseAbs().maxCoeff(), 0);
}

TEST(ExploreTest, ShapesOfAGeodesicLieOnALine) {
  const ShapeFamily tube = SmallTube();
  GeodesicOptions geodesic;
  geodesic.tolerance = 1e-8;
  const std::vector<Shape> path =
      Interpolate(tube.connectivity, {tube.pose(0), tube.pose(90)}, geodesic).path.Placed();
  ExploreOptions options;
  options.depth = 0;
  const PoseSpace space =
      Explore(tube.connectivity, {path[0], path[16], path[4], path[12]}, {}, options).space;
  EXPECT_EQ(space.triangles.cols(), 0);
  ASSERT_EQ(space.segments.cols(), 3);
  EXPECT_LT(space.stress, 1e-2);
  const double whole = space.distances(0, 1);
  EXPECT_NEAR(space.distances(0, 2), whole / 4, 0.01 * whole);
  EXPECT_NEAR(space.distances(2, 3), whole / 2, 0.01 * whole);
  EXPECT_NEAR((space.points.col(0) - space.points.col(1)).norm(), whole, 0.01 * whole);
  std::vector<int> order = {space.segments(0, 0), space.segments(1, 0), space.segments(1, 1),
                            space.segments(1, 2)};
  if (order[0] == 1) std::reverse(order.begin(), order.end());
  EXPECT_EQ(order, (std::vector<int>{0, 2, 3, 1}));
}

TEST(ExploreTest, TwoPosesAreALineThatIsRefined) {
  const ShapeFamily tube = SmallTube();
  const ExploreResult result = Explore(tube.connectivity, {tube.pose(0), tube.pose(100)});
  const PoseSpace& space = result.space;
  EXPECT_EQ(space.triangles.cols(), 0);
  EXPECT_EQ(space.segments.cols(), space.NumNodes() - 1);
  ASSERT_GT(space.NumNodes(), 2);
  for (int s = 1; s < space.segments.cols(); ++s) {
    EXPECT_EQ(space.segments(0, s), space.segments(1, s - 1));
  }
  // Half way on the geodesic the tube is bent by about half, where the blend would be too short.
  const Shape middle = space.At((space.points.col(0) + space.points.col(1)) / 2);
  const auto off = [&](const Shape& shape) {
    const Eigen::VectorXd weights = Eigen::VectorXd::Ones(shape.cols());
    const Shape expected = tube.pose(50);
    return Distance(FitRigidMotion(shape, expected, weights)(shape), expected);
  };
  EXPECT_LT(off(middle), 0.1);
  EXPECT_GT(off((space.Placed(0) + space.Placed(1)) / 2), 0.15);
}

TEST(ExploreTest, CopiesAreToldOfAndNothingButCopiesIsRefused) {
  const ShapeFamily tube = SmallTube();
  std::vector<Shape> poses = TubePoses(tube);
  poses.push_back(Rotation(70, {1, 1, 0}) * poses[2]);
  const ExploreResult result = Explore(tube.connectivity, poses, {"a", "b", "c", "d", "copy"});
  ASSERT_EQ(result.summary.warnings.size(), 1u);
  EXPECT_NE(result.summary.warnings[0].find("copy"), std::string::npos);
  EXPECT_LT((result.space.points.col(2) - result.space.points.col(4)).norm(),
            1e-6 * result.space.distances.maxCoeff());
  EXPECT_NE(MessageOf<SolverError>([&] {
              Explore(tube.connectivity, {poses[2], poses[4]});
            }).find("copies"),
            std::string::npos);
}

TEST(ExploreTest, ThePosesAreAtTheirPlacesUpToRigidMotion) {
  const ShapeFamily tube = SmallTube();
  std::vector<Shape> poses = TubePoses(tube);
  for (Shape& pose : poses) pose.colwise() += Eigen::Vector3d(1e6, 0, 0);
  poses[1] = Rotation(100, {0, 1, 1}) * poses[1];
  const PoseSpace space = Explore(tube.connectivity, poses).space;
  EXPECT_LT(Distance(space.Placed(0), poses[0]), 1e-8);  // in a frame a million units away
  for (int i = 1; i < 4; ++i) {
    const Shape shape = space.At(space.points.col(i));
    const Eigen::VectorXd weights = Eigen::VectorXd::Ones(shape.cols());
    EXPECT_LT(Distance(FitRigidMotion(shape, poses[i], weights)(shape), poses[i]), 1e-7) << i;
  }
}

TEST(ExploreTest, TheOrderOfWorkDoesNotMatter) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  LastFirst crew;
  EXPECT_EQ(Explore(tube.connectivity, poses, {}, {}, nullptr, &crew).space.nodes,
            Explore(tube.connectivity, poses).space.nodes);
}

TEST(ExploreTest, TellsHowFarItIsAndStopsWhenAsked) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  Listener listener;
  Explore(tube.connectivity, poses, {}, {}, &listener);
  EXPECT_GT(listener.reports, 10);
  EXPECT_EQ(std::count(listener.shares.begin(), listener.shares.end(), 0), 3);  // one per stage
  EXPECT_EQ(listener.shares.back(), 1);
  for (int last : {1, 2, 5, listener.reports / 2}) {
    Listener stops(last);
    EXPECT_THROW(Explore(tube.connectivity, poses, {}, {}, &stops), Cancelled) << last;
  }
}

// Finished geodesics of a stopped run are stored, and the next run takes them.
TEST(ExploreTest, StoppedItKeepsWhatIsFinished) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  ExploreOptions options;
  options.records = testing::TemporaryFile("records_of_a_stopped_run");
  Listener whole;
  const PoseSpace space = Explore(tube.connectivity, poses, {}, {}, &whole).space;
  Listener stops(whole.reports / 2);
  EXPECT_THROW(Explore(tube.connectivity, poses, {}, options, &stops), Cancelled);
  const ExploreResult again = Explore(tube.connectivity, poses, {}, options);
  EXPECT_GT(again.summary.found, 0);
  EXPECT_GT(again.summary.solved, 0);
  EXPECT_EQ(again.space.nodes, space.nodes);
  RemoveRecords(options.records);
}

TEST(ExploreTest, WhatDoesNotConvergeIsToldOf) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  options.geodesic.max_iterations = 1;
  const ExploreSummary summary = Explore(tube.connectivity, TubePoses(tube), {}, options).summary;
  EXPECT_GT(summary.not_converged, 0);
  EXPECT_FALSE(summary.Converged());
  EXPECT_FALSE(nlohmann::json::parse(summary.ToJson())["converged"].get<bool>());
  ASSERT_FALSE(summary.warnings.empty());
  EXPECT_NE(summary.FullReport().find(summary.warnings[0]), std::string::npos);
}

TEST(ExploreTest, BadCallsNameTheirField) {
  const ShapeFamily tube = SmallTube();
  const std::vector<Shape> poses = TubePoses(tube);
  const auto message = [&](const std::function<void(ExploreOptions*)>& spoil) {
    ExploreOptions options;
    spoil(&options);
    return MessageOf<InvalidOptions>([&] { Explore(tube.connectivity, poses, {}, options); });
  };
  EXPECT_EQ(message([](auto* o) { o->geodesic.shapes = 4; }).rfind("shapes:", 0), 0u);
  EXPECT_EQ(message([](auto* o) { o->geodesic.metric.rigid = 1; }).rfind("rigid:", 0), 0u);
  EXPECT_EQ(message([](auto* o) { o->resolution = -1; }).rfind("resolution:", 0), 0u);
  EXPECT_EQ(message([](auto* o) { o->threshold = 0; }).rfind("threshold:", 0), 0u);
  EXPECT_EQ(message([](auto* o) { o->depth = -1; }).rfind("depth:", 0), 0u);
  EXPECT_THROW(Explore(tube.connectivity, {poses[0]}), MeshError);
  EXPECT_THROW(Explore(tube.connectivity, poses, {"a"}), InvalidOptions);
  EXPECT_THROW(Explore(tube.connectivity, {poses[0], poses[1].leftCols(3)}), MeshError);
}

}  // namespace
}  // namespace shapespace
