#include <shapespace/mesh/write.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <ostream>

#include <shapespace/base/atomic_file.h>
#include <shapespace/base/error.h>

namespace shapespace {
namespace {

/// Text put together in one piece of memory: streams format numbers several times slower.
class Text {
 public:
  void Add(std::string_view words) { text_ += words; }

  void Add(int number) {
    char buffer[16];
    text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr);
  }

  void Add(double number) {
    constexpr int kDigits = 9;
    char buffer[32];
    text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number,
                                       std::chars_format::general, kDigits)
                             .ptr);
  }

  const std::string& Get() const { return text_; }

 private:
  std::string text_;
};

std::string Obj(const Shape& vertices, const Soup& appearance) {
  Text text;
  for (const std::string& library : appearance.material_libraries) {
    text.Add("mtllib " + library + "\n");
  }
  for (int v = 0; v < vertices.cols(); ++v) {
    text.Add("v ");
    text.Add(vertices(0, v));
    text.Add(" ");
    text.Add(vertices(1, v));
    text.Add(" ");
    text.Add(vertices(2, v));
    text.Add("\n");
  }
  for (int t = 0; t < appearance.texture_coordinates.cols(); ++t) {
    text.Add("vt ");
    text.Add(appearance.texture_coordinates(0, t));
    text.Add(" ");
    text.Add(appearance.texture_coordinates(1, t));
    text.Add("\n");
  }
  std::string material;
  for (int p = 0; p < appearance.NumPolygons(); ++p) {
    if (!appearance.polygon_material.empty() && appearance.polygon_material[p] != material) {
      material = appearance.polygon_material[p];
      text.Add("usemtl " + material + "\n");
    }
    text.Add("f");
    for (int k = appearance.polygon_begin[p]; k < appearance.polygon_begin[p + 1]; ++k) {
      text.Add(" ");
      text.Add(appearance.corners[k] + 1);
      if (!appearance.corner_texture.empty() && appearance.corner_texture[k] >= 0) {
        text.Add("/");
        text.Add(appearance.corner_texture[k] + 1);
      }
    }
    text.Add("\n");
  }
  for (const auto& [a, b] : appearance.segments) {
    text.Add("l ");
    text.Add(a + 1);
    text.Add(" ");
    text.Add(b + 1);
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

std::string Ply(const Shape& vertices, const Soup& appearance) {
  int longest = 0;
  for (int p = 0; p < appearance.NumPolygons(); ++p) {
    longest = std::max(longest, appearance.polygon_begin[p + 1] - appearance.polygon_begin[p]);
  }
  // One byte a length is what every reader knows; longer polygons leave no choice.
  const bool short_lengths = longest <= 255;
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(vertices.cols()) +
                      "\nproperty double x\nproperty double y\nproperty double z\n";
  if (appearance.NumPolygons() > 0) {
    bytes += "element face " + std::to_string(appearance.NumPolygons()) + "\nproperty list " +
             (short_lengths ? "uchar" : "int") + " int vertex_indices\n";
  }
  if (!appearance.segments.empty()) {
    bytes += "element edge " + std::to_string(appearance.segments.size()) +
             "\nproperty int vertex1\nproperty int vertex2\n";
  }
  bytes += "end_header\n";
  bytes.reserve(bytes.size() + 24 * vertices.cols() + 4 * appearance.corners.size() +
                4 * appearance.polygon_begin.size() + 8 * appearance.segments.size());
  for (int i = 0; i < vertices.size(); ++i) {
    AddBytes<std::uint64_t>(vertices.data()[i], &bytes);
  }
  for (int p = 0; p < appearance.NumPolygons(); ++p) {
    const int begin = appearance.polygon_begin[p], end = appearance.polygon_begin[p + 1];
    if (short_lengths) {
      bytes += static_cast<char>(end - begin);
    } else {
      AddBytes<std::uint32_t>(end - begin, &bytes);
    }
    for (int k = begin; k < end; ++k) AddBytes<std::uint32_t>(appearance.corners[k], &bytes);
  }
  for (const auto& [a, b] : appearance.segments) {
    AddBytes<std::uint32_t>(a, &bytes);
    AddBytes<std::uint32_t>(b, &bytes);
  }
  return bytes;
}

}  // namespace

void WriteMesh(const std::string& file, const Shape& vertices, const Soup& appearance) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".obj" && extension != ".ply") {
    throw FileError(file + ": the extension '" + extension +
                    "' is neither .obj nor .ply; name the file as one of these");
  }
  if (vertices.cols() != appearance.NumVertices()) {
    throw MeshError(file + ": " + std::to_string(vertices.cols()) +
                    " vertices for the polygons of a mesh of " +
                    std::to_string(appearance.NumVertices()));
  }
  for (int v = 0; v < vertices.cols(); ++v) {
    if (!vertices.col(v).allFinite()) {
      throw MeshError(file + ": vertex " + std::to_string(v + 1) +
                      ": a coordinate is not a finite number; nothing was written");
    }
  }
  const std::string content =
      extension == ".obj" ? Obj(vertices, appearance) : Ply(vertices, appearance);
  WriteFileAtomically(file, [&content](std::ostream& stream) {
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  });
}

}  // namespace shapespace
