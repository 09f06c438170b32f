#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/merge.h>
#include <shapespace/files/detail/read_formats.h>

namespace shapespace::internal {
namespace {

// Of binary files: bytes before the first triangle, whose last four are the number of triangles,
// and bytes of a triangle.
constexpr size_t kHeader = 84, kTriangle = 50;

/// The corners of all triangles, one after the other, with nothing merged.
struct Corners {
  std::vector<Eigen::Vector3d> positions;
  std::vector<int> lines;   // of a text, of each corner
  int lines_after_end = 0;  // of a text: those after a solid that do not begin another one
};

// The number of triangles that a binary file says it has.
std::uint64_t NumTriangles(const std::string& bytes) {
  return ReadLittleEndian<std::uint32_t>(bytes.data() + kHeader - 4);
}

// A binary file may begin with "solid" too, but has a zero byte in its header or, at the latest, in
// the number of triangles.
bool IsText(const std::string& bytes) {
  std::string_view line;
  Lines lines(WithoutByteOrderMark(bytes));
  while (lines.Next(&line) && LineWords(line).Done()) continue;
  return InSmallLetters(LineWords(line).Next()) == "solid" && bytes.find('\0') >= kHeader;
}

// Whether it has the triangles that it says it has. More bytes may follow.
bool IsBinary(const std::string& bytes) {
  if (bytes.size() < kHeader) return false;
  const std::uint64_t wanted = kTriangle * NumTriangles(bytes), held = bytes.size() - kHeader;
  return held == wanted || (held > wanted && wanted > 0 && !IsText(bytes));
}

Corners ReadBinary(const std::string& file, const std::string& bytes) {
  Corners corners;
  const auto triangles = static_cast<size_t>(NumTriangles(bytes));
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
  TextReader(const std::string& file, std::string_view text) : file_(file), lines_(text) {}

  Corners Read() {
    std::string_view line;
    while (lines_.Next(&line)) {
      LineWords words(line);
      const std::string_view first = words.Next();
      const std::string word = InSmallLetters(first);
      if (word == "vertex") {
        AddCorner(words);
      } else if (word == "endfacet") {
        CheckFacet();
      } else if (IsEnd(word)) {
        ended_ = true;
        continue;
      } else if (!word.empty() && word != "solid" && word != "facet" && word != "outer" &&
                 word != "endloop") {
        if (!ended_) {
          FailAt(file_, lines_.Number(), Quoted(first) + " is no word of STL" + kReexport);
        }
        ++corners_.lines_after_end;
        continue;
      }
      ended_ = ended_ && word.empty();
    }
    if (!ended_) {
      FailAt(file_, lines_.Number(), std::string("the file ends before endsolid") + kReexport);
    }
    return std::move(corners_);
  }

 private:
  /// Other bytes may follow the word without a blank.
  static bool IsEnd(const std::string& word) { return word.compare(0, 8, "endsolid") == 0; }

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

// Whether every triangle begins with a normal of length 1, or with one of length 0 and ends with
// two bytes that are 0: hardly where the bytes have moved. Normals that are not finite, of
// triangles without area, tell nothing.
bool BytesAreInPlace(const std::string& bytes) {
  constexpr double kRounding = 0.01;  // of writers that store few digits
  for (size_t t = 0; t < NumTriangles(bytes); ++t) {
    const char* const begin = bytes.data() + kHeader + kTriangle * t;
    Eigen::Vector3d normal;
    for (int axis = 0; axis < 3; ++axis) {
      normal[axis] = ReadLittleEndian<float>(begin + 4 * axis);
    }
    const bool is_zero = normal.isZero(0) && ReadLittleEndian<std::uint16_t>(begin + 48) == 0;
    if (!is_zero && std::abs(normal.norm() - 1) > kRounding) return false;
  }
  return true;
}

// A sentence about the bytes that follow the last triangle of a binary file.
// \throw FileError if they are triangles, or if the last triangle was not read from its place: then
//        it mostly has no edge in common with another, or normals are none.
std::string WhatFollows(const std::string& bytes, const Merged& merged, const std::string& file) {
  const size_t triangles = merged.index.size() / 3, end = kHeader + kTriangle * triangles;
  const size_t further = bytes.size() - end;
  const auto before = [&](int vertex) {
    return merged.first[vertex] < static_cast<int>(3 * triangles - 3);
  };
  const bool is_padding = bytes.find_first_not_of(bytes[end], end) == std::string::npos;
  if ((further % kTriangle == 0 && !is_padding) || !BytesAreInPlace(bytes) ||
      std::count_if(merged.index.end() - 3, merged.index.end(), before) < 2) {
    FailAt(file, 0,
           std::to_string(bytes.size() - kHeader) + " bytes follow the header, " +
               std::to_string(triangles) + " triangles have " +
               std::to_string(kTriangle * triangles) + kReexport);
  }
  return std::to_string(further) + " bytes after the last triangle not kept";
}

}  // namespace

Soup ReadStl(const std::string& file, const std::string& bytes) {
  const bool binary = IsBinary(bytes);
  if (!binary && !IsText(bytes)) {
    FailAt(file, 0,
           std::string("is neither text, which begins with 'solid', nor as long as its number of "
                       "triangles asks for") +
               kReexport);
  }
  const Corners corners =
      binary ? ReadBinary(file, bytes) : TextReader(file, WithoutByteOrderMark(bytes)).Read();
  Soup soup;
  soup.file = file;
  if (corners.lines_after_end > 0) {
    soup.dropped.push_back(std::to_string(corners.lines_after_end) +
                           " lines after endsolid not kept");
  }
  if (corners.positions.empty()) return soup;
  const Shape all = Eigen::Map<const Shape>(corners.positions[0].data(), 3,
                                            static_cast<Eigen::Index>(corners.positions.size()));
  Merged merged = MergeEqual({all});
  if (binary && bytes.size() > kHeader + kTriangle * NumTriangles(bytes)) {
    soup.dropped.push_back(WhatFollows(bytes, merged, file));
  }
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
