// What a deformation says of itself, against what can be worked out.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/path/energy.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Noise;
using testing::Refuses;
using testing::Where;

// What is reported: "stage done/total".
struct StageRecorder : Progress {
  bool Report(const std::string& stage, int done, int total) override {
    stages.push_back(stage + " " + std::to_string(done) + "/" + std::to_string(total));
    return true;
  }
  bool Has(const std::string& stage) const {
    return std::find(stages.begin(), stages.end(), stage) != stages.end();
  }
  std::vector<std::string> stages;
};

// A bar away from the origin, of which both ends are held.
struct SmallBar {
  ShapeFamily body = MakeBar(6, 1, 1, 8, 2, 2);
  Shape rest = body.pose(0).colwise() + Eigen::Vector3d(10, -7, 2);
  std::vector<int> left = Where(rest, [](const auto& p) { return p.x() < 7.1; });
  std::vector<int> right = Where(rest, [](const auto& p) { return p.x() > 12.9; });

  // The right end turns about the bar, the left one stays.
  std::vector<DeformationHandle> Handles(double degrees,
                                         const Eigen::Vector3d& way = {0, 0, 0}) const {
    std::vector<DeformationHandle> handles(2);
    handles[0].name = "left";
    handles[0].vertices = left;
    handles[1].vertices = right;
    handles[1].motion.axis = Eigen::Vector3d::UnitX();
    handles[1].motion.point = Eigen::Vector3d(13, -7, 2);
    handles[1].motion.angle = degrees * M_PI / 180;
    handles[1].motion.translation = way;
    return handles;
  }
};

