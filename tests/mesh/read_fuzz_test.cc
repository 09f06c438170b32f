#include <random>

#include <zlib.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/mesh/check.h>

#include "mesh/bodies.h"
#include "mesh/files.h"

namespace shapespace {
namespace {

class ReadFuzzTest : public testing::FilesTest {
 protected:
  /// Damaged copies of a file must be rejected with an Error, or give a soup that can be checked.
  void Damage(const std::string& extension, const std::string& content, int count) {
    std::mt19937 random(12345);
    auto below = [&random](size_t n) { return static_cast<size_t>(random() % n); };
    // Bytes with a meaning for one of the readers are inserted more often.
    const std::string telling = "0123456789 \n\r\t-+.e/#\\vflOFply<>\"=_A\xff";
    int accepted = 0, refused = 0;
    for (int i = 0; i < count; ++i) {
      std::string damaged = content;
      for (size_t change = 0, changes = 1 + below(4); change < changes; ++change) {
        const size_t at = below(damaged.size());
        switch (below(5)) {
          case 0:
            damaged[at] = static_cast<char>(random());
            break;
          case 1:
            damaged[at] = telling[below(telling.size())];
            break;
          case 2:
            damaged.resize(at + 1);
            break;
          case 3:
            damaged.erase(at, std::min<size_t>(1 + below(8), damaged.size() - 1));
            break;
          default:
            damaged.insert(at, damaged.substr(below(damaged.size()), 1 + below(12)));
        }
        if (damaged.empty()) damaged = " ";
      }
      const std::string file = File("damaged" + extension, damaged);
      try {
        const Soup soup = ReadSoup(file);
        ASSERT_TRUE(soup.vertices.allFinite());
        soup.appearance.Validate(soup.NumVertices(), soup.NumPolygons(),
                                 static_cast<int>(soup.corners.size()));
        for (const Finding& finding : CheckSoup(soup)) ASSERT_FALSE(finding.message.empty());
        CheckSameMesh(soup, soup);
        ++accepted;
      } catch (const Error& error) {
        ASSERT_NE(std::string(error.what()).find("damaged" + extension), std::string::npos);
        ++refused;
      }
    }
    // Otherwise the damage was too small, or too large, for a meaningful test.
    EXPECT_GT(accepted, count / 100);
    EXPECT_GT(refused, count / 5);
  }
};

TEST_F(ReadFuzzTest, Obj) {
  Damage(".obj",
         "mtllib a.mtl\no a\nv 0 0 0 1 0 1\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nv 2 2 2\nvt 0 0\nvt 1 "
         "1\nvn 0 0 1\n"
         "usemtl red\nf 1/1 2/2 3/1 4/2\nf -1//1 3/1/1 2\nl 1 2 \\\n 5\ng part\n",
         3000);
}

TEST_F(ReadFuzzTest, Off) {
  Damage(".off",
         "OFF\n5 3 0\n0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n2 2 2\n4 0 1 2 3\n3 1 4 2\n3 3 2 4 255 0 0\n",
         3000);
}

TEST_F(ReadFuzzTest, TextPly) {
  Damage(".ply",
         "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nproperty uchar red\nproperty uchar green\nproperty float blue\n"
         "element face 2\nproperty list uchar int vertex_indices\n"
         "property list uchar float texcoord\nelement edge 1\nproperty int vertex1\n"
         "property int vertex2\nend_header\n0 0 0 1 2 1\n1 0 0 1 3 0\n1 1 0.5 1 4 .5\n"
         "0 1 0 1 5 1\n3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 0\n1 3\n",
         3000);
}

TEST_F(ReadFuzzTest, BinaryPly) {
  Soup soup = testing::Cube();
  soup.segments = {{0, 7}};
  soup.appearance.texture_coordinates = Eigen::Matrix2Xd::Random(2, 24);
  for (int k = 0; k < 24; ++k) soup.appearance.corner_texture.push_back(k);
  soup.appearance.vertex_colours.setConstant(4, 8, 0.5);
  WriteMesh(Path("cube.ply"), soup.vertices, soup);
  Damage(".ply", testing::Content(Path("cube.ply")), 3000);
}

TEST_F(ReadFuzzTest, TextStl) {
  Damage(".stl",
         "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0.5\n"
         "endloop\nendfacet\nfacet normal 0 0 1\n outer loop\nvertex 0 0 0\nvertex 1 1 .5\n"
         "vertex 0 1 0\nendloop\nendfacet\nendsolid a b\n",
         3000);
}

TEST_F(ReadFuzzTest, BinaryStl) {
  const Soup cube = testing::Cube();
  WriteMesh(Path("cube.stl"), cube.vertices, cube);
  Damage(".stl", testing::Content(Path("cube.stl")), 3000);
}

TEST_F(ReadFuzzTest, TextVtk) {
  Damage(".vtk",
         "# vtk DataFile Version 5.1\nx\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
         "0 0 0 1 0 0 1 1 .5 0 1 0\nMETADATA\nINFORMATION 0\n\nLINES 2 2\nOFFSETS int\n0 2\n"
         "CONNECTIVITY int\n0 3\nTRIANGLE_STRIPS 2 4\nOFFSETS int\n0 4\nCONNECTIVITY int\n"
         "0 1 3 2\nPOINT_DATA 4\nCOLOR_SCALARS c 3\n1 0 0 0 1 0 0 0 1 1 1 1\nSCALARS s int 1\n"
         "LOOKUP_TABLE default\n1 2 3 4\nFIELD f 1\na%20b 2 4 float\n1 2 3 4 5 6 7 8\n"
         "TEXTURE_COORDINATES t 2 float\n0 0 1 0 1 1 0 1\n",
         3000);
}

TEST_F(ReadFuzzTest, BinaryVtk) {
  std::string file =
      "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 short\n";
  const auto add = [&file](const std::vector<int>& numbers, auto type) {
    for (const int number : numbers) {
      internal::AppendBigEndian(static_cast<decltype(type)>(number), &file);
    }
  };
  add({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1}, std::int16_t{});
  file += "\nCELLS 3 13\n";
  add({4, 0, 1, 2, 3, 3, 0, 2, 1, 3, 0, 1, 3}, std::int32_t{});
  file += "\nCELL_TYPES 3\n";
  add({8, 5, 6}, std::int32_t{});
  file +=
      "\nPOINT_DATA 4\nFIELD f 1\nt 1 2 string\n\xc1x\xc2xy\n"
      "SCALARS s unsigned_char 4\nLOOKUP_TABLE default\n";
  add({1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 1, 2, 3, 4, 5, 6}, std::uint8_t{});
  Damage(".vtk", file, 3000);
}

TEST_F(ReadFuzzTest, Vtp) {
  Damage(".vtp",
         "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData><Piece "
         "NumberOfPoints=\"4\" NumberOfPolys=\"2\" NumberOfLines=\"1\"><PointData "
         "TCoords=\"t\"><DataArray type=\"UInt8\" Name=\"c\" NumberOfComponents=\"3\" "
         "format=\"ascii\">1 2 3 4 5 6 7 8 9 0 1 2</DataArray></PointData><Points><DataArray "
         "type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points>"
         "<Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 0 2 3"
         "</DataArray><DataArray type=\"Int8\" Name=\"offsets\" format=\"binary\">AgAAAAMG"
         "</DataArray></Polys><Lines><DataArray type=\"Int32\" Name=\"connectivity\" "
         "format=\"ascii\">0 3</DataArray><DataArray type=\"Int32\" Name=\"offsets\" "
         "format=\"ascii\">2</DataArray></Lines></Piece></PolyData><AppendedData "
         "encoding=\"base64\">_MAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAIA/AAAAAAAAAAAAAIA/"
         "AAAAAA==</AppendedData></VTKFile>",
         3000);
}

// Blocks that zlib compressed.
TEST_F(ReadFuzzTest, CompressedVtp) {
  std::string points;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
    internal::AppendLittleEndian(x, &points);
  }
  std::string block(compressBound(points.size()), '\0'), appended;
  uLongf size = block.size();
  compress(reinterpret_cast<Bytef*>(block.data()), &size,
           reinterpret_cast<const Bytef*>(points.data()), points.size());
  for (const size_t number : {size_t{1}, points.size(), size_t{0}, size_t{size}}) {
    internal::AppendLittleEndian(static_cast<std::uint32_t>(number), &appended);
  }
  Damage(".vtp",
         "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><!-- of which not "
         "every byte matters, so that some of the damage is accepted --><PolyData><Piece "
         "NumberOfPoints=\"3\"><Points><DataArray type=\"Float32\" format=\"appended\" "
         "offset=\"0\"/></Points></Piece></PolyData><AppendedData encoding=\"raw\">_" +
             appended + block.substr(0, size),
         3000);
}

// With an embedded buffer: eight vertices, a target that moves one of them, and indices of bytes.
TEST_F(ReadFuzzTest, Gltf) {
  Damage(".gltf",
         R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0,"scale":[1,2,3],"children":[1]},{}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":2,"targets":[{"POSITION":1}]}]}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":4,"min":[0,0,0],"max":[1,1,1]},
{"componentType":5126,"type":"VEC3","count":4,"min":[0,0,0],"max":[1,1,1],
"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}}},
{"bufferView":1,"byteOffset":1,"componentType":5121,"type":"SCALAR","count":6}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":8}],
"buffers":[{"byteLength":56,"uri":"data:application/octet-stream;base64,)"
         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAwABAgACAwA=\"}]}",
         3000);
}

}  // namespace
}  // namespace shapespace
