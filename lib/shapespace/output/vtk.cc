#include <shapespace/output/vtk.h>

#include <cstdint>
#include <ostream>
#include <utility>
#include <vector>

#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/vertex_energy.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/parallel.h>
#include <shapespace/output/frames.h>

namespace shapespace {
namespace {

// Arrays of a file: the XML tells their offsets in a block of bytes that follows after it.
class Arrays {
 public:
  template <typename Array>
  std::string Add(const char* type, const std::string& name, const Array& numbers,
                  const std::string& attributes = "") {
    std::string tag = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\"" +
                      attributes + " format=\"appended\" offset=\"" +
                      std::to_string(bytes_.size()) + "\"/>\n";
    using Number = std::decay_t<decltype(*std::begin(numbers))>;
    internal::AppendLittleEndian(std::uint64_t{std::size(numbers) * sizeof(Number)}, &bytes_);
    for (const Number number : numbers) internal::AppendLittleEndian(number, &bytes_);
    return tag;
  }

  const std::string& Bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Cells of polygons or lines: their corners, and where each ends among these.
std::string Cells(const char* kind, const std::vector<int>& corners, const std::vector<int>& ends,
                  Arrays* arrays) {
  std::string xml = "<" + std::string(kind) + ">\n";
  xml += arrays->Add("Int32", "connectivity", corners);
  xml += arrays->Add("Int32", "offsets", ends);
  return xml + "</" + kind + ">\n";
}

std::string Content(const Shape& placed, const Connectivity& connectivity, double time,
                    const std::vector<std::pair<const char*, Eigen::VectorXd>>& data) {
  Arrays arrays;
  std::vector<int> ends_of_segments, ends;
  for (const auto& [a, b] : connectivity.Segments()) {
    ends_of_segments.insert(ends_of_segments.end(), {a, b});
    ends.push_back(static_cast<int>(ends_of_segments.size()));
  }
  const std::vector<int>& begin = connectivity.PolygonBegin();
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n";
  xml += arrays.Add("Float64", "TimeValue", std::vector<double>{time}, " NumberOfTuples=\"1\"");
  xml += "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(placed.cols()) +
         "\" NumberOfLines=\"" + std::to_string(ends.size()) + "\" NumberOfPolys=\"" +
         std::to_string(connectivity.NumPolygons()) + "\">\n<PointData>\n";
  for (const auto& [name, values] : data) xml += arrays.Add("Float64", name, values);
  xml += "</PointData>\n<Points>\n";
  xml += arrays.Add("Float64", "Points", placed.reshaped(), " NumberOfComponents=\"3\"");
  xml += "</Points>\n";
  xml += Cells("Lines", ends_of_segments, ends, &arrays);
  xml += Cells("Polys", connectivity.Corners(), {begin.begin() + 1, begin.end()}, &arrays);
  xml += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">_";
  return xml + arrays.Bytes() + "</AppendedData>\n</VTKFile>\n";
}

}  // namespace

void WriteVtkSeries(const std::string& pattern, const Path& path, const Shape& reference) {
  path.Validate();
  FrameName(pattern, 0);  // throws before anything is written
  const Shape& rest = reference.cols() > 0 ? reference : path.shapes.at(0);
  std::vector<Eigen::VectorXd> energies;
  if (path.metric->options.rigid == 0) energies = VertexEnergy(path);
  ParallelFor(path.NumShapes(), [&](int i) {
    std::vector<std::pair<const char*, Eigen::VectorXd>> data = {
        {"deviation", EdgeDeviation(*path.metric, rest, path.shapes[i])}};
    if (!energies.empty()) data.emplace_back("energy", energies[i]);
    const std::string content =
        Content(path.Placed(i), *path.metric->connectivity, path.parameters[i], data);
    internal::WriteFileAtomically(FrameName(pattern, i),
                                  [&](std::ostream& stream) { stream << content; });
  });
}

}  // namespace shapespace
