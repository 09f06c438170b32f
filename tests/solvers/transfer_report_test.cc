// What transfers say of themselves, word by word, of numbers that all differ, and what their paths
// and summaries must be to be consistent.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
using nlohmann::json;

TransferSummary TransferOfNumbers() {
  TransferSummary summary;
  summary.method = TransferMethod::kLadder;
  summary.vertices = 11;
  summary.metric = "strain 1";
  summary.scale = 1.25;
  TransferSummary::Step step;
  step.converged = step.on_mesh = true;
  step.iterations = 7;
  step.ratio = 1.5;
  step.norm_change = -0.25;
  step.seconds = 0.125;
  summary.steps.push_back(step);
  step.iterations = 9;
  step.on_mesh = step.converged = false;
  step.warnings = {"of a step"};
  summary.steps.push_back(step);
  step.on_mesh = true;
  step.warnings.clear();
  summary.steps.push_back(step);
  summary.strain_rms = 0.01;
  summary.strain_max = 0.02;
  summary.angle_rms = 3.5;
  summary.uncertified_segments = 2;
  summary.contact_distance = 0.0625;
  summary.warnings = {"one", "two"};
  summary.estimated_bytes = 1e5;
  summary.total_seconds = 4.5;
  return summary;
}

TEST(TransferSummary, ReportsHaveEveryNumber) {
  TransferSummary summary = TransferOfNumbers();
  EXPECT_EQ(summary.BriefReport(),
            "NOT CONVERGED: 11 vertices, 3 shapes; target 1.25 times as large; strains off by 1% "
            "rms, dihedral angles by 3.5 degrees; 4.50 s");
  EXPECT_EQ(summary.FullReport(),
            "Ending            NOT CONVERGED\n"
            "Metric            strain 1\n"
            "Mesh              11 vertices; target 1.25 times as large as the source\n"
            "Strains, last     off by 1% rms, 2% at most\n"
            "Angles, last      off by 3.5 degrees rms\n"
            "Contact           2 segments not shown to be free of it; least distance 0.0625\n"
            "\n"
            "shape  iterations  seconds  energy / bound  norm changes\n"
            "    2           7    0.125         1.50000         -0.25\n"
            "    3           9    0.125         1.50000         -0.25  (on a coarser mesh)  (not "
            "converged)\n"
            "    4           9    0.125         1.50000         -0.25  (not converged)\n"
            "\n"
            "Time              4.500 s\n"
            "Warning: one\n"
            "Warning: two\n");
  json written = json::parse(summary.ToJson());
  ASSERT_EQ(written["steps"].size(), 3u);
  const json step = {{"converged", false}, {"iterations", 9},      {"on_mesh", false},
                     {"ratio", 1.5},       {"norm_change", -0.25}, {"warnings", {"of a step"}},
                     {"seconds", 0.125}};
  EXPECT_EQ(written["steps"][1], step);
  written.erase("steps");
  const json expected = {{"termination", "not_converged"},
                         {"converged", false},
                         {"method", "ladder"},
                         {"vertices", 11},
                         {"metric", "strain 1"},
                         {"scale", 1.25},
                         {"strain_rms", 0.01},
                         {"strain_max", 0.02},
                         {"angle_rms", 3.5},
                         {"uncertified_segments", 2},
                         {"contact_distance", 0.0625},
                         {"cancelled", false},
                         {"estimated_bytes", 1e5},
                         {"total_seconds", 4.5},
                         {"warnings", {"one", "two"}}};
  EXPECT_EQ(written, expected);
}

TEST(TransferSummary, HasConvergedWhereEveryShapeHasOnTheMeshItself) {
  TransferSummary summary;
  EXPECT_FALSE(summary.Converged());
  summary.steps.resize(3);
  EXPECT_FALSE(summary.Converged());
  for (auto& step : summary.steps) step.converged = step.on_mesh = true;
  EXPECT_TRUE(summary.Converged());
  summary.cancelled = true;
  EXPECT_FALSE(summary.Converged());
  EXPECT_EQ(json::parse(summary.ToJson())["termination"], "cancelled");
  summary.cancelled = false;
  summary.steps[1].on_mesh = false;
  EXPECT_FALSE(summary.Converged());
  summary.steps[1].on_mesh = true;
  summary.steps[2].converged = false;
  EXPECT_FALSE(summary.Converged());
}

