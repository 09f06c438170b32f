#include <shapespace/statistics/internal/modes_arrays.h>

#include <string>

namespace shapespace::internal {

void AddModes(const PoseModes& modes, const std::string& file, HeaderJson* header,
              ArrayWriter* arrays) {
  AddMetric(*modes.metric, header, arrays);
  AddAppearance(modes.appearance, file, header, arrays);
  (*header)["names"] = NamesToJson(modes.names);
  (*header)["modes"] = modes.NumModes();
  (*header)["size"] = modes.size == PoseSize::kRemove ? "removed" : "kept";
  (*header)["total_variance"] = modes.total_variance;
  (*header)["provenance"] = modes.provenance;
  arrays->Add("weights", modes.weights);
  arrays->Add("variances", modes.variances);
  arrays->Add("coefficients", modes.coefficients);
  arrays->Add("rotation", modes.place.rotation);
  arrays->Add("translation", modes.place.translation);
  AddMotions(modes.motions, arrays);
  arrays->Add("mean", modes.mean);
  for (int i = 0; i < modes.NumPoses(); ++i) {
    arrays->Add("pose" + std::to_string(i), modes.poses[i]);
  }
  for (int k = 0; k < modes.NumModes(); ++k) {
    arrays->Add("mode" + std::to_string(k), modes.modes[k]);
  }
}

PoseModes ReadModes(const std::string& file, const HeaderJson& header, const ArrayReader& arrays) {
  PoseModes modes;
  modes.metric = ReadMetric(header, arrays);
  modes.appearance = ReadAppearance(header, file, arrays);
  const int vertices = modes.metric->connectivity->NumVertices();
  modes.names = NamesFromJson(header.at("names"));
  modes.size =
      header.at("size").get<std::string>() == "removed" ? PoseSize::kRemove : PoseSize::kKeep;
  header.at("total_variance").get_to(modes.total_variance);
  header.at("provenance").get_to(modes.provenance);
  const auto count = static_cast<Eigen::Index>(modes.names.size());
  const int num_modes = CountFrom(header, "modes");
  modes.weights = arrays.Get<Eigen::VectorXd>("weights", count, 1);
  modes.variances = arrays.Get<Eigen::VectorXd>("variances", num_modes, 1);
  modes.coefficients = arrays.Get<Eigen::MatrixXd>("coefficients", count, num_modes);
  modes.place.rotation = arrays.Get<Eigen::Matrix3d>("rotation", 3, 3);
  modes.place.translation = arrays.Get<Eigen::Vector3d>("translation", 3, 1);
  modes.mean = arrays.Get<Shape>("mean", 3, vertices);
  modes.motions = ReadMotions(arrays, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    modes.poses.push_back(arrays.Get<Shape>("pose" + std::to_string(i), 3, vertices));
  }
  for (int k = 0; k < num_modes; ++k) {
    modes.modes.push_back(arrays.Get<Tangent>("mode" + std::to_string(k), 3, vertices));
  }
  modes.Validate();
  return modes;
}

}  // namespace shapespace::internal
