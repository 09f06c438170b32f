#include <shapespace/output/detail/playback.h>

#include <cmath>

#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

// Share of the duration for which the shapes rest at each end.
constexpr double kRest = 0.1;

// The speed of an eased motion is constant between this number of points of time.
constexpr int kEasePoints = 64;

// Shapes whose vertices are nearer to each other than this, in diagonals of the bounding box, are
// the same.
constexpr double kSameShape = 1e-6;

}  // namespace

GltfPlayback DecidePlayback(GltfPlayback playback, int shapes, const Shape& first,
                            const Shape& last) {
  if (playback != GltfPlayback::kAutomatic) return playback;
  const double size = (first.rowwise().maxCoeff() - first.rowwise().minCoeff()).norm();
  const bool is_cycle = shapes > 2 && (last - first).cwiseAbs().maxCoeff() <= kSameShape * size;
  return is_cycle ? GltfPlayback::kLoop : GltfPlayback::kThereAndBack;
}

std::vector<std::pair<double, double>> PlaybackMoments(const std::vector<double>& parameters,
                                                       int shapes, const GltfOptions& options) {
  std::vector<double> points = parameters;
  if (options.ease) {
    for (int i = 1; i < kEasePoints; ++i) {
      points.push_back((1 - std::cos(kPi * i / kEasePoints)) / 2);
    }
    SortUnique(&points);
  }
  const bool back = options.playback == GltfPlayback::kThereAndBack;
  const bool held = options.playback == GltfPlayback::kOnce;
  // Share of the duration for the way from the first shape to the last.
  const double share = back ? 0.5 - kRest : held ? 1 - kRest : 1.0;
  const double duration = options.fps > 0 ? (shapes - 1) / options.fps / share : options.duration;
  const double begin = back ? kRest / 2 * duration : 0;
  std::vector<std::pair<double, double>> moments;
  if (back) moments.emplace_back(0, 0);
  for (const double point : points) {
    const double time = options.ease ? std::acos(1 - 2 * point) / kPi : point;
    moments.emplace_back(begin + share * duration * time, point);
  }
  if (back) {
    for (size_t i = points.size(); i > 0; --i) {
      moments.emplace_back(duration - moments[i].first, points[i - 1]);
    }
    moments.emplace_back(duration, 0);
  }
  if (held) moments.emplace_back(duration, 1);
  return moments;
}

}  // namespace shapespace::internal
