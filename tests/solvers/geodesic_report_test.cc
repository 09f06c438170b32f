// What geodesics say of themselves, word by word, of numbers that all differ, and the figures of
// real ones, each worked out from the path.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <shapespace/analysis/intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/memory.h>
#include <shapespace/metric/feature_map.h>

#include "support/cut_ring.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using nlohmann::json;
using testing::MessageOf;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

PathQuality GeodesicQualityOfNumbers() {
  PathQuality quality;
  quality.inner_shapes = 14;
  quality.edge_rms = 0.01;
  quality.edge_p99 = 0.02;
  quality.edge_max = 0.03;
  quality.first_rms = 0.04;
  quality.first_p99 = 0.05;
  quality.first_max = 0.06;
  quality.roughness = 7.5;
  quality.folds = 8.5;
  quality.speed_max = 1.25;
  return quality;
}

GeodesicSummary GeodesicOfNumbers() {
  GeodesicSummary summary;
  summary.termination = Termination::kMaxIterations;
  summary.vertices = 11;
  summary.triangles = 22;
  summary.edges = 33;
  summary.hinges = 44;
  summary.poses = 3;
  summary.shapes = 7;
  summary.metric = "strain 1";
  summary.unit = 2.5;
  summary.energy = 0.375;
  summary.lower_bound = 0.25;
  summary.parts = {{"strain", 0.25}, {"bending", 0.125}};
  summary.quality = GeodesicQualityOfNumbers();
  summary.intersections = 4.5;
  summary.crossings_between = 6;
  summary.uncertified_segments = 5;
  summary.contact_distance = 0.0625;
  summary.hierarchy = {9, 11};
  summary.hierarchy_stopped_early = true;
  summary.levels = {{0, 9, 1, "blend", "L-BFGS", Termination::kConverged, 10, 12, 13.5, 12.5,
                     0.015625, true, 0.125},
                    {1, 11, 7, "lifted", "trust region", Termination::kStalled, 15, 16, 17.5, 16.5,
                     0.03125, false, 0.25}};
  summary.warnings = {"one", "two"};
  summary.estimated_bytes = 3e6;
  summary.freeze_seconds = 0.5;
  summary.hierarchy_seconds = 1.5;
  summary.factor_seconds = 2.5;
  summary.solve_seconds = 3.5;
  summary.contact_seconds = 4.5;
  summary.total_seconds = 15.5;
  summary.factor_nonzeros = 123;
  summary.threads = 4;
  return summary;
}

const char kGeodesicBriefly[] =
    "NOT CONVERGED: out of iterations: 11 vertices, 3 poses, 7 shapes inserted; energy 0.375, "
    "1.5000 of its lower bound; edges off by 1% rms, roughness 7.5 degrees, 8.5 folds; 15.50 s";

TEST(GeodesicSummary, ReportsHaveEveryNumber) {
  const GeodesicSummary summary = GeodesicOfNumbers();
  EXPECT_EQ(summary.BriefReport(), kGeodesicBriefly);
  EXPECT_EQ(summary.FullReport(),
            "Termination       NOT CONVERGED: out of iterations\n"
            "Mesh              11 vertices, 22 triangles, 33 edges, 44 hinges; 3 poses\n"
            "Path              7 shapes inserted between poses\n"
            "Metric            strain 1; unit of length 2.5\n"
            "Energy            0.375  strain 0.25  bending 0.125\n"
            "Lower bound       0.25; energy / bound 1.50000\n"
            "Edges, expected   rms 1%, 99th percentile 2%, max 3%\n"
            "Edges, first pose rms 4%, 99th percentile 5%, max 6%\n"
            "Roughness         7.5 degrees; folds 8.5 per inner shape\n"
            "Speed             at most 1.25 times the mean of the piece\n"
            "Intersections     4.5 pairs of triangles more than in the poses\n"
            "Contact           5 segments not shown to be free of it; 6 crossings at most between "
            "shapes; least distance 0.0625; 4.500 s\n"
            "Hierarchy         9, 11 vertices (no further edge could be collapsed)\n"
            "\n"
            "piece vertices shapes start     solver        iterations  evaluations  energy before  "
            "energy after   remaining  seconds\n"
            "    0        9      1 blend     L-BFGS                10           12           13.5"
            "          12.5       0.016    0.125\n"
            "    1       11      7 lifted    trust region          15           16           17.5"
            "          16.5       0.031    0.250  (not kept)  (not converged)\n"
            "\n"
            "Time              15.500 s: metric 0.500, hierarchy 1.500, solves 3.500; of which "
            "factorisation 2.500 (123 numbers); 4 threads\n"
            "Memory            about 3 MB estimated\n"
            "Warning: one\n"
            "Warning: two\n");
}

