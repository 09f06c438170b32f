#include <shapespace/output/frames.h>

#include <regex>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/files/write.h>

namespace shapespace {

bool IsNumbered(const std::string& file) {
  static const std::regex number("%0?[1-9]?d");
  return std::regex_search(file, number);
}

std::string FrameName(const std::string& pattern, int number) {
  static const std::regex place("^([^%]*)%(0?)([1-9]?)d([^%]*)$");
  std::smatch match;
  if (!std::regex_match(pattern, match, place)) {
    throw FileError(pattern + ": a name for frames needs one number, as in frames/%03d.obj");
  }
  std::string digits = std::to_string(number);
  const size_t width = match[3].length() > 0 ? std::stoul(match[3]) : 0;
  if (digits.size() < width) {
    digits.insert(0, width - digits.size(), match[2].length() > 0 ? '0' : ' ');
  }
  return match[1].str() + digits + match[4].str();
}

void WriteFrames(const std::string& pattern, const std::vector<Shape>& shapes, const Soup& soup,
                 const std::vector<Eigen::MatrixXd>& colours) {
  FrameName(pattern, 0);  // throws before anything is written
  if (!colours.empty() && colours.size() != shapes.size()) {
    throw InvalidOptions("colours", "there must be as many as shapes");
  }
  ParallelFor(static_cast<int>(shapes.size()), [&](int i) {
    WriteMesh(FrameName(pattern, i), shapes[i],
              colours.empty() ? soup : Coloured(soup, colours[i]));
  });
}

Soup Coloured(Soup soup, const Eigen::MatrixXd& colours) {
  Appearance& appearance = soup.appearance;
  appearance.vertex_colours = colours;
  appearance.texture_coordinates.resize(2, 0);
  appearance.corner_texture.clear();
  appearance.material_libraries.clear();
  appearance.materials = {};
  return soup;
}

Soup FrameSoup(const Connectivity& connectivity, const Appearance& appearance) {
  Soup soup;
  soup.vertices.setZero(3, connectivity.NumVertices());
  soup.polygon_begin = connectivity.PolygonBegin();
  soup.corners = connectivity.Corners();
  soup.triangles = connectivity.FileTriangles();
  soup.segments = connectivity.Segments();
  soup.appearance = appearance;
  return soup;
}

}  // namespace shapespace
