// The effect of bending, the round trip of logarithm and exponential map, the number of steps of
// geodesics of real bodies, and the effect of error correction: prints the tables of
// docs/measurements.md, sections 3, 8 and 9, in Markdown. No times.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/files/read.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/path/align.h>

namespace shapespace {
namespace {

struct Pair {
  const char* name;
  Poses poses;  // two
};

Pair Read(const char* name, const std::string& folder, const char* first, const char* second) {
  const std::string place = std::string(SHAPESPACE_DATA_DIR) + "/" + folder + "/";
  return {name, ReadPoses({place + first + ".obj", place + second + ".obj"})};
}

// 15 inner shapes under each of three metrics.
void PrintBending() {
  MetricOptions membrane = MetricOptions::Isometric();
  membrane.bending = 0;
  std::printf(
      "\n| section 3: roughness in degrees; folds; edges off, rms; energy / bound | bending 0 | "
      "bending 1e-5 | the paper's |\n|---|---|---|---|\n");
  for (const Pair& pair : {Read("plate rolledA-rolledB", "plate", "rolledA", "rolledB"),
                           Read("cat reference-01", "cat", "reference", "01"),
                           Read("cat reference-04", "cat", "reference", "04"),
                           Read("human 000-007", "human", "000", "007"),
                           Read("horse reference-01", "horse", "reference", "01")}) {
    std::printf("| %s |", pair.name);
    for (const MetricOptions& metric :
         {membrane, MetricOptions::Isometric(), MetricOptions::Paper()}) {
      GeodesicOptions options;
      options.metric = metric;
      const GeodesicSummary summary = Interpolate(pair.poses, options).summary;
      std::printf(" %.1f; %.0f; %.1f %%; %.3f%s |", summary.quality.roughness,
                  summary.quality.folds, 100 * summary.quality.edge_rms, summary.Ratio(),
                  summary.termination == Termination::kConverged ? "" : ", NOT CONVERGED");
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}

// The distance between Exponential's end and the shape given to Logarithm, over the diameter.
void PrintLogarithms() {
  std::printf(
      "\n| section 8: distance, of the diameter, by tolerance of the path | 1e-10 | 1e-12 | 1e-14 "
      "|\n"
      "|---|---|---|---|\n");
  for (const Pair& pair :
       {Read("finger 0-1", "finger", "0", "1"), Read("hand rest-curl30", "hand", "rest", "curl30"),
        Read("low horse base-m03", "horse_lowpoly", "base", "m03")}) {
    const Shape &from = pair.poses.shapes[0], &to = pair.poses.shapes[1];
    const auto metric = FreezeMetric({}, pair.poses.connectivity, {from, to});
    const Shape wanted = FitRigidMotion(to, from, metric->vertex_area)(to);
    const double diameter = (to.rowwise().maxCoeff() - to.rowwise().minCoeff()).norm();
    std::printf("| %s |", pair.name);
    for (const double tolerance : {1e-10, 1e-12, 1e-14}) {
      LogarithmOptions options;
      options.tolerance = tolerance;
      try {
        const Shape end =
            Exponential(metric, from, Logarithm(metric, from, to, options), options.shapes + 1);
        std::printf(" %.0e |", (end - wanted).colwise().norm().maxCoeff() / diameter);
      } catch (const SolverError& error) {
        std::printf(" %s |", error.what());
      }
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}

// 16 steps after 15 inner shapes, under strain.
void PrintSteps() {
  std::printf(
      "\n| section 8: steps on the mesh itself | of 16 | greatest number of increments | last "
      "segment's energy over the first's |\n|---|---:|---:|---:|\n");
  for (const Pair& pair : {Read("finger 0-1", "finger", "0", "1"),
                           Read("horse reference-01", "horse", "reference", "01"),
                           Read("human 000-007", "human", "000", "007"),
                           Read("cat reference-01", "cat", "reference", "01"),
                           Read("lion reference-01", "lion", "reference", "01")}) {
    GeodesicOptions options;
    options.metric = MetricOptions::Strain();
    options.tolerance = 1e-6;
    const ExponentialSummary summary =
        Extrapolate(Interpolate(pair.poses, options).path, 16).summary;
    int on_mesh = 0, increments = 0;
    for (const ExponentialSummary::Step& step : summary.steps) {
      on_mesh += step.converged && step.vertices == summary.vertices;
      increments = std::max(increments, step.increments);
    }
    std::printf("| %s | %d | %d | %.4f |\n", pair.name, on_mesh, increments,
                summary.steps.back().energy / summary.steps.front().energy);
    std::fflush(stdout);
  }
}

// From one shape on a straight line towards another to `reach` times the distance, in 8 segments,
// corrected.
void PrintCorrection(const char* name, const std::shared_ptr<const Connectivity>& connectivity,
                     const Shape& first, const Shape& towards, double reach) {
  Path path;
  path.metric = FreezeMetric({}, connectivity, {first});
  const AlignedPoses aligned = AlignPoses(*path.metric, {first, towards});
  constexpr int kSegments = 8;
  for (int i = 0; i <= kSegments; ++i) {
    const double share = reach * i / kSegments;
    path.shapes.push_back((1 - share) * aligned.shapes[0] + share * aligned.shapes[1]);
    path.parameters.push_back(i);
  }
  path.motions.assign(kSegments + 1, RigidMotion());
  path.poses = {0};
  path.extrapolated = kSegments;
  const CorrectionSummary summary = CorrectPath(path).summary;
  std::printf("| %s | %.1f %% | %.1f %% |\n", name, 100 * summary.initial_quality.first_rms,
              100 * summary.quality.first_rms);
}

}  // namespace
}  // namespace shapespace

int main() {
  using namespace shapespace;
  std::printf("| section 9: edges off, rms | straight on | corrected, mu = 1 |\n|---|---:|---:|\n");
  const ShapeFamily strip = MakeStrip(1, 0.9, 16), bar = MakeBar(6, 1, 1, 6, 2, 2);
  PrintCorrection("strip", strip.connectivity, strip.pose(0), strip.pose(2.5), 8);
  PrintCorrection("bar", bar.connectivity, bar.pose(0), bar.pose(10), 8);
  if (std::string(SHAPESPACE_DATA_DIR).empty()) {
    std::printf("\nno real meshes: set the CMake cache path SHAPESPACE_DATA_DIR\n");
    return 0;
  }
  for (const Pair& pair : {Read("finger 0-1", "finger", "0", "1"),
                           Read("horse reference-01", "horse", "reference", "01")}) {
    PrintCorrection(pair.name, pair.poses.connectivity, pair.poses.shapes[0], pair.poses.shapes[1],
                    2);
  }
  PrintLogarithms();
  PrintSteps();
  PrintBending();
}
