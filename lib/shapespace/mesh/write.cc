#include <shapespace/mesh/write.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ostream>

#include <shapespace/base/atomic_file.h>
#include <shapespace/base/error.h>
#include <shapespace/base/extension.h>

namespace shapespace {
namespace {

/// Text assembled in one block of memory, because streams format numbers several times slower.
class Text {
 public:
  void Add(std::string_view words) { text_ += words; }

  /// Appends `words` and a number. Numbers that are not integers have the fewest digits that
  /// reproduce the number exactly.
  template <typename Number>
  void Add(std::string_view words, Number number) {
    Add(words);
    char buffer[32];
    text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr);
  }

  const std::string& Get() const { return text_; }

 private:
  std::string text_;
};

/// The names of polygons as statements, written where they change from one polygon to the next.
class NameStatements {
 public:
  NameStatements(const char* keyword, const PolygonNames& names)
      : keyword_(keyword), names_(names) {}

  void Next(int polygon, Text* text) {
    const int name = names_.of_polygon.empty() ? -1 : names_.of_polygon[polygon];
    if (name == current_) return;
    current_ = name;
    text->Add(keyword_);
    if (name >= 0) text->Add(" " + names_.names[name]);
    text->Add("\n");
  }

 private:
  const char* keyword_;
  const PolygonNames& names_;
  int current_ = -1;
};

std::string Obj(const Shape& vertices, const Soup& soup) {
  const Appearance& appearance = soup.appearance;
  Text text;
  for (const std::string& library : appearance.material_libraries) {
    text.Add("mtllib " + library + "\n");
  }
  for (int v = 0; v < vertices.cols(); ++v) {
    text.Add("v");
    for (const double x : vertices.col(v)) text.Add(" ", x);
    if (appearance.vertex_colours.size() > 0) {
      for (const double x : appearance.vertex_colours.col(v)) text.Add(" ", x);
    }
    text.Add("\n");
  }
  for (const auto& coordinates : appearance.texture_coordinates.colwise()) {
    text.Add("vt");
    for (const double x : coordinates) text.Add(" ", x);
    text.Add("\n");
  }
  NameStatements objects("o", appearance.objects), groups("g", appearance.groups),
      materials("usemtl", appearance.materials);
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    for (NameStatements* names : {&objects, &groups, &materials}) names->Next(p, &text);
    text.Add("f");
    for (int k = soup.polygon_begin[p]; k < soup.polygon_begin[p + 1]; ++k) {
      text.Add(" ", soup.corners[k] + 1);
      if (!appearance.corner_texture.empty() && appearance.corner_texture[k] >= 0) {
        text.Add("/", appearance.corner_texture[k] + 1);
      }
    }
    text.Add("\n");
  }
  for (const auto& [a, b] : soup.segments) {
    text.Add("l ", a + 1);
    text.Add(" ", b + 1);
    text.Add("\n");
  }
  return text.Get();
}

/// Appends the bytes of a number in little-endian order on any machine.
template <typename Bits, typename T>
void AddBytes(T number, std::string* bytes) {
  static_assert(sizeof(Bits) == sizeof(T));
  Bits bits;
  std::memcpy(&bits, &number, sizeof bits);
  for (size_t i = 0; i < sizeof bits; ++i) *bytes += static_cast<char>(bits >> (8 * i) & 0xff);
}

/// Whether every corner of the polygon has a texture coordinate.
bool IsTextured(const Soup& soup, int polygon) {
  const std::vector<int>& texture = soup.appearance.corner_texture;
  return !texture.empty() && std::none_of(texture.begin() + soup.polygon_begin[polygon],
                                          texture.begin() + soup.polygon_begin[polygon + 1],
                                          [](int index) { return index < 0; });
}

/// Lists in PLY. If all lengths fit, they are stored in one byte, which every reader supports.
class Lists {
 public:
  explicit Lists(int longest) : short_lengths_(longest <= 255) {}

  const char* LengthType() const { return short_lengths_ ? "uchar" : "int"; }

  void AddLength(int length, std::string* bytes) const {
    if (short_lengths_) {
      *bytes += static_cast<char>(length);
    } else {
      AddBytes<std::uint32_t>(length, bytes);
    }
  }

 private:
  bool short_lengths_;
};

