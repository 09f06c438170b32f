#include <cmath>
#include <istream>
#include <map>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_obj_loader.h>

#include <shapespace/base/error.h>
#include <shapespace/mesh/read_formats.h>
#include <shapespace/mesh/text.h>

// tinyobjloader reads what is well-formed and takes anything else without a word: 'nan' and missing
// coordinates become 0, "1.5x" becomes 1.5, "f 1 2 x" a triangle with vertex 0. So every line is
// checked first (`Scan`), which also blanks what tinyobjloader would trip over, and keeps the line
// numbers and the polylines, which its callbacks do not deliver. Its callbacks are used rather than
// its `attrib_t`, which counts the corners of a polygon in a byte and loses or repeats polylines at
// `g` and `usemtl`.

namespace shapespace::internal {
namespace {

/// Checks the lines of an OBJ file one by one.
class Scan {
 public:
  Scan(const std::string& file, std::string* text, Soup* soup)
      : file_(file), text_(text), soup_(soup) {}

  /// \throw FileError at the first malformed line. Afterwards the text holds no byte order mark, no
  /// comment behind an element and no continued line; line numbers, segments, material libraries
  /// and what is dropped are in the soup.
  void Run() {
    if (text_->compare(0, 3, "\xEF\xBB\xBF") == 0) text_->replace(0, 3, 3, ' ');
    size_t position = 0;
    while (position < text_->size()) position = CheckLine(position);
    TellDropped();
  }

 private:
  /// Joins lines that a backslash continues, by blanks; returns where the text goes on.
  size_t CheckLine(size_t begin) {
    ++lines_read_;
    line_ = lines_read_;
    size_t end = EndOfLine(begin);
    while (end > begin && (*text_)[end - 1] == '\\' && end < text_->size()) {
      const size_t next = AfterLineEnd(end);
      text_->replace(end - 1, next - end + 1, next - end + 1, ' ');
      ++lines_read_;
      end = EndOfLine(next);
    }
    const std::string_view line(text_->data() + begin, end - begin);
    if (line.find('\0') != std::string_view::npos) {
      FailAt(file_, line_, "a zero byte: this is no text file, or it is stored as UTF-16");
    }
    CheckStatement(begin, line);
    return end < text_->size() ? AfterLineEnd(end) : end;
  }

  size_t EndOfLine(size_t begin) const {
    return std::min(text_->find_first_of("\r\n", begin), text_->size());
  }

  size_t AfterLineEnd(size_t end) const {
    return end + (text_->compare(end, 2, "\r\n") == 0 ? 2 : 1);
  }

  void CheckStatement(size_t begin, std::string_view line) {
    Words words(line);
    const std::string_view keyword = words.Next();
    if (keyword.empty() || keyword[0] == '#') return;
    const bool element = keyword == "v" || keyword == "vt" || keyword == "f" || keyword == "l";
    if (element) {
      const size_t comment = line.find('#');
      if (comment != std::string_view::npos) {
        text_->replace(begin + comment, line.size() - comment, line.size() - comment, ' ');
      }
    }
    if (keyword == "v") return CheckVertex(words);
    if (keyword == "vt") return CheckTexture(words);
    if (keyword == "f") return CheckPolygon(words);
    if (keyword == "l") return TakePolyline(words);
    if (keyword == "mtllib") {
      if (!words.Done()) soup_->material_libraries.emplace_back(words.Rest());
    } else if (keyword != "usemtl") {
      auto& [count, first_line] = dropped_[std::string(keyword.substr(0, kLongestKeyword))];
      if (count++ == 0) first_line = line_;
    }
  }

  void CheckVertex(Words words) {
    soup_->vertex_line.push_back(line_);
    const std::string element = "vertex " + std::to_string(soup_->vertex_line.size());
    for (const char* axis : {"coordinate x", "coordinate y", "coordinate z"}) {
      FiniteNumber(words.Next(), axis, file_, line_, element);
    }
    // Behind x y z stand a weight, or a colour of three or four numbers.
    double further[4];
    int count = 0;
    for (; !words.Done(); ++count) {
      if (count == 4) FailAt(file_, line_, element + ": more than seven numbers" + kReexport);
      further[count] = FiniteNumber(words.Next(), "what follows x y z,", file_, line_, element);
    }
    if (count == 2) FailAt(file_, line_, element + ": five numbers instead of three" + kReexport);
    if (count == 1 && further[0] != 1.0) ++weights_;
    if (count >= 3) ++colours_;
  }

