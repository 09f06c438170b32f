#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/internal/read_formats.h>

namespace shapespace::internal {
namespace {

class OffReader {
 public:
  OffReader(const std::string& file, const std::string& text) : lines_(text) { soup_.file = file; }

  Soup Read() {
    ReadHeader();
    ReadVertices();
    ReadPolygons();
    while (lines_.Next(&line_)) {
      if (!LineWords(WithoutComment(line_)).Done()) {
        Fail("something follows the last polygon; the counts of the header do not fit" +
             std::string(kReexport));
      }
    }
    if (further_vertex_numbers_ > 0) {
      soup_.dropped.push_back("what follows x y z of " + std::to_string(further_vertex_numbers_) +
                              " vertices (normals, colours, texture coordinates) not kept");
    }
    if (further_polygon_numbers_ > 0) {
      soup_.dropped.push_back(std::to_string(further_polygon_numbers_) +
                              " polygon colours not kept");
    }
    return std::move(soup_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) { FailAt(soup_.file, lines_.Number(), what); }

  /// The words of the next line that is not empty.
  /// \throw FileError at the end of the file.
  LineWords NextWords(const ElementName& wanted, int of = 0) {
    while (lines_.Next(&line_)) {
      const LineWords words(WithoutComment(line_));
      if (!words.Done()) return words;
    }
    Fail("the file ends before " + wanted.Text() + (of > 0 ? " of " + std::to_string(of) : "") +
         kReexport);
  }

  void ReadHeader() {
    LineWords words = NextWords({"its header"});
    if (!ParseInteger(LineWords(words).Next())) CheckKeyword(words.Next(), words);
    if (words.Done()) words = NextWords({"the numbers of vertices and polygons"});
    num_vertices_ = Count(words.Next(), "vertices");
    num_polygons_ = Count(words.Next(), "polygons");
    if (num_vertices_ == 0) Fail("the header says that there are no vertices");
  }

  /// [ST][C][N]OFF: x y z is followed by the data that the letters stand for, which is not stored.
  void CheckKeyword(std::string_view keyword, LineWords rest) {
    std::string_view prefix = keyword;
    if (prefix.substr(0, 2) == "ST") prefix.remove_prefix(2);
    if (prefix.substr(0, 1) == "C") prefix.remove_prefix(1);
    if (prefix.substr(0, 1) == "N") prefix.remove_prefix(1);
    if (prefix != "OFF") {
      Fail("begins with " + Quoted(keyword) + ", not with OFF, COFF, NOFF or STOFF; " +
           "export it as OFF with three coordinates a vertex");
    }
    if (rest.Next() == "BINARY") Fail("binary OFF is not read; export it as text");
  }

  int Count(std::string_view word, const std::string& what) {
    const std::optional<std::int64_t> count = ParseInteger(word);
    if (!count || *count < 0) {
      Fail("the header has " + Quoted(word) + " for the number of " + what + kReexport);
    }
    // Each element has a line of at least two bytes.
    if (*count > static_cast<std::int64_t>(lines_.BytesLeft())) {
      Fail("the header promises " + std::to_string(*count) + " " + what +
           ", more than the file can hold" + kReexport);
    }
    return static_cast<int>(*count);
  }

  void ReadVertices() {
    soup_.vertices.resize(3, num_vertices_);
    for (int v = 0; v < num_vertices_; ++v) {
      const ElementName element{"vertex", static_cast<size_t>(v + 1)};
      LineWords words = NextWords(element, num_vertices_);
      static constexpr const char* kAxes[3] = {"coordinate x", "coordinate y", "coordinate z"};
      for (int axis = 0; axis < 3; ++axis) {
        soup_.vertices(axis, v) =
            FiniteNumber(words.Next(), kAxes[axis], soup_.file, lines_.Number(), element);
      }
      if (!words.Done()) ++further_vertex_numbers_;
      while (!words.Done()) {
        FiniteNumber(words.Next(), "what follows x y z,", soup_.file, lines_.Number(), element);
      }
      soup_.vertex_line.push_back(lines_.Number());
    }
  }

  void ReadPolygons() {
    for (int p = 0; p < num_polygons_; ++p) {
      const ElementName element{"polygon", static_cast<size_t>(p + 1)};
      LineWords words = NextWords(element, num_polygons_);
      const std::string_view word = words.Next();
      const std::optional<std::int64_t> size = ParseInteger(word);
      if (!size || *size < 3) {
        Fail(element.Text() + ": " + Quoted(word) + " corners, a polygon needs three" + kReexport);
      }
      for (std::int64_t k = 0; k < *size; ++k) {
        if (words.Done()) {
          Fail(element.Text() + ": " + std::to_string(k) + " of " + std::to_string(*size) +
               " corners, the others are missing" + kReexport);
        }
        soup_.corners.push_back(Index(words.Next(), element));
      }
      if (!words.Done()) ++further_polygon_numbers_;
      soup_.polygon_begin.push_back(static_cast<int>(soup_.corners.size()));
      soup_.polygon_line.push_back(lines_.Number());
    }
  }

  int Index(std::string_view word, const ElementName& element) {
    const std::optional<std::int64_t> index = ParseInteger(word);
    if (!index || *index < 0 || *index >= num_vertices_) {
      Fail(element.Text() + ": vertex index " + Quoted(word) + " is not one of 0 to " +
           std::to_string(num_vertices_ - 1) + kReexport);
    }
    return static_cast<int>(*index);
  }

  Lines lines_;
  std::string_view line_;
  Soup soup_;
  int num_vertices_ = 0, num_polygons_ = 0;
  int further_vertex_numbers_ = 0, further_polygon_numbers_ = 0;
};

}  // namespace

Soup ReadOff(const std::string& file, const std::string& text) {
  return OffReader(file, text).Read();
}

}  // namespace shapespace::internal
