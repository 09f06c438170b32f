#include <shapespace/files/write.h>

#include <algorithm>
#include <ostream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/files/detail/write_formats.h>
#include <shapespace/files/internal/storable.h>

namespace shapespace {
namespace {

struct Format {
  const char* extension;
  std::string (*content)(const Shape& vertices, const Soup& soup);
};

constexpr Format kPly = {".ply", &internal::PlyContent};
constexpr Format kFormats[] = {{".obj", &internal::ObjContent},
                               kPly,
                               {".off", &internal::OffContent},
                               {".stl", &internal::StlContent}};

const Format* WriterOf(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  for (const Format& format : kFormats) {
    if (extension == format.extension) return &format;
  }
  return nullptr;
}

// The file's content. `name` is used in messages.
std::string ContentOf(const std::string& name, const Format& format, const Shape& vertices,
                      const Soup& soup) {
  const std::string extension = format.extension;
  if (vertices.cols() != soup.NumVertices()) {
    throw MeshError(name + ": " + std::to_string(vertices.cols()) +
                    " vertices for the polygons of a mesh of " +
                    std::to_string(soup.NumVertices()));
  }
  internal::CheckFinite(name, vertices);
  try {
    soup.appearance.Validate(soup.NumVertices(), soup.NumPolygons(),
                             static_cast<int>(soup.corners.size()));
  } catch (const MeshError& error) {
    throw MeshError(name + ": " + error.what());
  }
  if (extension == ".ply" && !soup.appearance.texture_coordinates.cast<float>().allFinite()) {
    throw MeshError(name + ": a texture coordinate is too large for PLY's single precision");
  }
  if ((extension == ".off" || extension == ".stl") && soup.NumPolygons() == 0) {
    throw MeshError(name + ": the mesh has no polygons, and the format stores no segments; " +
                    "write .obj or .ply");
  }
  if (extension == ".stl") internal::CheckSinglePrecision(name, vertices);
  return format.content(vertices, soup);
}

}  // namespace

bool IsWritableMesh(const std::string& file) { return WriterOf(file) != nullptr; }

std::vector<std::string> NotKept(const std::string& file, const Soup& soup) {
  const std::string extension = internal::FileExtension(file);
  if (extension == ".obj") return {};
  const bool is_ply = extension == ".ply";
  const Appearance& appearance = soup.appearance;
  const std::vector<int>& texture = appearance.corner_texture;
  std::vector<std::string> sentences;
  std::string names;
  const auto add = [&names](bool present, const char* what) {
    if (present) names += (names.empty() ? "" : ", ") + std::string(what);
  };
  add(!appearance.materials.of_polygon.empty(), "materials");
  add(!appearance.groups.of_polygon.empty(), "groups");
  add(!appearance.objects.of_polygon.empty(), "objects");
  if (!is_ply) {
    add(!texture.empty(), "texture coordinates");
    add(appearance.vertex_colours.size() > 0, "vertex colours");
    add(!soup.segments.empty(), "segments");
  }
  if (!names.empty()) sentences.push_back(names + " are dropped; OBJ keeps them");
  int partly = 0;
  for (int p = 0; is_ply && p < soup.NumPolygons() && !texture.empty(); ++p) {
    const auto begin = texture.begin() + soup.polygon_begin[p];
    const auto end = texture.begin() + soup.polygon_begin[p + 1];
    partly +=
        !internal::IsTextured(soup, p) && std::any_of(begin, end, [](int t) { return t >= 0; });
  }
  if (partly > 0) {
    sentences.push_back("texture coordinates of " + std::to_string(partly) +
                        " polygons are dropped, since some of their corners have none");
  }
  return sentences;
}

void WriteMesh(const std::string& file, const Shape& vertices, const Soup& soup) {
  const Format* const format = WriterOf(file);
  if (format == nullptr) {
    throw FileError(file + ": the extension '" + internal::FileExtension(file) +
                    "' is not one of .obj, .ply, .off, .stl; name the file as one of these");
  }
  const std::string content = ContentOf(file, *format, vertices, soup);
  internal::WriteFileAtomically(file, [&content](std::ostream& stream) {
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  });
}

void WritePly(std::ostream& stream, const std::string& name, const Shape& vertices,
              const Soup& soup) {
  const std::string content = ContentOf(name, kPly, vertices, soup);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  if (!stream.flush()) throw FileError(name + ": writing failed (is the disk full?)");
}

}  // namespace shapespace
