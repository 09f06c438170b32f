#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/read_formats.h>

namespace shapespace::internal {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Elements of a kind, and the line of the first.
struct Seen {
  int count = 0, first_line = 0;
  void Add(int line) {
    if (count++ == 0) first_line = line;
  }
};

/// The current name of `usemtl`, `g` or `o`, for the following polygons.
class CurrentName {
 public:
  explicit CurrentName(PolygonNames* names) : names_(names) {}

  /// An empty name means none.
  void Set(std::string_view name) {
    current_ = name.empty() ? nullptr : &index_.try_emplace(std::string(name), -1).first->second;
    if (current_ != nullptr && *current_ < 0) pending_ = name;
  }

  void AddPolygon() {
    if (current_ != nullptr && *current_ < 0) {
      *current_ = static_cast<int>(names_->names.size());
      names_->names.push_back(pending_);
    }
    names_->of_polygon.push_back(current_ == nullptr ? -1 : *current_);
  }

  /// Returns the number of names that no polygon has.
  int Finish() {
    if (names_->names.empty()) names_->of_polygon.clear();
    return static_cast<int>(index_.size() - names_->names.size());
  }

 private:
  PolygonNames* names_;
  std::map<std::string, int, std::less<>> index_;  // index of the name; -1: no polygon yet
  int* current_ = nullptr;                         // in `index_`
  std::string pending_;                            // the current name, until a polygon has it
};

class ObjReader {
 public:
  ObjReader(const std::string& file, std::string text) : text_(std::move(text)) {
    soup_.file = file;
    soup_.appearance.folder = std::filesystem::u8path(file).parent_path().u8string();
    soup_.appearance.own_folder = soup_.appearance.folder;
  }