// Where only positions cost, the body moves as a whole, and the balance is that of two squares.
TEST(Deform, TheBalanceIsThatOfEnergyAndMeanSquaredDistances) {
  const SmallBar bar;
  std::vector<int> all(bar.rest.cols());
  for (size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
  const Eigen::Vector3d ways[] = {{3, 0, 1}, {0, 2, -1}};
  const double weights[] = {1, 4};
  std::vector<DeformationHandle> handles(2);
  for (int h : {0, 1}) {
    handles[h].vertices = all;
    handles[h].positions = bar.rest.colwise() + ways[h];
    handles[h].hard = false;
    handles[h].weight = weights[h];
  }
  DeformationOptions options;
  options.metric = MetricOptions();
  options.metric->strain = options.metric->isometric = options.metric->bending = 0;
  options.metric->lambda = 1;
  options.tolerance = 1e-12;
  for (const double balance : {0.2, 0.7}) {
    for (const int shapes : {1, 3}) {
      options.balance = balance;
      options.shapes = shapes;
      const auto [path, summary] = Deform(bar.body.connectivity, bar.rest, handles, options);
      // The mean of weight * distance squared is 2.5 |d - m|^2 but for a constant.
      const Eigen::Vector3d middle = (ways[0] + 4 * ways[1]) / 5;
      const double pull = (1 - balance) * 2.5, cost = balance;
      const Eigen::Vector3d moved = pull / (pull + cost) * middle;
      EXPECT_LT((path.Placed(shapes) - (bar.rest.colwise() + moved)).cwiseAbs().maxCoeff(), 1e-4);
      const double unit = summary.unit;
      EXPECT_NEAR(summary.energy, moved.squaredNorm() / (unit * unit), 1e-4 * summary.energy);
      const double value = summary.energy + (1 - balance) / balance * 2.5 *
                                                (moved - middle).squaredNorm() / (unit * unit);
      EXPECT_NEAR(summary.levels.back().value, value, 1e-4 * value);
      for (int h : {0, 1}) {
        EXPECT_NEAR(summary.handles[h].residual_rms, (moved - ways[h]).norm(), 1e-4);
        EXPECT_NEAR(summary.handles[h].residual_max, (moved - ways[h]).norm(), 1e-4);
      }
    }
  }
}

TEST(Deform, TheSummaryIsOfThePath) {
  const SmallBar bar;
  std::vector<DeformationHandle> handles = bar.Handles(80, {0.2, 0.3, 0.5});
  DeformationOptions options;
  options.shapes = 3;
  options.balance = 0.25;
  options.coarsest = 60;
  StageRecorder recorder;
  const auto [path, summary] = Deform(bar.body.connectivity, bar.rest, handles, options, &recorder);
  EXPECT_EQ(summary.vertices, bar.rest.cols());
  EXPECT_EQ(summary.triangles, bar.body.connectivity->NumTriangles());
  EXPECT_EQ(summary.shapes, 3);
  EXPECT_EQ(summary.balance, 0.25);
  EXPECT_EQ(summary.metric, DescribeMetric(path.metric->options));
  EXPECT_EQ(summary.unit, path.metric->unit);
  EXPECT_EQ(summary.threads, NumThreads());
  EXPECT_EQ(summary.free_components, 0);
  EXPECT_FALSE(summary.warm);
  EXPECT_TRUE(summary.warnings.empty());
  EXPECT_GT(summary.estimated_bytes, 0);
  EXPECT_EQ(summary.uncertified_segments, -1);
  EXPECT_TRUE(std::isnan(summary.contact_distance));

  ASSERT_EQ(path.NumShapes(), 4);
  EXPECT_EQ(path.poses, std::vector<int>{0});
  EXPECT_EQ(path.parameters, (std::vector<double>{0, 1 / 3., 2 / 3., 1}));
  EXPECT_TRUE(path.converged);
  EXPECT_LT((path.Placed(0) - bar.rest).cwiseAbs().maxCoeff(), 1e-12);

  // The energy in the user's frame, in which position has its cost.
  std::vector<Shape> shapes;
  for (const Shape& shape : path.Placed()) shapes.push_back(shape / path.metric->unit);
  PathEnergy energy(path.metric, 2);
  std::vector<double> unknowns(energy.Size());
  energy.Load(shapes, unknowns.data());
  EXPECT_NEAR(summary.energy, ScaledEnergy(energy.Evaluate(unknowns.data(), nullptr), 3),
              1e-9 * summary.energy);
  const ShapeError error = CompareShapes(path.metric, shapes[0], shapes[3]);
  EXPECT_NEAR(summary.error.edge_rms, error.edge_rms, 1e-12);
  EXPECT_NEAR(summary.error.volume, error.volume, 1e-12);

  ASSERT_GE(summary.levels.size(), 2u);
  ASSERT_EQ(summary.hierarchy.size(), summary.levels.size());
  double seconds = 0;
  for (size_t i = 0; i < summary.levels.size(); ++i) {
    const DeformationSummary::Level& level = summary.levels[i];
    EXPECT_EQ(level.vertices, summary.hierarchy[i]);
    EXPECT_EQ(level.shapes, 3);
    EXPECT_EQ(level.start, i == 0 ? "handles" : "lifted");
    EXPECT_GT(level.iterations, 0);
    EXPECT_GE(level.evaluations, level.iterations);
    EXPECT_LE(level.value, level.initial_value);
    seconds += level.seconds;
    EXPECT_TRUE(recorder.Has(std::to_string(level.vertices) + " vertices, 3 shapes 1/0"));
  }
  EXPECT_LT(summary.hierarchy.front(), summary.hierarchy.back());
  EXPECT_EQ(summary.hierarchy.back(), summary.vertices);
  EXPECT_NEAR(summary.levels.back().value, summary.energy, 1e-9 * summary.energy);
  EXPECT_LE(seconds, summary.solve_seconds);
  EXPECT_LE(summary.solve_seconds + summary.hierarchy_seconds + summary.factor_seconds,
            summary.total_seconds);
  // Ten steps at least, as many for each shape.
  EXPECT_TRUE(recorder.Has("following the handles 1/12"));
  EXPECT_TRUE(recorder.Has("following the handles 12/12"));
  EXPECT_EQ(recorder.stages.front(), "deforming 0/0");

  ASSERT_EQ(summary.handles.size(), 2u);
  EXPECT_EQ(summary.handles[0].name, "left");
  EXPECT_EQ(summary.handles[1].name, "");
  EXPECT_EQ(summary.handles[1].vertices, static_cast<int>(bar.right.size()));
  EXPECT_TRUE(summary.handles[1].hard);
}

// Two handles of different vertices share one, of which both want something else.
TEST(Deform, ResidualsAreWeightedByArea) {
  const SmallBar bar;
  const int shared = bar.right[0];
  std::vector<DeformationHandle> handles = bar.Handles(0);
  handles[1].name = "right";
  DeformationHandle other;
  other.vertices = {shared};
  other.motion.translation = {0, 0, 0.5};
  handles.push_back(other);
  handles.push_back(handles[1]);
  handles.back().hard = false;
  handles.back().name = "under it";
  const auto [path, summary] = Deform(bar.body.connectivity, bar.rest, handles);
  const Eigen::VectorXd& area = path.metric->vertex_area;
  double all = 0;
  for (const int v : bar.right) all += area(v);
  ASSERT_GT(std::abs(area(shared) / all - 1. / bar.right.size()), 0.01);
  const double expected = 0.25 * std::sqrt(area(shared) / all);
  EXPECT_NEAR(summary.handles[0].residual_max, 0, 1e-12);
  EXPECT_NEAR(summary.handles[1].residual_rms, expected, 1e-12);
  EXPECT_NEAR(summary.handles[1].residual_max, 0.25, 1e-12);
  EXPECT_NEAR(summary.handles[2].residual_rms, 0.25, 1e-12);
  EXPECT_NEAR(summary.handles[3].residual_rms, expected, 1e-12);
  EXPECT_FALSE(summary.handles[3].hard);
  EXPECT_TRUE(testing::EachNames(summary.warnings, {{"\"right\"", "targets"}, {"targets"}}));
}

// Five bars and two vertices of no triangle; the second bar has handles.
TEST(Deform, ComponentsWithoutAHandleAreNamedUpToThree) {
  const ShapeFamily body = MakeBar(4, 1, 1, 4, 1, 1);
  const int count = body.connectivity->NumVertices();
  const Eigen::Matrix3Xi& one = body.connectivity->Triangles();
  const auto solve = [&](int bars) {
    Eigen::Matrix3Xi triangles(3, bars * one.cols());
    Shape rest(3, bars * count + 2);
    for (int i = 0; i < bars; ++i) {
      triangles.middleCols(i * one.cols(), one.cols()) = one.array() + i * count;
      rest.middleCols(i * count, count) = body.pose(0).colwise() + Eigen::Vector3d(0, 5 * i, 0);
    }
    rest.rightCols(2).setConstant(9);
    DeformationHandle handle;
    handle.vertices = {count + 2};
    handle.motion.translation = {0, 0, 0.5};
    const auto [path, summary] = Deform(
        Connectivity::FromTriangles(static_cast<int>(rest.cols()), triangles), rest, {handle});
    EXPECT_LT((path.Placed(5).leftCols(count) - rest.leftCols(count)).norm(), 1e-12);
    EXPECT_LT((path.Placed(5).rightCols(2) - rest.rightCols(2)).norm(), 1e-12);
    EXPECT_EQ(summary.free_components, bars - 1);
    return summary.warnings;
  };
  const auto stays = [&](int first) {
    return std::vector<std::string>{std::to_string(count) + " vertices",
                                    "vertex " + std::to_string(first * count + 1)};
  };
  EXPECT_TRUE(testing::EachNames(solve(4), {stays(0), stays(2), stays(3)}));
  EXPECT_TRUE(testing::EachNames(solve(6), {stays(0), stays(2), stays(3), {"2 further"}}));
}

TEST(Deform, ATurnIsTooFarFromTwoThirdsOfAHalfTurnOnForEachShape) {
  const SmallBar bar;
  DeformationOptions options;
  options.shapes = 2;
  const auto warnings = [&](double degrees) {
    return Deform(bar.body.connectivity, bar.rest, bar.Handles(degrees), options).summary.warnings;
  };
  EXPECT_TRUE(warnings(236).empty());
  EXPECT_TRUE(testing::EachNames(warnings(-250), {{"125 degrees", "3 shapes"}}));
}

TEST(Deform, EndingsAreSaid) {
  const SmallBar bar;
  DeformationOptions options;
  options.shapes = 1;
  options.tolerance = 1e-12;
  options.max_iterations = 1;
  StageRecorder recorder;
  const auto [path, summary] =
      Deform(bar.body.connectivity, bar.rest, bar.Handles(90), options, &recorder);
  EXPECT_EQ(summary.termination, Termination::kMaxIterations);
  EXPECT_TRUE(testing::EachNames(summary.warnings, {{"max_iterations"}}));
  EXPECT_FALSE(path.converged);
  EXPECT_TRUE(recorder.Has(std::to_string(bar.rest.cols()) + " vertices, 1 shape 1/0"));
  EXPECT_TRUE(recorder.Has("following the handles 10/10"));
  struct StopsLate : Progress {
    bool Report(const std::string& stage, int done, int) override {
      return stage.find("vertices") == std::string::npos || done < 1;
    }
  } stops;
  options.max_iterations = 100;
  const DeformationSummary stopped =
      Deform(bar.body.connectivity, bar.rest, bar.Handles(90), options, &stops).summary;
  EXPECT_EQ(stopped.termination, Termination::kCancelled);
  EXPECT_TRUE(testing::EachNames(stopped.warnings, {{"cancelled"}}));
}

// A tenth of a radian, and a tenth of the root of the area.
TEST(Deformer, IsWarmWhereHandlesMoveLittle) {
  const SmallBar bar;
  DeformationOptions options;
  options.shapes = 2;
  options.tolerance = 1e-2;
  const double unit = FreezeMetric({}, bar.body.connectivity, {bar.rest})->unit;
  const auto is_warm = [&](double degrees, double way) {
    Deformer deformer(bar.body.connectivity, bar.rest, options);
    EXPECT_FALSE(deformer.Deform(bar.Handles(20)).summary.warm);
    const DeformationSummary second =
        deformer.Deform(bar.Handles(20 + degrees, {way * unit, 0, 0})).summary;
    EXPECT_EQ(second.levels.size(), second.warm ? 1u : second.hierarchy.size());
    EXPECT_EQ(second.levels.back().start == "warm", second.warm);
    EXPECT_EQ(second.factor_seconds, 0);
    EXPECT_EQ(second.hierarchy_seconds, 0);
    return second.warm;
  };
  EXPECT_TRUE(is_warm(5, 0));
  EXPECT_FALSE(is_warm(6.5, 0));
  EXPECT_FALSE(is_warm(-6.5, 0));
  EXPECT_TRUE(is_warm(0, 0.09));
  EXPECT_FALSE(is_warm(0, 0.11));
}

TEST(Deformer, WhatIsWrongWithAnEndIsSaid) {
  const SmallBar bar;
  Deformer deformer(bar.body.connectivity, bar.rest);
  const auto message = [&](const Shape& end) {
    return MessageOf<MeshError>([&] { deformer.DeformFrom(end, bar.Handles(10)); });
  };
  const std::string count = std::to_string(bar.rest.cols());
  EXPECT_TRUE(Names(message(bar.rest.leftCols(7)), {"7", count}));
  Shape end = bar.rest;
  end(1, 4) = end(2, 9) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(Names(message(end), {"vertex 5"}));
}

// The shapes before a given end are those of a geodesic in the frame in which the handles are.
TEST(Deformer, FromAGivenEndThePathIsEvenToo) {
  const SmallBar bar;
  DeformationOptions options;
  options.shapes = 4;
  options.tolerance = 1e-8;
  const DeformationResult wanted =
      Deform(bar.body.connectivity, bar.rest, bar.Handles(60), options);
  const DeformationResult found = Deformer(bar.body.connectivity, bar.rest, options)
                                      .DeformFrom(wanted.path.Placed(4), bar.Handles(60));
  ASSERT_EQ(found.path.NumShapes(), 5);
  for (int i = 0; i <= 4; ++i) {
    EXPECT_LT((found.path.Placed(i) - wanted.path.Placed(i)).cwiseAbs().maxCoeff(), 0.01) << i;
  }
  ASSERT_FALSE(found.summary.levels.empty());
  EXPECT_EQ(found.summary.levels[0].start, "given");
}

TEST(Deform, ValidateRefusesAloneAndSaysWhy) {
  const auto message = [](void (*change)(DeformationOptions*)) {
    DeformationOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { options.Validate(); });
  };
  EXPECT_EQ(message([](DeformationOptions* o) {
              o->metric = MetricOptions();
              o->metric->lambda = -1;
            }).find("lambda:"),
            0u);
  EXPECT_TRUE(Names(message([](DeformationOptions* o) { o->metric = MetricOptions::Rigid(); }),
                    {"rigid:", "0"}));
  EXPECT_TRUE(Names(message([](DeformationOptions* o) { o->metric = MetricOptions::Paper(); }),
                    {"discretization:"}));
  EXPECT_TRUE(Names(message([](DeformationOptions* o) { o->shapes = 0; }), {"shapes:", "1"}));
  EXPECT_EQ(message([](DeformationOptions* o) { o->shapes = 1; }), "nothing was thrown");
  EXPECT_TRUE(
      Names(message([](DeformationOptions* o) { o->balance = 0; }), {"balance:", "0", "1"}));
  EXPECT_TRUE(
      Names(message([](DeformationOptions* o) { o->balance = NAN; }), {"balance:", "0", "1"}));
  EXPECT_EQ(message([](DeformationOptions* o) { o->balance = 1; }), "nothing was thrown");
  EXPECT_EQ(message([](DeformationOptions* o) { o->coarsest = 1; }).find("coarsest:"), 0u);
  EXPECT_EQ(message([](DeformationOptions* o) { o->tolerance = NAN; }).find("tolerance:"), 0u);
  EXPECT_EQ(message([](DeformationOptions* o) { o->max_iterations = 0; }).find("max_iterations:"),
            0u);
  EXPECT_EQ(message([](DeformationOptions* o) { o->memory_limit = -1; }).find("memory_limit:"), 0u);
  const SmallBar bar;
  DeformationOptions options;
  options.memory_limit = 1000;
  EXPECT_TRUE(Refuses<SolverError>([&] { Deformer(bar.body.connectivity, bar.rest, options); },
                                   {"this deformation", "fewer shapes"}));
}

