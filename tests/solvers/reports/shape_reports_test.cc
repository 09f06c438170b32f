// What solvers of shapes and of spaces say of themselves, of numbers that all differ.

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/exploration/explore.h>

#include "solvers/reports/texts.h"
#include "support/golden.h"

namespace shapespace {
namespace {

using testing::BriefTextsOf;
using testing::ExpectGolden;
using testing::GoldenText;
using testing::TextsOf;

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

TEST(Golden, Deformations) {
  DeformationSummary summary = DeformationOfNumbers();
  GoldenText text(TextsOf(summary));
  summary.termination = Termination::kConverged;
  summary.shapes = summary.threads = 1;
  summary.handles.pop_back();
  summary.warm = false;
  summary.uncertified_segments = -1;
  summary.error.volume = summary.intersections = std::numeric_limits<double>::quiet_NaN();
  text.Variant("one of each thing, of an open mesh", TextsOf(summary));
  ExpectGolden("deformation.txt", text.Content());
}

TEST(Golden, Repairs) {
  RepairSummary summary;
  summary.deformation = DeformationOfNumbers();
  summary.before = {0.11, 0.12, 0.13, 0.14, 15};
  summary.after = {0.21, 0.22, 0.23, -0.24, 25};
  summary.moved = 0.625;
  EXPECT_FALSE(summary.Converged());
  ExpectGolden("repair.txt", TextsOf(summary));
}

TEST(Golden, StandingParts) {
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
  GoldenText text(BriefTextsOf(summary));
  for (const auto ending :
       {Termination::kConverged, Termination::kStalled, Termination::kCancelled}) {
    summary.termination = ending;
    text.Variant("ended otherwise", BriefTextsOf(summary));
  }
  ExpectGolden("standing.txt", text.Content());
}

CorrespondenceSummary CorrespondenceOfNumbers() {
  CorrespondenceSummary summary;
  summary.converged = true;
  summary.template_vertices = 123;
  summary.template_triangles = 242;
  summary.target_vertices = 77;
  summary.target_triangles = 150;
  summary.markers = 19;
  summary.doubtful = {{2, 0.25, 40, -1}, {6, 0.5, 8, 9}};
  summary.scale = 2.5;
  summary.stages = {{31, "gradients", 0, 1, 0, 0, 0.125}, {123, "shell", 30, 6, 0.015, 0.002, 1.5}};
  summary.distance_rms = 0.004;
  summary.distance_max = 0.03;
  summary.round_trip_mean = 0.0125;
  summary.round_trip_p95 = 0.0625;
  summary.turned = 0.0075;
  summary.uncovered = 0.05;
  summary.warnings = {"one", "two"};
  summary.estimated_bytes = 1e6;
  summary.total_seconds = 9.5;
  summary.matching_seconds = 0.375;
  summary.marker_seconds = 0.5;
  summary.hierarchy_seconds = 1.25;
  summary.fit_seconds = 4;
  summary.unfold_seconds = 0.75;
  summary.map_seconds = 2;
  return summary;
}

TEST(Golden, Correspondences) {
  CorrespondenceSummary summary = CorrespondenceOfNumbers();
  GoldenText text(TextsOf(summary));
  summary.doubtful.clear();
  summary.converged = false;
  text.Variant("no doubts, not converged", TextsOf(summary));
  summary.cancelled = true;
  text.Variant("cancelled", TextsOf(summary));
  summary = CorrespondenceOfNumbers();
  summary.candidates = {
      {0.75, 40, 0.25, 0.0625, 0.125, 0.375, 0.875, 0.00073242, 0.0009765625, true}, {}};
  summary.candidates[1].orientation = 0.625;
  summary.candidates[1].markers = 39;
  summary.candidates[1].rough_cost = 0.00390625;
  summary.template_extremities = 5;
  summary.target_extremities = 6;
  summary.certainty = 1.5;
  summary.parts_in_doubt = {{0.125, 1.0625, 11, 22, 33}};
  text.Variant("found without markers", TextsOf(summary));
  ExpectGolden("correspondence.txt", text.Content());
}

ExploreSummary SpaceOfNumbers() {
  ExploreSummary summary;
  summary.vertices = 1234;
  summary.triangles = 2464;
  summary.distance_vertices = 77;
  summary.poses = 5;
  summary.nodes = 17;
  summary.cells = 23;
  summary.metric = "lengths";
  summary.unit = 2.5;
  summary.threshold = 0.125;
  summary.solved = 31;
  summary.found = 12;
  summary.damaged = 3;
  summary.not_converged = 2;
  summary.stress = 0.0625;
  summary.stress_iterations = 9;
  summary.embedded = true;
  summary.levels = {{4, 6, 3, 0.375, 2, 1.25}, {7, 8, 0, 0.0625, 1, 0.5}};
  summary.edges_not_measured = 11;
  summary.warnings = {"one", "two"};
  summary.distance_seconds = 1.5;
  summary.embedding_seconds = 0.25;
  summary.refinement_seconds = 3.125;
  summary.total_seconds = 5;
  summary.threads = 1;
  summary.processes = 2;
  return summary;
}

TEST(Golden, Spaces) {
  ExploreSummary summary = SpaceOfNumbers();
  GoldenText text(TextsOf(summary));
  summary.not_converged = 0;
  summary.processes = 1;
  summary.threads = 4;
  EXPECT_TRUE(summary.Converged());
  text.Variant("converged, in one process", TextsOf(summary));
  summary.embedded = false;
  EXPECT_FALSE(summary.Converged());
  ExpectGolden("explore.txt", text.Content());
}

}  // namespace
}  // namespace shapespace
