#include <shapespace/output/detail/gltf_file.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/json.h>

namespace shapespace::internal {

Eigen::RowVectorXf TimesOf(const std::vector<std::pair<double, double>>& moments) {
  Eigen::RowVectorXf times(moments.size());
  float least = 0;
  for (size_t m = 0; m < moments.size(); ++m) {
    times[m] = std::max(least, static_cast<float>(moments[m].first));
    least = std::nextafter(times[m], std::numeric_limits<float>::max());
  }
  return times;
}

tinygltf::Node PlacedNode(const Eigen::Vector3d& origin, const GltfOptions& options) {
  tinygltf::Node node;
  node.name = "shape";
  node.mesh = 0;
  Eigen::Vector3d place = options.unit * origin;
  if (options.up == 'z') {
    place = Eigen::Vector3d(place.x(), place.z(), -place.y());
    node.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  }
  node.translation = {place.x(), place.y(), place.z()};
  if (options.unit != 1) node.scale = {options.unit, options.unit, options.unit};
  return node;
}

std::string AsUtf8(const std::string& text) {
  return nlohmann::json::parse(JsonText(nlohmann::json(text)));
}

size_t WriteGltfModel(const std::string& file, const tinygltf::Value::Object& extras,
                      tinygltf::Model* model) {
  model->asset.generator = "shapespace " SHAPESPACE_VERSION;
  model->asset.extras = tinygltf::Value(extras);
  size_t bytes = 0;
  WriteFileAtomically(file, [&](std::ostream& stream) {
    tinygltf::TinyGLTF().WriteGltfSceneToStream(model, stream, false, true);
    bytes = static_cast<size_t>(stream.tellp());
  });
  return bytes;
}

}  // namespace shapespace::internal