TEST(Repair, TheSummaryIsOfThePath) {
  const SmallBar bar;
  const Shape distorted = (testing::Rotation(40, {1, 2, 3}) *
                           (bar.rest + Noise(static_cast<int>(bar.rest.cols()), 0.05, 3)))
                              .colwise() +
                          Eigen::Vector3d(1, 2, 3);
  RepairOptions options;
  options.vertices = bar.left;
  options.vertices.push_back(bar.right[0]);
  const auto [path, summary] = Repair(bar.body.connectivity, bar.rest, distorted, options);
  ASSERT_EQ(summary.deformation.handles.size(), 1u);
  EXPECT_EQ(summary.deformation.handles[0].name, "distorted shape");
  EXPECT_EQ(summary.deformation.handles[0].vertices, static_cast<int>(bar.left.size()) + 1);
  EXPECT_FALSE(summary.deformation.handles[0].hard);
  EXPECT_EQ(summary.deformation.shapes, 1);
  EXPECT_EQ(summary.deformation.balance, 0.5);
  const Shape repaired = path.Placed(1);
  const Eigen::VectorXd area =
      FreezeMetric(MetricOptions::Isometric(), bar.body.connectivity, {bar.rest, distorted})
          ->vertex_area;
  double squares = 0;
  for (int v = 0; v < area.size(); ++v) {
    squares += area(v) * (repaired.col(v) - distorted.col(v)).squaredNorm();
  }
  EXPECT_NEAR(summary.moved, std::sqrt(squares / area.sum()), 1e-9);
  const ShapeError before = CompareShapes(path.metric, path.Placed(0), distorted);
  const ShapeError after = CompareShapes(path.metric, path.Placed(0), repaired);
  EXPECT_NEAR(summary.before.edge_rms, before.edge_rms, 1e-12);
  EXPECT_NEAR(summary.before.volume, before.volume, 1e-12);
  EXPECT_NEAR(summary.after.edge_rms, after.edge_rms, 1e-12);
  EXPECT_NEAR(summary.after.volume, after.volume, 1e-12);
  EXPECT_LT(summary.after.edge_rms, summary.before.edge_rms);
  const std::string count = std::to_string(bar.rest.cols());
  options.vertices = {3, static_cast<int>(bar.rest.cols())};
  const auto repair = [&] { Repair(bar.body.connectivity, bar.rest, distorted, options); };
  EXPECT_TRUE(
      Refuses<InvalidOptions>(repair, {"vertices:", count, std::to_string(bar.rest.cols() - 1)}));
  options.deformation.balance = 2;
  EXPECT_TRUE(Refuses<InvalidOptions>(repair, {"balance:", "0", "1"}));
}

