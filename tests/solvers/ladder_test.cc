#include <shapespace/transfer/transfer.h>

#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/skinned.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/path_of.h"
#include "support/paths.h"
#include "support/transfer_cases.h"

namespace shapespace {
namespace {

using namespace testing;

TransferOptions Ladder() {
  TransferOptions options;
  options.method = TransferMethod::kLadder;
  options.hybrids = true;
  return options;
}

// The case for the metric of strains and the ladder's scaling and alignment.
TEST(Ladder, AbsoluteLengthsAndThePapersTransportBendFalsely) {
  const Path source = Bending(6);
  const Shape straight = ThinBar();
  TransferOptions lengths = Ladder();
  lengths.ladder.metric = MetricOptions();
  EXPECT_GT(BendOf(straight, Transfer(source, straight, lengths).path.Placed(6)), 100);

  TransferOptions paper = Ladder();
  paper.ladder.metric = MetricOptions();
  paper.ladder.metric.bending = 0;
  paper.ladder.connection = TransportConnection::kConstrainedProjection;
  paper.ladder.scale = paper.ladder.align = false;
  EXPECT_GT(BendOf(straight, Transfer(source, straight, paper).path.Placed(6)), 80);
  const Shape turned = Rotation(90, Vector3d::UnitZ()) * straight;
  EXPECT_LT(BendOf(straight, Transfer(source, turned, paper).path.Placed(6)), 20);
}

// The step is made in features, so few rungs are sufficient for a bend of 60 degrees.
TEST(Ladder, HardlyDependsOnHowFinelyTheSourceIsDivided) {
  const Shape straight = ThinBar();
  const Eigen::VectorXd area = Bending(1).metric->vertex_area;
  const Shape fine = Transfer(Bending(12), straight, Ladder()).path.Placed(12);
  for (int steps : {1, 3, 6}) {
    const Shape end = Transfer(Bending(steps), straight, Ladder()).path.Placed(steps);
    EXPECT_LT(ShapesApart(end, fine, area), steps == 1 ? 4e-4 : 7e-5) << steps;
  }
}

// Where only positions count, transport leaves velocities as they are.
TEST(Ladder, WithoutScalingALargeTargetMovesAsFarAsTheSource) {
  const Shape bar = ThickBar().pose(0);
  Shape wide = bar;
  wide.row(1) *= 1.5;
  const Path source = PathOf(ThickBar().connectivity, {bar, wide});
  TransferOptions options = Ladder();
  options.ladder.metric = MetricOptions();
  options.ladder.metric.strain = options.ladder.metric.bending = 0;
  options.ladder.metric.lambda = 1;
  for (const bool scale : {true, false}) {
    options.ladder.scale = scale;
    const Path path = Transfer(source, 3 * bar, options).path;
    const Shape expected = 3 * bar + (scale ? 3 : 1) * (wide - bar);
    EXPECT_LT((path.Placed(1) - expected).norm(), 1e-3 * (wide - bar).norm()) << scale;
  }
}

TEST(Ladder, ACopyMovesAsTheSourceDoes) {
  std::vector<Shape> shapes;
  for (int i = 0; i <= 3; ++i) {
    // The path has a rigid motion and an oblique start.
    shapes.push_back((Rotation(40 + 30 * i, {1, 1, 0}) * ThickBar().pose(20 * i)).colwise() +
                     Vector3d(i, 7, -2 * i));
  }
  const Path source = PathOf(ThickBar().connectivity, shapes);
  const Matrix3d turn = Rotation(100, {3, -1, 2});
  const double scale = 2.5;
  const auto copy = [&](const Shape& shape) -> Shape {
    return (scale * turn * shape).colwise() + Vector3d(-11, 4, 0.5);
  };
  for (TransportConnection connection :
       {TransportConnection::kLeviCivita, TransportConnection::kConstrainedProjection}) {
    SCOPED_TRACE(static_cast<int>(connection));
    TransferOptions options = Ladder();
    options.ladder.connection = connection;
    const auto [path, hybrids, summary] = Transfer(source, copy(shapes[0]), options);
    EXPECT_TRUE(summary.Converged());
    EXPECT_NEAR(summary.scale, scale, 1e-12);
    EXPECT_LT(summary.strain_max, 1e-10);
    EXPECT_LT(summary.angle_rms, 1e-8);
    for (int i = 0; i <= 3; ++i) {
      EXPECT_LT(Apart(path.Placed(i), copy(shapes[i])), 1e-10) << i;
      EXPECT_LT(Apart(hybrids.Placed(i), copy(shapes[i])), 1e-10) << i;
    }
  }

  // Without alignment, the paper's transport rotates the motion of a rotated copy incorrectly.
  TransferOptions paper = Ladder();
  paper.ladder.connection = TransportConnection::kConstrainedProjection;
  paper.ladder.align = false;
  EXPECT_GT(Apart(Transfer(source, copy(shapes[0]), paper).path.Placed(3), copy(shapes[3])), 0.02);
}

// The expected results are the quadruped's own poses, in other proportions.
TEST(Ladder, BodiesWithJointsTakeThePoseOver) {
  const SkinnedBody normal = MakeSkinnedBody("quadruped", 1500);
  for (const char* proportions : {"long", "short"}) {
    SCOPED_TRACE(proportions);
    const SkinnedBody other = MakeSkinnedBody("quadruped", 1500, proportions);
    GeodesicOptions geodesic;
    geodesic.shapes = 3;
    const GeodesicResult source =
        Interpolate(normal.connectivity, {normal.pose("stand"), normal.pose("sit")}, geodesic);
    const Shape stand = other.pose("stand"), sit = other.pose("sit");
    const auto [path, hybrids, summary] = Transfer(source.path, stand, Ladder());
    const Shape end = path.Placed(4);
    const Eigen::VectorXd& area = path.metric->vertex_area;
    EXPECT_LT(ShapesApart(end, sit, area), 0.015);
    EXPECT_GT(ShapesApart(stand, sit, area), 0.04);
    EXPECT_LT(Degrees(FitRigidMotion(end, sit, area).rotation), 2);
    for (const TransferSummary::Step& step : summary.steps) {
      EXPECT_LE(step.norm_change, 0);  // the norm of a tangent never grows
      EXPECT_GT(step.norm_change, -0.1);
    }
    // The hybrid is in between: its distances from both are less than their distance.
    const Shape sitting = normal.pose("sit");
    EXPECT_LT(ShapesApart(hybrids.Placed(4), end, area), ShapesApart(sitting, end, area));
    EXPECT_LT(ShapesApart(hybrids.Placed(4), sitting, area), ShapesApart(end, sitting, area));
  }
}

TEST(Ladder, ReportsItsRungs) {
  const TransferSummary summary = Transfer(Bending(3), ThinBar(), Ladder()).summary;
  EXPECT_EQ(summary.metric, "strain 1, lambda 0.0001, bending 0.02");
  EXPECT_EQ(summary.steps.size(), 3u);
  const auto json = nlohmann::json::parse(summary.ToJson());
  EXPECT_EQ(json["method"], "ladder");
  for (const auto& step : json["steps"]) {
    EXPECT_EQ(step["on_mesh"], true);
    EXPECT_GE(step["ratio"], 1);
    EXPECT_LT(step["norm_change"], 0);
  }
}

TEST(LadderOfPoses, EveryPoseIsReachedOnItsOwn) {
  const auto& connectivity = ThickBar().connectivity;
  const std::vector<Shape> poses = {ThickBar().pose(0), ThickBar().pose(60), ThickBar().pose(30)};
  GeodesicOptions geodesic;
  geodesic.shapes = 3;
  const auto [path, hybrids, summary] =
      TransferPoses(connectivity, poses, ThinBar(), geodesic, Ladder());
  ASSERT_EQ(path.NumShapes(), 3);
  ASSERT_EQ(hybrids.NumShapes(), 3);
  EXPECT_EQ(path.parameters, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(path.poses, std::vector<int>{0});
  EXPECT_EQ(path.extrapolated, 2);
  EXPECT_TRUE(path.Placed(0).isApprox(ThinBar(), 1e-14));
  EXPECT_NEAR(BendOf(ThinBar(), path.Placed(1)), 60, 4);
  EXPECT_NEAR(BendOf(ThinBar(), path.Placed(2)), 30, 2);
  const auto alone =
      TransferPoses(connectivity, {poses[0], poses[2]}, ThinBar(), geodesic, Ladder());
  EXPECT_LT(Apart(alone.path.Placed(1), path.Placed(2)), 1e-12);
  EXPECT_LT(Apart(alone.hybrids.Placed(1), hybrids.Placed(2)), 1e-12);

  ASSERT_EQ(summary.transfers.size(), 2u);
  EXPECT_EQ(summary.transfers[0].steps.size(), 4u);
  EXPECT_TRUE(summary.Converged());
  EXPECT_TRUE(summary.Warnings().empty());
  const auto json = nlohmann::json::parse(summary.ToJson());
  ASSERT_EQ(json["transfers"].size(), 2u);
  EXPECT_EQ(json["geodesics"][0]["shapes"], 3);
  EXPECT_EQ(json["transfers"][1]["steps"].size(), 4u);

  EXPECT_THROW(TransferPoses(connectivity, {poses[0]}, ThinBar(), {}, Ladder()), MeshError);
}

TEST(Ladder, RefusesOptionsThatMeanNothing) {
  const auto message = [&](void (*change)(LadderOptions*)) {
    TransferOptions options = Ladder();
    change(&options.ladder);
    return MessageOf<InvalidOptions>([&] { Transfer(Bending(2), ThinBar(), options); });
  };
  EXPECT_EQ(message([](LadderOptions* o) { o->metric.rigid = 1; }).find("metric.rigid:"), 0u);
  EXPECT_EQ(message([](LadderOptions* o) {
              o->metric.discretization = Discretization::kTrapezoid;
            }).find("metric.discretization:"),
            0u);
  EXPECT_EQ(message([](LadderOptions* o) { o->metric.bending = -1; }).find("bending:"), 0u);
  EXPECT_EQ(message([](LadderOptions* o) { o->rung_shapes = 4; }).find("rung_shapes:"), 0u);
  EXPECT_EQ(message([](LadderOptions* o) { o->rung_shapes = -1; }).find("rung_shapes:"), 0u);
  EXPECT_EQ(message([](LadderOptions* o) { o->tolerance = 0; }).find("tolerance:"), 0u);
}

// A source that crumples almost to a point, a motion that cannot be continued.
TEST(Ladder, SaysWhichShapeDegenerates) {
  const Path source = PathOf(ThickBar().connectivity,
                             {ThickBar().pose(0), ThickBar().pose(5), Noise(106, 0.002, 3)});
  const auto transfer = [&] { Transfer(source, ThinBar(), Ladder()); };
  const std::string message = MessageOf<SolverError>(transfer);
  EXPECT_TRUE(Names(message, {"shape 3"}));
  EXPECT_TRUE(Names(message, {"more shapes"}));
}

TEST(LadderOfPoses, KeepsThePosesMadeBeforeItIsCancelled) {
  GeodesicOptions geodesic;
  geodesic.shapes = 1;
  const std::vector<Shape> poses = {ThickBar().pose(0), ThickBar().pose(40), ThickBar().pose(60)};
  const auto transfer = [&](Progress* progress) {
    return TransferPoses(ThickBar().connectivity, poses, ThinBar(), geodesic, Ladder(), progress);
  };
  Listener all;
  const PoseTransferResult whole = transfer(&all);
  ASSERT_FALSE(all.shares.empty());
  EXPECT_EQ(all.shares.front(), 0);
  EXPECT_TRUE(std::is_sorted(all.shares.begin(), all.shares.end()));
  EXPECT_LE(all.shares.back(), 1);
  Listener first(all.reports / 4);
  EXPECT_THROW(transfer(&first), Cancelled);
  Listener second(all.reports - 2);
  const PoseTransferResult half = transfer(&second);
  EXPECT_TRUE(half.summary.cancelled);
  EXPECT_FALSE(half.summary.Converged());
  EXPECT_NE(half.summary.Warnings().at(0).find("cancelled"), std::string::npos);
  ASSERT_EQ(half.path.NumShapes(), 2);
  EXPECT_EQ(half.summary.transfers.size(), 1u);
  EXPECT_LT(Apart(half.path.Placed(1), whole.path.Placed(1)), 1e-12);
}

}  // namespace
}  // namespace shapespace
