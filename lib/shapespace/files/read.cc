#include <shapespace/files/read.h>

#include <istream>
#include <iterator>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/read_formats.h>
#include <shapespace/files/point_cache.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/mesh/internal/check_positions.h>
#include <shapespace/mesh/internal/check_structure.h>
#include <shapespace/mesh/internal/check_words.h>
#include <shapespace/mesh/internal/polygons.h>
#include <shapespace/mesh/internal/surface_triangles.h>
#include <shapespace/mesh/mirrored.h>
#include <shapespace/mesh/seams.h>
#include <shapespace/mesh/ties.h>
#include <shapespace/mesh/triangulate.h>

namespace shapespace {
namespace {

std::string Content(const std::string& file) {
  return internal::ReadFile(file, internal::kMaxMeshBytes);
}

std::vector<Soup> Parse(const std::string& name, std::string content, MeshFormat format,
                        bool allow_outside_files) {
  switch (format) {
    case MeshFormat::kObj:
      return {internal::ReadObj(name, std::move(content))};
    case MeshFormat::kPly:
      return {internal::ReadPly(name, content)};
    case MeshFormat::kOff:
      return {internal::ReadOff(name, content)};
    case MeshFormat::kStl:
      return {internal::ReadStl(name, content)};
    case MeshFormat::kVtk:
      return {internal::ReadVtk(name, content)};
    case MeshFormat::kVtp:
      return {internal::ReadVtp(name, content)};
    case MeshFormat::kGltf:
      break;
  }
  return internal::ReadGltf(name, content, allow_outside_files);
}

MeshFormat FormatOf(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  for (const auto& [known, format] : {std::make_pair(".obj", MeshFormat::kObj),
                                      {".ply", MeshFormat::kPly},
                                      {".off", MeshFormat::kOff},
                                      {".stl", MeshFormat::kStl},
                                      {".glb", MeshFormat::kGltf},
                                      {".gltf", MeshFormat::kGltf},
                                      {".vtk", MeshFormat::kVtk},
                                      {".vtp", MeshFormat::kVtp}}) {
    if (extension == known) return format;
  }
  if (IsPointCache(file)) {
    throw FileError(file +
                    ": a point cache has no faces; where poses are read, name the file of its mesh "
                    "before it");
  }
  throw FileError(
      file + ": the extension " + internal::Quoted(extension) +
      " is not one of .obj, .ply, .off, .stl, .glb, .gltf, .vtk, .vtp; convert the mesh to "
      "one of these");
}

// Calls `add` with each frame of a point cache as a pose of the mesh before it.
template <typename Add>
void ForFrames(const std::string& file, const Soup& mesh, const Add& add) {
  PointCache cache = ReadPointCache(file);
  if (cache.shapes[0].cols() != mesh.NumVertices()) {
    throw FileError(file + ": has " + std::to_string(cache.shapes[0].cols()) + " vertices, and " +
                    internal::FileName(mesh) + " has " + std::to_string(mesh.NumVertices()) +
                    "; name the mesh that the cache moves before it, as an .obj or .ply, which "
                    "keep the order of vertices");
  }
  for (size_t i = 0; i < cache.shapes.size(); ++i) {
    Soup pose = mesh;
    pose.file = file;
    pose.name = "frame " + std::to_string(i + 1);
    pose.vertices = std::move(cache.shapes[i]);
    if (!cache.even && i == 0) {
      pose.dropped.push_back(file + ": its frames are not evenly spaced in time, and are taken so");
    }
    add(std::move(pose));
  }
}

// The first of a file's poses, with a sentence about the others.
Soup First(std::vector<Soup> poses) {
  if (poses.size() > 1) {
    poses[0].dropped.push_back(std::to_string(poses.size() - 1) +
                               " morph targets not read, since one mesh is wanted");
  }
  return std::move(poses[0]);
}

// Calls `add` with each pose of the files.
template <typename Add>
void ForPoses(const std::vector<std::string>& files, bool allow_outside_files, const Add& add) {
  Soup mesh;  // of the point caches that follow it
  for (size_t i = 0; i < files.size(); ++i) {
    if (i > 0 && IsPointCache(files[i])) {
      ForFrames(files[i], mesh, add);
      continue;
    }
    std::vector<Soup> soups = ReadSoups(files[i], allow_outside_files);
    if (i + 1 < files.size() && IsPointCache(files[i + 1])) {
      mesh = First(std::move(soups));
    } else {
      for (Soup& pose : soups) add(std::move(pose));
    }
  }
}

/// Sorts findings into warnings and errors. If several are fatal, the first three are reported,
/// because the others mostly follow from them.
class FindingPolicy {
 public:
  FindingPolicy(const ReadOptions& options, std::vector<std::string>* warnings)
      : options_(options), warnings_(warnings) {}

