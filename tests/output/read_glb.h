#ifndef TESTS_OUTPUT_READ_GLB_H_
#define TESTS_OUTPUT_READ_GLB_H_

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace shapespace {

/// Where a test writes a .glb file: in a persistent folder if the files are to be checked by other
/// programs (tests/gltf/run.sh).
inline std::string GlbFile(const std::string& name) {
  const char* const folder = std::getenv("SHAPESPACE_GLB_DIR");
  return (folder != nullptr ? folder + std::string("/") : ::testing::TempDir() + "gltf_test_") +
         name + ".glb";
}

/// A player's view of a .glb file with one mesh, whose primitives share their vertices, and at most
/// one animation. Written from the format's specification, independently of the writer.
class Glb {
 public:
  explicit Glb(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(stream), {});
    const size_t json_size = Word(12);
    const bool sound = bytes_.compare(0, 4, "glTF") == 0 && Word(4) == 2 &&
                       Word(8) == bytes_.size() && bytes_.compare(16, 4, "JSON") == 0 &&
                       bytes_.compare(24 + json_size, 4, std::string("BIN\0", 4)) == 0 &&
                       28 + json_size + Word(20 + json_size) == bytes_.size();
    if (!sound) throw std::runtime_error("no GLB container: " + file);
    json = nlohmann::json::parse(bytes_.substr(20, json_size));
    data_ = 28 + json_size;
  }

  /// Numbers of an accessor, one element per column.
  Eigen::MatrixXd Read(int index) const {
    const auto& accessor = json["accessors"].at(index);
    const auto& view = json["bufferViews"].at(accessor["bufferView"].get<int>());
    const std::string type = accessor["type"];
    const int rows = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : type.at(3) - '0';
    const int component = accessor["componentType"];
    const size_t size = component == 5121 ? 1 : component == 5123 ? 2 : 4;
    Eigen::MatrixXd values(rows, accessor["count"].get<int>());
    if (view["byteLength"] != values.size() * size) throw std::runtime_error("wrong length");
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const char* const at = &bytes_.at(data_ + view.value("byteOffset", 0) + i * size);
      values(i) = component == 5126   ? Number<float>(at)
                  : component == 5125 ? Number<uint32_t>(at)
                  : component == 5123 ? Number<uint16_t>(at)
                  : component == 5121 ? Number<uint8_t>(at)
                                      : throw std::runtime_error("unknown component type");
    }
    return values;
  }

  /// The bytes of a view, such as an image.
  std::string Bytes(int index) const {
    const auto& view = json["bufferViews"].at(index);
    return bytes_.substr(data_ + view.value("byteOffset", 0), view["byteLength"]);
  }

  const nlohmann::json& Primitive(int i = 0) const {
    return json["meshes"].at(0)["primitives"].at(i);
  }
  Eigen::MatrixXd Indices(int i = 0) const { return Read(Primitive(i)["indices"]); }
  Eigen::MatrixXd Attribute(const std::string& name) const {
    return Read(Primitive()["attributes"].at(name));
  }

  Eigen::MatrixXd Times() const { return Read(Sampler()["input"]); }

  /// The attribute at `time`, morphed, linearly interpolated.
  Eigen::MatrixXd Morphed(const std::string& attribute, double time) const {
    const Eigen::MatrixXd times = Times();
    const int targets = static_cast<int>(Primitive()["targets"].size());
    const Eigen::MatrixXd weights = Read(Sampler()["output"]).reshaped(targets, times.size());
    Eigen::Index after = 1;
    while (after + 1 < times.size() && times(after) < time) ++after;
    const double t = (time - times(after - 1)) / (times(after) - times(after - 1));
    Eigen::MatrixXd result = Attribute(attribute);
    for (int k = 0; k < targets; ++k) {
      const double weight = (1 - t) * weights(k, after - 1) + t * weights(k, after);
      result += weight * Read(Primitive()["targets"][k][attribute]);
    }
    return result;
  }

  /// Positions, stored or morphed, after the node's transformation.
  Eigen::Matrix3Xd InTheWorld(const Eigen::Matrix3Xd& positions) const {
    const auto& node = json["nodes"].at(json["scenes"][0]["nodes"].at(0).get<int>());
    const auto numbers = [&](const char* key, std::vector<double> value) {
      return node.value(key, value);
    };
    const auto r = numbers("rotation", {0, 0, 0, 1});
    const auto s = numbers("scale", {1, 1, 1});
    const auto t = numbers("translation", {0, 0, 0});
    const Eigen::Matrix3d turn = Eigen::Quaterniond(r[3], r[0], r[1], r[2]).toRotationMatrix();
    return (turn * Eigen::Scaling(s[0], s[1], s[2]) * positions).colwise() +
           Eigen::Vector3d(t[0], t[1], t[2]);
  }

  nlohmann::json json;

 private:
  template <typename Scalar>
  static double Number(const char* at) {
    Scalar number;
    std::memcpy(&number, at, sizeof number);
    return number;
  }

  size_t Word(size_t at) const {
    uint32_t word = 0;
    if (at + 4 <= bytes_.size()) std::memcpy(&word, &bytes_[at], 4);
    return word;
  }

  const nlohmann::json& Sampler() const {
    const auto& animation = json["animations"].at(0);
    const auto& channel = animation["channels"].at(0);
    if (channel["target"]["path"] != "weights") throw std::runtime_error("no morph animation");
    const auto& sampler = animation["samplers"].at(channel["sampler"].get<int>());
    if (sampler["interpolation"] != "LINEAR") throw std::runtime_error("not linear");
    return sampler;
  }

  std::string bytes_;
  size_t data_;
};

}  // namespace shapespace

#endif  // TESTS_OUTPUT_READ_GLB_H_
