#include <shapespace/mesh/read.h>

#include <istream>
#include <iterator>
#include <limits>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/extension.h>
#include <shapespace/base/read_file.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/check_positions.h>
#include <shapespace/mesh/check_words.h>
#include <shapespace/mesh/polygons.h>
#include <shapespace/mesh/read_formats.h>
#include <shapespace/mesh/text.h>
#include <shapespace/mesh/triangulate.h>
#include <shapespace/mesh/volume.h>

namespace shapespace {
namespace {

// The limit of size keeps all indices and counts in a file within the range of int.
constexpr int kMostBytes = std::numeric_limits<int>::max();

std::string Content(const std::string& file) { return ReadFile(file, kMostBytes); }

Soup Parse(const std::string& name, std::string content, MeshFormat format) {
  switch (format) {
    case MeshFormat::kObj:
      return internal::ReadObj(name, std::move(content));
    case MeshFormat::kPly:
      return internal::ReadPly(name, content);
    case MeshFormat::kOff:
      break;
  }
  return internal::ReadOff(name, content);
}

/// Sorts findings into warnings and errors. If several are fatal, the first three are reported,
/// because the others mostly follow from them.
class Judge {
 public:
  Judge(const ReadOptions& options, std::vector<std::string>* warnings)
      : options_(options), warnings_(warnings) {}

  /// \throw E if a finding is fatal.
  template <typename E>
  void Hear(const std::vector<Finding>& findings) {
    constexpr int kMostTold = 3;
    std::string refusal;
    int told = 0;
    for (const Finding& finding : findings) {
      const bool fatal =
          finding.severity == Severity::kFatal ||
          (finding.severity == Severity::kNonManifold && !options_.allow_nonmanifold);
      if (fatal && told++ < kMostTold) {
        refusal += (refusal.empty() ? "" : "\n") + finding.message;
      } else if (!fatal && finding.severity != Severity::kNote) {
        warnings_->push_back(finding.message);
      }
    }
    if (!refusal.empty()) throw E(refusal);
  }

 private:
  const ReadOptions& options_;
  std::vector<std::string>* warnings_;
};

// Poses from `count` soups, the i-th of which is next(i). They are made one after the other,
// because of all but the first only the positions are kept.
template <typename Next>
Poses Collect(size_t count, const Next& next, const ReadOptions& options) {
  Poses poses;
  Judge judge(options, &poses.warnings);
  poses.soup = next(0);
  const Soup& first = poses.soup;
  poses.names.push_back(first.file);
  judge.Hear<MeshError>(CheckSoup(first));
  poses.shapes.push_back(first.vertices);
  for (size_t i = 1; i < count; ++i) {
    Soup pose = next(i);
    poses.names.push_back(pose.file);
    if (options.mirror != 0 && MirrorBack(first, options.mirror, &pose)) {
      poses.warnings.push_back(internal::FileName(pose) + ": is a mirror image of " +
                               internal::FileName(first) + "; its " + options.mirror +
                               " has changed sign");
    }
    judge.Hear<CorrespondenceError>(CheckCorrespondence(first, pose));
    // From here on only its positions are used, with the polygons of the first one.
    judge.Hear<MeshError>(internal::CheckPositions(pose));
    poses.shapes.push_back(std::move(pose.vertices));
  }
  std::vector<std::pair<int, int>> stiffeners;
  if (!options.stiffeners.empty()) {
    stiffeners = ReadStiffeners(options.stiffeners, first.NumVertices());
  }
  poses.connectivity = ConnectivityOf(first, poses.shapes, stiffeners);
  return poses;
}

}  // namespace

Soup ReadSoup(const std::string& file) {
  const std::string extension = FileExtension(file);
  if (extension == ".obj") return Parse(file, Content(file), MeshFormat::kObj);
  if (extension == ".ply") return Parse(file, Content(file), MeshFormat::kPly);
  if (extension == ".off") return Parse(file, Content(file), MeshFormat::kOff);
  throw FileError(file + ": the extension " + internal::Quoted(extension) +
                  " is not one of .obj, .ply, .off; convert the mesh to one of these");
}

Soup ReadSoup(std::istream& stream, const std::string& name, MeshFormat format) {
  std::string content{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw FileError(name + ": cannot be read to its end");
  if (content.empty()) throw FileError(name + ": is empty");
  if (content.size() > static_cast<size_t>(kMostBytes)) {
    throw FileError(name + ": is larger than the " + std::to_string(kMostBytes) +
                    " bytes that such a file may have");
  }
  return Parse(name, std::move(content), format);
}

bool MirrorBack(const Soup& reference, char axis, Soup* pose) {
  if (axis < 'x' || axis > 'z') {
    throw InvalidOptions(std::string("mirror: '") + axis + "' is not one of x, y and z");
  }
  if (pose->NumVertices() != reference.NumVertices()) return false;
  internal::CheckPolygons(reference.NumVertices(), reference.polygon_begin, reference.corners);
  const Eigen::Matrix3Xi triangles = internal::Fans(reference.polygon_begin, reference.corners);
  if (!IsMirrored(triangles, reference.vertices, pose->vertices)) return false;
  pose->vertices.row(axis - 'x') *= -1;
  return true;
}

std::shared_ptr<const Connectivity> ConnectivityOf(
    const Soup& soup, const std::vector<Shape>& poses,
    const std::vector<std::pair<int, int>>& stiffeners) {
  return Connectivity::Make(soup.NumVertices(), soup.polygon_begin, soup.corners, soup.segments,
                            stiffeners, Triangulate(soup.polygon_begin, soup.corners, poses));
}

std::vector<std::pair<int, int>> ReadStiffeners(const std::string& file, int num_vertices) {
  const std::string content = Content(file);
  std::vector<std::pair<int, int>> pairs;
  internal::Lines lines(content);
  std::string_view line;
  while (lines.Next(&line)) {
    internal::Words words(internal::WithoutComment(line));
    if (words.Done()) continue;
    const std::string element = "stiffener " + std::to_string(pairs.size() + 1) + ": ";
    int ends[2];
    for (int& end : ends) {
      const std::string_view word = words.Next();
      const std::optional<std::int64_t> number = internal::ParseInteger(word);
      if (!number || *number < 1 || *number > num_vertices) {
        internal::FailAt(file, lines.Number(),
                         element + internal::Quoted(word) + " is not a vertex number from 1 to " +
                             std::to_string(num_vertices) + "; a line holds two of them");
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

Poses ReadPoses(const std::vector<std::string>& files, const ReadOptions& options) {
  if (files.empty()) throw FileError("no mesh file is named; at least one is needed");
  return Collect(
      files.size(), [&](size_t i) { return ReadSoup(files[i]); }, options);
}

Poses MakePoses(std::vector<Soup> soups, const ReadOptions& options) {
  if (soups.empty()) throw MeshError("there is no pose; at least one is needed");
  return Collect(
      soups.size(), [&](size_t i) { return std::move(soups[i]); }, options);
}

}  // namespace shapespace
