// Bones and weights for a sequence of meshes: errors and seconds for several numbers of bones, in
// Markdown. Seconds depend on the machine.
//
//   skinning_table 10,20 frame000.ply frame001.ply ...

#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/path/path.h>
#include <shapespace/skinning/skinning.h>

namespace shapespace {
namespace {

void PrintRow(const Path& path, int bones) {
  std::printf("| %d |", bones);
  for (const bool scale : {false, true}) {
    SkinningOptions options;
    options.bones = bones;
    options.scale = scale;
    const SkinningSummary summary = Skin(path, options).summary;
    std::printf(" %.2f | %.3f %% | %d | %.1f |", summary.LiteratureError(),
                100 * summary.relative_error, summary.iterations, summary.total_seconds);
  }
  std::printf("\n");
  std::fflush(stdout);
}

void PrintTable(const std::string& bones, const std::vector<std::string>& files) {
  const Poses poses = ReadPoses(files);
  const Path path =
      MakePath(FreezeMetric(MetricOptions(), poses.connectivity, poses.shapes), poses.shapes);
  std::printf(
      "| bones | E, rigid | error | iterations | seconds | E, with scale | error | iterations | "
      "seconds |\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  std::istringstream list(bones);
  for (std::string number; std::getline(list, number, ',');) PrintRow(path, std::stoi(number));
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) try {
  if (argc < 4) {
    std::fprintf(stderr, "usage: skinning_table BONES,BONES... FRAME FRAME...\n");
    return 2;
  }
  shapespace::PrintTable(argv[1], {argv + 2, argv + argc});
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
