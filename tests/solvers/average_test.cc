#include <shapespace/statistics/average.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/mesh/rigid_motion.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::Diameter;
using testing::Distance;
using testing::MessageOf;
using testing::Rotation;

const ShapeFamily& Tube() {
  static const ShapeFamily tube = MakeTube(400);
  return tube;
}

std::vector<Shape> PosesAt(const ShapeFamily& body, const std::vector<double>& values) {
  std::vector<Shape> poses;
  for (double value : values) poses.push_back(body.pose(value));
  return poses;
}

Shape Aligned(const Shape& shape, const Shape& to) {
  return FitRigidMotion(shape, to, Eigen::VectorXd::Ones(to.cols()))(shape);
}

// The mean distance after rigid alignment, as a share of the diameter.
double Off(const Shape& shape, const Shape& truth) {
  return (Aligned(shape, truth) - truth).colwise().norm().mean() / Diameter(truth);
}

TEST(Average, OfOneTriangleHasTheMeanStrains) {
  const auto triangle = Connectivity::FromTriangles(3, Eigen::Vector3i(0, 1, 2));
  const auto sides = [](double scale_x, double scale_y) {
    Shape shape(3, 3);
    shape << 0, scale_x, 0.3 * scale_x, 0, 0, 0.8 * scale_y, 0, 0, 0;
    return shape;
  };
  AverageOptions options;
  options.certify = false;
  // With so little cost of position, rounding turns the triangle in every step.
  for (double lambda = 1e-7; lambda > 1e-11; lambda *= 0.3) {
    options.geodesic.metric.lambda = lambda;
    const auto [shape, summary] = Average(triangle, {sides(1, 1), sides(1.2, 0.9)}, options);
    EXPECT_TRUE(summary.Converged()) << summary.FullReport();
    EXPECT_LT(summary.residual, 1e-6);
  }
}

TEST(Average, OfOnePoseIsThatPose) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 60, 90});
  const AverageResult alone = Average(Tube().connectivity, {poses[1]});
  EXPECT_LT(Distance(alone.shape, poses[1]), 1e-9);
  EXPECT_EQ(alone.summary.Ratio(), 1);
  AverageOptions options;
  options.weights = {0, 2, 0};
  EXPECT_LT(Distance(Average(Tube().connectivity, poses, options).shape, poses[1]), 1e-6);
}

TEST(Average, APoseGivenTwiceHasTwiceTheWeight) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 60, 90});
  AverageOptions options;
  options.certify = false;
  options.weights = {1, 2, 1};
  const Shape weighted = Average(Tube().connectivity, poses, options).shape;
  options.weights.clear();
  const Shape twice =
      Average(Tube().connectivity, {poses[0], poses[1], poses[1], poses[2]}, options).shape;
  EXPECT_LT(Off(twice, weighted), 1e-4);
}

TEST(Average, OfTwoPosesIsTheMiddleOfTheirGeodesic) {
  const std::vector<Shape> poses = PosesAt(Tube(), {20, 70});
  GeodesicOptions options;
  options.shapes = 1;
  options.tolerance = 1e-10;
  options.max_iterations = 5000;
  const Path path = Interpolate(Tube().connectivity, poses, options).path;
  const auto [shape, summary] = Average(Tube().connectivity, poses);
  EXPECT_LT(Off(shape, path.Placed(1)), 2e-4);
  EXPECT_GE(summary.Ratio(), 1);
  EXPECT_LT(summary.Ratio(), 1.02);
}

// Positions have a cost, which blends on straight lines would make least, so it is small here.
AverageOptions WithoutPositions() {
  AverageOptions options;
  options.geodesic.metric.lambda = 1e-9;
  return options;
}

// The sheet of triangles is nearly isometric. Straight lines would be off by 1.6 %.
TEST(Average, OfARolledSheetHasTheMeanAngle) {
  const ShapeFamily sheet = MakeSheet(2, 1, 16, 8);
  const std::vector<Shape> poses = PosesAt(sheet, {0, 40, 170});
  const AverageResult mean = Average(sheet.connectivity, poses, WithoutPositions());
  EXPECT_LT(Off(mean.shape, sheet.pose(70)), 1e-4);
  EXPECT_LT(mean.summary.edge_rms, 1e-3);
  EXPECT_NEAR(mean.summary.Ratio(), 1, 1e-3);
}

TEST(Average, OfASheetThatIsRolledBothWaysIsFlat) {
  const ShapeFamily sheet = MakeSheet(2, 1, 16, 8);
  std::vector<Shape> poses;
  for (double angle : {40.0, 80.0, 120.0}) {
    poses.push_back(sheet.pose(angle));
    poses.push_back(Eigen::Vector3d(1, 1, -1).asDiagonal() * sheet.pose(angle));
  }
  const AverageResult mean = Average(sheet.connectivity, poses, WithoutPositions());
  EXPECT_LT(Off(mean.shape, sheet.pose(0)), 2e-4);
  EXPECT_NEAR(mean.summary.Ratio(), 1, 1e-3);
  EXPECT_EQ(mean.summary.ambiguous_hinges, 0);
}

