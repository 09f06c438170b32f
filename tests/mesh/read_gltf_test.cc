#include <cstdint>
#include <cstring>

#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using Json = nlohmann::json;
using testing::ExpectError;

/// Files that are put together by hand, as exporters other than the library's own write them.
class ReadGltfTest : public testing::FilesTest {
 protected:
  /// A square of two triangles with one morph target, as separate triangles: six vertices.
  ReadGltfTest() {
    const std::vector<float> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
    std::vector<float> lifted(18, 0.0f);
    lifted[8] = lifted[14] = 2;  // both copies of the corner (1, 1)
    json_ = {{"asset", {{"version", "2.0"}}}, {"scene", 0},
             {"scenes", {{{"nodes", {0}}}}},  {"nodes", {{{"mesh", 0}, {"name", "square"}}}},
             {"accessors", Json::array()},    {"bufferViews", Json::array()}};
    Json primitive = {{"attributes", {{"POSITION", Add(square, "VEC3")}}},
                      {"targets", {{{"POSITION", Add(lifted, "VEC3")}}}}};
    json_["meshes"] = {{{"primitives", {primitive}}}};
  }

  Json& Primitive() { return json_["meshes"][0]["primitives"][0]; }

  /// Appends bytes and returns their buffer view.
  template <typename Number>
  int View(const std::vector<Number>& numbers) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const size_t begin = bytes_.size(), size = numbers.size() * sizeof(Number);
    bytes_.resize(begin + size);
    std::memcpy(&bytes_[begin], numbers.data(), size);
    json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", size}});
    return static_cast<int>(json_["bufferViews"].size()) - 1;
  }

  template <typename Number>
  int Add(const std::vector<Number>& numbers, const std::string& type) {
    const int component = sizeof(Number) == 1 ? 5121 : sizeof(Number) == 2 ? 5123 : 5126;
    const int per = type == "VEC3" ? 3 : type == "VEC2" ? 2 : 1;
    Json accessor = {{"bufferView", View(numbers)},
                     {"componentType", component},
                     {"type", type},
                     {"count", numbers.size() / per}};
    if (type == "VEC3") {  // required by the format, and not used
      accessor["min"] = {0, 0, 0};
      accessor["max"] = {1, 1, 1};
    }
    json_["accessors"].push_back(accessor);
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  /// The file as .gltf with a buffer beside it.
  std::string Gltf() {
    File("square.bin", bytes_);
    json_["buffers"] = {{{"byteLength", bytes_.size()}, {"uri", "square.bin"}}};
    return File("square.gltf", json_.dump());
  }

  /// The file as .glb.
  std::string Glb() {
    json_["buffers"] = {{{"byteLength", bytes_.size()}}};
    std::string text = json_.dump(), data = bytes_;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4);
    std::string file = "glTF" + Word(2) + Word(28 + text.size() + data.size());
    file += Word(text.size()) + "JSON" + text + Word(data.size()) + std::string("BIN\0", 4) + data;
    return File("square.glb", file);
  }

  void ExpectRefused(const std::vector<std::string>& parts) {
    ExpectError<FileError>([&] { ReadSoups(Glb()); }, parts);
  }

  Json json_;
  std::string bytes_;

 private:
  static std::string Word(size_t number) {
    std::string bytes(4, '\0');
    for (int i = 0; i < 4; ++i) bytes[i] = static_cast<char>(number >> (8 * i) & 0xff);
    return bytes;
  }
};

TEST_F(ReadGltfTest, CopiesOfAVertexBecomeOneIfAllPosesAgree) {
  for (const std::string& file : {Glb(), Gltf()}) {
    const std::vector<Soup> soups = ReadSoups(file);
    ASSERT_EQ(soups.size(), 2u);
    Shape square(3, 4);
    square << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
    EXPECT_EQ(soups[0].vertices, square);
    square(2, 2) = 2;
    EXPECT_EQ(soups[1].vertices, square);
    for (const Soup& soup : soups) {
      EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 0, 2, 3}));
      ASSERT_EQ(soup.dropped.size(), 1u);
      EXPECT_EQ(soup.dropped[0].find("2 vertices merged"), 0u);
    }
    EXPECT_EQ(soups[0].name, "");
    EXPECT_EQ(soups[1].name, "target 1");
  }
  // Where the copies part in one pose, they stay two vertices.
  std::memset(&bytes_[bytes_.size() - 4 * 4], 0, 4);
  EXPECT_EQ(ReadSoup(Glb()).NumVertices(), 5);
}

