// Paths that do not pass through themselves: of each pair of files the path with contact and the
// one that goes round, with pairs of intersecting triangles at 40 times between each two shapes.
//
//   contact_table shapes a.obj b.obj [c.obj d.obj ...]

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <shapespace/analysis/intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/geodesic/geodesic.h>

namespace shapespace {
namespace {

struct Crossings {
  double mean;
  std::int64_t most;
};

Crossings Count(const Path& path) {
  constexpr int kTimes = 40;
  std::vector<Shape> shapes;
  for (int i = 0; i + 1 < path.NumShapes(); ++i) {
    for (int k = 0; k < kTimes; ++k) {
      const double t = static_cast<double>(k) / kTimes;
      shapes.push_back((1 - t) * path.shapes[i] + t * path.shapes[i + 1]);
    }
  }
  Crossings crossings = {0, 0};
  for (const std::int64_t pairs : CountIntersections(*path.metric->connectivity, shapes)) {
    crossings.mean += static_cast<double>(pairs) / static_cast<double>(shapes.size());
    crossings.most = std::max(crossings.most, pairs);
  }
  return crossings;
}

void Print(const char* first, const char* last, int shapes) {
  const Poses poses = ReadPoses({first, last});
  GeodesicOptions options;
  options.shapes = shapes;
  const GeodesicResult through = Interpolate(poses, options);
  options.avoid_contact = true;
  const GeodesicResult round = Interpolate(poses, options);
  const Crossings before = Count(through.path), after = Count(round.path);
  std::printf(
      "| %s, %s | %d | %.3g (%lld) | %.3g (%lld) | %d | %.6f, %.6f | %.3f, %.3f | %.2f | %.2f |\n",
      first, last, through.summary.triangles, before.mean, static_cast<long long>(before.most),
      after.mean, static_cast<long long>(after.most), round.summary.uncertified_segments,
      through.summary.energy, round.summary.energy, through.summary.Ratio(), round.summary.Ratio(),
      round.summary.total_seconds, round.summary.contact_seconds);
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) try {
  if (argc < 4 || argc % 2 != 0 || std::atoi(argv[1]) < 1) {
    std::fprintf(stderr, "usage: contact_table shapes a.obj b.obj [c.obj d.obj ...]\n");
    return 2;
  }
  std::printf(
      "| poses | triangles | crossings before: mean (most) | after | segments not certified | E "
      "before, after | E / bound | s | of which contact "
      "|\n|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (int i = 2; i + 1 < argc; i += 2) {
    shapespace::Print(argv[i], argv[i + 1], std::atoi(argv[1]));
  }
  return 0;
} catch (const shapespace::Error& error) {
  std::fprintf(stderr, "contact_table: %s\n", error.what());
  return 1;
}
