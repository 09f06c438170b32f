#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/read_formats.h>

namespace shapespace::internal {
namespace {

class OffReader {
 public:
  OffReader(const std::string& file, std::string_view text) : lines_(text) { soup_.file = file; }

  Soup Read() {
    ReadHeader();
    ReadVertices();
    ReadPolygons();
    int further_lines = 0;
    while (lines_.Next(&line_)) {
      LineWords words(WithoutComment(line_));
      if (words.Done()) continue;
      // Further elements begin with a number.
      if (ParseDouble(words.Next())) {
        Fail("something follows the last polygon; the counts of the header do not fit" +
             std::string(kReexport));
      }
      ++further_lines;
    }
    if (further_lines > 0) {
      soup_.dropped.push_back(std::to_string(further_lines) +
                              " lines after the last polygon not kept");
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

  /// Begins the next element: `words_` are those of the next line that is not empty.
  /// \throw FileError at the end of the file.
  void Begin(const ElementName& wanted, int of = 0) {
    continues_.reset();
    do {
      if (!lines_.Next(&line_)) {
        Fail("the file ends before " + wanted.Text() + (of > 0 ? " of " + std::to_string(of) : "") +
             kReexport);
      }
      words_ = LineWords(WithoutComment(line_));
    } while (words_.Done());
  }

  /// The next word of an element, `missing` words before its end; empty if there is none. It may be
  /// on one of the following lines if these have as many words as are missing, and no more: a line
  /// that was cut off does not take the words of the next element.
  std::string_view Next(std::int64_t missing) {
    if (!words_.Done()) return words_.Next();
    if (!continues_) continues_ = FollowingLinesHave(missing);
    while (*continues_ && words_.Done() && lines_.Next(&line_)) {
      words_ = LineWords(WithoutComment(line_));
    }
    return words_.Next();
  }

  bool FollowingLinesHave(std::int64_t count) const {
    Lines ahead = lines_;
    for (std::string_view line; count > 0 && ahead.Next(&line);) {
      for (LineWords words(WithoutComment(line)); !words.Done(); words.Next()) --count;
    }
    return count == 0;
  }

  void ReadHeader() {
    Begin({"its header"});
    std::string_view vertices;
    if (!ParseInteger(LineWords(words_).Next())) {
      const std::string_view word = words_.Next();
      // ModelNet's files have the first number in the same word.
      const size_t digits = std::min(word.find_first_of("0123456789", 1), word.size());
      CheckKeyword(word.substr(0, digits), word);
      vertices = word.substr(digits);
    }
    if (vertices.empty()) {
      if (words_.Done()) Begin({"the numbers of vertices and polygons"});
      vertices = words_.Next();
    }
    const bool alone = words_.Done();
    num_vertices_ = Count(vertices, "vertices");
    num_polygons_ = Count(Next(1), "polygons");
    if (num_vertices_ == 0) Fail("the header says that there are no vertices");
    // The number of edges is not needed, and missing in some files.
    if (alone && FollowingLinesHave(1)) Begin({"the number of edges"});
  }

  /// [ST][C][N]OFF, in any order and in small letters too: x y z is followed by the data that the
  /// letters stand for, which is not stored. A small n in front of capitals is a dimension.
  void CheckKeyword(std::string_view keyword, std::string_view word) {
    const std::string small = InSmallLetters(keyword);
    const size_t off = small.find("off");
    std::string prefix = small.substr(0, off);
    for (const std::string data : {"st", "c", "n"}) {
      const size_t at = prefix.find(data);
      if (at != std::string::npos) prefix.erase(at, data.size());
    }
    const bool has_dimension = keyword.find("nO") != std::string_view::npos;
    if (off == std::string::npos || off + 3 != small.size() || !prefix.empty() || has_dimension) {
      Fail("begins with " + Quoted(word) + ", not with OFF, COFF, NOFF or STOFF; " +
           "export it as OFF with three coordinates a vertex");
    }
    if (InSmallLetters(LineWords(words_).Next()) == "binary") {
      Fail("binary OFF is not read; export it as text");
    }
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
      Begin(element, num_vertices_);
      soup_.vertex_line.push_back(lines_.Number());
      static constexpr const char* kAxes[3] = {"coordinate x", "coordinate y", "coordinate z"};
      for (int axis = 0; axis < 3; ++axis) {
        soup_.vertices(axis, v) =
            FiniteNumber(Next(3 - axis), kAxes[axis], soup_.file, lines_.Number(), element);
      }
      if (!words_.Done()) ++further_vertex_numbers_;
    }
  }

  void ReadPolygons() {
    for (int p = 0; p < num_polygons_; ++p) {
      const ElementName element{"polygon", static_cast<size_t>(p + 1)};
      Begin(element, num_polygons_);
      soup_.polygon_line.push_back(lines_.Number());
      const std::string_view word = words_.Next();
      const std::optional<std::int64_t> size = ParseInteger(word);
      if (!size || *size < 3) {
        Fail(element.Text() + ": " + Quoted(word) + " corners, a polygon needs three" + kReexport);
      }
      for (std::int64_t k = 0; k < *size; ++k) {
        const std::string_view index = Next(*size - k);
        if (index.empty()) {
          Fail(element.Text() + ": " + std::to_string(k) + " of " + std::to_string(*size) +
               " corners, the others are missing" + kReexport);
        }
        soup_.corners.push_back(Index(index, element));
      }
      if (!words_.Done()) ++further_polygon_numbers_;
      soup_.polygon_begin.push_back(static_cast<int>(soup_.corners.size()));
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
  LineWords words_{std::string_view()};  // of the current element, up to the end of a line
  std::optional<bool> continues_;        // whether it goes on on the next line, where that is known
  Soup soup_;
  int num_vertices_ = 0, num_polygons_ = 0;
  int further_vertex_numbers_ = 0, further_polygon_numbers_ = 0;
};

}  // namespace

Soup ReadOff(const std::string& file, const std::string& text) {
  return OffReader(file, WithoutByteOrderMark(text)).Read();
}

}  // namespace shapespace::internal