  Soup Read() {
    BlankByteOrderMark(&text_);
    size_t position = 0;
    while (position < text_.size()) position = ReadLine(position);
    if (coordinates_.empty()) {
      throw FileError(soup_.file + ": no vertex in it; is this an OBJ file?");
    }
    soup_.vertices = Eigen::Map<Shape>(coordinates_.data(), 3, NumVertices());
    CheckIndices();
    FinishTexture();
    FinishColours();
    TellDropped();
    return std::move(soup_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { FailAt(soup_.file, line_, what); }

  int NumVertices() const { return static_cast<int>(coordinates_.size() / 3); }
  int NumTexture() const { return static_cast<int>(texture_.size() / 2); }

  /// Joins lines that end with a backslash, with blanks; returns the beginning of the next line.
  size_t ReadLine(size_t begin) {
    line_ = ++lines_read_;
    size_t end = EndOfLine(begin);
    while (end > begin && text_[end - 1] == '\\' && end < text_.size()) {
      const size_t next = AfterLineEnd(end);
      text_.replace(end - 1, next - end + 1, next - end + 1, ' ');
      ++lines_read_;
      end = EndOfLine(next);
    }
    const std::string_view line(text_.data() + begin, end - begin);
    if (line.find('\0') != std::string_view::npos) {
      Fail("a zero byte: this is no text file, or it is stored as UTF-16");
    }
    ReadStatement(line);
    return end < text_.size() ? AfterLineEnd(end) : end;
  }

  size_t EndOfLine(size_t begin) const {
    return std::min(text_.find_first_of("\r\n", begin), text_.size());
  }

  size_t AfterLineEnd(size_t end) const {
    return end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
  }

  void ReadStatement(std::string_view line) {
    LineWords words(line);
    const std::string_view keyword = words.Next();
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "v") return ReadVertex(LineWords(WithoutComment(words.Rest())));
    if (keyword == "vt") return ReadTexture(LineWords(WithoutComment(words.Rest())));
    if (keyword == "f") return ReadPolygon(LineWords(WithoutComment(words.Rest())));
    if (keyword == "l") return ReadPolyline(LineWords(WithoutComment(words.Rest())));
    if (keyword == "usemtl") return material_.Set(words.Rest());
    if (keyword == "g") return group_.Set(words.Rest());
    if (keyword == "o") return object_.Set(words.Rest());
    if (keyword == "mtllib") {
      if (!words.Done()) soup_.appearance.material_libraries.emplace_back(words.Rest());
      return;
    }
    dropped_[std::string(keyword.substr(0, kLongestKeyword))].Add(line_);
  }

  double Number(std::string_view word, const char* what, const ElementName& element) const {
    return FiniteNumber(word, what, soup_.file, line_, element);
  }

  void ReadVertex(LineWords words) {
    soup_.vertex_line.push_back(line_);
    const ElementName element{"vertex", soup_.vertex_line.size()};
    for (const char* axis : {"coordinate x", "coordinate y", "coordinate z"}) {
      coordinates_.push_back(Number(words.Next(), axis, element));
    }
    // x y z may be followed by a weight, or by a colour of three or four numbers.
    double further[4] = {1, 1, 1, 1};
    int count = 0;
    for (; !words.Done(); ++count) {
      const double number = Unneeded(words.Next());
      if (count < 4) further[count] = number;
    }
    if (count == 2 || count > 4) unknown_further_.Add(line_);
    if (count == 1 && further[0] != 1.0) ++weights_;
    if (count == 3 || count == 4) {
      ++num_coloured_;
      any_opacity_ = any_opacity_ || count == 4;
      // Vertices without a colour are white.
      colours_.resize(4 * (soup_.vertex_line.size() - 1), 1.0);
      colours_.insert(colours_.end(), further, further + 4);
    }
  }

  /// A number that the mesh does not need: NaN if the word is none, or an infinite one.
  static double Unneeded(std::string_view word) {
    const double number = ParseDouble(word).value_or(kNan);
    return std::isfinite(number) ? number : kNan;
  }

  void ReadTexture(LineWords words) {
    double numbers[3] = {kNan, 0, 0};
    int count = 0;
    for (; !words.Done(); ++count) {
      const double number = Unneeded(words.Next());
      if (count < 3) numbers[count] = number;
    }
    // Those that are no numbers keep their place in the list, but no corner will have them.
    const bool good = !std::isnan(numbers[0] + numbers[1]);
    if (!good) bad_texture_.Add(line_);
    texture_.push_back(good ? numbers[0] : kNan);
    texture_.push_back(good ? numbers[1] : kNan);
    if (numbers[2] != 0.0 || count > 3) ++third_texture_;
  }

  void ReadPolygon(LineWords words) {
    soup_.polygon_line.push_back(line_);
    const ElementName element{"polygon", soup_.polygon_line.size()};
    int count = 0;
    for (; !words.Done(); ++count) {
      const auto [vertex, texture] = Corner(words.Next(), element);
      soup_.corners.push_back(vertex);
      soup_.appearance.corner_texture.push_back(texture);
    }
    if (count < 3) {
      Fail(element.Text() + ": " + std::to_string(count) + " corners, a polygon needs three" +
           kReexport);
    }
    soup_.polygon_begin.push_back(static_cast<int>(soup_.corners.size()));
    for (CurrentName* name : {&material_, &group_, &object_}) name->AddPolygon();
  }

  void ReadPolyline(LineWords words) {
    const ElementName element{"polyline on this line"};
    std::vector<int> vertices;
    while (!words.Done()) vertices.push_back(Corner(words.Next(), element).first);
    if (vertices.size() < 2) Fail(element.Text() + ": needs two vertices" + kReexport);
    for (size_t i = 1; i < vertices.size(); ++i) {
      soup_.segments.emplace_back(vertices[i - 1], vertices[i]);
      soup_.segment_line.push_back(line_);
    }
  }

  /// The vertex and the texture coordinate, or -1, of "v", "v/t", "v//n" or "v/t/n", where all but
  /// v may be empty. Counted from 0; whether they exist is checked at the end of the file.
  std::pair<int, int> Corner(std::string_view word, const ElementName& element) const {
    const size_t slash = std::min(word.find('/'), word.size());
    const std::optional<int> vertex = IndexFrom(word.substr(0, slash), NumVertices());
    if (!vertex) {
      Fail(element.Text() + ": corner " + Quoted(word) + " is not made of numbers counted from 1" +
           (ParseInteger(word.substr(0, slash)) == 0 ? kCountsFromOne : kReexport));
    }
    if (slash == word.size()) return {*vertex, -1};
    const std::string_view rest = word.substr(slash + 1);
    const size_t end = std::min(rest.find('/'), rest.size());
    if (end < rest.size() && rest.find('/', end + 1) != rest.npos) {
      Fail(element.Text() + ": corner " + Quoted(word) + " has more than three parts");
    }
    if (end == 0) return {*vertex, -1};
    return {*vertex, IndexFrom(rest.substr(0, end), NumTexture()).value_or(kNoIndex)};
  }

  /// Negative numbers count backwards from the last of `count` elements so far. Empty unless it is
  /// a number that could be an index; kNoIndex for an element before the first.
  static std::optional<int> IndexFrom(std::string_view digits, int count) {
    constexpr std::int64_t kMax = std::numeric_limits<int>::max();
    const std::optional<std::int64_t> number = ParseInteger(digits);
    if (!number || *number == 0 || *number < -kMax || *number > kMax) return std::nullopt;
    const auto index = static_cast<int>(*number);
    if (index > 0) return index - 1;
    return count + index >= 0 ? count + index : kNoIndex;
  }

  /// Corners keep the texture coordinates that exist and are numbers.
  void FinishTexture() {
    Appearance& appearance = soup_.appearance;
    bool any = false;
    for (int p = 0; p < soup_.NumPolygons(); ++p) {
      for (int k = soup_.polygon_begin[p]; k < soup_.polygon_begin[p + 1]; ++k) {
        int& texture = appearance.corner_texture[k];
        if (texture == -1) continue;
        if (texture == kNoIndex || texture >= NumTexture() || std::isnan(texture_[2 * texture])) {
          texture = -1;
          without_texture_.Add(soup_.polygon_line[p]);
        }
        any = any || texture != -1;
      }
    }
    if (!any) return appearance.corner_texture.clear();
    std::replace_if(
        texture_.begin(), texture_.end(), [](double x) { return std::isnan(x); }, 0.0);
    appearance.texture_coordinates = Eigen::Map<Eigen::Matrix2Xd>(texture_.data(), 2, NumTexture());
  }

  void FinishColours() {
    if (num_coloured_ == 0) return;
    colours_.resize(4 * soup_.vertex_line.size(), 1.0);
    const auto outside = [](double x) { return !(x >= 0 && x <= 1); };
    if (std::any_of(colours_.begin(), colours_.end(), outside)) {
      Tell(num_coloured_, "vertex colours (some number of them is not in 0 .. 1)");
    } else {
      soup_.appearance.vertex_colours =
          Eigen::Map<Eigen::Matrix4Xd>(colours_.data(), 4, NumVertices())
              .topRows(any_opacity_ ? 4 : 3);
    }
  }

  void CheckIndices() const {
    for (int p = 0; p < soup_.NumPolygons(); ++p) {
      for (int k = soup_.polygon_begin[p]; k < soup_.polygon_begin[p + 1]; ++k) {
        CheckVertex(soup_.corners[k], soup_.polygon_line[p],
                    {"polygon", static_cast<size_t>(p + 1)});
      }
    }
    for (size_t s = 0; s < soup_.segments.size(); ++s) {
      for (const int v : {soup_.segments[s].first, soup_.segments[s].second}) {
        CheckVertex(v, soup_.segment_line[s], {"segment", s + 1});
      }
    }
  }

  void CheckVertex(int index, int line, const ElementName& element) const {
    if (index >= 0 && index < NumVertices()) return;
    FailAt(soup_.file, line,
           element.Text() + ": " +
               (index < 0 ? "a relative index reaches before the first vertex"
                          : "vertex " + std::to_string(index + 1) + " does not exist") +
               ", the file has " + std::to_string(NumVertices()) + kReexport);
  }

  void Tell(int count, const std::string& what) {
    if (count > 0) soup_.dropped.push_back(std::to_string(count) + " " + what + " not kept");
  }

  void TellFirst(const Seen& seen, const std::string& what) {
    Tell(seen.count, what + " (the first on line " + std::to_string(seen.first_line) + ")");
  }

  void TellDropped() {
    Tell(weights_, "vertex weights other than 1");
    TellFirst(unknown_further_, "vertices' further numbers, which are no colours,");
    Tell(third_texture_, "third texture coordinates");
    TellFirst(bad_texture_, "texture coordinates that are not finite numbers");
    TellFirst(without_texture_, "corners' texture coordinates that the file does not have");
    if (soup_.appearance.corner_texture.empty()) {
      Tell(NumTexture() - bad_texture_.count, "texture coordinates that no polygon has");
    }
    Tell(material_.Finish(), "materials (usemtl) that no polygon has");
    Tell(group_.Finish(), "group names (g) that no polygon has");
    Tell(object_.Finish(), "object names (o) that no polygon has");
    static const std::map<std::string, std::string> kKnown = {
        {"vn", "normals (vn)"}, {"s", "smoothing groups (s)"}, {"p", "points (p)"}};
    constexpr int kMaxUnknown = 5;
    int unknown = 0;
    for (const auto& [keyword, seen] : dropped_) {
      const auto known = kKnown.find(keyword);
      if (known != kKnown.end()) {
        Tell(seen.count, known->second);
      } else if (++unknown <= kMaxUnknown) {
        TellFirst(seen, "statements " + Quoted(keyword));
      }
    }
    Tell(unknown - kMaxUnknown, "further kinds of statement");
  }

  static constexpr size_t kLongestKeyword = 40;
  static constexpr int kNoIndex = -2;  // -1 stands for a texture coordinate that is not wanted

  std::string text_;
  Soup soup_;
  int lines_read_ = 0;
  int line_ = 0;                               // on which the current statement begins
  std::vector<double> coordinates_, texture_;  // three per vertex, two per texture coordinate
  std::vector<double> colours_;                // four per vertex, up to the last one with a colour
  int num_coloured_ = 0, weights_ = 0, third_texture_ = 0;
  bool any_opacity_ = false;
  Seen bad_texture_, without_texture_, unknown_further_;
  CurrentName material_{&soup_.appearance.materials}, group_{&soup_.appearance.groups},
      object_{&soup_.appearance.objects};
  std::map<std::string, Seen> dropped_;  // by keyword
};

}  // namespace

Soup ReadObj(const std::string& file, std::string text) {
  return ObjReader(file, std::move(text)).Read();
}

}  // namespace shapespace::internal
