// Geodesics between pairs of poses, in Markdown: energy and bound, uniformity of speed, cost. The
// pairs are all real poses of a mesh (--set real), or made in code: random poses of the quadruped
// with 4 K triangles, 300 pairs with fixed seeds. The solver's constants were chosen with half of
// the made pairs (--set tuned); the others (--set kept) only measure the result. With several
// numbers of triangles for --coarsest, each pair is solved for each of them, and the spread of the
// energy is printed. "Work" is the number of evaluations of energy and gradient on all levels,
// weighted by vertices and shapes, in units of one on the finished path; it does not depend on the
// machine.

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gflags/gflags.h>

#include <shapespace/bodies/quadruped.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/files/read.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/crumpled.h"

DEFINE_string(set, "real", "pairs: real, tuned or kept");
DEFINE_string(name, "", "only the pairs whose names contain this");
DEFINE_string(metric, "strain", "preset: strain or isometric");
DEFINE_double(crumple, 0,
              "made pairs: vertices are moved by up to this share of the mean edge length");
DEFINE_int32(shapes, 15, "shapes between the two poses");
DEFINE_string(coarsest, "200", "triangles of the coarsest level, separated by commas");

namespace shapespace {
namespace {

// A greater speed than this, relative to the mean, is a jump: a part rests and then turns over.
constexpr double kJump = 1.1;

struct Pair {
  std::string name;
  std::function<Poses()> read;
};

struct Family {
  const char* folder;
  std::vector<const char*> poses;
};

const std::vector<Family> kFamilies = {
    {"finger", {"0", "1", "var"}},
    {"cactus", {"00", "01", "03", "04", "05"}},
    {"plate", {"flat", "rolledA", "rolledB"}},
    {"leaf", {"original", "bend0", "bend1"}},
    {"scape", {"ref", "5", "6"}},
    {"human", {"000", "007"}},
    {"hand", {"rest", "curl30", "curl65", "pinch", "point"}},
    {"horse", {"reference", "01", "02", "03"}},
    {"cat", {"reference", "01", "02", "03", "04"}},
    {"lion", {"reference", "01", "02"}},
    {"armadillo", {"rest", "arms_up", "arms_down", "step", "kick"}},
    {"horse_lowpoly", {"base", "m01", "m03", "m05", "m07"}},
    {"elephant", {"reference", "01", "02"}},
};

std::vector<Pair> RealPairs() {
  std::vector<Pair> pairs;
  for (const Family& family : kFamilies) {
    const std::string folder = std::string(SHAPESPACE_DATA_DIR) + "/" + family.folder + "/";
    for (size_t i = 0; i < family.poses.size(); ++i) {
      for (size_t k = i + 1; k < family.poses.size(); ++k) {
        const std::string first = family.poses[i], second = family.poses[k];
        pairs.push_back({std::string(family.folder) + " " + first + "-" + second, [=] {
                           return ReadPoses({folder + first + ".obj", folder + second + ".obj"});
                         }});
      }
    }
  }
  return pairs;
}

// Pairs of a shape that lies beyond a real pose, half as far again on the geodesic from another
// real pose, and a third real pose.
std::vector<Pair> BeyondPairs() {
  std::vector<Pair> pairs;
  for (const Family& family : kFamilies) {
    const std::string folder = std::string(SHAPESPACE_DATA_DIR) + "/" + family.folder + "/";
    for (const std::string from : family.poses) {
      for (const std::string to : family.poses) {
        for (const std::string other : family.poses) {
          if (from == to || other == to) continue;
          pairs.push_back({std::string(family.folder) + " " + from + ">" + to + "-" + other, [=] {
                             Poses poses = ReadPoses({folder + from + ".obj", folder + to + ".obj",
                                                      folder + other + ".obj"});
                             const Shape third = poses.shapes.back();
                             poses.shapes.pop_back();
                             GeodesicOptions options;
                             options.shapes = 3;
                             options.assess = false;

                             const Path path =
                                 Extrapolate(Interpolate(poses, options).path, 2).path;
                             poses.shapes = {path.Placed(path.NumShapes() - 1), third};
                             return poses;
                           }});
        }
      }
    }
  }
  return pairs;
}

// Pairs with even numbers if `half` is 0, else those with odd numbers.
std::vector<Pair> MadePairs(int half) {
  constexpr int kPairs = 300, kTriangles = 4000;
  const SkinnedBody body = MakeQuadruped(kTriangles);
  std::vector<Pair> pairs;
  for (int i = half; i < kPairs; i += 2) {
    pairs.push_back({"quadruped " + std::to_string(i), [=] {
                       Poses poses;
                       poses.connectivity = body.connectivity;
                       for (int seed : {2 * i, 2 * i + 1}) {
                         poses.shapes.push_back(testing::Crumpled(
                             *body.connectivity, body.random_pose(seed), FLAGS_crumple, seed));
                       }
                       return poses;
                     }});
  }
  return pairs;
}

double Work(const GeodesicSummary& summary) {
  double work = 0;
  for (const GeodesicSummary::Level& level : summary.levels) {
    work += static_cast<double>(level.evaluations) * level.vertices * level.shapes;
  }
  return work / summary.vertices / summary.shapes;
}

std::vector<int> CoarsestLevels() {
  std::vector<int> levels;
  std::istringstream list(FLAGS_coarsest);
  for (std::string number; std::getline(list, number, ',');) levels.push_back(std::stoi(number));
  return levels;
}

void PrintPairs(const std::vector<Pair>& pairs) {
  GeodesicOptions options;
  options.metric = FLAGS_metric == "strain" ? MetricOptions::Strain() : MetricOptions::Isometric();
  options.shapes = FLAGS_shapes;
  const std::vector<int> levels = CoarsestLevels();
  std::cout << "| pair | coarsest | vertices | energy | energy / bound | greatest speed | "
               "roughness | edges off | work | seconds | |\n"
               "|---|---|---|---|---|---|---|---|---|---|---|\n";
  double work = 0, seconds = 0, spreads = 0, greatest_spread = 0;
  int paths = 0, jumps = 0, solved = 0;
  for (const Pair& pair : pairs) {
    if (pair.name.find(FLAGS_name) == std::string::npos) continue;
    const Poses poses = pair.read();
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (int coarsest : levels) {
      options.coarsest = coarsest;
      const GeodesicSummary summary = Interpolate(poses, options).summary;
      std::printf("| %s | %d | %d | %.6g | %.4f | %.3f | %.2f | %.4f | %.1f | %.2f | %s |\n",
                  pair.name.c_str(), coarsest, summary.vertices, summary.energy, summary.Ratio(),
                  summary.quality.speed_max, summary.quality.roughness, summary.quality.edge_rms,
                  Work(summary), summary.solve_seconds,
                  summary.termination == Termination::kConverged ? "" : "NOT CONVERGED");
      std::fflush(stdout);
      work += Work(summary);
      seconds += summary.total_seconds;
      least = std::min(least, summary.energy);
      most = std::max(most, summary.energy);
      jumps += summary.quality.speed_max > kJump;
      ++paths;
    }
    const double spread = least > GeodesicSummary::kZeroEnergy ? most / least - 1 : 0;
    spreads += spread;
    greatest_spread = std::max(greatest_spread, spread);
    ++solved;
  }
  std::printf("\n%d paths, %d with a jump; work of all %.0f, %.1f seconds\n", paths, jumps, work,
              seconds);
  if (levels.size() > 1 && solved > 0) {
    std::printf("Spread of the energy over --coarsest: mean %.2f %%, most %.2f %%\n",
                100 * spreads / solved, 100 * greatest_spread);
  }
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) {
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  shapespace::PrintPairs(FLAGS_set == "real" ? shapespace::RealPairs()
                         : FLAGS_set == "beyond"
                             ? shapespace::BeyondPairs()
                             : shapespace::MadePairs(FLAGS_set == "kept" ? 1 : 0));
}
