#ifndef SHAPESPACE_TESTS_OUTPUT_SKINNED_PLAYER_H_
#define SHAPESPACE_TESTS_OUTPUT_SKINNED_PLAYER_H_

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "output/read_glb.h"

namespace shapespace {

/// A player of the one skinned mesh of a .glb file, written from the format's specification,
/// independently of the writer.
class SkinnedPlayer {
 public:
  explicit SkinnedPlayer(const Glb& glb) : glb_(glb) {
    for (const auto& node : glb.json["nodes"]) {
      if (node.contains("skin")) skin_ = glb.json["skins"].at(node["skin"].get<int>());
    }
  }

  /// The positions of all vertices in the rest pose of the nodes.
  Eigen::Matrix3Xd AtRest() const { return Skinned(RestNodes()); }

  /// The same at a time of the animation.
  Eigen::Matrix3Xd At(double time) const {
    std::vector<Node> nodes = RestNodes();
    const auto& animation = glb_.json["animations"].at(0);
    for (const auto& channel : animation["channels"]) {
      const auto& sampler = animation["samplers"].at(channel["sampler"].get<int>());
      const Eigen::MatrixXd times = glb_.Read(sampler["input"]);
      const Eigen::MatrixXd values = glb_.Read(sampler["output"]);
      const std::string path = channel["target"]["path"];
      Node& node = nodes.at(channel["target"]["node"].get<int>());
      Eigen::Index after = 0;
      while (after + 1 < times.size() && times(after) < time) ++after;
      const Eigen::Index before = std::max<Eigen::Index>(0, after - 1);
      const double way = times(after) - times(before);
      const double part = way > 0 ? std::clamp((time - times(before)) / way, 0.0, 1.0) : 0;
      const Eigen::VectorXd linear = (1 - part) * values.col(before) + part * values.col(after);
      if (path == "translation") node.translation = linear;
      if (path == "scale") node.scale = linear;
      if (path == "rotation") {
        node.rotation = Eigen::Quaterniond(Eigen::Vector4d(values.col(before)))
                            .slerp(part, Eigen::Quaterniond(Eigen::Vector4d(values.col(after))));
      }
    }
    return Skinned(nodes);
  }

 private:
  struct Node {
    Eigen::Vector3d translation = Eigen::Vector3d::Zero(), scale = Eigen::Vector3d::Ones();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  };

  std::vector<Node> RestNodes() const {
    std::vector<Node> nodes;
    for (const auto& json : glb_.json["nodes"]) {
      Node node;
      if (json.contains("translation")) node.translation = Vector<3>(json["translation"]);
      if (json.contains("scale")) node.scale = Vector<3>(json["scale"]);
      if (json.contains("rotation")) node.rotation.coeffs() = Vector<4>(json["rotation"]);
      nodes.push_back(node);
    }
    return nodes;
  }

  template <int kSize>
  static Eigen::Matrix<double, kSize, 1> Vector(const nlohmann::json& json) {
    const std::vector<double> numbers = json;
    return Eigen::Map<const Eigen::Matrix<double, kSize, 1>>(numbers.data());
  }

  void Place(int node, const Eigen::Affine3d& parent, const std::vector<Node>& nodes,
             std::vector<Eigen::Affine3d>* placed) const {
    Eigen::Affine3d& own = placed->at(node);
    own = parent;
    own.translate(nodes[node].translation).rotate(nodes[node].rotation).scale(nodes[node].scale);
    const auto& json = glb_.json["nodes"].at(node);
    if (!json.contains("children")) return;
    for (const int child : json["children"]) Place(child, own, nodes, placed);
  }

  Eigen::Matrix3Xd Skinned(const std::vector<Node>& nodes) const {
    std::vector<Eigen::Affine3d> placed(nodes.size(), Eigen::Affine3d::Identity());
    for (const int root : glb_.json["scenes"][0]["nodes"]) {
      Place(root, Eigen::Affine3d::Identity(), nodes, &placed);
    }
    const Eigen::MatrixXd inverses = glb_.Read(skin_["inverseBindMatrices"]);
    std::vector<Eigen::Matrix4d> matrices;
    for (size_t j = 0; j < skin_["joints"].size(); ++j) {
      matrices.push_back(placed.at(skin_["joints"][j].get<int>()).matrix() *
                         Eigen::Matrix4d(inverses.col(static_cast<int>(j)).reshaped(4, 4)));
    }
    const Eigen::MatrixXd positions = glb_.Attribute("POSITION");
    Eigen::Matrix3Xd result = Eigen::Matrix3Xd::Zero(3, positions.cols());
    for (int set = 0; set < 2; ++set) {
      const std::string number = std::to_string(set);
      if (!glb_.Primitive()["attributes"].contains("JOINTS_" + number)) continue;
      const Eigen::MatrixXd joints = glb_.Attribute("JOINTS_" + number);
      const Eigen::MatrixXd weights = glb_.Attribute("WEIGHTS_" + number) / 65535;
      for (Eigen::Index v = 0; v < positions.cols(); ++v) {
        const Eigen::Vector4d position = positions.col(v).homogeneous();
        for (int k = 0; k < 4; ++k) {
          result.col(v) +=
              weights(k, v) * (matrices.at(static_cast<size_t>(joints(k, v))) * position).head<3>();
        }
      }
    }
    return result;
  }

  const Glb& glb_;
  nlohmann::json skin_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_TESTS_OUTPUT_SKINNED_PLAYER_H_
