// What shooting, corrections and transports say of themselves, word by word, of numbers that all
// differ.

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/summary_fields.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/summary/internal/json_of.h>

namespace shapespace {
namespace {

using nlohmann::json;
using Ending = ExponentialSummary::Ending;

ExponentialSummary ShotOfNumbers() {
  ExponentialSummary summary;
  summary.ending = Ending::kComplete;
  summary.vertices = 11;
  summary.requested_steps = 4;
  summary.metric = "strain 1";
  summary.steps = {
      {0.25, true, 11, 2, 3, 5, 0.001, 0.375, 0.002, 0.01, 0.02, 0.03, 0.125},
      {0.5, true, 11, 7, 8, 9, 0.004, 0.625, 0.005, 0.04, 0.05, 0.06, 0.25},
  };
  summary.warnings = {"one", "two"};
  summary.total_seconds = 15.5;
  summary.factor_seconds = 2.5;
  summary.factorisations = 6;
  return summary;
}

const char kHeadOfSteps[] =
    "       t  solved on  increments  iterations  Krylov   residual        energy  momentum drift"
    "  edges rms   edges max  inverted  seconds\n";

TEST(ExponentialSummary, FullReportsHaveEveryNumber) {
  ExponentialSummary summary = ShotOfNumbers();
  summary.steps[1].converged = false;
  summary.ending = Ending::kContact;
  summary.stopped = "step 3: parts of the body touch";
  summary.integrator = GeodesicIntegrator::kFirstIntegral;
  summary.uncertified_segments = 3;
  summary.contact_distance = 0.0625;
  EXPECT_EQ(summary.FullReport(),
            std::string("Ending            before contact: step 3: parts of the body touch\n"
                        "Integrator        first integral (7)\n"
                        "Metric            strain 1\n"
                        "Mesh              11 vertices\n"
                        "Contact           3 segments not shown to be free of it; least distance "
                        "0.0625\n"
                        "\n") +
                kHeadOfSteps +
                "    0.25         11           2           3       5    1.0e-03         0.375"
                "         2.0e-03         1%          2%        3%    0.125\n"
                "     0.5         11           7           8       9    4.0e-03         0.625"
                "         5.0e-03         4%          5%        6%    0.250  (not converged)\n"
                "\n"
                "Time              15.500 s, of which 6 factorisations 2.500\n"
                "Warning: one\n"
                "Warning: two\n");
}

TEST(ExponentialSummary, ReportsSayHowItEnded) {
  const std::string numbers =
      ": 11 vertices, 2 of 4 steps; energy 0.375 to 0.625, edges off by 4% rms from the first "
      "shape; 15.50 s";
  const auto ending = [](const ExponentialSummary& summary) {
    const std::string report = summary.FullReport();
    return report.substr(0, report.find("\nIntegrator"));
  };
  ExponentialSummary summary = ShotOfNumbers();
  const auto termination = [&] { return json::parse(summary.ToJson())["termination"]; };
  EXPECT_TRUE(summary.Converged());
  EXPECT_EQ(summary.BriefReport(), "converged" + numbers);
  EXPECT_EQ(ending(summary), "Ending            complete, converged");
  EXPECT_EQ(summary.FullReport().find("Contact"), std::string::npos);
  EXPECT_NE(summary.FullReport().find("Integrator        variational\n"), std::string::npos);
  EXPECT_EQ(termination(), "converged");

  summary.ending = Ending::kContact;
  summary.stopped = "step 3: why";
  EXPECT_TRUE(summary.Converged());
  EXPECT_EQ(summary.BriefReport(), "ended before contact" + numbers);
  EXPECT_EQ(ending(summary), "Ending            before contact: step 3: why");
  EXPECT_EQ(termination(), "contact");

  // A step that did not converge, and one of a coarser mesh.
  for (const bool coarse : {false, true}) {
    summary = ShotOfNumbers();
    (coarse ? summary.steps[0].vertices : summary.steps[1].vertices) = coarse ? 9 : 11;
    summary.steps[1].converged = coarse;
    EXPECT_FALSE(summary.Converged());
    EXPECT_EQ(summary.BriefReport(), "1 steps NOT CONVERGED on the mesh itself" + numbers);
    EXPECT_EQ(ending(summary), "Ending            complete");
    EXPECT_EQ(termination(), "not_converged");
    summary.ending = Ending::kContact;
    EXPECT_EQ(summary.BriefReport(),
              "1 steps NOT CONVERGED on the mesh itself, ended before contact" + numbers);
    EXPECT_EQ(termination(), "not_converged");
  }
  for (const bool cancelled : {false, true}) {
    summary = ShotOfNumbers();
    summary.ending = cancelled ? Ending::kCancelled : Ending::kDegenerate;
    summary.stopped = "step 3: why";
    EXPECT_FALSE(summary.Converged());
    EXPECT_EQ(summary.BriefReport(), "STOPPED EARLY" + numbers);
    EXPECT_EQ(ending(summary), "Ending            STOPPED EARLY: step 3: why");
    EXPECT_EQ(termination(), cancelled ? "cancelled" : "degenerate");
    EXPECT_EQ(json::parse(summary.ToJson())["ending"], cancelled ? "cancelled" : "degenerate");
  }
  summary.steps.clear();
  EXPECT_EQ(summary.BriefReport(), "STOPPED EARLY: 11 vertices, 0 of 4 steps; 15.50 s");
}

TEST(ExponentialSummary, JsonHasEveryNumber) {
  ExponentialSummary summary = ShotOfNumbers();
  summary.steps[1].converged = false;
  summary.steps[1].vertices = 9;
  summary.stopped = "step 3: why";
  summary.ending = Ending::kContact;
  summary.uncertified_segments = 3;
  summary.contact_distance = 0.0625;
  const json steps = {{{"t", 0.25},
                       {"converged", true},
                       {"vertices", 11},
                       {"increments", 2},
                       {"iterations", 3},
                       {"krylov_iterations", 5},
                       {"residual", 0.001},
                       {"energy", 0.375},
                       {"momentum_drift", 0.002},
                       {"edge_rms", 0.01},
                       {"edge_max", 0.02},
                       {"inverted", 0.03},
                       {"seconds", 0.125}},
                      {{"t", 0.5},
                       {"converged", false},
                       {"vertices", 9},
                       {"increments", 7},
                       {"iterations", 8},
                       {"krylov_iterations", 9},
                       {"residual", 0.004},
                       {"energy", 0.625},
                       {"momentum_drift", 0.005},
                       {"edge_rms", 0.04},
                       {"edge_max", 0.05},
                       {"inverted", 0.06},
                       {"seconds", 0.25}}};
  const json expected = {{"termination", "not_converged"},
                         {"converged", false},
                         {"ending", "contact"},
                         {"stopped", "step 3: why"},
                         {"integrator", "variational"},
                         {"vertices", 11},
                         {"requested_steps", 4},
                         {"metric", "strain 1"},
                         {"steps", steps},
                         {"uncertified_segments", 3},
                         {"contact_distance", 0.0625},
                         {"total_seconds", 15.5},
                         {"factor_seconds", 2.5},
                         {"factorisations", 6},
                         {"warnings", {"one", "two"}}};
  EXPECT_EQ(json::parse(summary.ToJson()), expected);
}

PathQuality CorrectionQuality(double first) {
  PathQuality quality;
  quality.inner_shapes = static_cast<int>(100 * first);
  quality.edge_rms = first + 1;
  quality.edge_p99 = first + 2;
  quality.edge_max = first + 3;
  quality.first_rms = first;
  quality.first_p99 = first + 4;
  quality.first_max = first + 5;
  quality.roughness = first + 6;
  quality.folds = first + 7;
  quality.speed_max = first + 8;
  return quality;
}

json JsonOfQuality(double first) {
  return {{"inner_shapes", static_cast<int>(100 * first)},
          {"edge_rms", first + 1},
          {"edge_p99", first + 2},
          {"edge_max", first + 3},
          {"first_rms", first},
          {"first_p99", first + 4},
          {"first_max", first + 5},
          {"roughness", first + 6},
          {"folds", first + 7},
          {"speed_max", first + 8}};
}

TEST(CorrectionSummary, ReportsHaveEveryNumber) {
  CorrectionSummary summary;
  summary.mode = CorrectionMode::kPaper;
  summary.mu = 0.75;
  summary.vertices = 11;
  summary.shapes = 8;
  summary.termination = Termination::kStalled;
  summary.iterations = 12;
  summary.evaluations = 13;
  summary.initial_energy = 0.625;
  summary.energy = 0.375;
  summary.initial_quality = CorrectionQuality(0.5);
  summary.quality = CorrectionQuality(0.25);
  summary.distance = 0.0625;
  summary.deformation_left = 0.125;
  summary.warnings = {"one", "two"};
  summary.total_seconds = 15.5;
  EXPECT_EQ(summary.BriefReport(),
            "NOT CONVERGED (paper): 11 vertices, 8 shapes corrected; lengths off by 25% rms, "
            "before 50%; 12.5% of the deformation left; 12 iterations, 15.50 s");
  const json expected = {{"termination", "stalled"},
                         {"converged", false},
                         {"mode", "paper"},
                         {"mu", 0.75},
                         {"vertices", 11},
                         {"shapes", 8},
                         {"iterations", 12},
                         {"evaluations", 13},
                         {"initial_energy", 0.625},
                         {"energy", 0.375},
                         {"initial_quality", JsonOfQuality(0.5)},
                         {"quality", JsonOfQuality(0.25)},
                         {"distance", 0.0625},
                         {"deformation_left", 0.125},
                         {"total_seconds", 15.5},
                         {"warnings", {"one", "two"}}};
  EXPECT_EQ(json::parse(summary.ToJson()), expected);
  summary.converged = true;
  summary.mode = CorrectionMode::kProximal;
  EXPECT_EQ(summary.BriefReport().substr(0, 21), "converged (proximal):");
}

TEST(TransportSummary, ReportsHaveEveryNumber) {
  TransportSummary summary;
  summary.converged = false;
  summary.metric = "strain 1";
  summary.steps = {{2, 0.001, 0.125}, {3, 0.002, 0.25}, {5, 0.004, 0.5}};
  summary.first_norm = {4, 2};
  summary.last_norm = {4.5, 1.5};
  summary.estimated_bytes = 1e6;
  summary.total_seconds = 15.5;
  EXPECT_EQ(summary.BriefReport(),
            "NOT CONVERGED: 2 tangents over 3 segments; norms change by up to 0.25; 15.50 s");
  const json steps = {{{"krylov_iterations", 2}, {"residual", 0.001}, {"seconds", 0.125}},
                      {{"krylov_iterations", 3}, {"residual", 0.002}, {"seconds", 0.25}},
                      {{"krylov_iterations", 5}, {"residual", 0.004}, {"seconds", 0.5}}};
  const json expected = {{"converged", false},      {"metric", "strain 1"},
                         {"steps", steps},          {"first_norm", {4.0, 2.0}},
                         {"last_norm", {4.5, 1.5}}, {"estimated_bytes", 1e6},
                         {"total_seconds", 15.5}};
  EXPECT_EQ(json(internal::JsonOf(summary)), expected);
  summary.converged = true;
  EXPECT_EQ(summary.BriefReport().substr(0, 10), "converged:");
}

}  // namespace
}  // namespace shapespace
