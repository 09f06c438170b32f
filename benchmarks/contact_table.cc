// Paths that do not pass through themselves: of each pair of poses the path with contact and the
// one that goes round, with pairs of intersecting triangles at 40 times between each two shapes.
//
//   contact_table shapes a.obj b.obj [c.obj d.obj ...]
//   contact_table bodies              a fork, crossed legs, a ball through a hole
//   contact_table random first last   for each seed poses of several bodies, and how many ways
//                                     were found

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <shapespace/analysis/intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/contact_bodies.h"
#include "support/cut_ring.h"

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

void PrintHead() {
  std::printf(
      "| poses | triangles | crossings before: mean (most) | after | segments not certified | E "
      "before, after | E / bound | s | of which contact | |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|---:|---|\n");
}

void Print(const std::string& name, const std::shared_ptr<const Connectivity>& connectivity,
           const std::vector<Shape>& poses, GeodesicOptions options) {
  options.avoid_contact = true;
  const GeodesicResult round = Interpolate(connectivity, poses, options);
  options.avoid_contact = false;
  options.via.clear();
  const GeodesicResult through = Interpolate(connectivity, poses, options);
  const Crossings before = Count(through.path), after = Count(round.path);
  std::printf(
      "| %s | %d | %.3g (%lld) | %.3g (%lld) | %d | %.6f, %.6f | %.3f, %.3f | %.2f | %.2f | %s |\n",
      name.c_str(), through.summary.triangles, before.mean, static_cast<long long>(before.most),
      after.mean, static_cast<long long>(after.most), round.summary.uncertified_segments,
      through.summary.energy, round.summary.energy, through.summary.Ratio(), round.summary.Ratio(),
      round.summary.total_seconds, round.summary.contact_seconds,
      round.summary.termination == Termination::kConverged ? "" : "not converged");
}

void PrintBodies() {
  GeodesicOptions options;
  options.shapes = 7;
  const testing::TwoProngs prongs;
  Print("fork", prongs.connectivity,
        {prongs.Pose({80, -60}, {0, 0}), prongs.Pose({80, 60}, {0, 0})}, options);
  const std::vector<Shape> crossed = {prongs.Pose({64, -52}, {64, 128}),
                                      prongs.Pose({56, 60}, {56, 240})};
  Print("crossed legs", prongs.connectivity, crossed, options);
  options.via = {prongs.Pose({0, 0}, {0, 0})};
  Print("crossed legs, via straight ones", prongs.connectivity, crossed, options);
  options.via.clear();
  options.shapes = 15;
  options.metric.lambda = 0.01;
  for (const double radius : {0.9, 0.8, 0.7}) {
    const testing::BallAndWall ball(radius, 1, Eigen::Vector3d::Zero(), 15);
    options.avoid_contact = true;
    options.obstacle = ball.wall;
    const GeodesicSummary summary = Interpolate(ball.connectivity, ball.poses, options).summary;
    std::printf(
        "| ball of radius 1 through a hole of %g | %d | | %lld | %d | %.6f | | %.2f | | %s |\n",
        radius, summary.triangles, static_cast<long long>(summary.crossings_between),
        summary.uncertified_segments, summary.energy, summary.total_seconds,
        summary.termination == Termination::kConverged ? "" : "not converged");
  }
}

// A body and two poses in which it does not intersect itself, between which it passes through
// itself.
struct Random {
  Random(const std::string& kind, int seed) : random(static_cast<unsigned>(seed)) {
    if (kind == "ring") {
      const testing::CutRing ring;
      connectivity = ring.connectivity;
      for (const int side : {1, -1}) {
        const double front = side * Uniform(0.3, 0.8);
        poses.push_back(ring.Wound(front, Uniform(-0.1, 0.1)));
      }
      return;
    }
    const testing::TwoProngs prongs(kind != "two bodies");
    connectivity = prongs.connectivity;
    for (const int side : {-1, 1}) {
      if (kind == "legs") {
        const double angle = Uniform(55, 75), towards = side * Uniform(45, 60);
        poses.push_back(prongs.Pose({angle, towards}, {angle, 180 + towards}));
      } else {
        const double angle = Uniform(50, 90), towards = side * Uniform(45, 80);
        const double other = side > 0 ? Uniform(-20, 20) : 0;
        poses.push_back(prongs.Pose({angle, towards}, {other, Uniform(0, 360)}));
      }
    }
  }
  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  }
  std::mt19937 random;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
};

void PrintRandom(int first, int last) {
  std::printf(
      "| body | pairs that cross | ways found | E / bound at most | s |\n"
      "|---|---:|---:|---:|---:|\n");
  for (const char* kind : {"ring", "fork", "two bodies", "legs"}) {
    int crossing = 0, found = 0;
    double ratio = 0, seconds = 0;
    for (int seed = first; seed <= last; ++seed) {
      const Random body(kind, seed);
      if (CountIntersections(*body.connectivity, body.poses[0]) > 0 ||
          CountIntersections(*body.connectivity, body.poses[1]) > 0) {
        continue;
      }
      GeodesicOptions options;
      options.shapes = 7;
      if (Count(Interpolate(body.connectivity, body.poses, options).path).most == 0) continue;
      ++crossing;
      options.avoid_contact = true;
      const GeodesicResult round = Interpolate(body.connectivity, body.poses, options);
      seconds += round.summary.total_seconds;
      if (round.summary.uncertified_segments > 0 || Count(round.path).most > 0) continue;
      ++found;
      ratio = std::max(ratio, round.summary.Ratio());
    }
    std::printf("| %s | %d | %d | %.3f | %.1f |\n", kind, crossing, found, ratio, seconds);
  }
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) try {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "random" && argc == 4) {
    shapespace::PrintRandom(std::atoi(argv[2]), std::atoi(argv[3]));
    return 0;
  }
  if (first == "bodies" && argc == 2) {
    shapespace::PrintHead();
    shapespace::PrintBodies();
    return 0;
  }
  if (argc < 4 || argc % 2 != 0 || std::atoi(argv[1]) < 1) {
    std::fprintf(stderr,
                 "usage: contact_table shapes a.obj b.obj [c.obj d.obj ...]\n"
                 "       contact_table bodies\n"
                 "       contact_table random first last\n");
    return 2;
  }
  shapespace::PrintHead();
  shapespace::GeodesicOptions options;
  options.shapes = std::atoi(argv[1]);
  for (int i = 2; i + 1 < argc; i += 2) {
    const shapespace::Poses poses = shapespace::ReadPoses({argv[i], argv[i + 1]});
    shapespace::Print(std::string(argv[i]) + ", " + argv[i + 1], poses.connectivity, poses.shapes,
                      options);
  }
  return 0;
} catch (const shapespace::Error& error) {
  std::fprintf(stderr, "contact_table: %s\n", error.what());
  return 1;
}
