#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"
#include "support/message_of.h"

// What programs write in place of numbers, in every format that is text.

namespace shapespace {
namespace {

struct TextFormat {
  MeshFormat format;
  std::string with_number;  // of a triangle, one coordinate of which is 'N'
};

std::vector<TextFormat> TextFormats() {
  return {{MeshFormat::kObj, "v 0 0 0\nv 1 0 0\nv 0 N 1 # here\nf 1 2 3\n"},
          {MeshFormat::kOff, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 N 1 # here\n3 0 1 2\n"},
          {MeshFormat::kPly,
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 N 1\n3 0 1 2\n"},
          {MeshFormat::kStl,
           "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 N 1\n"
           "endloop\nendfacet\nendsolid\n"},
          {MeshFormat::kVtk,
           "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
           "0 0 0 1 0 0 0 N 1\nPOLYGONS 1 4\n3 0 1 2\n"},
          {MeshFormat::kVtp,
           "<VTKFile type='PolyData'><PolyData><Piece NumberOfPoints='3' NumberOfPolys='1'><Points>"
           "<DataArray type='Float32' Name='p' NumberOfComponents='3' format='ascii'>0 0 0 1 0 0 0"
           " N 1</DataArray></Points><Polys><DataArray type='Int32' Name='connectivity' "
           "format='ascii'>0 1 2</DataArray><DataArray type='Int32' Name='offsets' format='ascii'>3"
           "</DataArray></Polys></Piece></PolyData></VTKFile>"}};
}

Soup Read(const TextFormat& text, const std::string& number) {
  std::string content = text.with_number;
  content.replace(content.find(" N 1") + 1, 1, number);
  return testing::SoupOf(content, "m", text.format);
}

TEST(ForeignNumbersTest, NotANumberIsRefusedInEveryFormatHoweverItIsWritten) {
  for (const TextFormat& text : TextFormats()) {
    EXPECT_EQ(Read(text, "1.5").vertices.col(2), Eigen::Vector3d(0, 1.5, 1));
    for (const char* word : {"nan", "-nan", "NaN", "-nan(ind)", "inf", "1.#QNAN", "-1.#IND",
                             "1.#INF", "-1.#IND00", "1.#QNAN0", "1.#J"}) {
      EXPECT_THROW(Read(text, word), FileError) << word << " in " << text.with_number;
    }
  }
}

TEST(ForeignNumbersTest, DecimalCommasAreSaidInEveryFormat) {
  for (const TextFormat& text : TextFormats()) {
    const std::string message = testing::MessageOf<FileError>([&] { Read(text, "1,5"); });
    EXPECT_NE(message.find("'1,5'"), std::string::npos) << message;
    EXPECT_NE(message.find("comma"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace shapespace
