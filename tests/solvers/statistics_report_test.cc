// What averages, shape models, regressions and comparisons of groups say of themselves, word by
// word, of numbers that all differ.

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <shapespace/statistics/assess.h>
#include <shapespace/statistics/average.h>
#include <shapespace/statistics/regression.h>
#include <shapespace/statistics/shape_model.h>

namespace shapespace {
namespace {

using nlohmann::json;

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

TEST(AverageSummary, ReportsHaveEveryNumber) {
  AverageSummary summary = AverageOfNumbers();
  EXPECT_DOUBLE_EQ(summary.Ratio(), 1.2);
  EXPECT_EQ(summary.BriefReport(),
            "NOT CONVERGED: stalled: 11 vertices, average of 3 poses; 1.2000 of the lower bound, "
            "edges off their means by 3.75% rms; 3.50 s");
  EXPECT_EQ(summary.FullReport(),
            "Average           NOT CONVERGED: stalled after 17 iterations\n"
            "Mesh              11 vertices, 22 triangles; 3 poses\n"
            "Metric            strain 1; unit of length 2.5\n"
            "Variance          0.125 of the poses' features\n"
            "Residual          0.0625 of it: no shape has exactly the mean features\n"
            "Distances         0.6, the mean of their squares to the poses\n"
            "Lower bound       0.5 for any shape; ratio 1.2000\n"
            "Refined           in 6 rounds, by 1.5% of the squared distances\n"
            "Edges             3.75% rms off the poses' means\n"
            "Hinges            4 without a mean angle\n"
            "Seconds           1.250 for the lower bound, 3.500 in all\n"
            "Warning: one\n"
            "Warning: two\n");
  const json expected = {{"termination", "stalled"},
                         {"converged", false},
                         {"vertices", 11},
                         {"triangles", 22},
                         {"poses", 3},
                         {"metric", "strain 1"},
                         {"unit", 2.5},
                         {"variance", 0.125},
                         {"residual", 0.0625},
                         {"energy", 0.6},
                         {"lower_bound", 0.5},
                         {"ratio", 0.6 / 0.5},
                         {"edge_rms", 0.0375},
                         {"ambiguous_hinges", 4},
                         {"iterations", 17},
                         {"refinements", 6},
                         {"refined_by", 0.015},
                         {"estimated_bytes", 1e5},
                         {"certificate_seconds", 1.25},
                         {"total_seconds", 3.5},
                         {"warnings", {"one", "two"}}};
  EXPECT_EQ(json::parse(summary.ToJson()), expected);
}

TEST(AverageSummary, WithoutABoundOrRefinementThereIsNoWordOfThem) {
  AverageSummary summary = AverageOfNumbers();
  summary.termination = Termination::kConverged;
  summary.energy = summary.lower_bound = kNotComputed;
  summary.refinements = 0;
  EXPECT_TRUE(std::isnan(summary.Ratio()));
  EXPECT_EQ(summary.BriefReport(),
            "converged: 11 vertices, average of 3 poses; edges off their means by 3.75% rms; "
            "3.50 s");
  const std::string report = summary.FullReport();
  for (const char* word : {"Distances", "Lower bound", "Refined"}) {
    EXPECT_EQ(report.find(word), std::string::npos) << word;
  }
}

TEST(ShapeModelSummary, ReportsHaveEveryNumber) {
  ShapeModelSummary summary;
  summary.average = AverageOfNumbers();
  summary.average.termination = Termination::kMaxIterations;
  summary.modes = 2;
  summary.rank = 4;
  summary.variances = {0.5, 0.25, 0.15, 0.1};
  summary.warnings = {"one", "two", "three"};
  summary.total_seconds = 7.25;
  EXPECT_FALSE(summary.Converged());
  EXPECT_EQ(summary.BriefReport(),
            "NOT CONVERGED: out of iterations: 11 vertices, 3 poses, 2 modes; 50.0, 25.0% of the "
            "variance; 7.25 s");
  // The warnings of the average are not repeated.
  EXPECT_EQ(summary.FullReport(),
            summary.average.FullReport() +
                "Modes             2 of 4\n"
                "  mode 1           50.00% of the variance,  50.00% with those before\n"
                "  mode 2           25.00% of the variance,  75.00% with those before\n"
                "  mode 3           15.00% of the variance,  90.00% with those before\n"
                "  mode 4           10.00% of the variance, 100.00% with those before\n"
                "Seconds           7.250 with the modes\n"
                "Warning: three\n");
  const json expected = {{"termination", "max_iterations"},
                         {"converged", false},
                         {"average", json::parse(summary.average.ToJson())},
                         {"modes", 2},
                         {"rank", 4},
                         {"variances", {0.5, 0.25, 0.15, 0.1}},
                         {"warnings", {"one", "two", "three"}},
                         {"total_seconds", 7.25}};
  EXPECT_EQ(json::parse(summary.ToJson()), expected);
  // Of many modes three are named, and of none no share.
  summary.modes = 4;
  EXPECT_NE(summary.BriefReport().find("4 modes; 50.0, 25.0, 15.0% of the variance; 7.25 s"),
            std::string::npos);
  summary.modes = 0;
  EXPECT_NE(summary.BriefReport().find("0 modes; 7.25 s"), std::string::npos);
}

TEST(Assessment, ReportsHaveEveryNumber) {
  Assessment assessment;
  assessment.rows = {{1, 0.5, 0.01, 0.02, 0.03, 0.04}, {2, 0.75, 0.005, 0.006, 0.07, 0.08}};
  assessment.poses = 9;
  assessment.unconverged = 5;
  assessment.total_seconds = 2.5;
  EXPECT_EQ(assessment.FullReport(),
            "Modes  compactness  generalisation  (edges)  specificity  beyond the poses' edges\n"
            "    1       50.00%          1.000%    2.00%       3.000%                    4.00%\n"
            "    2       75.00%          0.500%    0.60%       7.000%                    8.00%\n");
  const json first = {{"modes", 1},
                      {"compactness", 0.5},
                      {"generalisation", 0.01},
                      {"generalisation_edges", 0.02},
                      {"specificity", 0.03},
                      {"beyond", 0.04}};
  const json second = {{"modes", 2},
                       {"compactness", 0.75},
                       {"generalisation", 0.005},
                       {"generalisation_edges", 0.006},
                       {"specificity", 0.07},
                       {"beyond", 0.08}};
  const json expected = {
      {"rows", {first, second}}, {"poses", 9}, {"unconverged", 5}, {"total_seconds", 2.5}};
  EXPECT_EQ(json::parse(assessment.ToJson()), expected);
}

TEST(Regression, ReportsHaveEveryNumber) {
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
  EXPECT_EQ(regression.FullReport(),
            "The scalars explain 87.5% of the variance (p = 0.0125).\n"
            "age (10 to 30): p = 0.2500; per unit, in standard deviations of the modes: 1 3 5\n"
            "weight (20 to 45): p = 0.0300; per unit, in standard deviations of the modes: -2 4 "
            "6\n");
  const json slopes = json::array({{1.0, 3.0, 5.0}, {-2.0, 4.0, 6.0}});
  const json expected = {{"scalars", {"age", "weight"}},
                         {"intercept", {0.5, 1.5, 2.5}},
                         {"slopes", slopes},
                         {"least", {10.0, 20.0}},
                         {"most", {30.0, 45.0}},
                         {"mean", {15.0, 25.0}},
                         {"r_squared", 0.875},
                         {"p_value", 0.0125},
                         {"p_values", {0.25, 0.03}}};
  EXPECT_EQ(json::parse(regression.ToJson()), expected);
  EXPECT_EQ(regression.CoordinatesAt(Eigen::Vector2d(2, 1)), Eigen::Vector3d(0.5, 11.5, 18.5));
}

TEST(GroupDifference, ReportsHaveEveryNumber) {
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
  EXPECT_EQ(ReportOf({one, other}),
            "cats (3 poses) and dogs (5 poses), in 2 modes: T^2 = 12.5, p = 0.2500; distance of "
            "the means 0.5, p = 0.1250\n"
            "foals (3 poses) and dogs (5 poses), in 2 modes: T^2 = 12.5, p = 0.2500; distance of "
            "the means 0.5, p = 0.1250\n");
  const json written = json::parse(JsonTextOf({one, other}));
  const json expected = {{"first", "cats"},     {"second", "dogs"}, {"first_count", 3},
                         {"second_count", 5},   {"modes", 2},       {"t_squared", 12.5},
                         {"t_squared_p", 0.25}, {"distance", 0.5},  {"distance_p", 0.125}};
  ASSERT_EQ(written.size(), 2u);
  EXPECT_EQ(written[0], expected);
  EXPECT_EQ(written[1]["first"], "foals");
}

}  // namespace
}  // namespace shapespace
