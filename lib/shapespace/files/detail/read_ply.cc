#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/number_type.h>
#include <shapespace/files/detail/read_formats.h>

namespace shapespace::internal {
namespace {

enum class Format { kText, kLittleEndian, kBigEndian };
using Type = NumberType;

std::optional<Type> ParseType(std::string_view word) {
  struct Name {
    std::string_view name, with_size;
    Type type;
  };
  static constexpr Name kNames[] = {
      {"char", "int8", Type::kInt8},      {"uchar", "uint8", Type::kUint8},
      {"short", "int16", Type::kInt16},   {"ushort", "uint16", Type::kUint16},
      {"int", "int32", Type::kInt32},     {"uint", "uint32", Type::kUint32},
      {"float", "float32", Type::kFloat}, {"double", "float64", Type::kDouble}};
  for (const Name& known : kNames) {
    if (word == known.name || word == known.with_size) return known.type;
  }
  return std::nullopt;
}

struct Property {
  std::string name;
  Type type = Type::kInt8;
  std::optional<Type> count_type;  // of a list
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(const std::string& file, const std::string& text, std::string wanted = {})
      : text_(text), lines_(text), wanted_(std::move(wanted)) {
    soup_.file = file;
  }

  /// The requested property of all vertices.
  Eigen::VectorXd ReadField() {
    Read();
    return std::move(field_);
  }

