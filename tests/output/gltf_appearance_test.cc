#include <cmath>
#include <set>
#include <tuple>
#include <vector>

#include <shapespace/output/gltf.h>
#include <shapespace/output/internal/colour.h>
#include <shapespace/output/picture.h>

#include "output/painted_cube.h"
#include "output/read_glb.h"
#include "support/message_of.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

class WriteGltfAppearanceTest : public PaintedCubeTest {};

TEST_F(WriteGltfAppearanceTest, EveryCornerHasItsTextureCoordinateInEveryShape) {
  const GltfSummary summary = WriteGltf(GlbFile("textured"), path_);
  const Glb glb(GlbFile("textured"));
  const auto& materials = glb.json["materials"];
  ASSERT_EQ(glb.json["meshes"][0]["primitives"].size(), 4u);
  const Eigen::MatrixXd uv = glb.Attribute("TEXCOORD_0");

  // The minimal number of vertices: one per different pair.
  std::set<std::tuple<int, double, double>> pairs;
  for (int p = 0; p < 6; ++p) {
    for (int k = connectivity_->PolygonBegin()[p]; k < connectivity_->PolygonBegin()[p + 1]; ++k) {
      const int v = connectivity_->Corners()[k];
      if (path_.appearance.corner_texture[k] < 0) continue;
      pairs.insert({v, Texture(p, v).x(), Texture(p, v).y()});
    }
  }
  EXPECT_EQ(pairs.size(), 21u);
  EXPECT_EQ(uv.cols(), 21);

  const std::vector<std::string> names = {"painted", "glass", "unknown", "shape"};
  const std::vector<std::set<int>> polygons = {{0, 1, 3}, {2}, {4}, {5}};
  for (const auto& [time, shape] : {std::pair(0.0, 0), std::pair(2.0, 1)}) {
    const Shape drawn = glb.InTheWorld(glb.Morphed("POSITION", time));
    const Shape placed = path_.Placed(shape);
    EXPECT_LT((drawn.leftCols(8) - placed).cwiseAbs().maxCoeff(), 1e-6) << "the mesh's own first";
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(materials[glb.Primitive(i)["material"].get<int>()]["name"], names[i]);
      EXPECT_EQ(glb.Primitive(i)["attributes"], glb.Primitive(0)["attributes"]);
      EXPECT_EQ(glb.Primitive(i)["targets"], glb.Primitive(0)["targets"]);
      const Eigen::MatrixXd indices = glb.Indices(i);
      int at = 0;
      for (const int p : polygons[i]) {
        for (int f = 2 * p; f < 2 * p + 2; ++f) {
          for (int k = 0; k < 3; ++k, ++at) {
            const int v = connectivity_->Triangles()(k, f), index = static_cast<int>(indices(at));
            EXPECT_LT((drawn.col(index) - placed.col(v)).norm(), 1e-6);
            const int t = path_.appearance.corner_texture[CornerOf(p, v)];
            if (t < 0) continue;
            const Eigen::Vector2d expected = path_.appearance.texture_coordinates.col(t);
            EXPECT_EQ(uv(0, index), static_cast<float>(expected.x())) << p << " " << v;
            EXPECT_EQ(uv(1, index), static_cast<float>(1 - expected.y())) << p << " " << v;
          }
        }
      }
      EXPECT_EQ(indices.size(), at);
    }
  }
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_NE(summary.warnings[0].find("'unknown'"), std::string::npos);
}

TEST_F(WriteGltfAppearanceTest, MaterialsAreThoseOfTheLibrary) {
  WriteGltf(GlbFile("materials"), path_);
  const Glb glb(GlbFile("materials"));
  const auto& materials = glb.json["materials"];
  const auto& painted = materials[0]["pbrMetallicRoughness"];
  EXPECT_FALSE(painted.contains("baseColorFactor")) << "black beside a texture";
  const auto& texture = glb.json["textures"][painted["baseColorTexture"]["index"].get<int>()];
  const auto& image = glb.json["images"][texture["source"].get<int>()];
  EXPECT_EQ(image["mimeType"], "image/png");
  EXPECT_EQ(glb.Bytes(image["bufferView"]), testing::Content(Path("maps/checks.png")));

  const auto& glass = materials[1]["pbrMetallicRoughness"];
  EXPECT_FALSE(glass.contains("baseColorTexture"));
  const std::vector<double> factor = glass["baseColorFactor"];
  const internal::Colour linear = internal::FromHex(0x8040ff);  // 128, 64 and 255 of 255
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(factor[k], linear[k], 0.005) << k;
  EXPECT_EQ(factor[3], 0.5);
  EXPECT_EQ(materials[1]["alphaMode"], "BLEND");
  EXPECT_FALSE(materials[0].contains("alphaMode"));
  EXPECT_EQ(materials[3]["pbrMetallicRoughness"], materials[2]["pbrMetallicRoughness"]);
  for (const auto& material : materials) EXPECT_EQ(material["doubleSided"], true);
}