TEST(Standing, RefusalsNameThePart) {
  const auto message = [](const std::vector<StandingPart>& parts) {
    return MessageOf<InvalidOptions>([&] { CheckStandingParts(parts, 10, 4); });
  };
  EXPECT_TRUE(Names(message({}), {"parts:"}));
  const StandingPart good = {"good", {9, 0}, {{0, 1}, {2, 3}}};
  EXPECT_TRUE(Names(message({good, {"foot", {}, {{0, 1}}}}), {"part 2 (foot):", "vertex"}));
  EXPECT_TRUE(Names(message({good, {"", {-1}, {{0, 1}}}}), {"part 2:", "vertex -1", "0", "9"}));
  EXPECT_TRUE(Names(message({{"", {1}, {{0, 1}}}, good, {"foot", {3, 9}, {{0, 1}}}}),
                    {"part 3 (foot):", "vertex 10", "part 2 (good)"}));
  EXPECT_TRUE(Names(message({good, {"", {1}, {}}}), {"part 2:", "poses"}));
  EXPECT_TRUE(Names(message({good, {"", {1}, {{0, 2}, {2, 3}}}}), {"part 2:", "4 poses"}));
  EXPECT_EQ(StandingDefaults().shapes, 1);
  EXPECT_EQ(StandingDefaults().tolerance, 1e-6);
  EXPECT_EQ(StandingDefaults().balance, DeformationOptions().balance);
}