TEST(PoseTransferSummary, ReportsAreOfAllPoses) {
  PoseTransferSummary summary;
  EXPECT_EQ(summary.BriefReport(), "no pose was transferred");
  EXPECT_EQ(summary.FullReport(), "");
  EXPECT_TRUE(summary.Warnings().empty());
  TransferSummary first;
  first.vertices = 11;
  first.scale = 1.25;
  first.steps.resize(4);
  for (auto& step : first.steps) step.converged = step.on_mesh = true;
  first.strain_rms = 0.03;
  first.angle_rms = 1.5;
  first.total_seconds = 2;
  TransferSummary second = first;
  second.steps.push_back(second.steps.back());
  second.strain_rms = 0.02;
  second.angle_rms = 2.5;
  second.total_seconds = 4;
  second.warnings = {"of the second"};
  GeodesicSummary to_first, to_second;
  to_first.termination = to_second.termination = Termination::kConverged;
  to_first.total_seconds = 8;
  to_first.warnings = {"of its geodesic"};
  to_second.total_seconds = 16;
  summary.geodesics = {to_first, to_second};
  summary.transfers = {first, second};
  EXPECT_EQ(summary.BriefReport(),
            "converged: 11 vertices, 2 poses in 9 steps; target 1.25 times as large; strains off "
            "by up to 3% rms, dihedral angles by 2.5 degrees; 30.00 s");
  EXPECT_EQ(summary.FullReport(), "Pose 2, the geodesic to it\n" + to_first.FullReport() +
                                      "\nPose 2, its transfer\n" + first.FullReport() +
                                      "\nPose 3, the geodesic to it\n" + to_second.FullReport() +
                                      "\nPose 3, its transfer\n" + second.FullReport());
  EXPECT_EQ(summary.Warnings(),
            (std::vector<std::string>{"pose 2: of its geodesic", "pose 3: of the second"}));
  summary.cancelled = true;
  EXPECT_EQ(summary.Warnings().front(),
            "cancelled: only the poses before this point were computed");
  EXPECT_FALSE(summary.Converged());
  const json written = json::parse(summary.ToJson());
  EXPECT_EQ(written["termination"], "cancelled");
  EXPECT_EQ(written["cancelled"], true);
  EXPECT_EQ(written["warnings"].size(), 3u);
  summary.cancelled = false;
  summary.geodesics[1].termination = Termination::kStalled;
  EXPECT_FALSE(summary.Converged());
  summary.geodesics[1].termination = Termination::kConverged;
  EXPECT_TRUE(summary.Converged());
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
  EXPECT_EQ(summary.warnings[0],
            std::to_string(std::count_if(summary.steps.begin(), summary.steps.end(),
                                         [](const auto& step) { return !step.converged; })) +
                " of 3 shapes did not converge: check the pictures");
}

TEST(Transfer, RefusalsNameTheFieldAndTheRemedy) {
  const Path source = Bending(2);
  const auto of_options = [&](void (*change)(TransferOptions*)) {
    TransferOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { options.Validate(); });
  };
  EXPECT_EQ(of_options([](TransferOptions* o) { o->metric.rigid = 1; }),
            "metric.rigid: the rigid metric knows no transfer; use 0");
  EXPECT_EQ(
      of_options([](TransferOptions* o) { o->metric.discretization = Discretization::kTrapezoid; }),
      "metric.discretization: in trapezoid form nothing can be transferred; use kMidpoint");
  EXPECT_EQ(of_options([](TransferOptions* o) { o->ladder.rung_shapes = 2; }),
            "rung_shapes: must be odd, 1 or more");
  EXPECT_EQ(of_options([](TransferOptions* o) { o->ladder.metric.rigid = 1; }),
            "metric.rigid: the rigid metric knows no transfer; use 0");
  EXPECT_EQ(of_options([](TransferOptions* o) { o->memory_limit = 0; }).find("memory_limit"), 0u);
  EXPECT_EQ(of_options([](TransferOptions* o) { o->ladder.rung_shapes = 1; }),
            "nothing was thrown");
  EXPECT_EQ(MessageOf<MeshError>([&] { Transfer(FirstShapes(source, 1), ThinBar()); }),
            "a source of one shape has no motion to transfer");
  EXPECT_EQ(MessageOf<MeshError>(
                [&] { TransferPoses(ThickBar().connectivity, {ThickBar().pose(0)}, ThinBar()); }),
            "one pose has no motion to transfer");
  EXPECT_EQ(MessageOf<MeshError>([&] { Transfer(source, Shape::Zero(3, 106)); }),
            "the target or the source's first shape has no extent");
  for (const auto method : {TransferMethod::kFeatures, TransferMethod::kLadder}) {
    TransferOptions options;
    options.method = method;
    options.memory_limit = 1000;
    const std::string message =
        MessageOf<SolverError>([&] { Transfer(source, ThinBar(), options); });
    EXPECT_NE(message.find("this transfer"), std::string::npos) << message;
    EXPECT_NE(message.find("use meshes of fewer vertices"), std::string::npos) << message;
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
