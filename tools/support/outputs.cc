#include "support/outputs.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/mesh/write.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/gltf.h>
#include <shapespace/output/picture.h>
#include <shapespace/path/path_file.h>
#include <shapespace/path/quality.h>
#include <shapespace/path/rigid_parts.h>

#include "support/lists.h"
#include "support/tool.h"

DEFINE_string(
    output, "path.png",
    "files to write, separated by commas: .path (everything, to go on from), .png (film "
    "strip), .glb (animated, for browsers and Blender), frames/%03d.obj or .ply (one mesh "
    "a shape)");
DEFINE_string(color, "plain",
              "film strip and glb: plain, deviation (of edge lengths from the first pose), or "
              "parts (that move nearly rigidly)");

DEFINE_string(up, "",
              "the axis of the poses that points up, y or z; without, film strips choose, and glb "
              "takes y");
DEFINE_double(unit, 1, "glb: metres in one unit of the poses; 0.001 for millimetres");
DEFINE_double(seconds, 4, "glb: duration, there and back");
DEFINE_string(title, "", "film strip: a line above it");

namespace shapespace::tools {
namespace {

enum class Kind { kPath, kPicture, kGltf, kFrames };

Kind KindOf(const std::string& output, const std::string& flag = "output") {
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension == ".path") return Kind::kPath;
  if (extension == ".png") return Kind::kPicture;
  if (extension == ".glb") return Kind::kGltf;
  if (extension == ".obj" || extension == ".ply") {
    try {
      FrameName(output, 0);
    } catch (const FileError& error) {
      throw UsageError("--" + flag + " " + error.what());
    }
    return Kind::kFrames;
  }
  throw UsageError("--" + flag + " " + output + ": must end in .path, .png, .glb, .obj or .ply");
}

GltfOptions GltfOptionsFromFlags() {
  if (!FLAGS_up.empty() && FLAGS_up != "y" && FLAGS_up != "z") {
    throw UsageError("--up " + FLAGS_up + ": must be y or z");
  }
  GltfOptions options;
  options.duration = FLAGS_seconds;
  options.up = FLAGS_up == "z" ? 'z' : 'y';
  options.unit = FLAGS_unit;
  options.colour_by_deviation = FLAGS_color == "deviation";
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
    std::cerr << "warning: " << output << ": " << warning << '\n';
  }
  if (summary.subsampled) {
    std::cerr << "note: " << output << ": " << summary.keys << " of the " << path.NumShapes()
              << " shapes, evenly, as many as players can be expected to take\n";
  }
  if (FLAGS_color == "deviation") {
    std::cerr << "note: " << output << ": the last colour stands for a deviation of "
              << 100 * summary.colour_end << "%\n";
  }
}

void WriteFramesAndTell(const std::string& output, const std::vector<Shape>& shapes,
                        const Soup& soup) {
  for (const std::string& sentence : NotKept(output, soup)) {
    std::cerr << "note: " << output << ": " << sentence << '\n';
  }
  WriteFrames(output, shapes, soup);
}

}  // namespace

std::vector<std::string> OutputsFromFlags() {
  if (FLAGS_color != "plain" && FLAGS_color != "deviation" && FLAGS_color != "parts") {
    throw UsageError("--color " + FLAGS_color + ": must be plain, deviation or parts");
  }
  FilmStripOptions strip;
  strip.title = FLAGS_title;
  strip.Validate();  // a title that cannot be drawn is told now, not after the solve
  GltfOptionsFromFlags().Validate();
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

void CheckCanBeWritten(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::is_directory(file, error)) throw FileError(file + ": cannot be written: it is a folder");
  fs::path folder = fs::absolute(file).parent_path();
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (!fs::is_directory(folder, error)) {
    throw FileError(file + ": cannot be written: " + folder.string() + " is no folder");
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw FileError(file + ": cannot be written: " + folder.string() + ": " + std::strerror(errno));
  }
}

std::string Provenance(const char* program, const std::vector<std::string>& files) {
  std::string provenance = std::string(program) + " " SHAPESPACE_VERSION ":";
  for (const std::string& file : files) provenance += " " + file;
  return provenance;
}

void WriteOutputs(const std::vector<std::string>& outputs, const Path& path, const Path& whole) {
  const std::vector<Shape> placed = path.Placed();
  Eigen::VectorXi parts;
  if (FLAGS_color == "parts") parts = FindRigidParts(whole).of_vertex;
  int done = 0;
  for (const std::string& output : outputs) {
    ReportProgress(TerminalProgress(), "writing " + output, ++done,
                   static_cast<int>(outputs.size()));
    switch (KindOf(output)) {
      case Kind::kPath:
        WritePath(output, path);
        break;
      case Kind::kPicture: {
        FilmStripOptions options;
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
            options.values.push_back(EdgeDeviation(*path.metric, whole.shapes[0], path.shapes[i]));
          }
          options.legend = "edge length, deviation from the first pose";
        } else if (FLAGS_color == "parts") {
          options.groups = parts;
          options.legend = "near-rigid parts, by size";
        }
        WritePng(output, RenderFilmStrip(*path.metric->connectivity, placed, options));
        break;
      }
      case Kind::kGltf:
        WriteGltfAndTell(output, path, whole.shapes[0], parts);
        break;
      case Kind::kFrames:
        WriteFramesAndTell(output, placed, FrameSoup(*path.metric->connectivity, path.appearance));
        break;
    }
  }
}

}  // namespace shapespace::tools