TEST_F(ReadGltfTest, PosesAreNamedAsTheFileSays) {
  json_["meshes"][0]["extras"]["targetNames"] = {"sit.001"};
  const Poses poses = ReadPoses({Glb(), Gltf()});
  EXPECT_EQ(poses.names, (std::vector<std::string>{Path("square.glb"), "sit.001",
                                                   Path("square.gltf"), "sit.001"}));
  EXPECT_EQ(poses.shapes[3], poses.shapes[1]);
  // One mesh is asked for: the others are mentioned.
  const Soup soup = ReadSoup(Glb());
  EXPECT_EQ(soup.dropped.back().find("1 morph targets not read"), 0u);
  for (const std::string names : {"3", "[]", "[7]", "[\"\"]", "{}"}) {
    json_["meshes"][0]["extras"]["targetNames"] = Json::parse(names);
    EXPECT_EQ(ReadSoups(Glb())[1].name, "target 1") << names;
  }
}

TEST_F(ReadGltfTest, NodesPlaceTheMesh) {
  json_["nodes"][0]["scale"] = {2, 3, 4};
  json_["nodes"][0]["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // x to y
  json_["nodes"].push_back({{"children", {0}}, {"translation", {10, 20, 30}}});
  json_["scenes"][0]["nodes"] = {1};
  const std::vector<Soup> soups = ReadSoups(Glb());
  EXPECT_LT((soups[1].vertices.col(2) - Eigen::Vector3d(10 - 3, 20 + 2, 30 + 8)).norm(), 1e-12);
  // The length of the quaternion does not matter.
  for (const double length : {1e-170, 1e200}) {
    json_["nodes"][0]["rotation"] = {0, 0, length, length};
    const Eigen::Vector3d placed = ReadSoups(Glb())[1].vertices.col(2);
    EXPECT_LT((placed - Eigen::Vector3d(10 - 3, 20 + 2, 30 + 8)).norm(), 1e-12) << length;
  }
  json_["nodes"][0]["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  json_["nodes"][1] = {{"children", {0}},
                       {"matrix", {0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 6, 7, 1}}};
  EXPECT_LT((ReadSoups(Glb())[1].vertices.col(2) - Eigen::Vector3d(5 + 2, 6 + 8, 7 - 3)).norm(),
            1e-12);
  json_["nodes"][0]["children"] = {1};
  ExpectRefused({"parent"});
}

// Both sides of a surface stay what they were.
TEST_F(ReadGltfTest, MirroringNodesKeepTrianglesFacingTheSameWay) {
  json_["nodes"][0]["scale"] = {-2, 1, 1};
  const Soup soup = ReadSoup(Glb());
  ASSERT_EQ(soup.corners.size(), 6u);
  for (size_t k = 0; k < 6; k += 3) {
    const auto corner = [&](size_t i) { return soup.vertices.col(soup.corners[k + i]); };
    const Eigen::Vector3d along = corner(1) - corner(0), across = corner(2) - corner(0);
    EXPECT_EQ(along.x() * across.y() - along.y() * across.x(), 2);
  }
}

// As Blender writes targets that move a few vertices only.
TEST_F(ReadGltfTest, SparseTargetsMoveTheVerticesThatTheyName) {
  const int indices = View(std::vector<std::uint8_t>{2, 4});
  const int values = View(std::vector<float>{0, 0, 2, 0, 0, 2});
  const std::vector<Soup> full = ReadSoups(Glb());
  Json& accessor = json_["accessors"][1];
  accessor.erase("bufferView");
  accessor["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                        {"values", {{"bufferView", values}}}};
  EXPECT_EQ(ReadSoups(Glb())[1].vertices, full[1].vertices);
  accessor["sparse"]["count"] = 3;
  ExpectRefused({"square.glb", "bytes"});
}

// One primitive per material: with vertices of its own, or shared with the first.
TEST_F(ReadGltfTest, PrimitivesFormOneMesh) {
  Primitive()["indices"] = Add(std::vector<std::uint8_t>{0, 1, 2}, "SCALAR");
  Json second = Primitive();
  second["indices"] = Add(std::vector<std::uint16_t>{3, 4, 5}, "SCALAR");
  second["material"] = 0;
  json_["materials"] = {{{"name", "red"}}};
  json_["meshes"][0]["primitives"].push_back(second);
  const Soup shared = ReadSoup(Glb());
  EXPECT_EQ(shared.NumVertices(), 4);
  EXPECT_EQ(shared.corners, (std::vector<int>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(shared.dropped[1], "materials and textures not kept");

  const std::vector<float> numbers = {5, 0, 0, 6, 0, 0, 5, 1, 0};
  Json third = {{"attributes", {{"POSITION", Add(numbers, "VEC3")}}},
                {"targets", {{{"POSITION", Add(std::vector<float>(9, 1.0f), "VEC3")}}}}};
  json_["meshes"][0]["primitives"].push_back(third);
  const std::vector<Soup> soups = ReadSoups(Glb());
  EXPECT_EQ(soups[0].NumVertices(), 7);
  EXPECT_EQ(soups[1].vertices.col(5), Eigen::Vector3d(7, 1, 1));
  EXPECT_EQ(soups[1].corners, (std::vector<int>{0, 1, 2, 0, 2, 3, 4, 5, 6}));

  json_["meshes"][0]["primitives"][2].erase("targets");
  ExpectRefused({"morph targets"});
}

TEST_F(ReadGltfTest, TextureCoordinatesPointUp) {
  Primitive()["attributes"]["TEXCOORD_0"] =
      Add(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 0.25f}, "VEC2");
  const Appearance appearance = ReadSoup(Glb()).appearance;
  ASSERT_EQ(appearance.corner_texture.size(), 6u);
  EXPECT_EQ(appearance.texture_coordinates.col(appearance.corner_texture[5]),
            Eigen::Vector2d(0, 0.75));

  // A second primitive with the same positions and other texture coordinates.
  Json second = Primitive();
  second["attributes"]["TEXCOORD_0"] = Add(std::vector<float>(12, 0.5f), "VEC2");
  json_["meshes"][0]["primitives"].push_back(second);
  const Soup both = ReadSoup(Glb());
  EXPECT_EQ(both.NumVertices(), 4);
  EXPECT_EQ(both.appearance.texture_coordinates.col(both.appearance.corner_texture[5]),
            Eigen::Vector2d(0, 0.75));
  EXPECT_EQ(both.appearance.texture_coordinates.col(both.appearance.corner_texture[11]),
            Eigen::Vector2d(0.5, 0.5));

  json_["accessors"].back()["componentType"] = 5123;
  EXPECT_EQ(ReadSoup(Glb()).dropped.back(), "1 morph targets not read, since one mesh is wanted");
  EXPECT_EQ(ReadSoups(Glb())[0].dropped.back(),
            "texture coordinates that are not floating-point numbers not kept");
}

/// Integers of a type, each vertex in four bytes or eight, as gltfpack writes them.
template <typename Integer>
std::vector<Integer> Padded(const std::vector<int>& numbers) {
  std::vector<Integer> padded;
  for (size_t i = 0; i < numbers.size(); ++i) {
    padded.push_back(static_cast<Integer>(numbers[i]));
    if (i % 3 == 2) padded.push_back(0);
  }
  return padded;
}

TEST_F(ReadGltfTest, QuantizedPositionsAreReadAsTheNodePlacesThem) {
  const Json good = json_;
  const std::string good_bytes = bytes_;
  // A square of `side` with a target that lifts two corners by half of it.
  const auto read = [&](auto integer, int component, bool normalized, int side) {
    using Integer = decltype(integer);
    json_ = good;
    bytes_ = good_bytes;
    json_["extensionsUsed"] = json_["extensionsRequired"] = {"KHR_mesh_quantization"};
    json_["nodes"][0]["scale"] = {2, 2, 2};
    json_["nodes"][0]["translation"] = {10, 0, 0};
    const std::vector<int> square = {0, 0, 0, side, 0,    0, side, side, 0,
                                     0, 0, 0, side, side, 0, 0,    side, 0};
    std::vector<int> lifted(18, 0);
    lifted[8] = lifted[14] = side / 2;
    int accessor = 0;
    for (const std::vector<int>& numbers : {square, lifted}) {
      json_["accessors"][accessor]["bufferView"] = View(Padded<Integer>(numbers));
      json_["accessors"][accessor]["componentType"] = component;
      json_["accessors"][accessor]["normalized"] = normalized;
      json_["bufferViews"].back()["byteStride"] = 4 * sizeof(Integer);
      ++accessor;
    }
    return ReadSoups(Glb());
  };
  const auto expect = [&](const std::vector<Soup>& soups, double side, double lift) {
    ASSERT_EQ(soups.size(), 2u);
    Shape square(3, 4);
    square << 10, 10 + 2 * side, 10 + 2 * side, 10, 0, 0, 2 * side, 2 * side, 0, 0, 0, 0;
    EXPECT_LT((soups[0].vertices - square).norm(), 1e-14 * square.norm());
    square(2, 2) = 2 * lift;
    EXPECT_LT((soups[1].vertices - square).norm(), 1e-14 * square.norm());
    EXPECT_EQ(soups[1].corners, (std::vector<int>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(soups[0].dropped.size(), 1u);  // merged vertices
  };
  expect(read(std::int8_t{}, 5120, false, -128), -128, -64);
  expect(read(std::uint8_t{}, 5121, false, 200), 200, 100);
  expect(read(std::int16_t{}, 5122, false, -32768), -32768, -16384);
  expect(read(std::uint16_t{}, 5123, false, 65534), 65534, 32767);
  expect(read(std::int8_t{}, 5120, true, 127), 1, 63 / 127.0);
  expect(read(std::int8_t{}, 5120, true, -128), -1, -64 / 127.0);  // the least number is -1 too
  expect(read(std::uint8_t{}, 5121, true, 255), 1, 127 / 255.0);
  expect(read(std::int16_t{}, 5122, true, 32767), 1, 16383 / 32767.0);
  expect(read(std::uint16_t{}, 5123, true, 65535), 1, 32767 / 65535.0);
  // Without a declaration such positions are no glTF.
  read(std::int16_t{}, 5122, false, 100);
  json_["extensionsUsed"] = json_["extensionsRequired"] = Json::array();
  ExpectRefused({"positions", "floating"});
  json_["extensionsUsed"] = {"KHR_mesh_quantization"};
  EXPECT_EQ(ReadSoups(Glb()).size(), 2u);
  json_["accessors"][0]["componentType"] = 5125;
  ExpectRefused({"positions", "floating"});
  json_["accessors"][0]["componentType"] = 5122;
  json_["bufferViews"].back()["byteLength"] = 5;
  ExpectRefused({"bytes"});
}

TEST_F(ReadGltfTest, TextureCoordinatesThatAreDamagedAreDropped) {
  std::vector<float> numbers(12, 0.5f);
  numbers[7] = std::nanf("");
  const int nan = Add(numbers, "VEC2"), few = Add(std::vector<float>(8, 0.5f), "VEC2");
  for (const int accessor : {nan, few, 99}) {
    Primitive()["attributes"]["TEXCOORD_0"] = accessor;
    const Soup soup = ReadSoups(Glb())[0];
    EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 0, 2, 3}));
    EXPECT_TRUE(soup.appearance.corner_texture.empty());
    EXPECT_EQ(soup.appearance.texture_coordinates.size(), 0);
    EXPECT_EQ(soup.dropped.size(), 2u) << accessor;
  }
}

TEST_F(ReadGltfTest, LinesAreSegments) {
  Primitive()["mode"] = 1;
  const Soup soup = ReadSoup(Glb());
  EXPECT_EQ(soup.NumPolygons(), 0);
  EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{0, 1}, {2, 0}, {2, 3}}));
}