TEST(GeodesicSummary, JsonHasEveryNumber) {
  const json quality = {{"inner_shapes", 14}, {"edge_rms", 0.01},  {"edge_p99", 0.02},
                        {"edge_max", 0.03},   {"first_rms", 0.04}, {"first_p99", 0.05},
                        {"first_max", 0.06},  {"roughness", 7.5},  {"folds", 8.5},
                        {"speed_max", 1.25}};
  const json levels = {{{"termination", "converged"},
                        {"piece", 0},
                        {"vertices", 9},
                        {"shapes", 1},
                        {"start", "blend"},
                        {"solver", "L-BFGS"},
                        {"iterations", 10},
                        {"evaluations", 12},
                        {"initial_energy", 13.5},
                        {"energy", 12.5},
                        {"remaining", 0.015625},
                        {"kept", true},
                        {"seconds", 0.125}},
                       {{"termination", "stalled"},
                        {"piece", 1},
                        {"vertices", 11},
                        {"shapes", 7},
                        {"start", "lifted"},
                        {"solver", "trust region"},
                        {"iterations", 15},
                        {"evaluations", 16},
                        {"initial_energy", 17.5},
                        {"energy", 16.5},
                        {"remaining", 0.03125},
                        {"kept", false},
                        {"seconds", 0.25}}};
  const json expected = {{"termination", "max_iterations"},
                         {"converged", false},
                         {"vertices", 11},
                         {"triangles", 22},
                         {"edges", 33},
                         {"hinges", 44},
                         {"poses", 3},
                         {"shapes", 7},
                         {"metric", "strain 1"},
                         {"unit", 2.5},
                         {"energy", 0.375},
                         {"lower_bound", 0.25},
                         {"quality", quality},
                         {"intersections", 4.5},
                         {"crossings_between", 6},
                         {"uncertified_segments", 5},
                         {"contact_distance", 0.0625},
                         {"hierarchy", {9, 11}},
                         {"hierarchy_stopped_early", true},
                         {"levels", levels},
                         {"estimated_bytes", 3e6},
                         {"freeze_seconds", 0.5},
                         {"hierarchy_seconds", 1.5},
                         {"factor_seconds", 2.5},
                         {"solve_seconds", 3.5},
                         {"contact_seconds", 4.5},
                         {"total_seconds", 15.5},
                         {"factor_nonzeros", 123},
                         {"threads", 4},
                         {"ratio", 1.5},
                         {"parts", {{"strain", 0.25}, {"bending", 0.125}}},
                         {"warnings", {"one", "two"}}};
  EXPECT_EQ(json::parse(GeodesicOfNumbers().ToJson()), expected);
}

