#include "support/outputs.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <utility>

#include <gflags/gflags.h>

#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/base/error.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/internal/option_fields.h>
#include <shapespace/output/path_output.h>

#include "support/bones_flags.h"
#include "support/camera_flags.h"
#include "support/command_line.h"
#include "support/flag_group.h"
#include "support/frames.h"
#include "support/interrupt.h"
#include "support/lists.h"
#include "support/option_flags.h"
#include "support/outside_files_flag.h"
#include "support/tool.h"
#include "viewer/page.h"

DEFINE_string(
    output, "path.path,path.png",
    "files to write, separated by commas: .path (the complete result, for other tools), "
    ".png (film strip), .gif or .apng (moving picture), .glb (animation, for browsers and "
    "Blender), .usda (animation, for programs that read USD), .pc2 or .mdd (point cache, "
    "for Blender, Maya, Houdini, 3ds Max), .html (a page for browsers), "
    "frames/%03d.obj, .ply, .off or .stl (one mesh per shape), frames/%03d.png (one "
    "picture per shape), frames/%03d.vtp (with deviation and energy, for ParaView). "
    "Names must not contain commas");
DEFINE_string(
    color, "plain",
    "pictures, glb, usda, and frames in OBJ or PLY: deviation is that of edge lengths from the "
    "first pose, parts are regions that move nearly rigidly (plain, deviation, parts)");

DEFINE_double(unit, 1, "glb, usda: metres in one unit of the poses; 0.001 for millimetres");
DEFINE_double(seconds, 4, "gif, apng, glb: duration");
DEFINE_double(
    fps, 0,
    "gif, apng, glb: shapes of the path per second, instead of --seconds; mdd, usda: the same, 24 "
    "without");
DEFINE_bool(loop, false,
            "gif, apng, glb: from the first shape to the last and again from the first, as without "
            "this flag for motions whose last shape is the first; other motions: forward and back");
DEFINE_bool(once, false, "gif, apng, glb: from the first shape to the last, which is then held");
DEFINE_bool(
    ease, false,
    "gif, apng, glb, and frames of shape-export --frames: the motion begins and ends slowly");
DEFINE_string(title, "", "pictures: a line above them");
DEFINE_string(labels, "",
              "film strip, numbered png: texts under the shapes, separated by commas, one for each "
              "shape or one for each pose; or none; film strips without this flag have the number "
              "of each shape, from 0, and its time");
DEFINE_string(ground_line, "",
              "pictures: draw a line on the ground at this height, seen from the side, and the "
              "shapes where they are, so that feet that slide or sink are seen; without, each "
              "shape is in the middle of its cell. Moves no shape, as --ground would");
FLAG_GROUP(outputs, "Output", "color, output, seconds");