// Readers that call themselves for every level overflow the stack.
TEST_F(ReadGltfTest, DeepNestingIsRefused) {
  const auto nested = [](int levels) {
    return "{\"asset\":{\"version\":\"2.0\",\"extras\":" + std::string(levels, '[') +
           std::string(levels, ']') + "}}";
  };
  ExpectError<FileError>([&] { ReadSoup(File("deep.gltf", nested(200000))); },
                         {"deep.gltf: ", "nested more than 100 deep"});
  json_["asset"]["extras"] = Json::parse(std::string(101, '[') + std::string(101, ']'));
  ExpectRefused({"square.glb: ", "100"});
  json_["asset"]["extras"] = Json::parse(std::string(50, '[') + std::string(50, ']'));
  EXPECT_EQ(ReadSoups(Glb()).size(), 2u);
}

TEST_F(ReadGltfTest, AFewBytesCannotTakeAllMemory) {
  const Json good = json_;
  // Targets without content take three bytes each in the file.
  json_["meshes"][0]["primitives"][0]["targets"] = Json::array();
  for (int k = 0; k < 2000; ++k) Primitive()["targets"].push_back(Json::object());
  EXPECT_EQ(ReadSoups(Glb()).size(), 2001u);
  Primitive()["attributes"]["POSITION"] = Add(std::vector<float>(3 * 30000, 1.0f), "VEC3");
  ExpectRefused({"square.glb: ", "2000 morph targets", "memory"});
  // As do corners that all poses repeat, and parts of the mesh that share their numbers.
  json_ = good;
  for (int k = 1; k < 2000; ++k) Primitive()["targets"].push_back(Json::object());
  Primitive()["indices"] = Add(std::vector<std::uint8_t>(60000, 0), "SCALAR");
  ExpectRefused({"memory"});
  json_["meshes"][0]["primitives"] = Json::array();
  const int positions = Add(std::vector<float>(3 * 999, 1.0f), "VEC3");
  for (int k = 0; k < 200; ++k) {
    const Json view = json_["accessors"][positions];
    json_["accessors"].push_back(view);
    json_["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", json_["accessors"].size() - 1}}},
         {"targets", std::vector<Json>(300, Json::object())}});
  }
  ExpectRefused({"300 morph targets", "memory"});
  // And buffers, each of which would be a copy of the binary part.
  json_ = good;
  json_["buffers"] = {{{"byteLength", 4}}, {{"byteLength", 4}}};
  ExpectError<FileError>([&] { ReadSoups(File("two.gltf", json_.dump())); },
                         {"two.gltf: has more than one buffer without a file"});
}

