#include <shapespace/exploration/space_file.h>

#include <algorithm>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/json.h>
#include <shapespace/base/internal/quoted.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/path/internal/metric_arrays.h>

namespace shapespace {
namespace {

using internal::ArrayReader;
using internal::ArrayWriter;
using internal::HeaderJson;

constexpr internal::ArrayFileKind kKind = {"SHAPPLAN", 1, ".space"};

PoseSpace Parse(const std::string& file, const HeaderJson& header, const ArrayReader& arrays) {
  PoseSpace space;
  space.metric = internal::ReadMetric(header, arrays);
  space.appearance = internal::ReadAppearance(header, file, arrays);
  const int count = header.at("nodes").get<int>();
  for (int i = 0; i < count; ++i) {
    space.nodes.push_back(arrays.Get<Shape>("node" + std::to_string(i), 3,
                                            space.metric->connectivity->NumVertices()));
  }
  space.names = internal::NamesFromJson(header.at("names"));
  header.at("stress").get_to(space.stress);
  header.at("provenance").get_to(space.provenance);
  space.translation = arrays.Get<Eigen::Vector3d>("translation", 3, 1);
  space.points = arrays.Get<Eigen::Matrix2Xd>("points", 2, count);
  space.triangles = arrays.Get<Eigen::Matrix3Xi>("plane_triangles", 3, Eigen::Dynamic);
  space.segments = arrays.Get<Eigen::Matrix2Xi>("plane_segments", 2, Eigen::Dynamic);
  space.distances = arrays.Get<Eigen::MatrixXd>("distances", Eigen::Dynamic, Eigen::Dynamic);
  const auto parents = arrays.Get<Eigen::Matrix2Xi>("parents", 2, Eigen::Dynamic);
  for (int i = 0; i < parents.cols(); ++i) space.parents.push_back({parents(0, i), parents(1, i)});
  space.Validate();
  return space;
}

Eigen::Vector2d PointFrom(const internal::Json& entry, const PoseSpace& space,
                          const std::string& field) {
  if (entry.is_string()) {
    const std::string name = entry.get<std::string>();
    const auto found = std::find(space.names.begin(), space.names.end(), name);
    if (found == space.names.end()) {
      internal::FailIn(field, internal::Quoted(name) + " is not a pose of the space");
    }
    return space.points.col(found - space.names.begin());
  }
  if (!entry.is_array() || entry.size() != 2) {
    internal::FailIn(field, "must be two numbers, or the name of a pose");
  }
  return {internal::NumberFrom(entry[0], field), internal::NumberFrom(entry[1], field)};
}

}  // namespace

void WriteSpace(const std::string& file, const PoseSpace& space) {
  try {
    space.Validate();
  } catch (const MeshError& error) {
    throw MeshError(file + ": " + error.what());
  }
  HeaderJson header;
  ArrayWriter arrays;
  internal::AddMetric(*space.metric, &header, &arrays);
  internal::AddAppearance(space.appearance, file, &header, &arrays);
  header["nodes"] = space.NumNodes();
  header["names"] = internal::NamesToJson(space.names);
  header["stress"] = space.stress;
  header["provenance"] = space.provenance;
  arrays.Add("translation", space.translation);
  arrays.Add("points", space.points);
  arrays.Add("plane_triangles", space.triangles);
  arrays.Add("plane_segments", space.segments);
  arrays.Add("distances", space.distances);
  Eigen::Matrix2Xi parents(2, space.parents.size());
  for (Eigen::Index i = 0; i < parents.cols(); ++i) {
    parents.col(i) << space.parents[i][0], space.parents[i][1];
  }
  arrays.Add("parents", parents);
  for (int i = 0; i < space.NumNodes(); ++i) {
    arrays.Add("node" + std::to_string(i), space.nodes[i]);
  }
  internal::WriteArrayFile(file, kKind, std::move(header), arrays);
}

PoseSpace ReadSpace(const std::string& file) {
  return internal::ReadArrayFile(file, kKind,
                                 [&](const HeaderJson& header, const ArrayReader& arrays) {
                                   return Parse(file, header, arrays);
                                 });
}

std::vector<Eigen::Vector2d> ReadCurve(const std::string& file, const PoseSpace& space) {
  const std::string text = internal::ReadFile(file);
  try {
    const internal::Json json = internal::ParseJson(text);
    internal::CheckKeys(json, "", {"points", "$schema"});
    const internal::Json& entries =
        internal::ListFrom(internal::Required(json, "", "points"), "points");
    std::vector<Eigen::Vector2d> points;
    for (size_t i = 0; i < entries.size(); ++i) {
      const std::string field = "points (point " + std::to_string(i + 1) + ")";
      points.push_back(PointFrom(entries[i], space, field));
    }
    return points;
  } catch (const InvalidOptions& error) {
    throw FileError(file + ": " + error.what());
  }
}

}  // namespace shapespace
