// What the paths and summaries of transfers must be to be consistent.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/transfer/detail/ladder.h>
#include <shapespace/transfer/internal/frames.h>
#include <shapespace/transfer/transfer.h>

#include "support/message_of.h"
#include "support/path_of.h"
#include "support/transfer_cases.h"

namespace shapespace {
namespace {

using namespace testing;

TEST(TransferSummary, HasConvergedWhereEveryShapeHasOnTheMeshItself) {
  TransferSummary summary;
  EXPECT_FALSE(summary.Converged());
  summary.steps.resize(3);
  EXPECT_FALSE(summary.Converged());
  for (auto& step : summary.steps) step.converged = step.on_mesh = true;
  EXPECT_TRUE(summary.Converged());
  summary.cancelled = true;
  EXPECT_FALSE(summary.Converged());
  summary.cancelled = false;
  summary.steps[1].on_mesh = false;
  EXPECT_FALSE(summary.Converged());
  summary.steps[1].on_mesh = true;
  summary.steps[2].converged = false;
  EXPECT_FALSE(summary.Converged());
}

TEST(PoseTransferSummary, HasConvergedWhereEveryPartHas) {
  PoseTransferSummary summary;
  EXPECT_FALSE(summary.Converged());
  EXPECT_TRUE(summary.Warnings().empty());
  summary.transfers.resize(2);
  summary.geodesics.resize(2);
  for (int i = 0; i < 2; ++i) {
    summary.geodesics[i].termination = Termination::kConverged;
    summary.transfers[i].steps.resize(1);
    summary.transfers[i].steps[0].converged = summary.transfers[i].steps[0].on_mesh = true;
  }
  EXPECT_TRUE(summary.Converged());
  summary.geodesics[1].termination = Termination::kStalled;
  EXPECT_FALSE(summary.Converged());
  summary.geodesics[1].termination = Termination::kConverged;
  summary.cancelled = true;
  EXPECT_FALSE(summary.Converged());
  summary.cancelled = false;
  summary.transfers[1].steps[0].converged = false;
  EXPECT_FALSE(summary.Converged());
}

// The source is stretched along x, and the target, a box too, is twice as large: what is off is
// known.
TEST(Transfer, TheErrorIsThatOfLogarithmicLengths) {
  const Path source = Bending(4);
  const auto [path, hybrids, summary] = Transfer(source, ThinBar());
  const Connectivity& connectivity = *source.metric->connectivity;
  double squares = 0, area = 0, most = 0;
  const Shape first = path.Placed(0), last = path.Placed(4);
  const Shape from = source.Placed(0), to = source.Placed(4);
  for (int e = 0; e < connectivity.NumEdges(); ++e) {
    const auto length = [&](const Shape& shape) {
      const auto edge = connectivity.Edges().col(e);
      return (shape.col(edge(0)) - shape.col(edge(1))).norm();
    };
    const double off = std::log(length(last) * length(from) / (length(first) * length(to)));
    squares += path.metric->edge_area(e) * off * off;
    area += path.metric->edge_area(e);
    most = std::max(most, std::abs(off));
  }
  EXPECT_NEAR(summary.strain_rms, std::sqrt(squares / area), 1e-9);
  EXPECT_NEAR(summary.strain_max, most, 1e-9);
  EXPECT_GT(most, 1.2 * summary.strain_rms);
  const auto angles = [&](const Shape& shape) { return DihedralAngles(connectivity, shape); };
  const Eigen::VectorXd turned = angles(last) - angles(first) - angles(to) + angles(from);
  const Eigen::VectorXd& hinge_area = path.metric->hinge_area;
  EXPECT_NEAR(summary.angle_rms,
              180 / M_PI * std::sqrt(hinge_area.dot(turned.cwiseAbs2()) / hinge_area.sum()), 1e-6);
  EXPECT_GT(summary.angle_rms, 0.1);
  EXPECT_EQ(summary.vertices, connectivity.NumVertices());
  EXPECT_GT(summary.estimated_bytes, 0);
  double seconds = 0;
  for (const auto& step : summary.steps) {
    EXPECT_GT(step.iterations, 0);
    EXPECT_TRUE(step.on_mesh);
    seconds += step.seconds;
  }
  EXPECT_LE(seconds, summary.total_seconds);
  EXPECT_GT(seconds, 0);
}

TEST(Transfer, TellsHowManyShapesDidNotConverge) {
  TransferOptions options;
  options.tolerance = 1e-14;
  options.max_iterations = 1;
  std::vector<Shape> shapes = {ThickBar().pose(0), ThickBar().pose(0), ThickBar().pose(30),
                               ThickBar().pose(50)};
  const TransferSummary summary =
      Transfer(PathOf(ThickBar().connectivity, shapes), ThinBar(), options).summary;
  ASSERT_EQ(summary.warnings.size(), 1u);
  const auto open = std::count_if(summary.steps.begin(), summary.steps.end(),
                                  [](const auto& step) { return !step.converged; });
  EXPECT_TRUE(Names(summary.warnings[0], {std::to_string(open) + " of 3 shapes"}));
}

TEST(Transfer, RefusalsNameTheFieldAndTheRemedy) {
  const Path source = Bending(2);
  const auto of_options = [&](void (*change)(TransferOptions*)) {
    TransferOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { options.Validate(); });
  };
  EXPECT_TRUE(
      Names(of_options([](TransferOptions* o) { o->metric.rigid = 1; }), {"metric.rigid:", "0"}));
  EXPECT_TRUE(Names(
      of_options([](TransferOptions* o) { o->metric.discretization = Discretization::kTrapezoid; }),
      {"metric.discretization:", "kMidpoint"}));
  EXPECT_TRUE(Names(of_options([](TransferOptions* o) { o->ladder.rung_shapes = 2; }),
                    {"rung_shapes:", "1"}));
  EXPECT_TRUE(Names(of_options([](TransferOptions* o) { o->ladder.metric.rigid = 1; }),
                    {"metric.rigid:", "0"}));
  EXPECT_EQ(of_options([](TransferOptions* o) { o->memory_limit = 0; }).find("memory_limit"), 0u);
  EXPECT_EQ(of_options([](TransferOptions* o) { o->ladder.rung_shapes = 1; }),
            "nothing was thrown");
  EXPECT_TRUE(
      Refuses<MeshError>([&] { Transfer(FirstShapes(source, 1), ThinBar()); }, {"one shape"}));
  EXPECT_TRUE(Refuses<MeshError>(
      [&] { TransferPoses(ThickBar().connectivity, {ThickBar().pose(0)}, ThinBar()); },
      {"one pose"}));
  EXPECT_TRUE(Refuses<MeshError>([&] { Transfer(source, Shape::Zero(3, 106)); }, {"extent"}));
  for (const auto method : {TransferMethod::kFeatures, TransferMethod::kLadder}) {
    TransferOptions options;
    options.method = method;
    options.memory_limit = 1000;
    EXPECT_TRUE(Refuses<SolverError>([&] { Transfer(source, ThinBar(), options); },
                                     {"this transfer", "fewer vertices"}));
  }
}

// A path that has not converged makes none that has, and its colours and parameters are kept.
TEST(Transfer, TakesOverWhatTheSourceIs) {
  Path source = Bending(2);
  source.parameters = {0, 0.25, 1};
  source.converged = false;
  source.appearance.vertex_colours = Eigen::MatrixXd::Constant(3, 106, 0.25);
  TransferOptions options;
  options.hybrids = true;
  const TransferResult result = Transfer(source, ThinBar(), options);
  EXPECT_TRUE(result.summary.Converged());
  EXPECT_FALSE(result.path.converged);
  EXPECT_FALSE(result.hybrids.converged);
  for (const Path& path : {result.path, result.hybrids}) {
    EXPECT_EQ(path.parameters, source.parameters);
    EXPECT_EQ(path.appearance.vertex_colours, source.appearance.vertex_colours);
  }
  EXPECT_EQ(result.path.provenance, "transferred");
  EXPECT_EQ(result.hybrids.provenance, "hybrids");
  source.converged = true;
  EXPECT_TRUE(Transfer(source, ThinBar()).path.converged);
}

TEST(Transfer, ReportsShareAndShapeOfTheWork) {
  struct Recorder : Progress {
    bool Report(const std::string& stage, int done, int total) override {
      stages.push_back(stage + " " + std::to_string(done) + "/" + std::to_string(total));
      return true;
    }
    std::vector<std::string> stages;
  } recorder;
  Transfer(Bending(2), ThinBar(), {}, &recorder);
  recorder.stages.erase(std::unique(recorder.stages.begin(), recorder.stages.end()),
                        recorder.stages.end());
  EXPECT_EQ(recorder.stages,
            (std::vector<std::string>{"transferring 0/3", "transferring 1/3", "transferring 2/3"}));
}

// The tenth part of the work for a pose is its geodesic.
TEST(LadderOfPoses, TellsWhatShareOfTheWorkIsDone) {
  struct Recorder : Progress {
    bool Report(const std::string&, int, int) override { return true; }
    void ReportShare(double share) override { shares.push_back(share); }
    std::vector<double> shares;
  } recorder;
  GeodesicOptions geodesic;
  geodesic.shapes = 1;
  TransferOptions options;
  options.method = TransferMethod::kLadder;
  const std::vector<Shape> poses = {ThickBar().pose(0), ThickBar().pose(20), ThickBar().pose(30)};
  TransferPoses(ThickBar().connectivity, poses, ThinBar(), geodesic, options, &recorder);
  for (const double share : {0.05, 0.2, 0.35, 0.55, 0.7, 0.85}) {
    EXPECT_TRUE(std::any_of(recorder.shares.begin(), recorder.shares.end(), [&](double one) {
      return std::abs(one - share) < 1e-12;
    })) << share;
  }
  EXPECT_TRUE(std::is_sorted(recorder.shares.begin(), recorder.shares.end()));
  geodesic.memory_limit = 1000;
  const std::string message = MessageOf<SolverError>(
      [&] { TransferPoses(ThickBar().connectivity, poses, ThinBar(), geodesic, options); });
  EXPECT_EQ(message.find("pose 2: "), 0u) << message;
}

TEST(Ladder, ATargetRestsWithItsSource) {
  const Shape rest = ThickBar().pose(0);
  TransferOptions options;
  options.method = TransferMethod::kLadder;
  options.hybrids = true;
  Shape middle;
  for (const int shapes : {1, 5}) {
    options.ladder.rung_shapes = shapes;
    const auto [path, hybrids, summary] =
        Transfer(PathOf(ThickBar().connectivity, {rest, rest, rest}), ThinBar(), options);
    ASSERT_EQ(summary.steps.size(), 2u);
    for (const auto& step : summary.steps) {
      EXPECT_NEAR(step.norm_change, 0, 1e-2);
      EXPECT_GE(step.ratio, 1);
      EXPECT_LT(step.ratio, 1.1);
    }
    EXPECT_LT(Apart(path.Placed(2), ThinBar()), 1e-6);
    ASSERT_EQ(hybrids.NumShapes(), 3);
    // The middle of the rung, of however many shapes.
    if (shapes > 1) {
      EXPECT_LT(Apart(hybrids.Placed(1), middle), 0.01);
    }
    middle = hybrids.Placed(1);
  }
}

// Without alignment a copy that is only moved makes the moved motion, rotation included.
TEST(Ladder, WithoutAlignmentAMovedCopyMovesAsTheSourceDoes) {
  std::vector<Shape> shapes;
  for (int i = 0; i <= 2; ++i) {
    shapes.push_back((Rotation(40 + 20 * i, {1, 1, 0}) * ThickBar().pose(15 * i)).colwise() +
                     Vector3d(i, 7, -2 * i));
  }
  TransferOptions options;
  options.method = TransferMethod::kLadder;
  options.ladder.align = false;
  const Vector3d shift(3, -4, 5);
  const auto [path, hybrids, summary] =
      Transfer(PathOf(ThickBar().connectivity, shapes), shapes[0].colwise() + shift, options);
  for (int i = 0; i <= 2; ++i) {
    EXPECT_LT(Apart(path.Placed(i), shapes[i].colwise() + shift), 1e-4) << i;
  }
}

}  // namespace