TEST_F(ReadGltfTest, BuffersOutsideOfTheFolderAreReadOnRequestOnly) {
  const std::string inside = Gltf();
  std::filesystem::create_directories(Path("home/below"));
  const auto naming = [&](const std::string& uri) {
    json_["buffers"][0]["uri"] = uri;
    return File("home/square.gltf", json_.dump());
  };
  for (const std::string& uri :
       {std::string("../square.bin"), std::string("below/%2e%2e/../../square.bin"),
        Path("square.bin")}) {
    ExpectError<FileError>([&] { ReadSoups(naming(uri)); }, {"home/square.gltf: its buffer "});
  }
  std::filesystem::create_symlink(Path("square.bin"), Path("home/link.bin"));
  for (const char* uri : {"../square.bin", "link.bin"}) {
    const std::string file = naming(uri);
    ExpectError<FileError>([&] { ReadSoups(file); },
                           {"square.gltf: its buffer ", "lies outside of the folder"});
    EXPECT_EQ(ReadSoups(file, /*allow_outside_files=*/true)[1].vertices,
              ReadSoups(inside)[1].vertices);
    ReadOptions options;
    EXPECT_THROW(ReadPoses({file}, options), FileError);
    options.allow_outside_files = true;
    EXPECT_EQ(ReadPoses({file}, options).shapes.size(), 2u);
  }
  File("home/below/square.bin", bytes_);
  EXPECT_EQ(ReadSoups(naming("below/square.bin")).size(), 2u);
}

