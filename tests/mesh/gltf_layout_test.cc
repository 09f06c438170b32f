#include <cstdint>

#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"
#include "support/message_of.h"

// Where glTF stores its numbers, and what is said about the rest.

namespace shapespace::gltf_layout_test {
namespace {

using internal::AppendLittleEndian;
using Ints = std::vector<int>;
using Json = nlohmann::json;
using Strings = std::vector<std::string>;

/// A triangle whose positions and texture coordinates alternate, behind four other bytes; its
/// indices are the second to fourth of a list. The first target moves one vertex, the second none.
class GltfLayoutTest : public testing::FilesTest {
 protected:
  GltfLayoutTest() : bytes_("else") {
    for (const float x : std::vector<float>{1, 2, 3, 0, 0.25, 4, 5, 6, 1, 0.5, 7, 8, 10, 0.75, 2}) {
      AppendLittleEndian(x, &bytes_);
    }
    for (const std::uint32_t i : {9u, 2u, 0u, 1u}) AppendLittleEndian(i, &bytes_);
    for (const float x : std::vector<float>{0, 0, 0, 0, 0, 0, 0.5, -1, 2}) {
      AppendLittleEndian(x, &bytes_);
    }
    json_ = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0, "translation": [10, 20, 30]}],
      "meshes": [{"primitives": [{"mode": 4, "indices": 2,
        "attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "targets": [{"POSITION": 3}, {}]}],
        "extras": {"targetNames": ["", "second"]}}],
      "bufferViews": [{"buffer": 0, "byteOffset": 4, "byteLength": 60, "byteStride": 20},
        {"buffer": 0, "byteOffset": 64, "byteLength": 16},
        {"buffer": 0, "byteOffset": 80, "byteLength": 36}],
      "accessors": [
        {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
         "min": [1, 2, 3], "max": [7, 8, 10]},
        {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "type": "VEC2", "count": 3},
        {"bufferView": 1, "byteOffset": 4, "componentType": 5125, "type": "SCALAR", "count": 3},
        {"bufferView": 2, "componentType": 5126, "type": "VEC3", "count": 3,
         "min": [0, -1, 0], "max": [0.5, 0, 2]}]})");
  }

  std::string Written() const {
    File("m.bin", bytes_);
    Json json = json_;
    json["buffers"] = {{{"byteLength", bytes_.size()}, {"uri", "m.bin"}}};
    return File("m.gltf", json.dump());
  }

  void Refused(const std::vector<std::string>& parts) const {
    const std::string file = Written();
    const std::string message = testing::MessageOf<FileError>([&] { ReadSoups(file); });
    EXPECT_EQ(message.find(file + ": "), 0u) << message;
    EXPECT_TRUE(testing::Names(message, parts));
  }

  Json json_;
  std::string bytes_;
};

TEST_F(GltfLayoutTest, NumbersAreReadFromTheirPlaces) {
  const std::vector<Soup> soups = ReadSoups(Written());
  ASSERT_EQ(soups.size(), 3u);
  Shape expected(3, 3);
  expected << 11, 14, 17, 22, 25, 28, 33, 36, 40;
  EXPECT_EQ(soups[0].vertices, expected);
  EXPECT_EQ(soups[2].vertices, expected);
  expected.col(2) += Eigen::Vector3d(0.5, -1, 2);
  EXPECT_EQ(soups[1].vertices, expected);
  EXPECT_EQ(soups[0].name + "," + soups[1].name + "," + soups[2].name, ",target 1,second");
  for (const Soup& soup : soups) {
    EXPECT_EQ(soup.corners, (Ints{2, 0, 1}));
    EXPECT_EQ(soup.polygon_begin, (Ints{0, 3}));
    EXPECT_EQ(soup.appearance.corner_texture, (Ints{2, 0, 1}));
    EXPECT_EQ(soup.appearance.texture_coordinates,
              (Eigen::MatrixXd(2, 3) << 0, 1, 0.75, 0.75, 0.5, -1).finished());
    EXPECT_TRUE(soup.dropped.empty());
  }
}

TEST_F(GltfLayoutTest, ListsMayEndWithTheirBytesButNotBehind) {
  json_["bufferViews"][0]["byteLength"] = 51;
  Refused({"bytes"});
  // The mesh does not need texture coordinates.
  const auto loses_texture = [&] {
    const Soup soup = ReadSoups(Written())[0];
    EXPECT_TRUE(soup.appearance.corner_texture.empty());
    ASSERT_EQ(soup.dropped.size(), 1u);
    EXPECT_NE(soup.dropped[0].find("bytes"), std::string::npos) << soup.dropped[0];
  };
  json_["bufferViews"][0]["byteLength"] = 59;
  loses_texture();
  json_["bufferViews"][0]["byteLength"] = 60;
  json_["accessors"][1]["byteOffset"] = 13;
  loses_texture();
  json_["accessors"][1]["byteOffset"] = 12;
  json_["accessors"][2]["count"] = 4;
  Refused({"bytes"});
  json_["accessors"][2]["count"] = 3;
  json_["accessors"][2]["byteOffset"] = 0;
  Refused({"index 9", "3"});
  json_["accessors"][2]["byteOffset"] = 4;
  json_["accessors"][2]["componentType"] = 5126;
  Refused({"indices"});
}

TEST_F(GltfLayoutTest, SkinnedMeshesAreNotPlacedByTheirNode) {
  json_["skins"] = Json::parse(R"([{"joints": [0]}])");
  json_["nodes"][0]["skin"] = 0;
  const std::vector<Soup> soups = ReadSoups(Written());
  EXPECT_EQ(soups[0].vertices.col(2), Eigen::Vector3d(7, 8, 10));
  EXPECT_EQ(soups[1].vertices.col(2), Eigen::Vector3d(7.5, 7, 12));
  EXPECT_EQ(soups[0].dropped, Strings{"the skeleton is not applied: the mesh is in its bind pose"});
}

TEST_F(GltfLayoutTest, SaysWhatItDrops) {
  json_["materials"] = Json::parse(R"([{"name": "red"}])");
  json_["extensionsRequired"] = {"KHR_texture_transform"};
  Json& primitives = json_["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 0;
  primitives[1]["attributes"].erase("TEXCOORD_0");
  primitives[1]["attributes"]["COLOR_0"] = 0;
  const Soup soup = ReadSoup(Written());
  // Without texture coordinates the second triangle has vertices of its own, which are merged.
  EXPECT_EQ(soup.corners, (Ints{2, 0, 1, 2, 0, 1}));
  EXPECT_EQ(soup.appearance.corner_texture, (Ints{2, 0, 1, -1, -1, -1}));
  EXPECT_EQ(soup.appearance.texture_coordinates.cols(), 3);
  EXPECT_EQ(soup.dropped,
            (Strings{"3 vertices merged with others that are in the same place in all poses",
                     "materials and textures not kept", "vertex colours not kept",
                     "2 morph targets not read, since one mesh is wanted"}));
}

}  // namespace
}  // namespace shapespace::gltf_layout_test
