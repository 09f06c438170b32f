// The figures of geodesics, each worked out from the path.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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

using testing::MessageOf;
using testing::Names;
using testing::Refuses;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(GeodesicSummary, TheRatioIsOneOfCopiesAndInfiniteWhereTheBoundIsZero) {
  GeodesicSummary summary;
  summary.energy = 0.9e-18;
  summary.lower_bound = 1e-20;
  EXPECT_EQ(summary.Ratio(), 1);
  summary.energy = 1.1e-18;
  EXPECT_EQ(summary.Ratio(), std::numeric_limits<double>::infinity());
  summary.lower_bound = 2.2e-18;
  EXPECT_DOUBLE_EQ(summary.Ratio(), 0.5);
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
      std::vector<std::vector<std::string>> expected;
      for (const auto& level : summary.levels) {
        if (level.kept && level.termination == Termination::kMaxIterations) {
          expected.push_back({std::to_string(level.shapes) + " shapes",
                              "piece " + std::to_string(level.piece), "max_iterations"});
        }
      }
      if (summary.intersections > 5) {
        expected.push_back({std::to_string(std::lround(summary.intersections)), "avoid_contact"});
        ++crossing;
      }
      if (summary.energy / summary.lower_bound > 1.5) {
        expected.push_back({std::to_string(summary.energy / summary.lower_bound), "lower bound"});
        ++poor;
      }
      if (summary.quality.speed_max > 1.15) {
        expected.push_back({std::to_string(summary.quality.speed_max), "fast"});
        ++uneven;
      }
      if (summary.quality.folds > 1e-3 * of.connectivity->NumHinges()) {
        expected.push_back({std::to_string(std::lround(summary.quality.folds)) + " folds"});
      }
      EXPECT_TRUE(testing::EachNames(summary.warnings, expected)) << summary.FullReport();
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
  EXPECT_TRUE(Names(refusal([](GeodesicOptions* o) { o->shapes = 0; }, {a, b}), {"shapes:", "1"}));
  EXPECT_TRUE(Names(refusal([](GeodesicOptions* o) { o->tolerance = 1; }, {a, b}),
                    {"tolerance:", "0", "1"}));
  EXPECT_TRUE(Names(refusal([](GeodesicOptions* o) { o->max_iterations = 0; }, {a, b}),
                    {"max_iterations:", "1"}));
  EXPECT_TRUE(
      Names(refusal([](GeodesicOptions* o) { o->memory_limit = 0; }, {a, b}), {"memory_limit:"}));
  EXPECT_TRUE(
      Names(refusal([](GeodesicOptions* o) { o->metric.strain = -1; }, {a, b}), {"strain:"}));
  EXPECT_TRUE(Names(refusal([](GeodesicOptions* o) { o->via.emplace_back(3, 20); }, {a, b}),
                    {"via:", "avoid_contact"}));
  EXPECT_TRUE(Names(refusal(
                        [](GeodesicOptions* o) {
                          o->avoid_contact = true;
                          o->via.emplace_back(Shape::Zero(3, 20));
                        },
                        {a, b, a}),
                    {"via:"}));
  EXPECT_TRUE(Names(refusal([](GeodesicOptions* o) { o->memory_limit = 100; }, {a, b}),
                    {"this solve", "fewer shapes"}));
  EXPECT_TRUE(Names(refusal(nothing, {a}), {"two poses"}));
  EXPECT_TRUE(Names(refusal(nothing, {}), {"two poses"}));
  EXPECT_TRUE(Names(refusal(nothing, {a, Shape::Zero(3, 19)}), {"a pose"}));
  for (const size_t i : {0, 1, 2}) {
    std::vector<Shape> poses = {a, b, a};
    poses[i](2, 19) = kNotANumber;
    EXPECT_TRUE(Names(refusal(nothing, poses), {"a pose"})) << i;
  }
  GeodesicOptions via = ReportedOptions(1);
  via.avoid_contact = true;
  via.via = {a};
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [&] {
        Interpolator(sheet.connectivity, {a, b}, via);
      },
      {"via:"}));
  const Interpolator interpolator(sheet.connectivity, {a, b}, ReportedOptions(1));
  Shape broken = b;
  broken(0, 3) = kNotANumber;
  EXPECT_TRUE(Refuses<MeshError>([&] { interpolator.Between(broken, a); }, {"a pose"}));
  EXPECT_TRUE(Refuses<MeshError>([&] { interpolator.Between(a, broken); }, {"a pose"}));
}

}  // namespace
}  // namespace shapespace
