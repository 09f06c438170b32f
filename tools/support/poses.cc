#include "support/poses.h"

#include <gflags/gflags.h>

#include "support/console.h"
#include "support/mesh_flags.h"
#include "support/metric_flags.h"

DEFINE_string(stiffeners, "",
              "text file of additional edges (stiffeners): two vertex numbers per line, from 1");

namespace shapespace::tools {

std::vector<std::string> WithStiffeners(std::vector<std::string> files) {
  if (!FLAGS_stiffeners.empty()) files.push_back(FLAGS_stiffeners);
  return files;
}

Poses ReadPosesFromFlags(const std::vector<std::string>& files) {
  ReadOptions options;
  options.stiffeners = FLAGS_stiffeners;
  options.allow_nonmanifold = FLAGS_allow_nonmanifold;
  options.mirror = MirrorFromFlags();
  Poses poses = ReadPoses(files, options);
  CheckMetricFlags(*poses.connectivity);
  for (const std::string& warning : poses.warnings) Err() << "warning: " << warning << '\n';
  for (const std::string& dropped : poses.soup.dropped) {
    Err() << "note: " << dropped << '\n';
  }
  return poses;
}

}  // namespace shapespace::tools