  Soup Read() {
    ReadHeader();
    for (const Element& element : elements_) {
      CheckCount(element);
      if (element.name == "vertex") {
        ReadVertices(element);
      } else if (element.name == "face") {
        ReadPolygons(element);
      } else if (element.name == "edge") {
        ReadSegments(element);
      } else {
        Skip(element);
      }
    }
    CheckEnd();
    CheckIndices();
    FinishAppearance();
    return std::move(soup_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    FailAt(soup_.file, in_header_ || IsText() ? lines_.Number() : 0, what);
  }

  bool IsText() const { return format_ == Format::kText; }

  // ---- header

  void ReadHeader() {
    std::string_view line;
    if (!lines_.Next(&line) || LineWords(line).Next() != "ply") {
      Fail("does not begin with 'ply'; is this a PLY file?");
    }
    bool has_format = false;
    while (true) {
      if (!lines_.Next(&line)) Fail("the file ends inside its header" + std::string(kReexport));
      LineWords words(line);
      const std::string_view keyword = words.Next();
      if (keyword == "end_header") break;
      if (keyword == "format") {
        ReadFormat(words.Next());
        has_format = true;
      } else if (keyword == "element") {
        ReadElement(words);
      } else if (keyword == "property") {
        ReadProperty(words);
      } else if (keyword == "comment") {
        // Some programs name the image for the texture coordinates in a comment.
        if (words.Next() == "TextureFile") {
          soup_.dropped.push_back("texture file " + Quoted(words.Rest()) +
                                  " not kept; a material of an OBJ can name it");
        }
      } else if (keyword != "obj_info" && !keyword.empty()) {
        Fail("the header holds " + Quoted(keyword) + ", which is not a statement of PLY" +
             kReexport);
      }
    }
    if (!has_format) Fail("the header has no 'format' statement" + std::string(kReexport));
    in_header_ = false;
    position_ = text_.size() - lines_.BytesLeft();
    const Element* vertex = nullptr;
    for (const Element& element : elements_) {
      if (element.name == "vertex") vertex = &element;
      if (element.name == "tristrips" && element.count > 0) {
        Fail("triangle strips are not read; export polygons (faces) instead");
      }
    }
    if (vertex == nullptr || vertex->count == 0) Fail("the header says that there are no vertices");
  }

  void ReadFormat(std::string_view word) {
    if (word == "ascii") {
      format_ = Format::kText;
    } else if (word == "binary_little_endian") {
      format_ = Format::kLittleEndian;
    } else if (word == "binary_big_endian") {
      format_ = Format::kBigEndian;
    } else {
      Fail("format " + Quoted(word) +
           " is not one of ascii, binary_little_endian, binary_big_endian");
    }
  }

  void ReadElement(LineWords words) {
    Element element;
    element.name = words.Next();
    for (const Element& other : elements_) {
      if (other.name == element.name) Fail("element " + Quoted(element.name) + " occurs twice");
    }
    const std::string_view word = words.Next();
    const std::optional<std::int64_t> count = ParseInteger(word);
    if (!count || *count < 0) {
      Fail("element " + Quoted(element.name) + ": " + Quoted(word) + " is not a count" + kReexport);
    }
    element.count = *count;
    elements_.push_back(std::move(element));
  }

  void ReadProperty(LineWords words) {
    if (elements_.empty()) Fail("a property precedes any element" + std::string(kReexport));
    Property property;
    std::string_view word = words.Next();
    if (word == "list") {
      const std::string_view count_word = words.Next();
      property.count_type = ParseType(count_word);
      if (!property.count_type || !IsInteger(*property.count_type)) {
        Fail(Quoted(count_word) + " is not a type that can count the items of a list");
      }
      word = words.Next();
    }
    const std::optional<Type> type = ParseType(word);
    if (!type) Fail(Quoted(word) + " is not a type of PLY");
    property.type = *type;
    property.name = words.Next();
    for (const Property& other : elements_.back().properties) {
      if (other.name == property.name) Fail("property " + Quoted(property.name) + " occurs twice");
    }
    elements_.back().properties.push_back(std::move(property));
  }

  // ---- values

  size_t BytesLeft() const { return IsText() ? lines_.BytesLeft() : text_.size() - position_; }

  /// Rejects a count that exceeds the rest of the file, before memory is allocated for it.
  void CheckCount(const Element& element) {
    if (element.count > 0 && element.properties.empty()) {
      Fail("element " + Quoted(element.name) + " has no properties" + kReexport);
    }
    size_t least = 0;
    for (const Property& property : element.properties) {
      least += IsText() ? 2 : Size(property.count_type.value_or(property.type));
    }
    // The last line of a text need not be terminated.
    const size_t held = least == 0 ? 0 : (BytesLeft() + (IsText() ? 1 : 0)) / least;
    if (static_cast<std::uint64_t>(element.count) > held) {
      Fail("the header promises " + std::to_string(element.count) + " of element " +
           Quoted(element.name) + ", the file has room for at most " + std::to_string(held) +
           kReexport);
    }
  }

  /// Begins the next instance of an element; `label` is its name in messages.
  void Begin(const std::string& label) {
    label_ = label;
    if (!IsText()) return;
    std::string_view line;
    do {
      if (!lines_.Next(&line)) Fail("the file ends before " + label_ + kReexport);
      words_ = LineWords(line);
    } while (words_.Done());
  }

  void End() {
    if (IsText() && !words_.Done()) {
      Fail(label_ + ": " + Quoted(words_.Next()) + " at the end of its line is too much" +
           kReexport);
    }
  }

  std::string_view Word(const std::string& what) {
    const std::string_view word = words_.Next();
    if (word.empty()) Fail(label_ + ": " + what + " is missing" + kReexport);
    return word;
  }

  double Number(Type type, const std::string& what) {
    if (IsText()) {
      const std::string_view word = Word(what);
      const std::optional<double> value = ParseDouble(word);
      if (!value) Fail(label_ + ": " + what + " " + NotANumber(word));
      return *value;
    }
    if (BytesLeft() < Size(type)) Fail("the file ends inside " + label_ + kReexport);
    const bool swap = (format_ == Format::kBigEndian) != MachineIsBigEndian();
    const double value = Decode(text_.data() + position_, type, swap);
    position_ += Size(type);
    return value;
  }

  /// A number that the mesh does not need: NaN if a text has something else in its place.
  double Unneeded(Type type, const std::string& what) {
    if (!IsText()) return Number(type, what);
    return ParseDouble(Word(what)).value_or(std::numeric_limits<double>::quiet_NaN());
  }

  /// Length of the next list.
  std::int64_t Length(const Property& property) {
    const double length = Number(*property.count_type, "the length of " + property.name);
    const size_t room = BytesLeft() / (IsText() ? 1 : Size(property.type));
    if (!(length >= 0) || length != std::floor(length)) {
      Fail(label_ + ": the length of " + property.name + " is not a count" + kReexport);
    }
    if (length > static_cast<double>(room) && !IsText()) {
      Fail("the file ends inside " + label_ + kReexport);
    }
    return static_cast<std::int64_t>(std::min(length, 1e15));
  }

  void Skip(const Property& property) {
    const std::int64_t count = property.count_type ? Length(property) : 1;
    for (std::int64_t i = 0; i < count; ++i) Unneeded(property.type, property.name);
  }

  void Skip(const Element& element) {
    for (std::int64_t i = 0; i < element.count; ++i) {
      Begin(element.name + " " + std::to_string(i + 1));
      for (const Property& property : element.properties) Skip(property);
      End();
    }
    if (element.count > 0) {
      soup_.dropped.push_back(std::to_string(element.count) + " of element " +
                              Quoted(element.name) + " not kept");
    }
  }

  void TellDropped(const Element& element, const std::vector<int>& role) {
    std::string names;
    for (size_t i = 0; i < role.size(); ++i) {
      if (role[i] < 0) names += (names.empty() ? "" : ", ") + element.properties[i].name;
    }
    if (!names.empty() && element.count > 0) {
      soup_.dropped.push_back("properties of element " + Quoted(element.name) +
                              " not kept: " + names);
    }
  }

  // ---- elements

  /// For each property its index in `wanted`, or -1.
  std::vector<int> Roles(const Element& element, const std::vector<std::string>& wanted) const {
    std::vector<int> role(element.properties.size(), -1);
    for (size_t w = 0; w < wanted.size(); ++w) {
      bool found = false;
      for (size_t i = 0; i < role.size(); ++i) {
        if (element.properties[i].name != wanted[w]) continue;
        if (element.properties[i].count_type) {
          Fail("property " + wanted[w] + " of element " + element.name + " is a list");
        }
        role[i] = static_cast<int>(w);
        found = true;
      }
      if (!found) Fail("element " + element.name + " has no property " + wanted[w] + kReexport);
    }
    return role;
  }

  /// The value of this type that corresponds to full colour; empty if the type is not used for
  /// colours.
  static std::optional<double> FullColour(const Property& property) {
    if (property.count_type) return std::nullopt;
    switch (property.type) {
      case Type::kUint8:
        return 255;
      case Type::kUint16:
        return 65535;
      case Type::kFloat:
      case Type::kDouble:
        return 1;
      default:
        return std::nullopt;
    }
  }

  /// Assigns the roles 3 to 6 to red, green, blue and alpha, if vertices have the first three.
  /// Returns the number of channels, or 0.
  static int AddColourRoles(const Element& element, std::vector<int>* role) {
    static constexpr const char* kChannels[] = {"red", "green", "blue", "alpha"};
    int place[4] = {-1, -1, -1, -1};
    for (size_t i = 0; i < role->size(); ++i) {
      for (int c = 0; c < 4; ++c) {
        const Property& property = element.properties[i];
        if (property.name == kChannels[c] && FullColour(property)) place[c] = static_cast<int>(i);
      }
    }
    if (std::count(place, place + 3, -1) > 0) return 0;
    const int channels = place[3] < 0 ? 3 : 4;
    for (int c = 0; c < channels; ++c) (*role)[place[c]] = 3 + c;
    return channels;
  }

  void ReadVertices(const Element& element) {
    std::vector<int> role = Roles(element, {"x", "y", "z"});
    const int count = static_cast<int>(element.count);
    soup_.vertices.resize(3, count);
    soup_.appearance.vertex_colours.resize(AddColourRoles(element, &role), count);
    TellDropped(element, role);
    int of_field = -1;
    if (!wanted_.empty()) {
      const std::vector<int> wanted = Roles(element, {wanted_});
      of_field = static_cast<int>(std::find(wanted.begin(), wanted.end(), 0) - wanted.begin());
      field_.resize(count);
    }
    for (int v = 0; v < count; ++v) {
      Begin("vertex " + std::to_string(v + 1));
      for (size_t i = 0; i < role.size(); ++i) {
        const Property& property = element.properties[i];
        if (role[i] < 0 && static_cast<int>(i) != of_field) {
          Skip(property);
          continue;
        }
        const bool needed = role[i] < 3 || static_cast<int>(i) == of_field;
        const double value =
            needed ? Number(property.type, property.name) : Unneeded(property.type, property.name);
        if (static_cast<int>(i) == of_field) field_(v) = value;
        if (role[i] < 0) continue;
        if (role[i] >= 3) {
          soup_.appearance.vertex_colours(role[i] - 3, v) = value / *FullColour(property);
          continue;
        }
        if (!std::isfinite(value)) {
          Fail(label_ + ": coordinate " + property.name + " is not a finite number" + kReexport);
        }
        soup_.vertices(role[i], v) = value;
      }
      End();
      if (IsText()) soup_.vertex_line.push_back(lines_.Number());
    }
  }

  void ReadPolygons(const Element& element) {
    if (element.count == 0) return;
    std::vector<int> role(element.properties.size(), -1);
    int found = 0;
    for (size_t i = 0; i < role.size(); ++i) {
      const Property& property = element.properties[i];
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      if (!property.count_type || !IsInteger(property.type)) {
        Fail("property " + property.name + " of element face is not a list of integers");
      }
      role[i] = 0;
      ++found;
    }
    for (size_t i = 0; i < role.size(); ++i) {
      const Property& property = element.properties[i];
      if (property.name != "texcoord" || !property.count_type || IsInteger(property.type)) continue;
      role[i] = 1;
    }
    if (found != 1) {
      Fail("element face needs one list vertex_indices, it has " + std::to_string(found) +
           kReexport);
    }
    TellDropped(element, role);
    for (std::int64_t p = 0; p < element.count; ++p) {
      Begin("polygon " + std::to_string(p + 1));
      for (size_t i = 0; i < role.size(); ++i) {
        if (role[i] < 0) {
          Skip(element.properties[i]);
        } else if (role[i] == 0) {
          ReadCorners(element.properties[i]);
        } else {
          ReadTexture(element.properties[i]);
        }
      }
      End();
      AddTexture();
      if (IsText()) soup_.polygon_line.push_back(lines_.Number());
    }
  }

  void ReadCorners(const Property& property) {
    const std::int64_t count = Length(property);
    if (count < 3) {
      Fail(label_ + ": " + std::to_string(count) + " corners, a polygon needs three" + kReexport);
    }
    for (std::int64_t k = 0; k < count; ++k) soup_.corners.push_back(Index(property));
    soup_.polygon_begin.push_back(static_cast<int>(soup_.corners.size()));
  }

  /// Texture coordinates of the current polygon: u and v of each corner.
  void ReadTexture(const Property& property) {
    const std::int64_t count = Length(property);
    polygon_texture_.clear();
    for (std::int64_t k = 0; k < count; ++k) {
      polygon_texture_.push_back(Unneeded(property.type, property.name));
    }
  }

  /// Assigns them to its corners. Equal ones are merged, as in OBJ.
  void AddTexture() {
    std::vector<int>& corner_texture = soup_.appearance.corner_texture;
    const size_t corners = soup_.corners.size() - corner_texture.size();
    const bool fits = polygon_texture_.size() == 2 * corners &&
                      std::all_of(polygon_texture_.begin(), polygon_texture_.end(),
                                  [](double number) { return std::isfinite(number); });
    if (!fits && !polygon_texture_.empty()) ++unfit_texture_;
    for (size_t k = 0; k < corners; ++k) {
      if (!fits) {
        corner_texture.push_back(-1);
        continue;
      }
      const std::pair<double, double> uv(polygon_texture_[2 * k], polygon_texture_[2 * k + 1]);
      const int next = static_cast<int>(texture_.size() / 2);
      const auto [found, is_new] = texture_index_.try_emplace(uv, next);
      if (is_new) texture_.insert(texture_.end(), {uv.first, uv.second});
      corner_texture.push_back(found->second);
    }
    polygon_texture_.clear();
  }

  void FinishAppearance() {
    Appearance& appearance = soup_.appearance;
    if (unfit_texture_ > 0) {
      soup_.dropped.push_back("texture coordinates of " + std::to_string(unfit_texture_) +
                              " polygons, which are not two finite numbers a corner, not kept");
    }
    if (texture_.empty()) appearance.corner_texture.clear();
    appearance.texture_coordinates =
        Eigen::Map<Eigen::Matrix2Xd>(texture_.data(), 2, texture_.size() / 2);
    if (appearance.vertex_colours.rows() == 0) appearance.vertex_colours.resize(0, 0);
    const auto shares = appearance.vertex_colours.array();
    if (!((shares >= 0).all() && (shares <= 1).all())) {
      soup_.dropped.push_back(std::to_string(soup_.NumVertices()) +
                              " vertex colours (some number of them is not in 0 .. 1) not kept");
      appearance.vertex_colours.resize(0, 0);
    }
  }

  /// A vertex index; its range is checked when the number of vertices is known, because elements
  /// may be in any order.
  int Index(const Property& property) {
    const double value = Number(property.type, "vertex index");
    if (!(value >= 0) || value > std::numeric_limits<int>::max() || value != std::floor(value)) {
      Fail(label_ + ": a vertex index is not a number counted from 0" + kReexport);
    }
    return static_cast<int>(value);
  }

  void ReadSegments(const Element& element) {
    if (element.count == 0) return;
    const std::vector<int> role = Roles(element, {"vertex1", "vertex2"});
    TellDropped(element, role);
    for (std::int64_t s = 0; s < element.count; ++s) {
      Begin("segment " + std::to_string(s + 1));
      int ends[2] = {0, 0};
      for (size_t i = 0; i < role.size(); ++i) {
        if (role[i] < 0) {
          Skip(element.properties[i]);
        } else {
          ends[role[i]] = Index(element.properties[i]);
        }
      }
      End();
      soup_.segments.emplace_back(ends[0], ends[1]);
      if (IsText()) soup_.segment_line.push_back(lines_.Number());
    }
  }

  // ---- afterwards

  void CheckEnd() {
    if (!IsText()) {
      if (BytesLeft() > 0) {
        soup_.dropped.push_back(std::to_string(BytesLeft()) +
                                " bytes after the last element not kept");
      }
      return;
    }
    std::string_view line;
    int further_lines = 0;
    while (lines_.Next(&line)) {
      LineWords words(line);
      if (words.Done()) continue;
      // Further elements begin with a number.
      if (ParseDouble(words.Next())) {
        Fail("something follows the last element; the counts of the header do not fit" +
             std::string(kReexport));
      }
      ++further_lines;
    }
    if (further_lines > 0) {
      soup_.dropped.push_back(std::to_string(further_lines) +
                              " lines after the last element not kept");
    }
  }

  void CheckIndices() const {
    const int vertices = soup_.NumVertices();
    auto check = [&](int v, const std::vector<int>& lines, size_t i, const std::string& what) {
      if (v < vertices) return;
      FailAt(soup_.file, lines.empty() ? 0 : lines[i],
             what + " " + std::to_string(i + 1) + ": vertex index " + std::to_string(v) +
                 " is not one of 0 to " + std::to_string(vertices - 1) + kReexport);
    };
    for (int p = 0; p < soup_.NumPolygons(); ++p) {
      for (int k = soup_.polygon_begin[p]; k < soup_.polygon_begin[p + 1]; ++k) {
        check(soup_.corners[k], soup_.polygon_line, p, "polygon");
      }
    }
    for (size_t s = 0; s < soup_.segments.size(); ++s) {
      check(soup_.segments[s].first, soup_.segment_line, s, "segment");
      check(soup_.segments[s].second, soup_.segment_line, s, "segment");
    }
  }

  const std::string& text_;
  Lines lines_;          // of the header, and of a text's elements
  size_t position_ = 0;  // in the bytes of a binary file
  bool in_header_ = true;
  Format format_ = Format::kText;
  std::vector<Element> elements_;
  std::string label_;  // of the current instance
  LineWords words_{std::string_view()};
  std::vector<double> polygon_texture_;                     // of the current polygon
  std::vector<double> texture_;                             // u, v, u, v, ...
  std::map<std::pair<double, double>, int> texture_index_;  // of those
  int unfit_texture_ = 0;
  std::string wanted_;  // a requested property of vertices; empty for none
  Eigen::VectorXd field_;
  Soup soup_;
};

}  // namespace

Soup ReadPly(const std::string& file, const std::string& text) {
  return PlyReader(file, text).Read();
}

Eigen::VectorXd ReadPlyProperty(const std::string& file, const std::string& text,
                                const std::string& property) {
  return PlyReader(file, text, property).ReadField();
}

}  // namespace shapespace::internal
