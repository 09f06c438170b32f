#include "support/poses.h"

#include <utility>

#include <gflags/gflags.h>

#include "support/console.h"
#include "support/flag_group.h"
#include "support/mesh_flags.h"
#include "support/metric_flags.h"
#include "support/outside_files_flag.h"
#include "support/tool.h"

DEFINE_string(stiffeners, "",
              "text file of additional edges (stiffeners): two vertex numbers per line, from 1");
FLAG_GROUP(poses, "Input");

namespace shapespace::tools {

std::vector<std::string> WithStiffeners(std::vector<std::string> files) {
  if (!FLAGS_stiffeners.empty()) files.push_back(FLAGS_stiffeners);
  return files;
}

namespace {

ReadOptions OptionsFromFlags() {
  ReadOptions options;
  options.stiffeners = FLAGS_stiffeners;
  options.allow_nonmanifold = FLAGS_allow_nonmanifold;
  options.mirror = MirrorFromFlags();
  options.allow_outside_files = FLAGS_allow_outside_files;
  return options;
}

Poses CheckedWithWarnings(Poses poses) {
  CheckMetricFlags(*poses.connectivity);
  for (const std::string& warning : poses.warnings) Err() << "warning: " << warning << '\n';
  for (const std::string& dropped : poses.soup.dropped) {
    Err() << "note: " << dropped << '\n';
  }
  return poses;
}

}  // namespace

Poses ReadPosesFromFlags(const std::vector<std::string>& files, size_t least) {
  Poses poses = ReadPoses(files, OptionsFromFlags());
  if (poses.shapes.size() < least) {
    throw UsageError(files[0] + " has one pose; name at least two poses of one mesh");
  }
  return CheckedWithWarnings(std::move(poses));
}

Poses ReadMeshesFromFlags(const std::vector<std::string>& files) {
  std::vector<Soup> soups;
  for (const std::string& file : files) soups.push_back(ReadSoup(file, FLAGS_allow_outside_files));
  return MakePosesFromFlags(std::move(soups));
}

Poses MakePosesFromFlags(std::vector<Soup> soups) {
  return CheckedWithWarnings(MakePoses(std::move(soups), OptionsFromFlags()));
}

}  // namespace shapespace::tools