namespace internal {
namespace {

TEST(Frame, HasTwoSidesAndANormalOfTheirScale) {
  Shape shape(3, 4);
  shape << 9, 1, 4, 1,  //
      9, 2, 2, 8,       //
      9, 3, 3, 3;
  Eigen::Matrix3d expected;
  // The normal's length is the root of twice the area.
  expected << 3, 0, 0,  //
      0, 6, 0,          //
      0, 0, std::sqrt(18.);
  EXPECT_TRUE(Frame(shape, {1, 2, 3}).isApprox(expected, 1e-14));
  EXPECT_TRUE((InverseFrame(expected) * expected).isIdentity(1e-13));
  // Of a triangle that has collapsed the normal is zero, and the inverse is that on its line.
  const Eigen::Matrix3d flat = Frame(shape, {1, 2, 1});
  EXPECT_TRUE(flat.allFinite());
  EXPECT_TRUE(flat.col(2).isZero(1e-100));
  EXPECT_TRUE((flat * InverseFrame(flat) * flat).isApprox(flat, 1e-13));
}

TEST(Radius, IsWeightedByArea) {
  Shape shape(3, 3);
  shape << 1, 5, 1,  //
      2, 2, 2,       //
      7, 7, 7;
  const Eigen::Vector3d weights(1, 1, 2);
  // The centroid is at x = 2; squares are 1, 9 and 1.
  EXPECT_NEAR(Radius(shape, weights), std::sqrt((1 + 9 + 2 * 1) / 4.), 1e-14);
}

// The turn from the target's own motion to that of the source is the one that comes back.
TEST(Ladder, UprightsATargetThatHasTurned) {
  const auto metric =
      FreezeMetric(LadderOptions::Strains(), ThickBar().connectivity, {ThickBar().pose(0)});
  LadderOptions options;
  const Shape straight = ThickBar().pose(0), bent = ThickBar().pose(40), thin = ThinBar();
  const Eigen::Matrix3d turn = testing::Rotation(35, {1, 2, 3});
  EXPECT_TRUE(Ladder(metric, options)
                  .Uprighting(straight, bent, straight, turn * bent)
                  .isApprox(turn.transpose(), 1e-9));
  EXPECT_TRUE(Ladder(metric, options)
                  .Uprighting(straight, turn * straight, thin, thin)
                  .isApprox(turn, 1e-9));
  options.align = false;
  EXPECT_TRUE(
      Ladder(metric, options).Uprighting(straight, turn * straight, thin, thin).isIdentity(0));
}

}  // namespace
}  // namespace internal
}  // namespace shapespace