TEST_F(ReadGltfTest, WhatIsNotReadIsNamed) {
  const Json good = json_;
  const auto refuse = [&](const std::function<void()>& change, const std::string& message) {
    json_ = good;
    change();
    ExpectRefused({"square.glb: ", message});
  };
  refuse(
      [&] {
        json_["nodes"].push_back({{"mesh", 0}, {"name", "copy"}});
      },
      "2 meshes, 'square', 'copy'");
  refuse([&] { json_["nodes"][0].erase("mesh"); }, "has no mesh");
  refuse([&] { json_["nodes"][0]["mesh"] = 1; }, "does not exist");
  refuse([&] { json_["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
         "needs the extension KHR_draco_mesh_compression");
  refuse([&] { Primitive()["mode"] = 5; }, "strips");
  refuse([&] { Primitive()["attributes"].erase("POSITION"); }, "has no positions");
  refuse([&] { json_["accessors"][0]["componentType"] = 5122; }, "floating");
  refuse([&] { json_["accessors"][0]["count"] = 7; }, "bytes");
  refuse([&] { json_["accessors"][1]["count"] = 5; }, "as many as the vertices");
  refuse([&] { json_["bufferViews"][0]["byteOffset"] = 100000; }, "bytes");
  refuse(
      [&] {
        Primitive()["indices"] = Add(std::vector<std::uint8_t>{0, 1, 9}, "SCALAR");
      },
      "index 9 where there are 6");
  refuse(
      [&] {
        Primitive()["indices"] = Add(std::vector<std::uint8_t>{0, 1}, "SCALAR");
      },
      "last triangle");
  ExpectError<FileError>([&] { ReadSoup(File("bad.gltf", "{]")); },
                         {"bad.gltf: is not valid glTF"});
  ExpectError<FileError>([&] { ReadSoup(File("bad.glb", "glTF")); },
                         {"bad.glb: is not valid glTF"});
  const float nan = std::nanf("");
  std::memcpy(bytes_.data(), &nan, 4);
  refuse([] {}, "finite");
}

}  // namespace
}  // namespace shapespace
