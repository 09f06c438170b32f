// Means and modes of poses: how good the mean is, and how well models describe poses that they were
// made without.
//
//   statistics_table a.obj b.obj ...

#include <cstdio>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/statistics/assess.h>

namespace shapespace {
namespace {

void Print(const Poses& poses) {
  AverageOptions average;
  const AverageSummary mean = Average(poses, average).summary;
  std::printf(
      "mean: F / B %.4f, edges off %.2f %%, residual %.4f, %d iterations, %.2f s and %.2f s for "
      "the bound\n",
      mean.Ratio(), 100 * mean.edge_rms, mean.residual, mean.iterations,
      mean.total_seconds - mean.certificate_seconds, mean.certificate_seconds);
  average.refine = true;
  const AverageSummary star = Average(poses, average).summary;
  std::printf("refined: F / B %.4f, %d rounds, %.2f s in all\n", star.Ratio(), star.refinements,
              star.total_seconds);
  ShapeModelOptions model;
  const ShapeModelSummary modes =
      MakeShapeModel(poses.connectivity, poses.shapes, poses.names, model).summary;
  std::printf("model: %s\n", modes.BriefReport().c_str());
  for (const bool fit : {false, true}) {
    AssessmentOptions options;
    options.fit = fit;
    const Assessment assessment = AssessShapeModel(poses.connectivity, poses.shapes, options);
    std::printf("%s (%d not converged, %.1f s)\n%s", fit ? "with fit" : "without fit",
                assessment.unconverged, assessment.total_seconds, assessment.FullReport().c_str());
  }
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) try {
  std::vector<std::string> files(argv + 1, argv + argc);
  shapespace::Print(shapespace::ReadPoses(files));
} catch (const shapespace::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