  void CheckTexture(Words words) {
    ++num_texture_;
    const std::string element = "texture coordinate " + std::to_string(num_texture_);
    FiniteNumber(words.Next(), "u", file_, line_, element);
    if (!words.Done()) FiniteNumber(words.Next(), "v", file_, line_, element);
    if (!words.Done() && FiniteNumber(words.Next(), "w", file_, line_, element) != 0.0) {
      ++third_texture_;
    }
    if (!words.Done()) FailAt(file_, line_, element + ": more than three numbers" + kReexport);
  }

  void CheckPolygon(Words words) {
    soup_->polygon_line.push_back(line_);
    const std::string element = "polygon " + std::to_string(soup_->polygon_line.size());
    int corners = 0;
    for (; !words.Done(); ++corners) CheckCorner(words.Next(), element);
    if (corners < 3) {
      FailAt(
          file_, line_,
          element + ": " + std::to_string(corners) + " corners, a polygon needs three" + kReexport);
    }
  }

  void TakePolyline(Words words) {
    const std::string element = "polyline on this line";
    std::vector<int> vertices;
    while (!words.Done()) {
      const int number = CheckCorner(words.Next(), element);
      const int before = static_cast<int>(soup_->vertex_line.size());
      vertices.push_back(number > 0 ? number - 1 : before + number);
    }
    if (vertices.size() < 2) FailAt(file_, line_, element + ": needs two vertices" + kReexport);
    for (size_t i = 1; i < vertices.size(); ++i) {
      soup_->segments.emplace_back(vertices[i - 1], vertices[i]);
      soup_->segment_line.push_back(line_);
    }
  }

  /// Checks "v", "v/t", "v//n" or "v/t/n", with any but v empty; returns v.
  int CheckCorner(std::string_view word, const std::string& element) {
    const std::string_view whole = word;
    int vertex = 0;
    for (int part = 0; part < 3; ++part) {
      const size_t slash = std::min(word.find('/'), word.size());
      const std::string_view digits = word.substr(0, slash);
      if (!digits.empty() || part == 0) {
        const std::optional<std::int64_t> number = ParseInteger(digits);
        if (!number || *number == 0 || std::abs(*number) > std::numeric_limits<int>::max()) {
          FailAt(file_, line_,
                 element + ": corner " + Quoted(whole) + " is not made of numbers counted from 1" +
                     kReexport);
        }
        if (part == 0) vertex = static_cast<int>(*number);
      }
      if (slash == word.size()) return vertex;
      word.remove_prefix(slash + 1);
    }
    FailAt(file_, line_, element + ": corner " + Quoted(whole) + " has more than three parts");
  }

  void TellDropped() {
    auto tell = [this](int count, const std::string& what) {
      if (count > 0) soup_->dropped.push_back(std::to_string(count) + " " + what + " not kept");
    };
    tell(colours_, "vertex colours");
    tell(weights_, "vertex weights other than 1");
    tell(third_texture_, "third texture coordinates");
    static const std::map<std::string, std::string> kKnown = {{"vn", "normals (vn)"},
                                                              {"g", "group names (g)"},
                                                              {"o", "object names (o)"},
                                                              {"s", "smoothing groups (s)"},
                                                              {"p", "points (p)"}};
    constexpr int kMostUnknown = 5;
    int unknown = 0;
    for (const auto& [keyword, seen] : dropped_) {
      const auto known = kKnown.find(keyword);
      if (known != kKnown.end()) {
        tell(seen.first, known->second);
      } else if (++unknown <= kMostUnknown) {
        tell(seen.first, "statements " + Quoted(keyword) + " (the first on line " +
                             std::to_string(seen.second) + ")");
      }
    }
    tell(unknown - kMostUnknown, "further kinds of statement");
  }

  static constexpr size_t kLongestKeyword = 40;

  const std::string& file_;
  std::string* text_;
  Soup* soup_;
  int lines_read_ = 0;
  int line_ = 0;  // on which the statement at hand begins
  int num_texture_ = 0, weights_ = 0, colours_ = 0, third_texture_ = 0;
  std::map<std::string, std::pair<int, int>> dropped_;  // keyword -> count, first line
};

/// What tinyobjloader's callbacks fill.
struct Taken {
  Soup* soup;
  std::vector<double> vertices, texture;
  std::string material;
  bool any_texture = false, any_material = false;

  static Taken& From(void* user) { return *static_cast<Taken*>(user); }

  static void Vertex(void* user, double x, double y, double z, double) {
    From(user).vertices.insert(From(user).vertices.end(), {x, y, z});
  }

