#include "support/bones_flags.h"

#include <algorithm>

#include <gflags/gflags.h>

#include <shapespace/base/internal/extension.h>
#include <shapespace/output/skinned_gltf.h>
#include <shapespace/skinning/skinning.h>

#include "support/command_line.h"
#include "support/flag_group.h"
#include "support/lists.h"
#include "support/solve_progress.h"
#include "support/tool.h"

DEFINE_string(bones, "",
              "glb: so many bones with weights, for engines and animators, instead of morph "
              "targets; or auto: as few as --bone_error needs");
DEFINE_string(bone_error, ".5%",
              "glb with --bones auto: permitted distance of vertices from their places, root mean "
              "square, as a share of half the diagonal of the mesh");
DEFINE_int32(bone_weights, 4, "glb with --bones: bones that may move a vertex; engines read 4");
DEFINE_bool(bone_scale, false,
            "glb with --bones: bones may also be stretched along their own axes; the error is "
            "lower, but not every engine plays it");
FLAG_GROUP(bones, "Output", "bones");

namespace shapespace::tools {
namespace {

SkinningOptions SkinningOptionsFromFlags() {
  SkinningOptions options;
  options.weights_per_vertex = FLAGS_bone_weights;
  options.scale = FLAGS_bone_scale;
  if (FLAGS_bones == "auto") {
    options.bones = 0;
    options.error = ShareFromFlag("bone_error", FLAGS_bone_error);
  } else {
    const std::vector<double> numbers = NumbersFromFlag("bones", FLAGS_bones);
    if (numbers.size() != 1 || !(numbers[0] >= 1) || numbers[0] != static_cast<int>(numbers[0])) {
      throw UsageError(AsTyped("bones") + ": must be a number of bones, or auto");
    }
    if (IsGiven("bone_error")) throw UsageError("--bone_error goes with --bones auto");
    options.bones = static_cast<int>(numbers[0]);
  }
  NamingFlags({{"error", "bone_error"}, {"weights_per_vertex", "bone_weights"}},
              [&] { options.Validate(); });
  return options;
}

}  // namespace

bool BonesAreAsked() { return !FLAGS_bones.empty(); }

void CheckBonesFlags(const std::vector<std::string>& outputs) {
  if (!BonesAreAsked()) {
    return RefuseFlags({"bones"}, {}, "goes with --bones", "bones");
  }
  SkinningOptionsFromFlags();
  const bool has_glb = std::any_of(outputs.begin(), outputs.end(), [](const std::string& output) {
    return internal::FileExtension(output) == ".glb";
  });
  if (!has_glb) throw UsageError("--bones: only a .glb has bones; name one as --output");
}

void WriteBones(const std::string& file, const Path& path, const GltfOptions& options) {
  const SkinningResult result = Skin(path, SkinningOptionsFromFlags(), SolveProgress({file}).get());
  for (const std::string& warning : result.summary.warnings) Warn(file, ": ", warning);
  SkinnedGltfOptions of_file;
  of_file.gltf = options;
  const SkinnedGltfSummary written = WriteSkinnedGltf(file, result.path, of_file);
  for (const std::string& warning : written.warnings) Warn(file, ": ", warning);
  Out() << result.summary.BriefReport() << '\n';
}

}  // namespace shapespace::tools