TEST_F(WriteGltfAppearanceTest, MissingLibrariesAndTexturesAreWarnedOf) {
  std::filesystem::remove(Path("maps/checks.png"));
  const GltfSummary summary = WriteGltf(GlbFile("no-texture"), path_);
  ASSERT_EQ(summary.warnings.size(), 2u);
  EXPECT_TRUE(testing::Names(summary.warnings[1], {Path("maps/checks.png"), "No such file"}));
  EXPECT_FALSE(Glb(GlbFile("no-texture")).json.contains("images"));

  File("maps/checks.png", "BM this is none");
  EXPECT_NE(WriteGltf(GlbFile("bad-texture"), path_).warnings[1].find("neither PNG nor JPEG"),
            std::string::npos);

  std::filesystem::remove(Path("cube.mtl"));
  const GltfSummary plain = WriteGltf(GlbFile("no-library"), path_);
  ASSERT_EQ(plain.warnings.size(), 2u);
  EXPECT_EQ(plain.warnings[0].find("material library " + Path("cube.mtl") + ": cannot be opened"),
            0u);
  EXPECT_TRUE(Glb(GlbFile("no-library")).Primitive()["attributes"].contains("TEXCOORD_0"));
}

// A mesh from a stranger must not carry pictures of its user into what the user passes on.
TEST_F(WriteGltfAppearanceTest, WhatLiesOutsideOfTheFolderIsTakenOnRequestOnly) {
  std::filesystem::create_directories(Path("home"));
  std::filesystem::create_symlink(Path("cube.mtl"), Path("home/link.mtl"));
  std::filesystem::create_symlink(Path("maps/checks.png"), Path("home/link.png"));
  path_.appearance.folder = path_.appearance.own_folder = Path("home");
  const std::string rest = "\nnewmtl glass\nnewmtl unknown\n";
  File("home/by_link.mtl", "newmtl painted\nmap_Kd link.png" + rest);
  File("home/by_dots.mtl", "newmtl painted\nmap_Kd ../maps/checks.png" + rest);
  File("home/by_root.mtl", "newmtl painted\nmap_Kd " + Path("maps/checks.png") + rest);
  for (const char* library :
       {"../cube.mtl", "link.mtl", "by_link.mtl", "by_dots.mtl", "by_root.mtl"}) {
    path_.appearance.material_libraries = {library};
    const GltfSummary summary = WriteGltf(GlbFile("confined"), path_);
    ASSERT_FALSE(summary.warnings.empty()) << library;
    EXPECT_TRUE(testing::Names(summary.warnings[0], {"folder"})) << summary.warnings[0];
    EXPECT_FALSE(Glb(GlbFile("confined")).json.contains("images")) << library;
    GltfOptions options;
    options.allow_outside_files = true;
    WriteGltf(GlbFile("trusted"), path_, options);
    // A link's target is read as if it lay beside the link.
    if (library != std::string("link.mtl")) {
      EXPECT_TRUE(Glb(GlbFile("trusted")).json.contains("images")) << library;
    }
  }
  // Below the folder, nothing needs to be allowed.
  path_.appearance.own_folder = Path("");
  path_.appearance.material_libraries = {"by_dots.mtl"};
  EXPECT_TRUE(WriteGltf(GlbFile("below"), path_).warnings.empty());
  EXPECT_TRUE(Glb(GlbFile("below")).json.contains("images"));
}

