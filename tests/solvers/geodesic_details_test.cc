// The order of the solves of a geodesic, the share of the work that is done, where solves start,
// and what the rows of the summary say, each exactly.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/geodesic/detail/schedule.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/arc_length.h>
#include <shapespace/geodesic/internal/workload.h>
#include <shapespace/metric/feature_map.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using internal::MakeSchedule;
using testing::Distance;
using testing::Listener;
using StepsInOrder = std::vector<std::pair<int, int>>;

StepsInOrder StepsOfSchedule(GeodesicSchedule schedule, int levels, int shapes) {
  StepsInOrder steps;
  for (const internal::ScheduleStep& step : MakeSchedule(schedule, levels, shapes)) {
    steps.emplace_back(step.level, step.shapes);
  }
  return steps;
}

TEST(Schedule, HasTheStepsThatItsDescriptionNames) {
  EXPECT_EQ(StepsOfSchedule(GeodesicSchedule::kAutomatic, 3, 31), (StepsInOrder{{0, 1},
                                                                                {1, 1},
                                                                                {2, 1},
                                                                                {0, 3},
                                                                                {1, 3},
                                                                                {2, 3},
                                                                                {0, 7},
                                                                                {1, 7},
                                                                                {2, 7},
                                                                                {2, 15},
                                                                                {2, 31}}));
  EXPECT_EQ(StepsOfSchedule(GeodesicSchedule::kAutomatic, 2, 8),
            (StepsInOrder{{0, 1}, {1, 1}, {0, 3}, {1, 3}, {1, 8}}));
  EXPECT_EQ(StepsOfSchedule(GeodesicSchedule::kAutomatic, 2, 2),
            (StepsInOrder{{0, 1}, {1, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(StepsOfSchedule(GeodesicSchedule::kAutomatic, 1, 1), (StepsInOrder{{0, 1}}));
  EXPECT_EQ(StepsOfSchedule(GeodesicSchedule::kFlat, 3, 10),
            (StepsInOrder{{2, 1}, {2, 4}, {2, 10}}));
  EXPECT_EQ(StepsOfSchedule(GeodesicSchedule::kPaper, 3, 7),
            (StepsInOrder{{0, 1}, {0, 3}, {1, 3}, {1, 7}, {2, 7}}));
  EXPECT_EQ(StepsOfSchedule(GeodesicSchedule::kPaper, 4, 3),
            (StepsInOrder{{0, 1}, {0, 3}, {1, 3}, {2, 3}, {3, 3}}));
  EXPECT_EQ(StepsOfSchedule(GeodesicSchedule::kPaper, 2, 15),
            (StepsInOrder{{0, 1}, {0, 3}, {1, 3}, {1, 7}, {1, 15}}));
}

// Work is vertices times shapes; a last solve to 1e-6 counts half as much again.
TEST(Workload, ReportsTheShareOfThePlannedWork) {
  Listener listener;
  std::vector<std::string> stages;
  std::vector<int> iterations;
  listener.on_report = [&](const std::string& stage, int iteration) {
    stages.push_back(stage);
    iterations.push_back(iteration);
  };
  internal::Workload workload(&listener, 1e-6, 100);
  workload.Plan(10, 4, false);  // 40
  workload.Plan(20, 2, true);   // 60
  workload.Begin("coarse", 10, 4, false);
  EXPECT_TRUE(workload.GoOn(0, 8));
  EXPECT_TRUE(workload.GoOn(1, 4));               // the first drop, of 1
  EXPECT_TRUE(workload.GoOn(2, 4 / (1 + 1e-3)));  // half of the logarithms to 1e-6
  EXPECT_TRUE(workload.GoOn(60, 3.9));            // by the number of iterations
  workload.End();
  workload.Begin("fine", 20, 2, true);
  EXPECT_TRUE(workload.GoOn(0, 3));
  EXPECT_TRUE(workload.GoOn(10, 3.1));  // a rise tells nothing
  EXPECT_TRUE(workload.GoOn(100, 3));   // all
  workload.End();
  const double half = std::pow(0.5, 2.5);
  const std::vector<double> expected = {0,   0.4 * 0.01,      0.4 * half, 0.4 * 0.6,
                                        0.4, 0.4 + 0.6 * 0.1, 1};
  ASSERT_EQ(listener.shares.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(listener.shares[i], expected[i], 1e-9) << i;
  }
  EXPECT_EQ(stages, (std::vector<std::string>{"coarse", "coarse", "coarse", "coarse", "fine",
                                              "fine", "fine"}));
  EXPECT_EQ(iterations, (std::vector<int>{0, 1, 2, 60, 0, 10, 100}));
  EXPECT_FALSE(workload.Stopped());
}

TEST(Workload, OnceStoppedStaysStopped) {
  Listener listener(2);
  internal::Workload workload(&listener, 1e-4, 10);
  workload.Plan(10, 1, true);
  workload.Begin("a", 10, 1, true);
  EXPECT_TRUE(workload.GoOn(0, 2));
  EXPECT_FALSE(workload.Stopped());
  EXPECT_FALSE(workload.GoOn(1, 1));
  EXPECT_TRUE(workload.Stopped());
  EXPECT_FALSE(workload.GoOn(2, 1));  // the listener must not be asked again
  EXPECT_EQ(listener.reports, 2);
  internal::Workload alone(nullptr, 1e-4, 10);
  alone.Begin("a", 10, 1, true);
  EXPECT_TRUE(alone.GoOn(50, 1));
  EXPECT_FALSE(alone.Stopped());
}

TEST(ArcLengthTimes, UniformTimesAreThoseOfInnerShapesAndBothEnds) {
  EXPECT_EQ(internal::UniformTimes(3), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(internal::UniformTimes(0), (std::vector<double>{0, 1}));
}

ShapeFamily SheetInDetail() { return MakeSheet(2, 1, 4, 3); }

GeodesicOptions OptionsInDetail(int shapes, double tolerance = 1e-10) {
  GeodesicOptions options;
  options.shapes = shapes;
  options.tolerance = tolerance;
  options.max_iterations = 5000;
  return options;
}

// Stopped before the first iteration, a path is its start.
TEST(Interpolate, BeginsAtTheShapeThatItsStartNames) {
  const ShapeFamily sheet = SheetInDetail();
  for (const GeodesicStart start :
       {GeodesicStart::kFirst, GeodesicStart::kLast, GeodesicStart::kBlend, GeodesicStart::kBest}) {
    GeodesicOptions options = OptionsInDetail(1);
    options.start = start;
    options.metric.lambda = 0.1;
    Listener all;
    int before = 0;
    all.on_report = [&](const std::string& stage, int) {
      if (before == 0 && stage == "20 vertices, 1 inner shape") before = all.reports;
    };
    const std::vector<Shape> poses = {sheet.pose(0), sheet.pose(70)};
    Interpolate(sheet.connectivity, poses, options, &all);
    ASSERT_GT(before, 0);
    Listener stop(before);
    const auto [path, summary] = Interpolate(sheet.connectivity, poses, options, &stop);
    ASSERT_EQ(path.NumShapes(), 3);
    const Shape expected = start == GeodesicStart::kFirst ? path.shapes[0]
                           : start == GeodesicStart::kLast
                               ? path.shapes[2]
                               : Shape(0.5 * (path.shapes[0] + path.shapes[2]));
    EXPECT_LT(Distance(path.shapes[1], expected), 0.02 * Distance(path.shapes[0], path.shapes[2]));
    ASSERT_FALSE(summary.levels.empty());
    EXPECT_EQ(summary.levels[0].start, start == GeodesicStart::kFirst  ? "first"
                                       : start == GeodesicStart::kLast ? "last"
                                                                       : "blend");
    EXPECT_EQ(summary.levels[0].iterations, 0);
    EXPECT_EQ(summary.levels[0].termination, Termination::kCancelled);
    EXPECT_FALSE(path.converged);
    ASSERT_EQ(summary.warnings.size(), 1u);
    EXPECT_TRUE(testing::Names(summary.warnings[0], {"cancelled:"}));
  }
}

// |Phi(Q) - Phi(P)|^2 over the segments, times their number.
double ScaledEnergyOfChanges(const std::shared_ptr<const Metric>& metric,
                             const std::vector<Shape>& shapes) {
  const FeatureMap map(metric);
  double sum = 0;
  for (size_t i = 1; i < shapes.size(); ++i) {
    sum += (map.Values(shapes[i]) - map.Values(shapes[i - 1])).squaredNorm();
  }
  return static_cast<double>(shapes.size() - 1) * sum;
}

TEST(Interpolate, RowsSayWithWhatEachSolverBeganAndEnded) {
  const ShapeFamily sheet = SheetInDetail();
  const std::vector<Shape> poses = {sheet.pose(0), sheet.pose(70)};
  const auto metric = FreezeMetric({}, sheet.connectivity, poses);
  struct Case {
    GeodesicSolver solver;
    const char* name;
  };
  for (const Case& of :
       {Case{GeodesicSolver::kAutomatic, "L-BFGS"}, Case{GeodesicSolver::kLbfgs, "L-BFGS"},
        Case{GeodesicSolver::kThreadedLbfgs, "own L-BFGS"},
        Case{GeodesicSolver::kTrustRegion, "trust region"}}) {
    SCOPED_TRACE(of.name);
    GeodesicOptions options = OptionsInDetail(1);
    options.solver = of.solver;
    options.start = GeodesicStart::kBlend;
    const auto [path, summary] = Interpolate(metric, poses, options);
    ASSERT_EQ(summary.levels.size(), 1u);
    const GeodesicSummary::Level& row = summary.levels[0];
    const Shape blend = 0.5 * (path.shapes[0] + path.shapes[2]);
    const double before = ScaledEnergyOfChanges(metric, {path.shapes[0], blend, path.shapes[2]});
    const double after = ScaledEnergyOfChanges(metric, path.shapes);
    EXPECT_EQ(row.piece, 0);
    EXPECT_EQ(row.vertices, 20);
    EXPECT_EQ(row.shapes, 1);
    EXPECT_EQ(row.start, "blend");
    EXPECT_EQ(row.solver, of.name);
    EXPECT_EQ(row.termination, Termination::kConverged);
    EXPECT_GT(row.iterations, 2);
    EXPECT_GE(row.evaluations, row.iterations);
    EXPECT_NEAR(row.initial_energy, before, 1e-6 * before);
    EXPECT_NEAR(row.energy, after, 1e-9 * after);
    EXPECT_LT(after, 0.99 * before);
    EXPECT_GE(row.remaining, 0);
    EXPECT_LT(row.remaining, 1e-5);
    EXPECT_TRUE(row.kept);
    EXPECT_GT(row.seconds, 0);

    options.max_iterations = 2;
    const auto [unfinished, short_one] = Interpolate(metric, poses, options);
    const GeodesicSummary::Level& early = short_one.levels[0];
    EXPECT_EQ(early.iterations, 2);
    EXPECT_EQ(early.termination, Termination::kMaxIterations);
    EXPECT_NEAR(early.initial_energy, before, 1e-6 * before);
    EXPECT_LT(early.energy, before);
    EXPECT_GE(early.energy, after * (1 - 1e-9));
    EXPECT_FALSE(unfinished.converged);
    EXPECT_TRUE(testing::Names(short_one.warnings[0], {"1", "piece 0", "max_iterations"}));
  }
}

TEST(Interpolate, TheRigidStartHasARowOfItsOwnInEachPiece) {
  const ShapeFamily sheet = SheetInDetail();
  GeodesicOptions options = OptionsInDetail(1);
  options.start = GeodesicStart::kRigid;
  const GeodesicSummary summary =
      Interpolate(sheet.connectivity, {sheet.pose(0), sheet.pose(70), sheet.pose(10)}, options)
          .summary;
  ASSERT_EQ(summary.levels.size(), 4u);
  for (const int piece : {0, 1}) {
    const GeodesicSummary::Level &rigid = summary.levels[2 * piece],
                                 &own = summary.levels[2 * piece + 1];
    EXPECT_EQ(rigid.piece, piece);
    EXPECT_EQ(rigid.start, "blend");
    EXPECT_EQ(rigid.solver, "L-BFGS, rigid metric");
    EXPECT_EQ(rigid.vertices, 20);
    EXPECT_EQ(rigid.shapes, 1);
    EXPECT_EQ(own.piece, piece);
    EXPECT_EQ(own.start, "rigid");
    EXPECT_EQ(own.solver, "L-BFGS");
  }
}

// Between the second pose and a copy of it there is nothing to solve.
TEST(Interpolate, ARigidCopyHasARowThatSaysThatNothingWasSolved) {
  const ShapeFamily sheet = SheetInDetail();
  const Shape bent = sheet.pose(70);
  const Shape copy = (testing::Rotation(40, {1, 2, 3}) * bent).colwise() + Eigen::Vector3d(3, 1, 2);
  const auto [path, summary] =
      Interpolate(sheet.connectivity, {sheet.pose(0), bent, copy}, OptionsInDetail(5));
  const GeodesicSummary::Level& row = summary.levels.back();
  EXPECT_EQ(row.piece, 1);
  EXPECT_EQ(row.vertices, 20);
  EXPECT_EQ(row.shapes, 5);
  EXPECT_EQ(row.start, "blend");
  EXPECT_EQ(row.solver, "none");
  EXPECT_EQ(row.iterations, 0);
  EXPECT_EQ(row.initial_energy, row.energy);
  EXPECT_LT(row.energy, 1e-18);
  EXPECT_TRUE(row.kept);
  ASSERT_EQ(path.NumShapes(), 13);
  EXPECT_EQ(path.poses, (std::vector<int>{0, 6, 12}));
  for (int i = 0; i <= 12; ++i) EXPECT_NEAR(path.parameters[i], i / 12.0, 1e-15);
  // The copy's motion is a screw of even speed.
  const Eigen::Vector3d way = path.motions[12].translation - path.motions[6].translation;
  EXPECT_LT((path.motions[8].translation - path.motions[6].translation - way / 3).norm(), 1e-12);
  EXPECT_LT((path.motions[8].rotation * path.motions[6].rotation.transpose() -
             testing::Rotation(40 / 3.0, {1, 2, 3}))
                .norm(),
            1e-9);
}

// A second pair does not carry the first one's figures, and is solved as if it were alone.
TEST(Interpolator, EachPairHasASummaryOfItsOwn) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(60), bar.pose(90)};
  const Interpolator interpolator(bar.connectivity, poses, OptionsInDetail(3, 1e-6));
  const GeodesicSummary first = interpolator.Between(poses[0], poses[1]).summary;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const auto [path, summary] = interpolator.Between(poses[2], poses[1]);
    EXPECT_LT(testing::Distance(path.Placed(0), poses[2]), 1e-12);
    EXPECT_LT(testing::Distance(path.Placed(4), poses[1]), 1e-12);
    EXPECT_EQ(summary.hierarchy, first.hierarchy);
    EXPECT_EQ(summary.factor_nonzeros, first.factor_nonzeros);
    EXPECT_EQ(summary.estimated_bytes, first.estimated_bytes);
    EXPECT_EQ(summary.poses, 2);
    EXPECT_EQ(summary.freeze_seconds, 0);
    EXPECT_EQ(summary.hierarchy_seconds, 0);
    EXPECT_GE(summary.total_seconds, summary.solve_seconds);
    EXPECT_NEAR(summary.energy, ScaledEnergyOfChanges(path.metric, path.shapes),
                1e-9 * summary.energy);
    EXPECT_GE(summary.factor_seconds, 0);
    least = std::min(least, summary.factor_seconds);
  }
  EXPECT_LT(least, first.factor_seconds);  // the factors are kept
}

}  // namespace
}  // namespace shapespace
