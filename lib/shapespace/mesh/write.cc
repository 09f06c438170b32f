#include <shapespace/mesh/write.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <ostream>

#include <shapespace/base/atomic_file.h>
#include <shapespace/base/error.h>
#include <shapespace/base/extension.h>

namespace shapespace {
namespace {

/// Text put together in one piece of memory: streams format numbers several times slower.
class Text {
 public:
  void Add(std::string_view words) { text_ += words; }

  /// Numbers stand behind `words`. Those that are not whole have the fewest digits that read back
  /// as the very number.
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

/// The names of polygons as statements, written where a polygon has another than the one before.
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

/// Appends the bytes of a number, lowest first on any machine.
template <typename Bits, typename T>
void AddBytes(T number, std::string* bytes) {
  static_assert(sizeof(Bits) == sizeof(T));
  Bits bits;
  std::memcpy(&bits, &number, sizeof bits);
  for (size_t i = 0; i < sizeof bits; ++i) *bytes += static_cast<char>(bits >> (8 * i) & 0xff);
}

std::string Ply(const Shape& vertices, const Soup& soup) {
  int longest = 0;
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    longest = std::max(longest, soup.polygon_begin[p + 1] - soup.polygon_begin[p]);
  }
  // One byte a length is what every reader knows; longer polygons leave no choice.
  const bool short_lengths = longest <= 255;
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(vertices.cols()) +
                      "\nproperty double x\nproperty double y\nproperty double z\n";
  if (soup.NumPolygons() > 0) {
    bytes += "element face " + std::to_string(soup.NumPolygons()) + "\nproperty list " +
             (short_lengths ? "uchar" : "int") + " int vertex_indices\n";
  }
  if (!soup.segments.empty()) {
    bytes += "element edge " + std::to_string(soup.segments.size()) +
             "\nproperty int vertex1\nproperty int vertex2\n";
  }
  bytes += "end_header\n";
  bytes.reserve(bytes.size() + 24 * vertices.cols() + 4 * soup.corners.size() +
                4 * soup.polygon_begin.size() + 8 * soup.segments.size());
  for (int i = 0; i < vertices.size(); ++i) {
    AddBytes<std::uint64_t>(vertices.data()[i], &bytes);
  }
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    const int begin = soup.polygon_begin[p], end = soup.polygon_begin[p + 1];
    if (short_lengths) {
      bytes += static_cast<char>(end - begin);
    } else {
      AddBytes<std::uint32_t>(end - begin, &bytes);
    }
    for (int k = begin; k < end; ++k) AddBytes<std::uint32_t>(soup.corners[k], &bytes);
  }
  for (const auto& [a, b] : soup.segments) {
    AddBytes<std::uint32_t>(a, &bytes);
    AddBytes<std::uint32_t>(b, &bytes);
  }
  return bytes;
}

}  // namespace

void WriteMesh(const std::string& file, const Shape& vertices, const Soup& soup) {
  const std::string extension = Extension(file);
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
  const std::string content = extension == ".obj" ? Obj(vertices, soup) : Ply(vertices, soup);
  WriteFileAtomically(file, [&content](std::ostream& stream) {
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  });
}

}  // namespace shapespace