// Two triangles, of which one is turned about the common edge.
TEST(Average, TellsOfHingesWhoseAnglesNoHalfCircleContains) {
  const auto connectivity =
      Connectivity::FromTriangles(4, (Eigen::Matrix3Xi(3, 2) << 0, 1, 1, 0, 2, 3).finished());
  const auto ambiguous = [&](const std::vector<double>& degrees) {
    std::vector<Shape> poses;
    for (const double angle : degrees) {
      const double turn = angle * M_PI / 180;
      poses.push_back(
          (Shape(3, 4) << 0, 0, 1, -std::cos(turn), 0, 1, 0.5, 0.5, 0, 0, 0, std::sin(turn))
              .finished());
    }
    return Average(connectivity, poses).summary.ambiguous_hinges;
  };
  EXPECT_EQ(ambiguous({160, -160, 170}), 0);
  EXPECT_EQ(ambiguous({0, 80, -80}), 0);
  EXPECT_EQ(ambiguous({0, 120, -120}), 1);
}

TEST(Average, DoesNotDependOnOrderPlaceOrUnit) {
  const SkinnedBody body = MakeQuadruped(1000);
  const std::vector<Shape> poses = {body.pose("stand"), body.pose("sit"), body.pose("stretch")};
  AverageOptions options;
  options.certify = false;
  const Shape mean = Average(body.connectivity, poses, options).shape;
  const Eigen::Vector3d way(1e6, -2e6, 3e6);
  std::vector<Shape> moved;
  for (int i : {2, 0, 1}) {
    moved.push_back((1000 * Rotation(50 * i, {1, 2, 3}) * poses[i]).colwise() + way);
  }
  EXPECT_LT(Off(Average(body.connectivity, moved, options).shape, 1000 * mean), 1e-4);
}

TEST(Average, IsNearTheLowerBoundWhereABlendIsNot) {
  const SkinnedBody body = MakeQuadruped(2000);
  std::vector<Shape> poses;
  for (int seed = 1; seed <= 6; ++seed) poses.push_back(body.random_pose(seed));
  const AverageSummary summary = Average(body.connectivity, poses).summary;
  EXPECT_TRUE(summary.Converged());
  EXPECT_GE(summary.Ratio(), 1);
  EXPECT_LT(summary.Ratio(), 1.08);
  EXPECT_LT(summary.edge_rms, 0.02);
}

TEST(Average, RefusesWhatItCannotAverage) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 90});
  const auto message = [&](const AverageOptions& options) {
    return MessageOf<InvalidOptions>([&] { Average(Tube().connectivity, poses, options); });
  };
  AverageOptions options;
  for (const std::vector<double>& weights :
       {std::vector<double>{1, -1}, {0, 0}, {1}, {1, std::nan("")}, {1, 2, 3}}) {
    options.weights = weights;
    EXPECT_EQ(message(options).find("weights: must"), 0u) << message(options);
  }
  options = {};
  options.geodesic.metric = MetricOptions::Rigid();
  EXPECT_EQ(message(options).find("rigid: "), 0u) << message(options);
  options.geodesic.metric = MetricOptions::Paper();
  EXPECT_EQ(message(options).find("discretization: "), 0u) << message(options);
  EXPECT_THROW(Average(Tube().connectivity, {}), MeshError);
}

TEST(Average, StopsWhenAskedTo) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 60, 90});
  testing::Listener first(1);
  EXPECT_THROW(Average(Tube().connectivity, poses, {}, &first), Cancelled);
  struct StopWhileCertified : Progress {
    bool Report(const std::string& stage, int, int) override { return stage == "averaging"; }
  } later;
  const AverageResult result = Average(Tube().connectivity, poses, {}, &later);
  EXPECT_EQ(result.summary.termination, Termination::kCancelled);
  EXPECT_TRUE(std::isnan(result.summary.lower_bound));
  EXPECT_TRUE(std::isnan(result.summary.energy));
  EXPECT_TRUE(std::isnan(result.summary.Ratio()));
  EXPECT_TRUE(result.shape.allFinite());
}

// Rounds whose shape is lost, because the refinement was stopped, are not counted.
TEST(Average, ARefinementThatIsStoppedHasNoRounds) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 140, 150});
  struct StopInALaterRound : Progress {
    bool Report(const std::string& stage, int done, int) override {
      if (stage == "comparing with the lower bound" && done == 0 && last != 0) ++stars;
      last = stage == "averaging" ? -1 : done;
      return stars < 3;
    }
    int stars = 0, last = -1;
  } later;
  AverageOptions options;
  options.refine = true;
  options.geodesic.shapes = 3;
  options.geodesic.tolerance = 1e-7;
  const AverageResult whole = Average(Tube().connectivity, poses, options);
  ASSERT_GE(whole.summary.refinements, 2);
  const AverageResult result = Average(Tube().connectivity, poses, options, &later);
  EXPECT_EQ(result.summary.termination, Termination::kCancelled);
  EXPECT_EQ(result.summary.refinements, 0);
  EXPECT_TRUE(std::isnan(result.summary.refined_by));
  options.refine = options.certify = false;
  EXPECT_EQ(result.shape, Average(Tube().connectivity, poses, options).shape);
}

}  // namespace
}  // namespace shapespace
