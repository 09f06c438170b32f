// Geodesics with 15 inner shapes between all pairs of real poses of a mesh, in Markdown: energy and
// bound, uniformity of speed, cost. With an argument, only the pairs whose names contain it. "Work"
// is the number of evaluations of energy and gradient on all levels, weighted by vertices and
// shapes, in units of one on the finished path; it does not depend on the machine.

#include <cstdio>
#include <string>
#include <vector>

#include <shapespace/mesh/read.h>
#include <shapespace/solvers/geodesic.h>

namespace shapespace {
namespace {

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

double Work(const GeodesicSummary& summary) {
  double work = 0;
  for (const GeodesicSummary::Level& level : summary.levels) {
    work += static_cast<double>(level.evaluations) * level.vertices * level.shapes;
  }
  return work / summary.vertices / summary.shapes;
}

void PrintPairs(const std::string& wanted) {
  std::printf(
      "| pair | vertices | energy | energy / bound | greatest speed | work | seconds | |\n"
      "|---|---|---|---|---|---|---|---|\n");
  double work = 0;
  for (const Family& family : kFamilies) {
    for (size_t i = 0; i < family.poses.size(); ++i) {
      for (size_t k = i + 1; k < family.poses.size(); ++k) {
        const std::string name =
            std::string(family.folder) + " " + family.poses[i] + "-" + family.poses[k];
        if (name.find(wanted) == std::string::npos) continue;
        const std::string folder = std::string(SHAPESPACE_DATA_DIR) + "/" + family.folder + "/";
        const Poses poses =
            ReadPoses({folder + family.poses[i] + ".obj", folder + family.poses[k] + ".obj"});
        const GeodesicSummary summary = Interpolate(poses).summary;
        std::printf("| %s | %d | %.6g | %.4f | %.3f | %.1f | %.2f | %s |\n", name.c_str(),
                    summary.vertices, summary.energy, summary.Ratio(), summary.quality.speed_max,
                    Work(summary), summary.solve_seconds,
                    summary.termination == Termination::kConverged ? "" : "NOT CONVERGED");
        std::fflush(stdout);
        work += Work(summary);
      }
    }
  }
  std::printf("\nWork of all: %.0f\n", work);
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) { shapespace::PrintPairs(argc > 1 ? argv[1] : ""); }
