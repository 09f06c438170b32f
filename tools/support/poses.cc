#include "support/poses.h"

#include <algorithm>
#include <set>
#include <utility>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/files/pose_order.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/output/frames.h>

#include "support/console.h"
#include "support/flag_group.h"
#include "support/mesh_flags.h"
#include "support/metric_flags.h"
#include "support/outside_files_flag.h"
#include "support/stdin_mesh.h"
#include "support/tool.h"

DEFINE_string(stiffeners, "",
              "text file of additional edges (stiffeners): two vertex numbers per line, from 1");
DEFINE_bool(loose_components, false,
            "leave connected components loose, such as eyes and clothes, that stay near others in "
            "all poses; they are tied to these otherwise, and a note says how many");
FLAG_GROUP(poses, "Input", "");

namespace shapespace::tools {

std::vector<std::string> WithStiffeners(std::vector<std::string> files) {
  if (!FLAGS_stiffeners.empty()) files.push_back(FLAGS_stiffeners);
  return files;
}

namespace {

ReadOptions OptionsFromFlags(bool tie = true) {
  ReadOptions options = MeshOptionsFromFlags();
  options.mirror = MirrorFromFlags();
  options.stiffeners = FLAGS_stiffeners;
  options.loose_components = FLAGS_loose_components || !tie;
  options.allow_outside_files = FLAGS_allow_outside_files;
  return options;
}

Poses CheckedWithWarnings(Poses poses) {
  CheckMetricFlags(*poses.connectivity);
  for (const std::string& warning : poses.warnings) Warn(warning);
  for (const std::string& note : poses.notes) Note(note);
  for (const std::string& dropped : poses.soup.dropped) {
    Note(dropped);
  }
  return poses;
}

// Whether a file of this name is written by tools, and holds no pose that could be read.
bool IsOutputAlone(const std::string& file) {
  static const std::set<std::string> extensions = {".png",  ".gif",  ".apng",
                                                   ".html", ".usda", ".path"};
  return extensions.count(internal::FileExtension(file)) > 0;
}

}  // namespace

Poses ReadPosesFromFlags(const std::vector<std::string>& files, size_t least, bool any_order) {
  for (const std::string& file : files) {
    if (!IsOutputAlone(file)) continue;
    throw UsageError(file + " cannot be read as a pose; to write it: --output " + file);
  }
  const bool from_stdin = std::find(files.begin(), files.end(), "-") != files.end();
  std::vector<Soup> soups;
  for (const std::string& file : files) {
    if (!from_stdin) break;
    for (Soup& soup : ReadSoupsOrStdin(file)) soups.push_back(std::move(soup));
  }
  Poses poses = from_stdin ? MakePoses(std::move(soups), OptionsFromFlags())
                           : ReadPoses(files, OptionsFromFlags());
  if (poses.shapes.size() < least) {
    throw UsageError(files[0] + " has one pose; name at least two poses of one mesh");
  }
  const std::string order = any_order ? "" : OrderWarning(files);
  if (!order.empty()) poses.warnings.push_back(order);
  return CheckedWithWarnings(std::move(poses));
}

Poses ReadMeshesFromFlags(const std::vector<std::string>& files, bool tie) {
  std::vector<Soup> soups;
  for (const std::string& file : files) soups.push_back(ReadSoupOrStdin(file));
  return MakePosesFromFlags(std::move(soups), tie);
}

Poses MakePosesFromFlags(std::vector<Soup> soups, bool tie) {
  return CheckedWithWarnings(MakePoses(std::move(soups), OptionsFromFlags(tie)));
}

Poses ReadPoseOf(const Path& path, const std::string& path_file, const std::string& file) {
  Poses read = ReadMeshesFromFlags({file}, /*tie=*/false);
  Soup reference = FrameSoup(*path.metric->connectivity), pose = read.soup;
  reference.file = path_file;
  reference.vertices = path.Placed(0);
  const char axis = MirrorFromFlags();
  if (axis != 0 && MirrorBack(reference, axis, &pose)) {
    Warn(file, ": is a mirror image of the path's first shape; its ", axis, " has changed sign");
    read.shapes[0] = pose.vertices;
  } else if (axis != 0) {
    Warn(file, ": is no mirror image of the path's first shape: --mirror has no effect");
  }
  for (const Finding& finding : CheckSameMesh(reference, pose)) {
    if (finding.different_meshes) throw DifferentMeshes(finding.message, path_file, file);
    if (IsRefused(finding, MeshOptionsFromFlags())) {
      throw MismatchError(finding.message, finding.option);
    }
    Warn(finding.message);
  }
  return read;
}

}  // namespace shapespace::tools
