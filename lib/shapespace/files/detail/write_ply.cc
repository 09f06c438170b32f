#include <algorithm>
#include <cmath>
#include <cstdint>

#include <shapespace/base/internal/bytes.h>
#include <shapespace/files/detail/write_formats.h>

namespace shapespace::internal {
namespace {

/// Lists in PLY. If all lengths fit, they are stored in one byte, which every reader supports.
class Lists {
 public:
  explicit Lists(int longest) : short_lengths_(longest <= 255) {}

  const char* LengthType() const { return short_lengths_ ? "uchar" : "int"; }

  void AddLength(int length, std::string* bytes) const {
    if (short_lengths_) {
      *bytes += static_cast<char>(length);
    } else {
      AppendLittleEndian(static_cast<std::int32_t>(length), bytes);
    }
  }

 private:
  bool short_lengths_;
};

}  // namespace

bool IsTextured(const Soup& soup, int polygon) {
  const std::vector<int>& texture = soup.appearance.corner_texture;
  return !texture.empty() && std::none_of(texture.begin() + soup.polygon_begin[polygon],
                                          texture.begin() + soup.polygon_begin[polygon + 1],
                                          [](int index) { return index < 0; });
}

std::string PlyContent(const Shape& vertices, const Soup& soup) {
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
    for (const double x : vertices.col(v)) AppendLittleEndian(x, &bytes);
    for (int c = 0; c < colours.rows(); ++c) {
      bytes += static_cast<char>(std::lround(255 * colours(c, v)));
    }
  }
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    const int begin = soup.polygon_begin[p], end = soup.polygon_begin[p + 1];
    corners.AddLength(end - begin, &bytes);
    for (int k = begin; k < end; ++k) AppendLittleEndian(soup.corners[k], &bytes);
    if (!textured) continue;
    const bool has_all = IsTextured(soup, p);
    texture.AddLength(has_all ? 2 * (end - begin) : 0, &bytes);
    for (int k = begin; has_all && k < end; ++k) {
      for (const double x : appearance.texture_coordinates.col(appearance.corner_texture[k])) {
        AppendLittleEndian(static_cast<float>(x), &bytes);
      }
    }
  }
  for (const auto& [a, b] : soup.segments) {
    AppendLittleEndian(a, &bytes);
    AppendLittleEndian(b, &bytes);
  }
  return bytes;
}

}  // namespace shapespace::internal