TEST(GeodesicSummary, WhatThereIsNoneOfIsNotReported) {
  GeodesicSummary summary = GeodesicOfNumbers();
  summary.termination = Termination::kConverged;
  summary.threads = 1;
  summary.uncertified_segments = -1;
  summary.hierarchy_stopped_early = false;
  summary.quality.speed_max = summary.lower_bound = kNotANumber;
  EXPECT_EQ(summary.BriefReport().substr(0, 56),
            "converged: 11 vertices, 3 poses, 7 shapes inserted; ener");
  EXPECT_NE(summary.BriefReport().find("energy 0.375, n/a of its lower bound; "),
            std::string::npos);
  const std::string report = summary.FullReport();
  EXPECT_EQ(report.find("Contact"), std::string::npos);
  for (const char* line :
       {"Termination       converged\n", "Lower bound       n/a (the rigid metric has none)\n",
        "Speed             n/a\n", "Hierarchy         9, 11 vertices\n\n",
        "(123 numbers); 1 thread\n"}) {
    EXPECT_NE(report.find(line), std::string::npos) << line;
  }
  summary.uncertified_segments = 0;
  EXPECT_NE(summary.FullReport().find("Contact           0 segments"), std::string::npos);
}

TEST(GeodesicSummary, TheRatioIsOneOfCopiesAndInfiniteWhereTheBoundIsZero) {
  GeodesicSummary summary;
  summary.energy = 0.9e-18;
  summary.lower_bound = 1e-20;
  EXPECT_EQ(summary.Ratio(), 1);
  summary.energy = 1.1e-18;
  EXPECT_EQ(summary.Ratio(), std::numeric_limits<double>::infinity());
  summary.lower_bound = 2.2e-18;
  EXPECT_DOUBLE_EQ(summary.Ratio(), 0.5);
  // A ratio of millions says nothing.
  summary.energy = 0.9;
  summary.lower_bound = 1e-6;
  EXPECT_NE(summary.BriefReport().find(", 900000.0000 of its"), std::string::npos);
  summary.energy = 1.1;
  EXPECT_NE(summary.BriefReport().find(", n/a of its"), std::string::npos);
}

// A sheet of 5 x 4 vertices: by Euler's formula it has 43 edges, 14 of them at its border.
ShapeFamily ReportedSheet() { return MakeSheet(2, 1, 4, 3); }

GeodesicOptions ReportedOptions(int shapes, double tolerance = 1e-12) {
  GeodesicOptions options;
  options.shapes = shapes;
  options.tolerance = tolerance;
  options.max_iterations = 5000;
  return options;
}

// |Phi(Q) - Phi(P)|^2 under one feature of a metric, or under all of them, summed over the segments
// of shapes first ... last, times their number.
double ScaledSumOfChanges(const Metric& metric, int feature, const Path& path, int first,
                          int last) {
  auto part = std::make_shared<Metric>(metric);
  if (feature >= 0) part->features = {metric.features[feature]};
  const FeatureMap map(part);
  double sum = 0;
  for (int i = first; i < last; ++i) {
    sum += (map.Values(path.shapes[i + 1]) - map.Values(path.shapes[i])).squaredNorm();
  }
  return (last - first) * sum;
}