  /// \throw MeshError if a finding about a mesh is fatal.
  void Enforce(const std::vector<Finding>& findings) {
    const Refusal refusal = Judge(findings);
    if (!refusal.message.empty()) throw MeshError(refusal.message, refusal.option);
  }

  /// \throw MismatchError if a finding about `pose` against `reference` is fatal.
  void Enforce(const std::vector<Finding>& findings, const Soup& reference, const Soup& pose) {
    const Refusal refusal = Judge(findings);
    if (refusal.different_meshes) {
      throw DifferentMeshes(refusal.message, internal::FileName(reference),
                            internal::FileName(pose));
    }
    if (!refusal.message.empty()) throw MismatchError(refusal.message, refusal.option);
  }

 private:
  struct Refusal {
    std::string message, option;  // the message is empty if nothing is refused
    bool different_meshes = false;
  };

  Refusal Judge(const std::vector<Finding>& findings) {
    constexpr int kMaxReported = 3;
    Refusal refusal;
    auto& [message, option, different_meshes] = refusal;
    int reported = 0;
    for (const Finding& finding : findings) {
      const bool fatal = IsRefused(finding, options_);
      // With an option, the call would do what it refuses only if it is that of all of them.
      if (fatal) option = reported == 0 || option == finding.option ? finding.option : "";
      different_meshes = different_meshes || finding.different_meshes;
      if (fatal && reported++ < kMaxReported) {
        message += (message.empty() ? "" : "\n") + finding.message;
      } else if (!fatal && finding.severity != Severity::kNote) {
        warnings_->push_back(finding.message);
      }
    }
    return refusal;
  }