  static void Texture(void* user, double u, double v, double) {
    From(user).texture.insert(From(user).texture.end(), {u, v});
  }

  static void Material(void* user, const char* name, int) {
    From(user).material = std::string(Words(name).Rest());
    From(user).any_material = true;
  }

  static void Polygon(void* user, tinyobj::index_t* corners, int count) {
    Taken& taken = From(user);
    Soup& soup = *taken.soup;
    const int vertices = static_cast<int>(taken.vertices.size() / 3);
    const int texture = static_cast<int>(taken.texture.size() / 2);
    for (int k = 0; k < count; ++k) {
      const int v = corners[k].vertex_index, t = corners[k].texcoord_index;
      soup.corners.push_back(v > 0 ? v - 1 : vertices + v);
      // 0 stands for none, which becomes -1; a relative index before the first becomes -2.
      soup.corner_texture.push_back(t >= 0 ? t - 1 : texture + t >= 0 ? texture + t : -2);
      taken.any_texture = taken.any_texture || t != 0;
    }
    soup.polygon_begin.push_back(static_cast<int>(soup.corners.size()));
    soup.polygon_material.push_back(taken.material);
  }
};

/// A string as a stream without a copy.
class StringBuffer : public std::streambuf {
 public:
  explicit StringBuffer(std::string& text) {
    setg(text.data(), text.data(), text.data() + text.size());
  }
};

void CheckIndices(const Soup& soup) {
  auto outside = [&soup](int index, int line, const std::string& element, int count,
                         const std::string& what) {
    FailAt(soup.file, line,
           element + ": " +
               (index < 0 ? "a relative index reaches before the first " + what
                          : what + " " + std::to_string(index + 1) + " does not exist") +
               ", the file has " + std::to_string(count) + kReexport);
  };
  const int vertices = soup.NumVertices();
  const int texture = static_cast<int>(soup.texture_coordinates.cols());
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    for (int k = soup.polygon_begin[p]; k < soup.polygon_begin[p + 1]; ++k) {
      const int v = soup.corners[k];
      if (v < 0 || v >= vertices) {
        outside(v, soup.polygon_line[p], "polygon " + std::to_string(p + 1), vertices, "vertex");
      }
      const int t = soup.corner_texture.empty() ? -1 : soup.corner_texture[k];
      if (t < -1 || t >= texture) {
        outside(t, soup.polygon_line[p], "polygon " + std::to_string(p + 1), texture,
                "texture coordinate");
      }
    }
  }
  for (size_t s = 0; s < soup.segments.size(); ++s) {
    for (int v : {soup.segments[s].first, soup.segments[s].second}) {
      if (v < 0 || v >= vertices) {
        outside(v, soup.segment_line[s], "segment " + std::to_string(s + 1), vertices, "vertex");
      }
    }
  }
}

}  // namespace

Soup ReadObj(const std::string& file, std::string text) {
  Soup soup;
  soup.file = file;
  Scan(file, &text, &soup).Run();
  const size_t num_polygons = soup.polygon_line.size();
  if (soup.vertex_line.empty()) throw FileError(file + ": no vertex in it; is this an OBJ file?");

  Taken taken;
  taken.soup = &soup;
  taken.vertices.reserve(3 * soup.vertex_line.size());
  soup.corners.reserve(3 * num_polygons);
  soup.corner_texture.reserve(3 * num_polygons);
  soup.polygon_begin.reserve(num_polygons + 1);
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = Taken::Vertex;
  callbacks.texcoord_cb = Taken::Texture;
  callbacks.usemtl_cb = Taken::Material;
  callbacks.index_cb = Taken::Polygon;
  StringBuffer buffer(text);
  std::istream stream(&buffer);
  tinyobj::LoadObjWithCallback(stream, callbacks, &taken);

  if (taken.vertices.size() != 3 * soup.vertex_line.size() ||
      soup.polygon_begin.size() != num_polygons + 1) {
    throw FileError(file + ": holds statements that cannot be told apart" + kReexport);
  }
  soup.vertices = Eigen::Map<Shape>(taken.vertices.data(), 3, soup.vertex_line.size());
  if (taken.any_texture) {
    soup.texture_coordinates =
        Eigen::Map<Eigen::Matrix2Xd>(taken.texture.data(), 2, taken.texture.size() / 2);
  } else {
    soup.corner_texture.clear();
  }
  if (!taken.any_material) soup.polygon_material.clear();
  CheckIndices(soup);
  return soup;
}

}  // namespace shapespace::internal
