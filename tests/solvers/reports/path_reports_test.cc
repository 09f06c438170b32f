// What solvers of paths say of themselves, of numbers that all differ.

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/summary_fields.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/spline/spline.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/transfer/transfer.h>

#include "solvers/reports/texts.h"
#include "support/golden.h"

namespace shapespace {
namespace {

using testing::BriefTextsOf;
using testing::ExpectGolden;
using testing::GoldenText;
using testing::TextsOf;
using Ending = ExponentialSummary::Ending;

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

TEST(Golden, Geodesics) {
  GeodesicSummary summary = GeodesicOfNumbers();
  GoldenText text(TextsOf(summary));
  summary.lower_bound = 1e-6;
  for (const double energy : {0.9, 1.1}) {
    summary.energy = energy;
    text.Variant("ratios round a million", summary.BriefReport());
  }
  summary = GeodesicOfNumbers();
  summary.termination = Termination::kConverged;
  summary.threads = 1;
  summary.uncertified_segments = -1;
  summary.hierarchy_stopped_early = false;
  summary.quality.speed_max = summary.lower_bound = kNotANumber;
  text.Variant("what there is none of", TextsOf(summary));
  summary.uncertified_segments = 0;
  summary.quality = PathQuality();
  summary.intersections = kNotANumber;
  text.Variant("quality not measured, no contact", TextsOf(summary));
  ExpectGolden("geodesic.txt", text.Content());
}

SplineSummary SplineOfNumbers() {
  SplineSummary summary;
  summary.geodesic.termination = Termination::kStalled;
  summary.geodesic.vertices = 11;
  summary.geodesic.poses = 3;
  summary.geodesic.shapes = 7;
  summary.geodesic.energy = 0.25;
  summary.geodesic.unit = 2.5;
  summary.geodesic.warnings = {"of the chain"};
  summary.ends = SplineEnds::kNotAKnot;
  summary.smooth = true;
  summary.jump_before = 1.5;
  summary.jump_after = 0.0625;
  summary.uncertified_segments = 2;
  summary.contact_distance = 0.03125;
  summary.energy = 0.375;
  summary.quality.edge_rms = 0.0125;
  summary.warnings = {"one", "two"};
  summary.estimated_bytes = 1e5;
  summary.spline_seconds = 1.25;
  summary.total_seconds = 3.5;
  return summary;
}

TEST(Golden, Splines) {
  SplineSummary summary = SplineOfNumbers();
  GoldenText text(TextsOf(summary));
  summary.smooth = false;
  summary.geodesic.termination = Termination::kConverged;
  summary.uncertified_segments = -1;
  text.Variant("the chain", TextsOf(summary));
  summary = SplineOfNumbers();
  for (const auto ends : {SplineEnds::kNatural, SplineEnds::kClamped, SplineEnds::kPeriodic}) {
    summary.ends = ends;
    text.Variant("other ends", TextsOf(summary));
  }
  ExpectGolden("spline.txt", text.Content());
}

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

TEST(Golden, Exponentials) {
  ExponentialSummary summary = ShotOfNumbers();
  summary.steps[1].converged = false;
  summary.steps[1].vertices = 9;
  summary.ending = Ending::kContact;
  summary.stopped = "step 3: why";
  summary.integrator = GeodesicIntegrator::kFirstIntegral;
  summary.uncertified_segments = 3;
  summary.contact_distance = 0.0625;
  GoldenText text(TextsOf(summary));

  summary = ShotOfNumbers();
  summary.uncertified_segments = 0;
  summary.contact_distance = 0.0625;
  text.Variant("complete, by the variational integrator, without contact", TextsOf(summary));
  for (const auto ending : {Ending::kContact, Ending::kCancelled, Ending::kDegenerate}) {
    summary.ending = ending;
    summary.stopped = "step 3: why";
    text.Variant("ended early", TextsOf(summary));
  }
  summary.steps.clear();
  text.Variant("without a step", summary.BriefReport());
  summary = ShotOfNumbers();
  summary.steps[1].converged = false;
  text.Variant("a step that did not converge", TextsOf(summary));
  summary = ShotOfNumbers();
  summary.steps[0].vertices = 9;
  text.Variant("a step of a coarser mesh", TextsOf(summary));
  ExpectGolden("exponential.txt", text.Content());
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

TEST(Golden, Corrections) {
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
  GoldenText text(BriefTextsOf(summary));
  summary.converged = true;
  summary.mode = CorrectionMode::kProximal;
  text.Variant("converged, proximal", BriefTextsOf(summary));
  ExpectGolden("correction.txt", text.Content());
}

TEST(Golden, Transports) {
  TransportSummary summary;
  summary.metric = "strain 1";
  summary.steps = {{2, 0.001, 0.125}, {3, 0.002, 0.25}, {5, 0.004, 0.5}};
  summary.first_norm = {4, 2, 0};
  summary.last_norm = {4.5, 1.5, 0};
  summary.estimated_bytes = 1e6;
  summary.total_seconds = 15.5;
  const auto texts = [&] {
    return summary.BriefReport() + '\n' + testing::Layout(internal::JsonOf(summary)) + '\n';
  };
  GoldenText text(texts());
  summary.converged = true;
  text.Variant("converged", texts());
  ExpectGolden("transport.txt", text.Content());
}

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

TEST(Golden, Transfers) {
  TransferSummary summary = TransferOfNumbers();
  GoldenText text(TextsOf(summary));
  summary.method = TransferMethod::kFeatures;
  summary.angle_rms = kNotANumber;
  summary.uncertified_segments = -1;
  for (auto& step : summary.steps) step.converged = step.on_mesh = true;
  text.Variant("of features, converged, without angles", TextsOf(summary));
  summary.cancelled = true;
  text.Variant("cancelled", TextsOf(summary));
  ExpectGolden("transfer.txt", text.Content());
}

TEST(Golden, TransfersOfPoses) {
  TransferSummary first;
  first.vertices = 11;
  first.scale = 1.25;
  first.steps.resize(2);
  for (auto& step : first.steps) step.converged = step.on_mesh = true;
  first.strain_rms = 0.03;
  first.strain_max = 0.04;
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
  to_first.unit = to_second.unit = 2.5;
  to_first.energy = to_second.energy = 0.375;
  to_first.total_seconds = 8;
  to_first.warnings = {"of its geodesic"};
  to_second.total_seconds = 16;
  PoseTransferSummary summary;
  summary.geodesics = {to_first, to_second};
  summary.transfers = {first, second};
  GoldenText text(TextsOf(summary));
  summary.cancelled = true;
  text.Variant("cancelled", TextsOf(summary));
  text.Variant("nothing", TextsOf(PoseTransferSummary()));
  ExpectGolden("pose_transfer.txt", text.Content());
}

}  // namespace
}  // namespace shapespace
