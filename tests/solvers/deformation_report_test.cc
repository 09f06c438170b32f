// What deformations, repairs and standing parts say of themselves, word by word, of numbers that
// all differ.

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/deformation/standing.h>

namespace shapespace {
namespace {

using nlohmann::json;

DeformationSummary DeformationOfNumbers() {
  DeformationSummary summary;
  summary.termination = Termination::kStalled;
  summary.vertices = 11;
  summary.triangles = 22;
  summary.shapes = 3;
  summary.metric = "strain 1";
  summary.unit = 2.5;
  summary.balance = 0.015625;
  summary.energy = 0.375;
  summary.error = {0.01, 0.02, 0.03, -0.04, 5};
  summary.handles = {{"foot", 6, true, 0.5, 0.75}, {"", 7, false, 0.25, 0.625}};
  summary.free_components = 8;
  summary.levels = {{9, 3, "handles", Termination::kConverged, 10, 12, 13.5, 14.5, 0.125},
                    {11, 3, "lifted", Termination::kStalled, 15, 16, 17.5, 18.5, 0.25}};
  summary.hierarchy = {9, 11};
  summary.uncertified_segments = 2;
  summary.contact_distance = 0.0625;
  summary.intersections = 12;
  summary.warm = true;
  summary.warnings = {"one", "two"};
  summary.estimated_bytes = 1e5;
  summary.hierarchy_seconds = 1.5;
  summary.factor_seconds = 2.5;
  summary.solve_seconds = 3.5;
  summary.contact_seconds = 4.5;
  summary.total_seconds = 15.5;
  summary.threads = 4;
  return summary;
}

TEST(DeformationSummary, ReportsHaveEveryNumber) {
  const DeformationSummary summary = DeformationOfNumbers();
  EXPECT_EQ(summary.BriefReport(),
            "NOT CONVERGED: stalled: 11 vertices, 3 shapes, 2 handles; off by at most 0.75; edges "
            "off by 1% rms, volume -4%; energy 0.375; 15.50 s");
  EXPECT_EQ(
      summary.FullReport(),
      "Termination       NOT CONVERGED: stalled\n"
      "Mesh              11 vertices, 22 triangles\n"
      "Path              3 shapes after the first, from the last solution\n"
      "Metric            strain 1; unit of length 2.5\n"
      "Balance           0.015625\n"
      "Energy            0.375\n"
      "Edges             rms 1%, 99th percentile 2%, max 3%\n"
      "Turned over       5 hinges; volume -4%\n"
      "Intersections     12 pairs of triangles more than in the mesh\n"
      "Contact           2 segments not shown to be free of it; least distance 0.0625\n"
      "Hierarchy         9, 11 vertices\n"
      "\n"
      "handle                   vertices         off, rms         off, max\n"
      "foot                            6              0.5             0.75  hard\n"
      "2                               7             0.25            0.625  soft\n"
      "\n"
      "vertices shapes start    iterations  evaluations  value before   value after  seconds\n"
      "       9      3 handles          10           12          13.5          14.5    0.125\n"
      "      11      3 lifted           15           16          17.5          18.5    0.250  (not "
      "converged)\n"
      "\n"
      "Time              15.500 s: hierarchy 1.500, factors 2.500, solves 3.500; 4 threads\n"
      "Warning: one\n"
      "Warning: two\n");
  const json error = {{"edge_rms", 0.01},
                      {"edge_p99", 0.02},
                      {"edge_max", 0.03},
                      {"volume", -0.04},
                      {"inverted_hinges", 5}};
  const json foot = {{"name", "foot"},
                     {"vertices", 6},
                     {"hard", true},
                     {"residual_rms", 0.5},
                     {"residual_max", 0.75}};
  const json level = {{"termination", "stalled"}, {"vertices", 11},   {"shapes", 3},
                      {"start", "lifted"},        {"iterations", 15}, {"evaluations", 16},
                      {"initial_value", 17.5},    {"value", 18.5},    {"seconds", 0.25}};
  json written = json::parse(summary.ToJson());
  ASSERT_EQ(written["handles"].size(), 2u);
  EXPECT_EQ(written["handles"][0], foot);
  EXPECT_EQ(written["handles"][1]["hard"], false);
  ASSERT_EQ(written["levels"].size(), 2u);
  EXPECT_EQ(written["levels"][1], level);
  written.erase("handles");
  written.erase("levels");
  const json expected = {{"termination", "stalled"},
                         {"converged", false},
                         {"vertices", 11},
                         {"triangles", 22},
                         {"shapes", 3},
                         {"metric", "strain 1"},
                         {"unit", 2.5},
                         {"balance", 0.015625},
                         {"energy", 0.375},
                         {"error", error},
                         {"free_components", 8},
                         {"hierarchy", {9, 11}},
                         {"uncertified_segments", 2},
                         {"contact_distance", 0.0625},
                         {"intersections", 12.0},
                         {"warm", true},
                         {"estimated_bytes", 1e5},
                         {"hierarchy_seconds", 1.5},
                         {"factor_seconds", 2.5},
                         {"solve_seconds", 3.5},
                         {"contact_seconds", 4.5},
                         {"total_seconds", 15.5},
                         {"threads", 4},
                         {"warnings", {"one", "two"}}};
  EXPECT_EQ(written, expected);
}

TEST(DeformationSummary, OneOfAThingIsNotSaidToBeMany) {
  DeformationSummary summary = DeformationOfNumbers();
  summary.termination = Termination::kConverged;
  summary.shapes = summary.threads = 1;
  summary.handles.pop_back();
  summary.warm = false;
  summary.uncertified_segments = -1;
  summary.error.volume = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(summary.BriefReport(),
            "converged: 11 vertices, 1 shape, 1 handle; off by at most 0.75; edges off by 1% rms, "
            "volume n/a (the mesh encloses none); energy 0.375; 15.50 s");
  const std::string report = summary.FullReport();
  EXPECT_NE(report.find("Path              1 shape after the first\n"), std::string::npos);
  EXPECT_NE(report.find("solves 3.500; 1 thread\n"), std::string::npos);
  EXPECT_EQ(report.find("Contact"), std::string::npos);
  EXPECT_TRUE(json::parse(summary.ToJson())["error"]["volume"].is_null());
}

TEST(RepairSummary, ReportsHaveEveryNumber) {
  RepairSummary summary;
  summary.deformation = DeformationOfNumbers();
  summary.before = {0.11, 0.12, 0.13, 0.14, 15};
  summary.after = {0.21, 0.22, 0.23, -0.24, 25};
  summary.moved = 0.625;
  EXPECT_FALSE(summary.Converged());
  const std::string before =
      "edges off by 11% rms, 13% at most; volume +14%; 15 hinges turned over";
  const std::string after = "edges off by 21% rms, 23% at most; volume -24%; 25 hinges turned over";
  EXPECT_EQ(summary.BriefReport(),
            "NOT CONVERGED: stalled: 11 vertices, moved by 0.625 rms; before: " + before +
                "; after: " + after + "; 15.50 s");
  EXPECT_EQ(summary.FullReport(), "Before            " + before + "\nAfter             " + after +
                                      "\nMoved             0.625 rms\n" +
                                      summary.deformation.FullReport());
  const json written = json::parse(summary.ToJson());
  EXPECT_EQ(written.size(), 6u);
  EXPECT_EQ(written["termination"], "stalled");
  EXPECT_EQ(written["converged"], false);
  EXPECT_EQ(written["deformation"], json::parse(summary.deformation.ToJson()));
  EXPECT_EQ(written["before"]["edge_rms"], 0.11);
  EXPECT_EQ(written["after"]["edge_rms"], 0.21);
  EXPECT_EQ(written["moved"], 0.625);
}

TEST(StandingSummary, ReportsHaveEveryNumber) {
  StandingSummary summary;
  summary.termination = Termination::kMaxIterations;
  summary.parts = 2;
  summary.shapes = 9;
  summary.slide_before = 0.05;
  summary.slide = 0.01;
  summary.drift = 0.02;
  summary.edge_rms = 0.03;
  summary.warnings = {"one"};
  summary.seconds = 4.5;
  EXPECT_EQ(summary.BriefReport(),
            "NOT CONVERGED: out of iterations: 2 standing parts held in 9 shapes; they slide by 1% "
            "of the diagonal (before: 5%), and are 2% apart in the poses; edges off by at most 3% "
            "rms; 4.50 s");
  const json expected = {{"termination", "max_iterations"},
                         {"converged", false},
                         {"parts", 2},
                         {"shapes", 9},
                         {"slide_before", 0.05},
                         {"slide", 0.01},
                         {"drift", 0.02},
                         {"edge_rms", 0.03},
                         {"warnings", {"one"}},
                         {"seconds", 4.5}};
  EXPECT_EQ(json::parse(summary.ToJson()), expected);
}

}  // namespace
}  // namespace shapespace
