#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/internal/merge.h>
#include <shapespace/files/internal/read_formats.h>

namespace shapespace::internal {
namespace {

// Of binary files: bytes before the first triangle, whose last four are the number of triangles,
// and bytes of a triangle.
constexpr size_t kHeader = 84, kTriangle = 50;

/// The corners of all triangles, one after the other, with nothing merged.
struct Corners {
  std::vector<Eigen::Vector3d> positions;
  std::vector<int> lines;  // of a text, of each corner
};

// By the size that the number of triangles asks for, since the header of a binary file may begin
// with any text.
bool IsBinary(const std::string& bytes) {
  if (bytes.size() < kHeader) return false;
  return bytes.size() - kHeader ==
         kTriangle * std::uint64_t{ReadLittleEndian<std::uint32_t>(bytes.data() + 80)};
}

Corners ReadBinary(const std::string& file, const std::string& bytes) {
  Corners corners;
  const size_t triangles = (bytes.size() - kHeader) / kTriangle;
  corners.positions.reserve(3 * triangles);
  for (size_t t = 0; t < triangles; ++t) {
    const char* const begin = bytes.data() + kHeader + kTriangle * t + 12;  // after the normal
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d position;
      for (int axis = 0; axis < 3; ++axis) {
        position[axis] = ReadLittleEndian<float>(begin + 12 * k + 4 * axis);
      }
      if (!position.allFinite()) {
        FailAt(file, 0,
               "triangle " + std::to_string(t + 1) + ": a coordinate is not a finite number" +
                   kReexport);
      }
      corners.positions.push_back(position);
    }
  }
  return corners;
}

class TextReader {
 public:
  TextReader(const std::string& file, const std::string& text) : file_(file), lines_(text) {}

  Corners Read() {
    std::string_view line;
    while (lines_.Next(&line)) {
      LineWords words(line);
      const std::string_view word = words.Next();
      if (word == "vertex") {
        AddCorner(words);
      } else if (word == "endfacet") {
        CheckFacet();
      } else if (!word.empty() && word != "solid" && word != "facet" && word != "outer" &&
                 word != "endloop" && word != "endsolid") {
        FailAt(file_, lines_.Number(), Quoted(word) + " is no word of STL" + kReexport);
      }
      ended_ = word == "endsolid" || (ended_ && word.empty());
    }
    if (!ended_) {
      FailAt(file_, lines_.Number(), std::string("the file ends before endsolid") + kReexport);
    }
    return std::move(corners_);
  }

 private:
  void AddCorner(LineWords words) {
    static constexpr const char* kAxes[3] = {"coordinate x", "coordinate y", "coordinate z"};
    const ElementName element{"corner", corners_.positions.size() % 3 + 1};
    Eigen::Vector3d position;
    for (int axis = 0; axis < 3; ++axis) {
      position[axis] = FiniteNumber(words.Next(), kAxes[axis], file_, lines_.Number(), element);
    }
    if (!words.Done()) {
      FailAt(file_, lines_.Number(), Quoted(words.Next()) + " follows x y z" + kReexport);
    }
    corners_.positions.push_back(position);
    corners_.lines.push_back(lines_.Number());
  }

  void CheckFacet() {
    const size_t facet = ++facets_;
    if (corners_.positions.size() == 3 * facet) return;
    FailAt(file_, lines_.Number(),
           "triangle " + std::to_string(facet) + " does not have three corners" + kReexport);
  }

  const std::string& file_;
  Lines lines_;
  Corners corners_;
  size_t facets_ = 0;
  bool ended_ = false;
};

}  // namespace

Soup ReadStl(const std::string& file, const std::string& bytes) {
  const bool binary = IsBinary(bytes);
  if (!binary && bytes.compare(0, 5, "solid") != 0) {
    FailAt(file, 0,
           std::string("is neither text, which begins with 'solid', nor as long as its number of "
                       "triangles asks for") +
               kReexport);
  }
  const Corners corners = binary ? ReadBinary(file, bytes) : TextReader(file, bytes).Read();
  Soup soup;
  soup.file = file;
  if (corners.positions.empty()) return soup;
  const Shape all = Eigen::Map<const Shape>(corners.positions[0].data(), 3,
                                            static_cast<Eigen::Index>(corners.positions.size()));
  Merged merged = MergeEqual({all});
  soup.vertices = all(Eigen::all, merged.first);
  soup.corners = std::move(merged.index);
  for (size_t corner = 3; corner <= soup.corners.size(); corner += 3) {
    soup.polygon_begin.push_back(static_cast<int>(corner));
  }
  for (const int corner : binary ? std::vector<int>() : merged.first) {
    soup.vertex_line.push_back(corners.lines[corner]);
  }
  for (size_t corner = 0; corner < corners.lines.size(); corner += 3) {
    soup.polygon_line.push_back(corners.lines[corner]);
  }
  return soup;
}

}  // namespace shapespace::internal
