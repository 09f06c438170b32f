#include <cstdint>

#include <shapespace/base/internal/bytes.h>
#include <shapespace/files/detail/write_formats.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/triangulate.h>

namespace shapespace::internal {

std::string StlContent(const Shape& vertices, const Soup& soup) {
  const Eigen::Matrix3Xi triangles =
      soup.triangles.cols() > 0 ? soup.triangles
                                : Triangulate(soup.polygon_begin, soup.corners, {vertices});
  // Readers take a file whose first word is "solid" for text.
  std::string bytes = "binary STL of shapespace";
  bytes.reserve(84 + 50 * triangles.cols());
  bytes.resize(80, ' ');
  AppendLittleEndian(static_cast<std::uint32_t>(triangles.cols()), &bytes);
  for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
    const Eigen::Vector3d normal = UnitNormal(vertices, triangles.col(f));
    for (const double x : normal) AppendLittleEndian(static_cast<float>(x), &bytes);
    for (const int v : triangles.col(f)) {
      for (const double x : vertices.col(v)) AppendLittleEndian(static_cast<float>(x), &bytes);
    }
    AppendLittleEndian(std::uint16_t{0}, &bytes);
  }
  return bytes;
}

}  // namespace shapespace::internal