TEST(Interpolate, TheSummarySaysOfWhatThePathIs) {
  const ShapeFamily sheet = ReportedSheet();
  const std::vector<Shape> poses = {sheet.pose(0), sheet.pose(50), sheet.pose(20)};
  GeodesicOptions options = ReportedOptions(3);
  const auto [path, summary] = Interpolate(sheet.connectivity, poses, options);
  EXPECT_EQ(summary.termination, Termination::kConverged);
  EXPECT_TRUE(path.converged);
  EXPECT_EQ(summary.vertices, 20);
  EXPECT_EQ(summary.triangles, 24);
  EXPECT_EQ(summary.edges, 43);
  EXPECT_EQ(summary.hinges, 29);
  EXPECT_EQ(summary.poses, 3);
  EXPECT_EQ(summary.shapes, 3);
  EXPECT_EQ(summary.unit, path.metric->unit);
  EXPECT_NEAR(summary.unit, std::sqrt(2), 0.1);
  EXPECT_EQ(summary.metric, DescribeMetric(path.metric->options));
  EXPECT_EQ(summary.hierarchy.back(), 20);
  EXPECT_EQ(summary.threads, NumThreads());
  // Three shapes, and seven where a jump is removed.
  EXPECT_EQ(summary.estimated_bytes, internal::GeodesicBytes(*path.metric, 3, 7));
  EXPECT_GT(summary.factor_nonzeros, 20u);
  EXPECT_GT(summary.freeze_seconds, 0);
  EXPECT_GT(summary.hierarchy_seconds, 0);
  EXPECT_GT(summary.factor_seconds, 0);
  EXPECT_GT(summary.solve_seconds, summary.factor_seconds);
  EXPECT_GT(summary.total_seconds,
            summary.freeze_seconds + summary.hierarchy_seconds + summary.solve_seconds);
  EXPECT_EQ(summary.contact_seconds, 0);
  EXPECT_TRUE(std::isnan(summary.crossings_between));
  EXPECT_EQ(summary.uncertified_segments, -1);

  // The energies of both pieces, feature by feature.
  ASSERT_EQ(summary.parts.size(), path.metric->features.size());
  double all = 0;
  for (size_t f = 0; f < summary.parts.size(); ++f) {
    const int feature = static_cast<int>(f);
    const double expected = ScaledSumOfChanges(*path.metric, feature, path, 0, 4) +
                            ScaledSumOfChanges(*path.metric, feature, path, 4, 8);
    EXPECT_EQ(summary.parts[f].first, path.metric->features[f]->Name());
    EXPECT_NEAR(summary.parts[f].second, expected, 1e-9 * summary.energy) << f;
    all += expected;
  }
  EXPECT_NEAR(summary.energy, all, 1e-9 * all);
  // The rows' as well: the last kept one of each piece is that of the path.
  for (const int piece : {0, 1}) {
    double last = 0;
    for (const auto& level : summary.levels) {
      if (level.piece == piece && level.kept && level.shapes == 3) last = level.energy;
    }
    const double expected = ScaledSumOfChanges(*path.metric, -1, path, 4 * piece, 4 * piece + 4);
    EXPECT_NEAR(last, expected, 1e-9 * all) << piece;
  }
  const PathQuality quality = MeasureQuality(path);
  EXPECT_EQ(summary.quality.edge_rms, quality.edge_rms);
  EXPECT_EQ(summary.quality.first_max, quality.first_max);
  EXPECT_EQ(summary.intersections, 0);
}

// Under one metric, a path through three poses is that of its pieces.
TEST(Interpolate, EnergiesAndBoundsAddUpOverPieces) {
  const ShapeFamily sheet = ReportedSheet();
  const Shape a = sheet.pose(0), b = sheet.pose(60), c = sheet.pose(150);
  for (const MetricOptions& kind : {MetricOptions(), MetricOptions::Isometric()}) {
    const auto metric = FreezeMetric(kind, sheet.connectivity, {a, b, c});
    const GeodesicSummary both = Interpolate(metric, {a, b, c}, ReportedOptions(3)).summary;
    const GeodesicSummary first = Interpolate(metric, {a, b}, ReportedOptions(3)).summary;
    const GeodesicSummary second = Interpolate(metric, {b, c}, ReportedOptions(3)).summary;
    EXPECT_NEAR(both.energy, first.energy + second.energy, 1e-6 * both.energy);
    EXPECT_NEAR(both.lower_bound, first.lower_bound + second.lower_bound, 1e-9 * both.lower_bound);
    EXPECT_GT(first.lower_bound, 0.1 * second.lower_bound);
    EXPECT_EQ(both.freeze_seconds, 0);
  }
}

