#include <shapespace/correspondence/marker_file.h>

#include <optional>
#include <ostream>
#include <string_view>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/correspondence/landmark_file.h>
#include <shapespace/mesh/selection.h>

namespace shapespace {
namespace {

constexpr const char* kWhatALineHolds =
    "; a line holds a vertex of the template and one of the target";

int VertexFrom(std::string_view word, const Poses& mesh, const std::string& file, int line) {
  const int num_vertices = mesh.connectivity->NumVertices();
  const std::string wanted = " is neither a vertex number from 1 to " +
                             std::to_string(num_vertices) + " nor a group of " + mesh.names[0] +
                             kWhatALineHolds;
  if (const std::optional<std::int64_t> number = internal::ParseInteger(word)) {
    if (*number < 1 || *number > num_vertices) {
      internal::FailAt(
          file, line,
          internal::Quoted(word) + wanted + (*number == 0 ? internal::kCountsFromOne : ""));
    }
    return static_cast<int>(*number) - 1;
  }
  Selection selection;
  selection.group = std::string(word);
  std::vector<int> vertices;
  try {
    vertices = SelectVertices(selection, mesh.shapes[0], *mesh.connectivity, mesh.soup.appearance);
  } catch (const InvalidOptions&) {
    internal::FailAt(file, line, internal::Quoted(word) + wanted);
  }
  const Shape group = mesh.shapes[0](Eigen::all, vertices);
  Eigen::Index nearest = 0;
  (group.colwise() - group.rowwise().mean()).colwise().squaredNorm().minCoeff(&nearest);
  return vertices[nearest];
}

}  // namespace

std::vector<CorrespondenceMarker> ReadMarkers(const std::string& file, const Poses& template_mesh,
                                              const Poses& target) {
  if (IsSlicerLandmarks(file)) {
    throw FileError(file + ": has landmarks of one mesh; name such a file for each of the two");
  }
  std::string text = internal::ReadFile(file);
  internal::BlankByteOrderMark(&text);
  std::vector<CorrespondenceMarker> markers;
  internal::Lines lines(text);
  std::string_view line;
  while (lines.Next(&line)) {
    internal::LineWords words(internal::WithoutComment(line));
    if (words.Done()) continue;
    const std::string_view first = words.Next();
    if (words.Done()) {
      internal::FailAt(file, lines.Number(),
                       std::string("there is one word only") + kWhatALineHolds);
    }
    const std::string_view second = words.Next();
    if (!words.Done()) {
      internal::FailAt(file, lines.Number(),
                       internal::Quoted(words.Next()) + " is too much" + kWhatALineHolds);
    }
    const CorrespondenceMarker marker = {VertexFrom(first, template_mesh, file, lines.Number()),
                                         VertexFrom(second, target, file, lines.Number())};
    for (size_t k = 0; k < markers.size(); ++k) {
      if (markers[k].template_vertex != marker.template_vertex &&
          markers[k].target_vertex != marker.target_vertex) {
        continue;
      }
      internal::FailAt(file, lines.Number(),
                       "shares a vertex with marker " + std::to_string(k + 1) +
                           " of this file; leave one of them out");
    }
    markers.push_back(marker);
  }
  return markers;
}

void WriteMarkers(const std::string& file, const std::vector<CorrespondenceMarker>& markers) {
  internal::WriteFileAtomically(file, [&](std::ostream& out) {
    out << "# Each line: a vertex of the template and the corresponding one of the target.\n";
    for (const CorrespondenceMarker& marker : markers) {
      out << marker.template_vertex + 1 << ' ' << marker.target_vertex + 1 << '\n';
    }
  });
}

}  // namespace shapespace