namespace shapespace::tools {
namespace {

bool writes_last_shape_alone = false;

bool IsAnimation(PathOutput::Kind kind) {
  return kind == PathOutput::Kind::kGltf || kind == PathOutput::Kind::kUsd;
}

PathOutput OutputOf(const std::string& name, const std::string& flag = "output") {
  if (name == "-" && writes_last_shape_alone) return {name, PathOutput::Kind::kLastShape};
  try {
    return PathOutput::Of(name, writes_last_shape_alone);
  } catch (const FileError& error) {
    throw UsageError("--" + flag + " " + error.what());
  }
}

GltfOptions GltfOptionsFromFlags() {
  GltfOptions options;
  for (const auto& [one, other] : {std::make_pair("seconds", "fps"), {"loop", "once"}}) {
    if (IsGiven(one) && IsGiven(other)) {
      throw UsageError("--" + std::string(one) + " and --" + other + " exclude each other");
    }
  }
  if (IsGiven("fps") && FLAGS_fps == 0) throw UsageError(AsTyped("fps") + ": must be positive");
  options.duration = FLAGS_seconds;
  options.fps = FLAGS_fps;
  if (FLAGS_loop) options.playback = GltfPlayback::kLoop;
  if (FLAGS_once) options.playback = GltfPlayback::kOnce;
  options.ease = FLAGS_ease;
  options.unit = FLAGS_unit;
  options.allow_outside_files = FLAGS_allow_outside_files;
  return options;
}

FilmStripOptions FilmStripOptionsFromFlags() {
  FilmStripOptions options;
  options.title = FLAGS_title;
  const PageView view = ViewFromFlags();
  options.up = view.up;
  options.view = view.eye;
  if (IsGiven("ground_line")) {
    const std::vector<double> numbers = NumbersFromFlag("ground_line", FLAGS_ground_line);
    if (numbers.size() != 1) throw UsageError(AsTyped("ground_line") + ": must be one height");
    options.ground_line = numbers[0];
  }
  return options;
}

// One label for each shape of `path`; none stands for those that paths have by default.
std::vector<std::string> LabelsFromFlag(const Path& path) {
  if (!IsGiven("labels")) return {};
  std::vector<std::string> labels(path.shapes.size());
  if (FLAGS_labels == "none") return labels;
  std::vector<std::string> given = Split(FLAGS_labels);
  if (given.size() == labels.size()) return given;
  if (given.size() != path.poses.size()) {
    throw Error("--labels has " + std::to_string(given.size()) + " texts for " +
                std::to_string(labels.size()) + " shapes, of which " +
                std::to_string(path.poses.size()) +
                " are poses; give one for each shape or one for each pose");
  }
  for (size_t i = 0; i < given.size(); ++i) labels[path.poses[i]] = given[i];
  return labels;
}

PathOutputOptions PathOptionsFromFlags() {
  PathOutputOptions options;
  options.colours = EnumFromFlag<PathColours>("color", FLAGS_color);
  options.film_strip = FilmStripOptionsFromFlags();
  options.gltf = GltfOptionsFromFlags();
  if (FLAGS_fps > 0) options.point_cache_fps = options.usd.fps = FLAGS_fps;
  options.usd.unit = options.gltf.unit;
  options.page_template = ViewerPage();
  return options;
}

void Write(const PathOutput& output, const Path& path, const PathOutputOptions& options) {
  using Kind = PathOutput::Kind;
  if (output.file == "-") {
    const Soup soup = FrameSoup(*path.metric->connectivity, path.appearance);
    return WriteMeshAndTell(output.file, path.Placed(path.NumShapes() - 1), soup);
  }
  if (output.kind == Kind::kGltf && BonesAreAsked()) {
    GltfOptions gltf = options.gltf;
    gltf.colour_by_deviation = options.colours == PathColours::kDeviation;
    gltf.groups = options.parts;
    WriteBones(output.file, path, gltf);
    Out() << "wrote " << output.file << '\n';
    return;
  }
  const PathOutputSummary summary = WritePathOutput(output, path, options);
  for (const std::string& warning : summary.warnings) {
    if (output.kind == Kind::kGltf || output.kind == Kind::kPage) {
      Warn(output.file, ": ", warning);
    } else {
      Note(output.file, ": ", warning);
    }
  }
  if (summary.gltf.subsampled) {
    Note(output.file, ": ", summary.gltf.keys, " of the ", path.NumShapes(),
         " shapes, evenly spaced, because players do not support more");
  }
  if (summary.colour_end > 0) {
    Note(output.file, ": the last colour stands for a deviation of ", 100 * summary.colour_end,
         "%");
  }
  if (output.kind == Kind::kFrames || output.kind == Kind::kVtk || output.kind == Kind::kPictures) {
    TellFrames(output.file, path.NumShapes());
  } else {
    Out() << "wrote " << output.file << '\n';
  }
}

}  // namespace

void WriteLastShapeAlone() { writes_last_shape_alone = true; }

std::vector<std::string> OutputsFromFlags() {
  EnumFromFlag<PathColours>("color", FLAGS_color);
  // Before the solve, not after it.
  NamingFlags({}, [] { FilmStripOptionsFromFlags().Validate(); });
  NamingFlags({{"duration", "seconds"}}, [] { GltfOptionsFromFlags().Validate(); });
  std::vector<std::string> outputs = OutputsFromFlag("output", FLAGS_output);
  CheckBonesFlags(outputs);
  if (BonesAreAsked() && FLAGS_color == "deviation") {
    throw UsageError("--color deviation: bones cannot show it; write the .glb without --bones");
  }
  return outputs;
}

std::vector<std::string> OutputsFromFlag(const std::string& flag, const std::string& list) {
  std::vector<std::string> outputs;
  for (const std::string& output : Split(list)) {
    if (output.empty()) continue;
    const PathOutput::Kind kind = OutputOf(output, flag).kind;
    if (kind == PathOutput::Kind::kPage) CheckHasViewer();
    if (IsAnimation(kind)) UpOfAnimation(output);
    if (output == "-") {
      if (IsGiven("color")) throw UsageError("--color: has no effect on what goes to stdout");
      ClaimStdout(flag);
    }
    CheckCanBeWritten(output);
    outputs.push_back(output);
  }
  if (outputs.empty()) throw UsageError("--" + flag + ": names no file");
  return outputs;
}

void WriteOutputs(const std::vector<std::string>& outputs, const Path& path, const Path& whole,
                  const Eigen::VectorXi& marks) {
  std::vector<std::string> paths_first = outputs;
  std::stable_partition(paths_first.begin(), paths_first.end(), IsPathFile);
  PathOutputOptions options = PathOptionsFromFlags();
  options.reference = whole.shapes[0];
  options.film_strip.marks = marks;
  for (const std::string& output : paths_first) {
    if (Interrupted() && !IsPathFile(output)) continue;
    ShowProgress("writing " + output);
    try {
      if (!IsPathFile(output) && FLAGS_color == "parts" && options.parts.size() == 0) {
        options.parts = FindRigidParts(whole).of_vertex;
      }
      const PathOutput::Kind kind = OutputOf(output).kind;
      if (kind == PathOutput::Kind::kFilmStrip || kind == PathOutput::Kind::kPictures) {
        options.film_strip.labels = LabelsFromFlag(path);
      }
      if (IsAnimation(kind)) options.gltf.up = options.usd.up = UpOfAnimation(output);
      Write(OutputOf(output), path, options);
    } catch (const Error& error) {
      Complain(error.what());
    } catch (const std::bad_alloc&) {
      Complain(output + ": not written: out of memory");
    }
  }
}

}  // namespace shapespace::tools