TEST(Interpolate, WhatIsNotMeasuredIsNotANumber) {
  const ShapeFamily sheet = ReportedSheet();
  GeodesicOptions options = ReportedOptions(1, 1e-4);
  options.assess = false;
  const GeodesicSummary summary =
      Interpolate(sheet.connectivity, {sheet.pose(0), sheet.pose(50)}, options).summary;
  const PathQuality& q = summary.quality;
  for (const double figure :
       {q.edge_rms, q.edge_p99, q.edge_max, q.first_rms, q.first_p99, q.first_max, q.roughness,
        q.folds, q.speed_max, summary.intersections, summary.crossings_between}) {
    EXPECT_TRUE(std::isnan(figure));
  }
  EXPECT_TRUE(summary.warnings.empty());
}

// The ends of the ring pass through each other on their way.
TEST(Interpolate, CountsIntersectionsAtTheQuartersOfEachPiece) {
  const testing::CutRing ring;
  const std::vector<Shape> poses = {ring.poses[0], ring.poses[1], ring.poses[0]};
  const auto [path, summary] = Interpolate(ring.connectivity, poses, ReportedOptions(3, 1e-6));
  const std::vector<std::int64_t> pairs = CountIntersections(*ring.connectivity, path.shapes);
  ASSERT_EQ(pairs.size(), 9u);
  double sum = 0;
  for (const int i : {1, 2, 3, 5, 6, 7}) {
    const int piece = i / 4;
    sum += static_cast<double>(
        std::max<std::int64_t>(0, pairs[i] - std::max(pairs[4 * piece], pairs[4 * piece + 4])));
  }
  EXPECT_GT(sum, 0);
  EXPECT_NEAR(summary.intersections, sum / 6, 1e-12);
}

// Each warning stands exactly where its figure is beyond what is usual.
TEST(Interpolate, WarnsOfWhatIsProbablyNotWanted) {
  const testing::CutRing ring;
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2), sheet = MakeSheet(1, 1, 12, 12);
  Shape ruffled = sheet.pose(0);
  for (int v = 0; v < ruffled.cols(); ++v) ruffled(2, v) += 0.2 * std::sin(5.0 * v * v);
  struct Case {
    std::shared_ptr<const Connectivity> connectivity;
    std::vector<Shape> poses;
  };
  int crossing = 0, poor = 0, uneven = 0;
  for (const Case& of :
       {Case{ring.connectivity, ring.poses}, Case{bar.connectivity, {bar.pose(0), bar.pose(340)}},
        Case{sheet.connectivity, {sheet.pose(0), ruffled}}}) {
    for (const int iterations : {1, 40}) {
      GeodesicOptions options = ReportedOptions(7, 1e-9);
      options.max_iterations = iterations;
      options.schedule = GeodesicSchedule::kFlat;
      options.start = GeodesicStart::kLast;
      const GeodesicSummary summary = Interpolate(of.connectivity, of.poses, options).summary;
      std::vector<std::string> expected;
      for (const auto& level : summary.levels) {
        if (level.kept && level.termination == Termination::kMaxIterations) {
          expected.push_back("the level of " + std::to_string(level.shapes) + " shapes of piece " +
                             std::to_string(level.piece) +
                             " ran out of iterations; raise max_iterations or the tolerance");
        }
      }
      if (summary.intersections > 5) {
        expected.push_back("the body intersects itself: inner shapes have " +
                           std::to_string(std::lround(summary.intersections)) +
                           " more pairs of intersecting triangles than the poses; avoid_contact "
                           "prevents this");
        ++crossing;
      }
      if (summary.energy / summary.lower_bound > 1.5) {
        expected.push_back("the energy is " + std::to_string(summary.energy / summary.lower_bound) +
                           " times its lower bound: the path may be a poor local minimum");
        ++poor;
      }
      if (summary.quality.speed_max > 1.15) {
        expected.push_back("some segment is " + std::to_string(summary.quality.speed_max) +
                           " times as fast as the mean: a part may rest and then jump; check the "
                           "pictures");
        ++uneven;
      }
      if (summary.quality.folds > 1e-3 * of.connectivity->NumHinges()) {
        expected.push_back("inner shapes have " +
                           std::to_string(std::lround(summary.quality.folds)) +
                           " folds that the poses do not have: check the pictures");
      }
      EXPECT_EQ(summary.warnings, expected) << summary.FullReport();
    }
  }
  EXPECT_GT(crossing, 0);
  EXPECT_GT(poor, 0);
  EXPECT_GT(uneven, 0);
}