  const ReadOptions& options_;
  std::vector<std::string>* warnings_;
};

// Finds the vertices that are one point of the surface, and puts them exactly there.
std::vector<int> JoinSeams(Poses* poses) {
  const Soup& first = poses->soup;
  Seams seams = FindSeams(first.polygon_begin, first.corners, poses->shapes);
  if (seams.joined > 0) {
    poses->notes.push_back(internal::FileName(first) + ": " + internal::WordsOfJoined(seams));
  }
  if (seams.unclear > 0) {
    poses->warnings.push_back(internal::FileName(first) + ": " + internal::WordsOfUnclear(seams));
  }
  return std::move(seams.representatives);
}

// Poses of the soups with which `give` calls its argument one after the other, because of all but
// the first only the positions are kept.
template <typename Give>
Poses Collect(const Give& give, const ReadOptions& options) {
  Poses poses;
  bool mirrored = false;
  FindingPolicy policy(options, &poses.warnings);
  const Soup& first = poses.soup;
  const auto add = [&](Soup pose) {
    poses.names.push_back(pose.name.empty() ? pose.file : pose.name);
    if (poses.shapes.empty()) {
      poses.soup = std::move(pose);
      policy.Enforce(internal::CheckMesh(first));
      poses.shapes.push_back(first.vertices);
      return;
    }
    if (options.mirror != 0 && MirrorBack(first, options.mirror, &pose)) {
      mirrored = true;
      poses.warnings.push_back(internal::FileName(pose) + ": is a mirror image of " +
                               internal::FileName(first) + "; its " + options.mirror +
                               " has changed sign");
    }
    policy.Enforce(CheckSameMesh(first, pose), first, pose);
    // From here on only its positions are used, with the polygons of the first one.
    policy.Enforce(internal::CheckPositions(pose));
    poses.shapes.push_back(std::move(pose.vertices));
  };
  give(add);
  if (options.mirror != 0 && !mirrored && poses.shapes.size() > 1) {
    poses.warnings.push_back("no pose is a mirror image of " + internal::FileName(first) +
                             ": mirror has no effect");
  }
  std::vector<std::pair<int, int>> stiffeners;
  if (!options.stiffeners.empty()) {
    stiffeners = ReadStiffeners(options.stiffeners, first.NumVertices());
  }
  std::vector<int> representatives;
  if (!options.open_seams) representatives = JoinSeams(&poses);
  poses.connectivity = ConnectivityOf(first, poses.shapes, stiffeners, representatives);
  for (Shape& shape : poses.shapes) poses.connectivity->CopyToTwins(&shape);
  if (!options.loose_components) TieComponents(&poses);
  return poses;
}

}  // namespace

Soup ReadSoup(const std::string& file, bool allow_outside_files) {
  return First(ReadSoups(file, allow_outside_files));
}

std::vector<Soup> ReadSoups(const std::string& file, bool allow_outside_files) {
  const MeshFormat format = FormatOf(file);
  return Parse(file, Content(file), format, allow_outside_files);
}

Soup ReadSoup(std::istream& stream, const std::string& name, MeshFormat format) {
  // By the stream, which notices errors, and not by iterators, which do not.
  std::string content;
  for (char part[1 << 16]; stream.read(part, sizeof part), stream.gcount() > 0;) {
    content.append(part, static_cast<size_t>(stream.gcount()));
  }
  if (stream.bad()) throw FileError(name + ": cannot be read to its end");
  if (content.empty()) throw FileError(name + ": is empty");
  if (content.size() > static_cast<size_t>(internal::kMaxMeshBytes)) {
    throw FileError(name + ": is larger than the " + std::to_string(internal::kMaxMeshBytes) +
                    " bytes that such a file may have");
  }
  return First(Parse(name, std::move(content), format, /*allow_outside_files=*/false));
}

bool MirrorBack(const Soup& reference, char axis, Soup* pose) {
  if (axis < 'x' || axis > 'z') {
    throw InvalidOptions("mirror", std::string("'") + axis + "' is not one of x, y and z");
  }
  if (pose->NumVertices() != reference.NumVertices()) return false;
  internal::CheckPolygons(reference.NumVertices(), reference.polygon_begin, reference.corners);
  if (!reference.vertices.allFinite() || !pose->vertices.allFinite()) return false;
  const Eigen::Matrix3Xi triangles = internal::SurfaceTriangles(reference, *pose);
  if (!IsMirrored(triangles, reference.vertices, pose->vertices)) return false;
  pose->vertices.row(axis - 'x') *= -1;
  return true;
}

std::shared_ptr<const Connectivity> ConnectivityOf(
    const Soup& soup, const std::vector<Shape>& poses,
    const std::vector<std::pair<int, int>>& stiffeners, const std::vector<int>& representatives) {
  return Connectivity::Make(soup.NumVertices(), soup.polygon_begin, soup.corners, soup.segments,
                            stiffeners, Triangulate(soup.polygon_begin, soup.corners, poses),
                            representatives);
}

std::vector<std::pair<int, int>> ReadStiffeners(const std::string& file, int num_vertices) {
  const std::string content = Content(file);
  std::vector<std::pair<int, int>> pairs;
  internal::Lines lines(content);
  std::string_view line;
  while (lines.Next(&line)) {
    internal::LineWords words(internal::WithoutComment(line));
    if (words.Done()) continue;
    const std::string element = "stiffener " + std::to_string(pairs.size() + 1) + ": ";
    int ends[2];
    for (int& end : ends) {
      const std::string_view word = words.Next();
      const std::optional<std::int64_t> number = internal::ParseInteger(word);
      if (!number || *number < 1 || *number > num_vertices) {
        internal::FailAt(
            file, lines.Number(),
            element + internal::Quoted(word) + " is not a vertex number from 1 to " +
                std::to_string(num_vertices) +
                (number == 0 ? internal::kCountsFromOne : "; a line holds two of them"));
      }
      end = static_cast<int>(*number) - 1;
    }
    if (!words.Done()) {
      internal::FailAt(file, lines.Number(),
                       element + internal::Quoted(words.Next()) +
                           " is too much; a line holds two vertex numbers");
    }
    if (ends[0] == ends[1]) {
      internal::FailAt(file, lines.Number(),
                       element + "joins vertex " + std::to_string(ends[0] + 1) +
                           " to itself; name two different vertices");
    }
    pairs.emplace_back(ends[0], ends[1]);
  }
  return pairs;
}

bool IsRefused(const Finding& finding, const ReadOptions& options) {
  switch (finding.severity) {
    case Severity::kNonManifold:
      return !options.allow_nonmanifold;
    case Severity::kMirrored:
      return !options.allow_mirrored;
    case Severity::kDoubtful:
      return !options.allow_mismatch;
    case Severity::kFatal:
      return true;
    default:
      return false;
  }
}

Poses ReadPoses(const std::vector<std::string>& files, const ReadOptions& options) {
  if (files.empty()) throw FileError("no mesh file is named; at least one is needed");
  return Collect([&](const auto& add) { ForPoses(files, options.allow_outside_files, add); },
                 options);
}

Poses MakePoses(std::vector<Soup> soups, const ReadOptions& options) {
  if (soups.empty()) throw MeshError("there is no pose; at least one is needed");
  return Collect(
      [&](const auto& add) {
        for (Soup& pose : soups) add(std::move(pose));
      },
      options);
}

void TieComponents(Poses* poses) {
  const Ties ties = FindTies(*poses->connectivity, poses->shapes);
  const auto tell = [&](int count, const std::string& what) {
    if (count == 0) return;
    poses->notes.push_back(internal::FileName(poses->soup) + ": connected components (" +
                           std::to_string(count) + ") " + what);
  };
  tell(ties.tied, "are tied to others near them, by stiffeners (" +
                      std::to_string(ties.stiffeners.size()) + ")");
  tell(ties.loose, "are near others, but do not stay there in all poses, and are not tied");
  if (ties.tied > 0) {
    poses->connectivity = WithStiffeners(*poses->connectivity, ties.stiffeners);
  }
}

}  // namespace shapespace