TEST_F(WriteGltfAppearanceTest, VertexColoursFollowTheirVerticesAcrossSeams) {
  path_.appearance.vertex_colours = (Eigen::MatrixXd::Random(4, 8).array() + 1) / 2;
  path_.appearance.materials = {};
  WriteGltf(GlbFile("vertex-colours"), path_);
  const Glb glb(GlbFile("vertex-colours"));
  const Eigen::MatrixXd colours = glb.Attribute("COLOR_0");
  const Shape drawn = glb.InTheWorld(glb.Attribute("POSITION")), placed = path_.Placed(0);
  ASSERT_EQ(colours.rows(), 4);
  ASSERT_EQ(colours.cols(), drawn.cols());
  for (int i = 0; i < drawn.cols(); ++i) {
    int v = 0;
    (placed.colwise() - drawn.col(i)).colwise().norm().minCoeff(&v);
    const Eigen::VectorXd given = path_.appearance.vertex_colours.col(v);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(internal::ToByte(static_cast<float>(colours(k, i))), 255 * given[k], 0.51) << i;
    }
    EXPECT_FLOAT_EQ(colours(3, i), given[3]);
  }
  EXPECT_EQ(glb.json["materials"][0]["alphaMode"], "BLEND");
  EXPECT_FALSE(glb.json["materials"][0]["pbrMetallicRoughness"].contains("baseColorFactor"));
}

TEST_F(WriteGltfAppearanceTest, OtherColoursReplaceIt) {
  GltfOptions options;
  options.colour_by_deviation = true;
  EXPECT_TRUE(WriteGltf(GlbFile("replaced"), path_, options).warnings.empty());
  const Glb glb(GlbFile("replaced"));
  EXPECT_EQ(glb.json["materials"].size(), 1u);
  EXPECT_EQ(glb.Attribute("POSITION").cols(), 8);
  EXPECT_FALSE(glb.Primitive()["attributes"].contains("TEXCOORD_0"));
  EXPECT_FALSE(glb.json.contains("images"));
}

TEST_F(WriteGltfAppearanceTest, GraphsHaveTheirVertexColours) {
  const auto graph = Connectivity::Make(3, {0}, {}, {{0, 1}, {1, 2}});
  const Shape shape = Shape::Identity(3, 3);
  shapespace::Path path = testing::PathOf(graph, {shape, 2 * shape});
  path.appearance.vertex_colours = Eigen::MatrixXd::Identity(3, 3);
  WriteGltf(GlbFile("coloured-graph"), path);
  EXPECT_EQ(Glb(GlbFile("coloured-graph")).Attribute("COLOR_0"), Eigen::MatrixXd::Identity(3, 3));
}

TEST_F(WriteGltfAppearanceTest, ATextureOfTwoMaterialsIsEmbeddedOnce) {
  File("maps/photo.jpg", "\xff\xd8\xff\xe0 a picture");
  File("cube.mtl",
       "newmtl painted\nmap_Kd maps/photo.jpg\nnewmtl glass\nmap_Kd maps/checks.png\nd 0.25\n"
       "newmtl unknown\nKd 1 1 1\nmap_Kd maps/photo.jpg\n");
  EXPECT_TRUE(WriteGltf(Path("twice.glb"), path_).warnings.empty());
  const Glb glb(Path("twice.glb"));
  const auto& images = glb.json["images"];
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0]["mimeType"], "image/jpeg");
  EXPECT_EQ(images[0]["name"], "photo.jpg");
  EXPECT_EQ(images[1]["mimeType"], "image/png");
  EXPECT_EQ(images[1]["name"], "checks.png");
  EXPECT_EQ(glb.Bytes(images[0]["bufferView"]), testing::Content(Path("maps/photo.jpg")));
  EXPECT_EQ(glb.Bytes(images[1]["bufferView"]), testing::Content(Path("maps/checks.png")));
  ASSERT_EQ(glb.json["textures"].size(), 2u);
  EXPECT_EQ(glb.json["textures"][1]["source"], 1);
  const auto& materials = glb.json["materials"];
  for (const auto& [material, texture] : {std::pair{0, 0}, {1, 1}, {2, 0}}) {
    EXPECT_EQ(materials[material]["pbrMetallicRoughness"]["baseColorTexture"]["index"], texture);
  }
  EXPECT_EQ(materials[1]["pbrMetallicRoughness"]["baseColorFactor"],
            (std::vector<double>{1, 1, 1, 0.25}));
}

