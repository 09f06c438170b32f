#include "support/outputs.h"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <new>
#include <regex>
#include <sstream>
#include <utility>

#include <gflags/gflags.h>

#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/files/write.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/gltf.h>
#include <shapespace/output/picture.h>
#include <shapespace/output/point_cache.h>
#include <shapespace/output/vertex_colours.h>
#include <shapespace/output/vtk.h>
#include <shapespace/path/path_file.h>

#include "support/flag_group.h"
#include "support/frames.h"
#include "support/interrupt.h"
#include "support/lists.h"
#include "support/outside_files_flag.h"
#include "support/tool.h"

DEFINE_string(output, "path.png",
              "files to write, separated by commas: .path (the complete result, for other tools), "
              ".png (film strip), .glb (animation, for browsers and Blender), .pc2 or .mdd (point "
              "cache, for Blender, Maya, Houdini, 3ds Max), frames/%03d.obj, .ply, .off or .stl "
              "(one mesh per shape), frames/%03d.vtp (with deviation and energy, for ParaView). "
              "Names must not contain commas");
DEFINE_string(color, "plain",
              "film strip, glb, and frames in OBJ or PLY: plain, deviation (of edge lengths from "
              "the first pose), or parts (regions that move nearly rigidly)");

DEFINE_string(up, "",
              "the axis of the poses that points up, y or z; without, film strips choose, and glb "
              "takes y");
DEFINE_double(unit, 1, "glb: metres in one unit of the poses; 0.001 for millimetres");
DEFINE_double(seconds, 4, "glb: duration");
DEFINE_double(
    fps, 0, "glb: shapes of the path per second, instead of --seconds; mdd: the same, 24 without");
DEFINE_bool(loop, false,
            "glb: from the first shape to the last and again from the first, for motions that end "
            "where they begin; default: forward and back");
DEFINE_bool(once, false, "glb: from the first shape to the last, which is then held");
DEFINE_bool(ease, false,
            "glb, and frames of shape-export --frames: the motion begins and ends slowly");
DEFINE_string(title, "", "film strip: a line above it");
FLAG_GROUP(outputs, "Output");