TEST(Standing, ErrorsInTheTextNameThePartAndTheField) {
  const SmallBar bar;
  const auto message = [&](const std::string& text) {
    return MessageOf<InvalidOptions>(
        [&] { ReadStandingParts(text, bar.rest, *bar.body.connectivity, {}); });
  };
  const std::string good = R"({"select": {"vertices": [1]}, "poses": [1, 2]}, )";
  const std::string select = R"([{"select": {"vertices": [1]}, "poses": )";
  EXPECT_TRUE(Names(message("[" + good + R"({"select": {"vertices": [99999]}, "poses": [1, 2]}])"),
                    {"part 2:", "99999"}));
  EXPECT_TRUE(Names(message("[" + good + R"({"poses": [1, 2]}])"), {"part 2:", "select"}));
  EXPECT_TRUE(Names(message(R"([{"select": {"vertices": [1]}}])"), {"part 1:", "poses"}));
  EXPECT_TRUE(Names(message(R"([{"pose": 1}])"), {"part 1:", "'pose'"}));
  EXPECT_TRUE(Names(message(select + "[1, 2, 3]}]"), {"part 1:", "poses"}));
  for (const char* poses : {"[0, 2]", "[1, 2.5]", "[1, 1000001]", "[[1, 2], [3, -4]]"}) {
    EXPECT_TRUE(Names(message(select + poses + "}]"), {"part 1:", "poses"})) << poses;
  }
  EXPECT_EQ(message(select + "[1, 1000000]}]"), "nothing was thrown");
  EXPECT_TRUE(Names(message(R"([{"name": 3, "select": {"vertices": [1]}, "poses": [1, 2]}])"),
                    {"part 1:"}));
}

}  // namespace
}  // namespace shapespace
