#include <shapespace/exploration/internal/space_arrays.h>

#include <string>

namespace shapespace::internal {

void AddSpace(const PoseSpace& space, const std::string& file, HeaderJson* header,
              ArrayWriter* arrays) {
  AddMetric(*space.metric, header, arrays);
  AddAppearance(space.appearance, file, header, arrays);
  (*header)["nodes"] = space.NumNodes();
  (*header)["names"] = NamesToJson(space.names);
  (*header)["stress"] = space.stress;
  (*header)["provenance"] = space.provenance;
  arrays->Add("translation", space.translation);
  arrays->Add("points", space.points);
  arrays->Add("plane_triangles", space.triangles);
  arrays->Add("plane_segments", space.segments);
  arrays->Add("distances", space.distances);
  Eigen::Matrix2Xi parents(2, space.parents.size());
  for (Eigen::Index i = 0; i < parents.cols(); ++i) {
    parents.col(i) << space.parents[i][0], space.parents[i][1];
  }
  arrays->Add("parents", parents);
  for (int i = 0; i < space.NumNodes(); ++i) {
    arrays->Add("node" + std::to_string(i), space.nodes[i]);
  }
}

PoseSpace ReadSpace(const std::string& file, const HeaderJson& header, const ArrayReader& arrays) {
  PoseSpace space;
  space.metric = ReadMetric(header, arrays);
  space.appearance = ReadAppearance(header, file, arrays);
  const int count = CountFrom(header, "nodes");
  for (int i = 0; i < count; ++i) {
    space.nodes.push_back(arrays.Get<Shape>("node" + std::to_string(i), 3,
                                            space.metric->connectivity->NumVertices()));
  }
  space.names = NamesFromJson(header.at("names"));
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

}  // namespace shapespace::internal