std::string Ply(const Shape& vertices, const Soup& soup) {
  const Appearance& appearance = soup.appearance;
  const Eigen::MatrixXd& colours = appearance.vertex_colours;
  int longest = 0;
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    longest = std::max(longest, soup.polygon_begin[p + 1] - soup.polygon_begin[p]);
  }
  const Lists corners(longest), texture(2 * longest);
  const bool textured = !appearance.corner_texture.empty();
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(vertices.cols()) +
                      "\nproperty double x\nproperty double y\nproperty double z\n";
  static constexpr const char* kChannels[] = {"red", "green", "blue", "alpha"};
  for (int c = 0; c < colours.rows(); ++c) {
    bytes += std::string("property uchar ") + kChannels[c] + "\n";
  }
  if (soup.NumPolygons() > 0) {
    bytes += "element face " + std::to_string(soup.NumPolygons()) + "\nproperty list " +
             corners.LengthType() + " int vertex_indices\n";
    if (textured) {
      bytes += std::string("property list ") + texture.LengthType() + " float texcoord\n";
    }
  }
  if (!soup.segments.empty()) {
    bytes += "element edge " + std::to_string(soup.segments.size()) +
             "\nproperty int vertex1\nproperty int vertex2\n";
  }
  bytes += "end_header\n";
  bytes.reserve(bytes.size() + 28 * vertices.cols() + (textured ? 12 : 4) * soup.corners.size() +
                8 * soup.polygon_begin.size() + 8 * soup.segments.size());
  for (int v = 0; v < vertices.cols(); ++v) {
    for (const double x : vertices.col(v)) AddBytes<std::uint64_t>(x, &bytes);
    for (int c = 0; c < colours.rows(); ++c) {
      bytes += static_cast<char>(std::lround(255 * colours(c, v)));
    }
  }
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    const int begin = soup.polygon_begin[p], end = soup.polygon_begin[p + 1];
    corners.AddLength(end - begin, &bytes);
    for (int k = begin; k < end; ++k) AddBytes<std::uint32_t>(soup.corners[k], &bytes);
    if (!textured) continue;
    const bool has_all = IsTextured(soup, p);
    texture.AddLength(has_all ? 2 * (end - begin) : 0, &bytes);
    for (int k = begin; has_all && k < end; ++k) {
      for (const double x : appearance.texture_coordinates.col(appearance.corner_texture[k])) {
        AddBytes<std::uint32_t>(static_cast<float>(x), &bytes);
      }
    }
  }
  for (const auto& [a, b] : soup.segments) {
    AddBytes<std::uint32_t>(a, &bytes);
    AddBytes<std::uint32_t>(b, &bytes);
  }
  return bytes;
}

}  // namespace

std::vector<std::string> NotKept(const std::string& file, const Soup& soup) {
  if (FileExtension(file) != ".ply") return {};
  const Appearance& appearance = soup.appearance;
  std::vector<std::string> sentences;
  std::string names;
  const auto add = [&names](const PolygonNames& of, const char* what) {
    if (!of.of_polygon.empty()) names += (names.empty() ? "" : ", ") + std::string(what);
  };
  add(appearance.materials, "materials");
  add(appearance.groups, "groups");
  add(appearance.objects, "objects");
  if (!names.empty()) sentences.push_back(names + " are dropped; OBJ keeps them");
  const std::vector<int>& texture = appearance.corner_texture;
  int partly = 0;
  for (int p = 0; p < soup.NumPolygons() && !texture.empty(); ++p) {
    const auto begin = texture.begin() + soup.polygon_begin[p];
    const auto end = texture.begin() + soup.polygon_begin[p + 1];
    partly += !IsTextured(soup, p) && std::any_of(begin, end, [](int t) { return t >= 0; });
  }
  if (partly > 0) {
    sentences.push_back("texture coordinates of " + std::to_string(partly) +
                        " polygons are dropped, since some of their corners have none");
  }
  return sentences;
}

void WriteMesh(const std::string& file, const Shape& vertices, const Soup& soup) {
  const std::string extension = FileExtension(file);
  if (extension != ".obj" && extension != ".ply") {
    throw FileError(file + ": the extension '" + extension +
                    "' is neither .obj nor .ply; name the file as one of these");
  }
  if (vertices.cols() != soup.NumVertices()) {
    throw MeshError(file + ": " + std::to_string(vertices.cols()) +
                    " vertices for the polygons of a mesh of " +
                    std::to_string(soup.NumVertices()));
  }
  for (int v = 0; v < vertices.cols(); ++v) {
    if (!vertices.col(v).allFinite()) {
      throw MeshError(file + ": vertex " + std::to_string(v + 1) +
                      ": a coordinate is not a finite number; nothing was written");
    }
  }
  try {
    soup.appearance.Validate(soup.NumVertices(), soup.NumPolygons(),
                             static_cast<int>(soup.corners.size()));
  } catch (const MeshError& error) {
    throw MeshError(file + ": " + error.what());
  }
  if (extension == ".ply" && !soup.appearance.texture_coordinates.cast<float>().allFinite()) {
    throw MeshError(file + ": a texture coordinate is too large for PLY's single precision");
  }
  const std::string content = extension == ".obj" ? Obj(vertices, soup) : Ply(vertices, soup);
  WriteFileAtomically(file, [&content](std::ostream& stream) {
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  });
}

}  // namespace shapespace
