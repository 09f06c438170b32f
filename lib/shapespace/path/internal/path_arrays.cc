#include <shapespace/path/internal/path_arrays.h>

#include <string>

namespace shapespace::internal {

void AddPath(const Path& path, const std::string& file, HeaderJson* header, ArrayWriter* arrays) {
  AddMetric(*path.metric, header, arrays);
  arrays->Add("parameters", path.parameters.data(), path.parameters.size(), 1);
  arrays->Add("poses", path.poses.data(), path.poses.size(), 1);
  AddMotions(path.motions, arrays);
  for (int i = 0; i < path.NumShapes(); ++i) {
    arrays->AddReference("shape" + std::to_string(i), path.shapes[i]);
  }
  AddAppearance(path.appearance, file, header, arrays);
  (*header)["shapes"] = path.NumShapes();
  (*header)["extrapolated"] = path.extrapolated;
  (*header)["converged"] = path.converged;
  if (!path.pose_names.empty()) (*header)["pose_names"] = NamesToJson(path.pose_names);
  if (path.smooth) (*header)["smooth"] = true;
  (*header)["provenance"] = path.provenance;
}

Path ReadPath(const std::string& file, const HeaderJson& header, const ArrayReader& arrays) {
  Path path;
  path.metric = ReadMetric(header, arrays);
  const int num_vertices = path.metric->connectivity->NumVertices();
  const int num_shapes = CountFrom(header, "shapes");
  const auto parameters = arrays.Get<Eigen::VectorXd>("parameters", num_shapes, 1);
  path.parameters.assign(parameters.begin(), parameters.end());
  path.poses = IndicesFrom(arrays, "poses");
  if (header.contains("pose_names")) path.pose_names = NamesFromJson(header.at("pose_names"));
  path.extrapolated = CountFrom(header, "extrapolated");
  path.converged = header.at("converged").get<bool>();
  path.smooth = header.value("smooth", false);
  path.motions = ReadMotions(arrays, num_shapes);
  for (int i = 0; i < num_shapes; ++i) {
    path.shapes.push_back(arrays.Get<Shape>("shape" + std::to_string(i), 3, num_vertices));
  }
  path.provenance = header.at("provenance").get<std::string>();
  path.appearance = ReadAppearance(header, file, arrays);
  path.Validate();
  return path;
}

}  // namespace shapespace::internal
