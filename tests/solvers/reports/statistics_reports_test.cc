// What averages, shape models, regressions and comparisons of groups say of themselves, of numbers
// that all differ.

#include <string>

#include <gtest/gtest.h>

#include <shapespace/statistics/assess.h>
#include <shapespace/statistics/average.h>
#include <shapespace/statistics/regression.h>
#include <shapespace/statistics/shape_model.h>

#include "solvers/reports/texts.h"
#include "support/golden.h"

namespace shapespace {
namespace {

using testing::ExpectGolden;
using testing::GoldenText;
using testing::JsonOf;
using testing::TextsOf;

AverageSummary AverageOfNumbers() {
  AverageSummary summary;
  summary.termination = Termination::kStalled;
  summary.vertices = 11;
  summary.triangles = 22;
  summary.poses = 3;
  summary.metric = "strain 1";
  summary.unit = 2.5;
  summary.variance = 0.125;
  summary.residual = 0.0625;
  summary.energy = 0.6;
  summary.lower_bound = 0.5;
  summary.edge_rms = 0.0375;
  summary.ambiguous_hinges = 4;
  summary.iterations = 17;
  summary.refinements = 6;
  summary.refined_by = 0.015;
  summary.estimated_bytes = 1e5;
  summary.certificate_seconds = 1.25;
  summary.total_seconds = 3.5;
  summary.warnings = {"one", "two"};
  return summary;
}

TEST(Golden, Averages) {
  AverageSummary summary = AverageOfNumbers();
  GoldenText text(TextsOf(summary));
  summary.termination = Termination::kConverged;
  summary.energy = summary.lower_bound = kNotComputed;
  summary.refinements = 0;
  text.Variant("without a bound or refinement", TextsOf(summary));
  ExpectGolden("average.txt", text.Content());
}

TEST(Golden, ShapeModels) {
  ShapeModelSummary summary;
  summary.average = AverageOfNumbers();
  summary.average.termination = Termination::kMaxIterations;
  summary.modes = 2;
  summary.rank = 4;
  summary.variances = {0.5, 0.25, 0.15, 0.1};
  summary.warnings = {"one", "two", "three"};
  summary.total_seconds = 7.25;
  EXPECT_FALSE(summary.Converged());
  GoldenText text(TextsOf(summary));
  for (const int modes : {4, 0}) {
    summary.modes = modes;
    text.Variant("other numbers of modes", summary.BriefReport());
  }
  ExpectGolden("shape_model.txt", text.Content());
}

TEST(Golden, Assessments) {
  Assessment assessment;
  assessment.rows = {{1, 0.5, 0.01, 0.02, 0.03, 0.04}, {2, 0.75, 0.005, 0.006, 0.07, 0.08}};
  assessment.poses = 9;
  assessment.unconverged = 5;
  assessment.total_seconds = 2.5;
  ExpectGolden("assessment.txt", assessment.FullReport() + JsonOf(assessment.ToJson()));
}

TEST(Golden, Regressions) {
  Regression regression;
  regression.scalars = {"age", "weight"};
  regression.intercept = Eigen::Vector3d(0.5, 1.5, 2.5);
  regression.slopes = (Eigen::MatrixXd(3, 2) << 1, -2, 3, 4, 5, 6).finished();
  regression.least = Eigen::Vector2d(10, 20);
  regression.most = Eigen::Vector2d(30, 45);
  regression.mean = Eigen::Vector2d(15, 25);
  regression.r_squared = 0.875;
  regression.p_value = 0.0125;
  regression.p_values = {0.25, 0.03};
  EXPECT_EQ(regression.CoordinatesAt(Eigen::Vector2d(2, 1)), Eigen::Vector3d(0.5, 11.5, 18.5));
  ExpectGolden("regression.txt", regression.FullReport() + JsonOf(regression.ToJson()));
}

TEST(Golden, DifferencesOfGroups) {
  GroupDifference one, other;
  one.first = "cats";
  one.second = "dogs";
  one.first_count = 3;
  one.second_count = 5;
  one.modes = 2;
  one.t_squared = 12.5;
  one.t_squared_p = 0.25;
  one.distance = 0.5;
  one.distance_p = 0.125;
  other = one;
  other.first = "foals";
  ExpectGolden("group_difference.txt", ReportOf({one, other}) + JsonOf(JsonTextOf({one, other})));
}

}  // namespace
}  // namespace shapespace