TEST(Interpolate, RefusalsNameTheFieldAndTheRemedy) {
  const ShapeFamily sheet = ReportedSheet();
  const Shape a = sheet.pose(0), b = sheet.pose(50);
  const auto metric = FreezeMetric({}, sheet.connectivity, {a, b});
  const auto refusal = [&](void (*change)(GeodesicOptions*), const std::vector<Shape>& poses) {
    GeodesicOptions options = ReportedOptions(3);
    change(&options);
    return MessageOf<Error>([&] { Interpolate(metric, poses, options); });
  };
  const auto nothing = [](GeodesicOptions*) {};
  EXPECT_EQ(refusal([](GeodesicOptions* o) { o->shapes = 0; }, {a, b}),
            "shapes: must be 1 or more");
  EXPECT_EQ(refusal([](GeodesicOptions* o) { o->tolerance = 1; }, {a, b}),
            "tolerance: must be between 0 and 1");
  EXPECT_EQ(refusal([](GeodesicOptions* o) { o->max_iterations = 0; }, {a, b}),
            "max_iterations: must be 1 or more");
  EXPECT_EQ(refusal([](GeodesicOptions* o) { o->memory_limit = 0; }, {a, b}).find("memory_limit: "),
            0u);
  EXPECT_EQ(refusal([](GeodesicOptions* o) { o->metric.strain = -1; }, {a, b}).find("strain: "),
            0u);
  EXPECT_EQ(refusal([](GeodesicOptions* o) { o->via.emplace_back(3, 20); }, {a, b}),
            "via: is for paths that avoid contact: set avoid_contact");
  EXPECT_EQ(refusal(
                [](GeodesicOptions* o) {
                  o->avoid_contact = true;
                  o->via.emplace_back(Shape::Zero(3, 20));
                },
                {a, b, a}),
            "via: is for two poses");
  EXPECT_NE(refusal([](GeodesicOptions* o) { o->memory_limit = 100; }, {a, b}).find("this solve"),
            std::string::npos);
  EXPECT_NE(refusal([](GeodesicOptions* o) { o->memory_limit = 100; }, {a, b})
                .find("insert fewer shapes"),
            std::string::npos);
  EXPECT_EQ(refusal(nothing, {a}), "a geodesic needs at least two poses");
  EXPECT_EQ(refusal(nothing, {}), "a geodesic needs at least two poses");
  const std::string unfit =
      "a pose is not finite, or has another number of vertices than the metric";
  EXPECT_EQ(refusal(nothing, {a, Shape::Zero(3, 19)}), unfit);
  for (const size_t i : {0, 1, 2}) {
    std::vector<Shape> poses = {a, b, a};
    poses[i](2, 19) = kNotANumber;
    EXPECT_EQ(refusal(nothing, poses), unfit) << i;
  }
  GeodesicOptions via = ReportedOptions(1);
  via.avoid_contact = true;
  via.via = {a};
  EXPECT_EQ(MessageOf<InvalidOptions>([&] {
              Interpolator(sheet.connectivity, {a, b}, via);
            }),
            "via: is for one path between two poses");
  const Interpolator interpolator(sheet.connectivity, {a, b}, ReportedOptions(1));
  Shape broken = b;
  broken(0, 3) = kNotANumber;
  EXPECT_EQ(MessageOf<MeshError>([&] { interpolator.Between(broken, a); }), unfit);
  EXPECT_EQ(MessageOf<MeshError>([&] { interpolator.Between(a, broken); }), unfit);
}

}  // namespace
}  // namespace shapespace
