// Smooth motion on a real sequence: of its frames every n-th is kept as a pose, the others are
// found again by straight lines, by the chain of geodesics and by the spline, and compared with the
// true ones after rigid alignment: mean distance, as a share of the frame's diagonal.
//
//   spline_table n frame000.ply frame001.ply ...

#include <cstdio>
#include <cstdlib>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/spline/spline.h>

namespace shapespace {
namespace {

RigidMotion Fit(const Shape& from, const Shape& to) {
  return FitRigidMotion(from, to, Eigen::VectorXd::Ones(from.cols()));
}

double Error(const Shape& shape, const Shape& truth) {
  const double diagonal = (truth.rowwise().maxCoeff() - truth.rowwise().minCoeff()).norm();
  return (Fit(shape, truth)(shape) - truth).colwise().norm().mean() / diagonal;
}

void Print(int every, const Poses& frames) {
  std::vector<Shape> poses;
  for (size_t i = 0; i < frames.shapes.size(); i += every) poses.push_back(frames.shapes[i]);
  SplineOptions options;
  options.geodesic.shapes = every == 2 ? 7 : 2 * every - 1;
  const int segments = options.geodesic.shapes + 1;
  const GeodesicResult chain = Interpolate(frames.connectivity, poses, options.geodesic);
  const SplineResult spline = Spline(frames.connectivity, poses, options);
  double straight = 0, geodesics = 0, smooth = 0;
  int count = 0;
  for (size_t i = 0; i + 1 < poses.size(); ++i) {
    for (int j = 1; j < every; ++j, ++count) {
      const Shape& truth = frames.shapes[i * every + j];
      const double s = static_cast<double>(j) / every;
      const int k = static_cast<int>(i) * segments + segments * j / every;
      straight += Error((1 - s) * poses[i] + s * Fit(poses[i + 1], poses[i])(poses[i + 1]), truth);
      geodesics += Error(chain.path.Placed(k), truth);
      smooth += Error(spline.path.Placed(k), truth);
    }
  }
  std::printf(
      "| frames kept | straight lines | chain of geodesics | spline | jump of velocity, chain / "
      "spline | seconds, spline / chain |\n|---|---:|---:|---:|---:|---:|\n"
      "| 1 of %d | %.3f %% | %.3f %% | %.3f %% | %.2f / %.3f | %.1f / %.1f |\n",
      every, 100 * straight / count, 100 * geodesics / count, 100 * smooth / count,
      spline.summary.jump_before, spline.summary.jump_after, spline.summary.total_seconds,
      chain.summary.total_seconds);
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) try {
  const int every = argc > 1 ? std::atoi(argv[1]) : 0;
  if (every < 2 || argc < 2 + 2 * every) {
    std::fprintf(stderr, "spline_table n frames ...: n is 2 or more, for at least 2 n frames\n");
    return 2;
  }
  shapespace::Print(every, shapespace::ReadPoses({argv + 2, argv + argc}));
} catch (const shapespace::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
