#include "support/bones_flags.h"

#include <algorithm>
#include <utility>

#include <gflags/gflags.h>

#include <shapespace/base/internal/extension.h>
#include <shapespace/output/skinned_gltf.h>
#include <shapespace/output/vertex_colours.h>
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
DEFINE_int32(
    bone_rest, 0,
    "glb with --bones: the shape that is the rest pose, by its number from 0; one in which "
    "no parts touch is best");
DEFINE_string(bone_color, "",
              "glb with --bones: colours of vertices that show weights (a colour for each bone, "
              "mixed) or error (the distance from their places)");
FLAG_GROUP(bones, "Output", "bones");

namespace shapespace::tools {
namespace {

SkinningOptions SkinningOptionsFromFlags() {
  SkinningOptions options;
  options.weights_per_vertex = FLAGS_bone_weights;
  options.scale = FLAGS_bone_scale;
  options.rest = FLAGS_bone_rest;
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
  NamingFlags(
      {{"error", "bone_error"}, {"weights_per_vertex", "bone_weights"}, {"rest", "bone_rest"}},
      [&] { options.Validate(); });
  return options;
}

// Colours instead of the appearance that the mesh has.
void Colour(const std::string& file, SkinningResult* result) {
  if (FLAGS_bone_color.empty()) return;
  Appearance appearance;
  if (FLAGS_bone_color == "weights") {
    appearance.vertex_colours = ColourByBone(result->path);
  } else {
    const Shape& rest = result->path.rest;
    const double half = 0.5 * (rest.rowwise().maxCoeff() - rest.rowwise().minCoeff()).norm();
    ValueColours colours = ColourByValue({result->summary.vertex_errors / half});
    appearance.vertex_colours = std::move(colours.of_shapes[0]);
    Note(file, ": the last colour stands for an error of ", 100 * colours.scale_end,
         "% of half the diagonal");
  }
  result->path.appearance = std::move(appearance);
}

}  // namespace

bool BonesAreAsked() { return !FLAGS_bones.empty(); }

void CheckBonesFlags(const std::vector<std::string>& outputs) {
  if (!BonesAreAsked()) {
    return RefuseFlags({"bones"}, {}, "goes with --bones", "bones");
  }
  SkinningOptionsFromFlags();
  if (!FLAGS_bone_color.empty() && FLAGS_bone_color != "weights" && FLAGS_bone_color != "error") {
    throw UsageError("--bone_color: must be weights or error");
  }
  if (IsGiven("bone_color") && IsGiven("color")) {
    throw UsageError("--bone_color and --color: give one");
  }
  const bool has_glb = std::any_of(outputs.begin(), outputs.end(), [](const std::string& output) {
    return internal::FileExtension(output) == ".glb";
  });
  if (!has_glb) throw UsageError("--bones: only a .glb has bones; name one as --output");
}

void WriteBones(const std::string& file, const Path& path, const GltfOptions& options) {
  SkinningResult result;
  NamingFlags({{"rest", "bone_rest"}}, [&] {
    result = Skin(path, SkinningOptionsFromFlags(), SolveProgress({file}).get());
  });
  for (const std::string& warning : result.summary.warnings) Warn(file, ": ", warning);
  Colour(file, &result);
  SkinnedGltfOptions of_file;
  of_file.gltf = options;
  const SkinnedGltfSummary written = WriteSkinnedGltf(file, result.path, of_file);
  for (const std::string& warning : written.warnings) Warn(file, ": ", warning);
  Out() << result.summary.BriefReport() << '\n';
}

}  // namespace shapespace::tools
