#ifndef TESTS_OUTPUT_READ_PAGE_H_
#define TESTS_OUTPUT_READ_PAGE_H_

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <zlib.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <shapespace/base/internal/read_file.h>

namespace shapespace {

/// One of a page's scenes, as written in the file.
struct PageElement {
  std::string type, name, bytes;
};

inline std::string FromBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<char>(bits >> (count -= 8) & 255));
  }
  return bytes;
}

inline std::vector<PageElement> ReadPage(const std::string& file) {
  const std::string page = internal::ReadFile(file);
  std::vector<PageElement> elements;
  const auto between = [&](const std::string& begin, const std::string& end, size_t* at) {
    const size_t from = page.find(begin, *at) + begin.size();
    *at = page.find(end, from);
    if (*at == page.npos) throw std::runtime_error("no " + end);
    return page.substr(from, *at - from);
  };
  for (size_t at = 0; page.find("<script type=\"", at) != page.npos;) {
    PageElement element;
    element.type = between("<script type=\"", "\"", &at);
    element.name = between("data-name=\"", "\"", &at);
    element.bytes = FromBase64(between(">", "</script>", &at));
    elements.push_back(element);
  }
  return elements;
}

/// A scene's arrays, decoded according to docs/file-formats.md.
class DecodedScene {
 public:
  explicit DecodedScene(const std::string& compressed) {
    bytes_.resize(64 << 20);
    uLongf size = bytes_.size();
    if (uncompress(reinterpret_cast<Bytef*>(bytes_.data()), &size,
                   reinterpret_cast<const Bytef*>(compressed.data()), compressed.size()) != Z_OK) {
      throw std::runtime_error("cannot be decompressed");
    }
    bytes_.resize(size);
    unsigned length = 0;
    for (int k = 3; k >= 0; --k) length = length << 8 | Byte(k);
    at_ = 4;
    header = nlohmann::json::parse(Take(length));
    vertices = header["vertices"];
    triangles = Indices(3 * header["triangles"].get<int>());
    segments = Indices(2 * header["segments"].get<int>());
    for (int s = 0; s < header["shapes"]; ++s) ReadShape(s);
    if (header["kind"] == "path") {
      shades = Shades();
      if (!header["energyEnd"].is_null()) energy_shades = Shades();
      if (header["parts"] > 0) part_colours = Take(3 * vertices);
      if (!header["intersections"].is_null()) ReadIntersections();
    }
    if (header["colours"]) colours = Take(3 * vertices);
    if (header["kind"] == "path" && !header["textures"].is_null()) ReadTextures();
    if (at_ != bytes_.size()) throw std::runtime_error("bytes are left over");
  }

  /// A shape in the user's frame.
  Eigen::Matrix3Xd Shape(int s) const {
    Eigen::Vector3d low;
    for (int k = 0; k < 3; ++k) low[k] = header["low"][k];
    return (steps[s].cast<double>() * Step()).colwise() + low;
  }
  double Step() const { return header["side"].get<double>() / 65535; }

  nlohmann::json header;
  int vertices = 0;
  std::vector<int> triangles, segments;
  std::vector<Eigen::Matrix3Xi> steps;
  std::vector<Eigen::VectorXi> shades, energy_shades;  ///< of deviations and energies
  std::string colours, part_colours;
  std::vector<std::vector<int>> intersecting;  ///< vertices of each shape

  std::vector<int> drawn_source, drawn_corners;  ///< of a textured surface as it is drawn
  Eigen::Matrix2Xf texture_coordinates;
  std::vector<std::string> images;

 private:
  unsigned Byte(size_t at) const { return static_cast<unsigned char>(bytes_.at(at)); }
  std::string Take(size_t count) {
    if (at_ + count > bytes_.size()) throw std::runtime_error("ends too early");
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  static std::int64_t UnZigZag(std::int64_t code) {
    return code % 2 == 0 ? code / 2 : -(code + 1) / 2;
  }

  std::vector<Eigen::VectorXi> Shades() {
    std::vector<Eigen::VectorXi> read;
    Eigen::VectorXi last = Eigen::VectorXi::Zero(vertices);
    for (size_t s = 0; s < steps.size(); ++s) {
      const std::string differences = Take(vertices);
      for (int v = 0; v < vertices; ++v) {
        last[v] = (last[v] + static_cast<unsigned char>(differences[v])) & 255;
      }
      read.push_back(last);
    }
    return read;
  }

  std::vector<int> Indices(int count) {
    std::vector<int> indices;
    std::int64_t last = 0;
    for (int k = 0; k < count; ++k) {
      std::int64_t code = 0;
      for (int plane = 3; plane >= 0; --plane) code = code << 8 | Byte(at_ + plane * count + k);
      indices.push_back(static_cast<int>(last += UnZigZag(code)));
    }
    at_ += 4 * static_cast<size_t>(count);
    return indices;
  }

  void ReadIntersections() {
    int total = 0;
    for (const nlohmann::json& shape : header["intersections"]) {
      total += shape["vertices"].get<int>();
    }
    const std::vector<int> all = Indices(total);
    auto end = all.begin();
    for (const nlohmann::json& shape : header["intersections"]) {
      const auto begin = end;
      end += shape["vertices"].get<int>();
      intersecting.emplace_back(begin, end);
    }
  }

  void ReadTextures() {
    const nlohmann::json& textures = header["textures"];
    const int count = textures["vertices"];
    int corners = 0;
    for (const nlohmann::json& part : textures["parts"])
      corners += 3 * part["triangles"].get<int>();
    drawn_source = Indices(count);
    drawn_corners = Indices(corners);
    texture_coordinates.resize(2, count);
    for (int axis = 0; axis < 2; ++axis) {
      const std::vector<int> bits = Indices(count);
      for (int v = 0; v < count; ++v) {
        std::memcpy(&texture_coordinates(axis, v), &bits[v], sizeof(float));
      }
    }
    for (const nlohmann::json& image : textures["images"]) images.push_back(Take(image["bytes"]));
  }

  int Predicted(int s, int axis, int v) const {
    const auto at = [&](int shape) { return steps[shape](axis, v); };
    if (s == 0) return 0;
    if (header["kind"] == "path") return s == 1 ? at(0) : 2 * at(s - 1) - at(s - 2);
    if (header["kind"] == "modes") return at(0);
    const int poses = static_cast<int>(header["names"].size());
    if (s < poses) return at(s - 1);
    const nlohmann::json& parents = header["parents"][s - poses];
    return (at(parents[0]) + at(parents[1])) / 2;
  }

  void ReadShape(int s) {
    Eigen::Matrix3Xi shape(3, vertices);
    for (int axis = 0; axis < 3; ++axis) {
      std::int64_t off = 0;
      for (int v = 0; v < vertices; ++v) {
        off += UnZigZag(Byte(at_ + v) | Byte(at_ + vertices + v) << 8);
        shape(axis, v) = static_cast<int>((Predicted(s, axis, v) + off) & 65535);
      }
      at_ += 2 * static_cast<size_t>(vertices);
    }
    steps.push_back(shape);
  }

  std::string bytes_;
  size_t at_ = 0;
};

}  // namespace shapespace

#endif  // TESTS_OUTPUT_READ_PAGE_H_