namespace shapespace::tools {
namespace {

enum class Kind { kPath, kPicture, kGltf, kPointCache, kFrames, kVtk, kLastShape };

bool writes_last_shape_alone = false;

Kind KindOf(const std::string& output, const std::string& flag = "output") {
  const std::string extension = internal::FileExtension(output);
  if (IsWritableMesh(output)) {
    if (writes_last_shape_alone && output.find('%') == output.npos) return Kind::kLastShape;
    CheckFramePattern(flag, output);
    return Kind::kFrames;
  }
  if (extension == ".vtp") {
    CheckFramePattern(flag, output);
    return Kind::kVtk;
  }
  for (const auto& [known, kind] : {std::make_pair(".path", Kind::kPath),
                                    {".png", Kind::kPicture},
                                    {".glb", Kind::kGltf},
                                    {".pc2", Kind::kPointCache},
                                    {".mdd", Kind::kPointCache}}) {
    if (extension != known) continue;
    static const std::regex number("%0?[1-9]?d");
    if (std::regex_search(output, number)) {
      throw UsageError("--" + flag + " " + output + ": only meshes and .vtp are numbered; one " +
                       extension + " contains the whole path");
    }
    return kind;
  }
  throw UsageError("--" + flag + " " + output +
                   ": must end in .path, .png, .glb, .pc2, .mdd, .obj, .ply, .off, .stl or .vtp");
}

GltfOptions GltfOptionsFromFlags() {
  if (!FLAGS_up.empty() && FLAGS_up != "y" && FLAGS_up != "z") {
    throw UsageError("--up " + FLAGS_up + ": must be y or z");
  }
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
  options.up = FLAGS_up == "z" ? 'z' : 'y';
  options.unit = FLAGS_unit;
  options.colour_by_deviation = FLAGS_color == "deviation";
  options.allow_outside_files = FLAGS_allow_outside_files;
  return options;
}

ShapeRole RoleOf(const Path& path, int i) {
  if (std::binary_search(path.poses.begin(), path.poses.end(), i)) return ShapeRole::kPose;
  return i < path.NumShapes() - path.extrapolated ? ShapeRole::kInserted : ShapeRole::kExtrapolated;
}

void WriteGltfAndTell(const std::string& output, const Path& path, const Shape& reference,
                      const Eigen::VectorXi& parts) {
  GltfOptions options = GltfOptionsFromFlags();
  options.reference = reference;
  options.groups = parts;
  const GltfSummary summary = WriteGltf(output, path, options);
  for (const std::string& warning : summary.warnings) {
    Err() << "warning: " << output << ": " << warning << '\n';
  }
  if (summary.subsampled) {
    Err() << "note: " << output << ": " << summary.keys << " of the " << path.NumShapes()
          << " shapes, evenly spaced, because players do not support more\n";
  }
  if (FLAGS_color == "deviation") {
    Err() << "note: " << output << ": the last colour stands for a deviation of "
          << 100 * summary.colour_end << "%\n";
  }
}

void WritePicture(const std::string& output, const Path& path, const Shape& reference,
                  const Eigen::VectorXi& parts, const Eigen::VectorXi& marks) {
  FilmStripOptions options;
  options.marks = marks;
  options.title = FLAGS_title;
  if (FLAGS_up == "y") options.up = Eigen::Vector3d::UnitY();
  if (FLAGS_up == "z") options.up = Eigen::Vector3d::UnitZ();
  for (int i = 0; i < path.NumShapes(); ++i) {
    options.roles.push_back(RoleOf(path, i));
    std::ostringstream label;
    label << "t = " << std::setprecision(3) << path.parameters[i];
    options.labels.push_back(label.str());
  }
  if (FLAGS_color == "deviation") {
    for (int i = 0; i < path.NumShapes(); ++i) {
      options.values.push_back(EdgeDeviation(*path.metric, reference, path.shapes[i]));
    }
    options.legend = "edge length, deviation from the first pose";
  } else if (FLAGS_color == "parts") {
    options.groups = parts;
    options.legend = "near-rigid parts, by size";
  }
  WritePng(output, RenderFilmStrip(*path.metric->connectivity, path.Placed(), options));
}

// The colours of frames according to --color, if any; one for each shape.
std::vector<Eigen::MatrixXd> FrameColours(const std::string& output, const Path& path,
                                          const Shape& reference, const Eigen::VectorXi& parts) {
  if (FLAGS_color == "deviation") {
    DeviationColours colours = ColourByDeviation(path, reference);
    Err() << "note: " << output << ": the last colour stands for a deviation of "
          << 100 * colours.scale_end << "%\n";
    return std::move(colours.of_shapes);
  }
  if (FLAGS_color == "plain") return {};
  return {path.shapes.size(), ColourByGroup(parts)};
}

// `parts` are computed when first needed.
void Write(const std::string& output, const Path& path, const Path& whole,
           const Eigen::VectorXi& marks, Eigen::VectorXi* parts) {
  const Kind kind = KindOf(output);
  if (kind != Kind::kPath && FLAGS_color == "parts" && parts->size() == 0) {
    *parts = FindRigidParts(whole).of_vertex;
  }
  if (kind == Kind::kFrames || kind == Kind::kLastShape) {
    const Soup soup = FrameSoup(*path.metric->connectivity, path.appearance);
    const std::vector<Eigen::MatrixXd> colours =
        FrameColours(output, path, whole.shapes[0], *parts);
    if (kind == Kind::kFrames) {
      WriteFramesAndTell(output, path.Placed(), soup, colours);
    } else {
      WriteMeshAndTell(output, path.Placed(path.NumShapes() - 1),
                       colours.empty() ? soup : Coloured(soup, colours.back()));
    }
    return;
  }
  if (kind == Kind::kVtk) {
    WriteVtkSeries(output, path, whole.shapes[0]);
    TellFrames(output, path.NumShapes());
    return;
  }
  if (kind == Kind::kPath) WritePath(output, path);
  if (kind == Kind::kPicture) WritePicture(output, path, whole.shapes[0], *parts, marks);
  if (kind == Kind::kPointCache) {
    FLAGS_fps > 0 ? WritePointCache(output, path.Placed(), FLAGS_fps)
                  : WritePointCache(output, path.Placed());
  }
  if (kind == Kind::kGltf) WriteGltfAndTell(output, path, whole.shapes[0], *parts);
  Out() << "wrote " << output << '\n';
}

}  // namespace

void WriteLastShapeAlone() { writes_last_shape_alone = true; }

std::vector<std::string> OutputsFromFlags() {
  if (FLAGS_color != "plain" && FLAGS_color != "deviation" && FLAGS_color != "parts") {
    throw UsageError("--color " + FLAGS_color + ": must be plain, deviation or parts");
  }
  FilmStripOptions strip;
  strip.title = FLAGS_title;
  strip.Validate();  // checks the title before the solve, not after it
  NamingFlags({{"duration", "seconds"}}, [] { GltfOptionsFromFlags().Validate(); });
  return OutputsFromFlag("output", FLAGS_output);
}

std::vector<std::string> OutputsFromFlag(const std::string& flag, const std::string& list) {
  std::vector<std::string> outputs;
  for (const std::string& output : Split(list)) {
    if (output.empty()) continue;
    KindOf(output, flag);
    CheckCanBeWritten(output);
    outputs.push_back(output);
  }
  if (outputs.empty()) throw UsageError("--" + flag + ": names no file");
  return outputs;
}

std::string Provenance(const char* program, const std::vector<std::string>& files) {
  std::string provenance = std::string(program) + " " SHAPESPACE_VERSION ":";
  for (const std::string& file : files) {
    const std::string name = std::filesystem::path(file).filename().string();
    const bool has_blanks = name.find(' ') != name.npos;
    provenance += has_blanks ? " '" + name + "'" : " " + name;
  }
  return provenance;
}

void WriteOutputs(const std::vector<std::string>& outputs, const Path& path, const Path& whole,
                  const Eigen::VectorXi& marks) {
  std::vector<std::string> paths_first = outputs;
  std::stable_partition(paths_first.begin(), paths_first.end(), IsPathFile);
  Eigen::VectorXi parts;
  for (const std::string& output : paths_first) {
    if (Interrupted() && !IsPathFile(output)) continue;
    ShowProgress("writing " + output);
    try {
      Write(output, path, whole, marks, &parts);
    } catch (const Error& error) {
      Complain(error.what());
    } catch (const std::bad_alloc&) {
      Complain(output + ": not written: out of memory");
    }
  }
}

}  // namespace shapespace::tools