TEST_F(WriteGltfAppearanceTest, WithoutCoordinatesThereIsNoTexture) {
  path_.appearance.texture_coordinates.resize(2, 0);
  path_.appearance.corner_texture.clear();
  EXPECT_EQ(WriteGltf(GlbFile("no-coordinates"), path_).warnings.size(), 1u);
  const Glb glb(GlbFile("no-coordinates"));
  EXPECT_FALSE(glb.json.contains("images"));
  const auto& painted = glb.json["materials"][0]["pbrMetallicRoughness"];
  EXPECT_EQ(painted["baseColorFactor"], (std::vector<double>{0, 0, 0, 1}));
}

TEST_F(WriteGltfAppearanceTest, OpaqueColoursBlendNothing) {
  path_.appearance.vertex_colours = Eigen::MatrixXd::Constant(4, 8, 0.5);
  path_.appearance.vertex_colours.row(3).setOnes();
  path_.appearance.materials = {};
  WriteGltf(GlbFile("opaque"), path_);
  EXPECT_FALSE(Glb(GlbFile("opaque")).json["materials"][0].contains("alphaMode"));
}

TEST_F(WriteGltfAppearanceTest, NodesMeshesAndAnimationsHaveTheirNames) {
  GltfOptions options;
  const auto written = [&] {
    WriteGltf(GlbFile("names"), path_, options);
    return Glb(GlbFile("names")).json;
  };
  const auto json = written();
  EXPECT_EQ(json["animations"][0]["name"], "there and back");
  EXPECT_EQ(json["nodes"][0]["name"], "shape");
  EXPECT_FALSE(json["nodes"][0].contains("scale"));
  EXPECT_FALSE(json["nodes"][0].contains("rotation"));
  EXPECT_EQ(json["meshes"][0]["name"], "shape");
  EXPECT_EQ(json["meshes"][0]["weights"], std::vector<double>{0});
  EXPECT_EQ(json["scene"], 0);
  const auto& plain = json["materials"][3]["pbrMetallicRoughness"];
  EXPECT_EQ(plain["metallicFactor"], 0);
  EXPECT_EQ(plain["roughnessFactor"], 0.7);
  EXPECT_FALSE(json["asset"]["extras"].contains("last_colour_deviation"));
  for (const auto& view : json["bufferViews"]) EXPECT_EQ(view.value("byteOffset", 0) % 4, 0);
  options.playback = GltfPlayback::kLoop;
  EXPECT_EQ(written()["animations"][0]["name"], "there");
  options.playback = GltfPlayback::kOnce;
  EXPECT_EQ(written()["animations"][0]["name"], "there");
}

// A strip of paper that is folded by so many degrees at each of its creases.
TEST_F(WriteGltfAppearanceTest, FacetsAreFlatIfMoreThanHalfOfTheBentEdgesAreSharp) {
  const auto has_normals = [&](const std::vector<double>& degrees) {
    const int creases = static_cast<int>(degrees.size());
    std::vector<int> begin = {0}, corners;
    Shape shape(3, 2 * creases + 4);
    Eigen::Vector2d at(0, 0);
    double direction = 0;
    for (int i = 0; i < creases + 2; ++i) {
      shape.col(2 * i) << at.x(), 0, at.y();
      shape.col(2 * i + 1) << at.x(), 1, at.y();
      if (i > 0 && i <= creases) direction += degrees[i - 1] * EIGEN_PI / 180;
      at += Eigen::Vector2d(std::cos(direction), std::sin(direction));
      if (i == creases + 1) break;
      for (const int k : {0, 2, 3, 1}) corners.push_back(2 * i + k);
      begin.push_back(4 * (i + 1));
    }
    const auto strip = Connectivity::Make(2 * creases + 4, begin, corners);
    WriteGltf(GlbFile("strip"), testing::PathOf(strip, {shape, shape}));
    return Glb(GlbFile("strip")).Primitive()["attributes"].contains("NORMAL");
  };
  EXPECT_TRUE(has_normals({60, 10}));
  EXPECT_FALSE(has_normals({60, 10, -60}));
  EXPECT_TRUE(has_normals({60, 10, -60, -10}));
  EXPECT_FALSE(has_normals({60, 0.5, 0.5, 0.5}));
  EXPECT_TRUE(has_normals({60, 1.5, 0.5, 0.5}));
  EXPECT_FALSE(has_normals({46.5}));
  EXPECT_TRUE(has_normals({45.5}));
  EXPECT_TRUE(has_normals({0, 0.5}));
}

}  // namespace
}  // namespace shapespace
