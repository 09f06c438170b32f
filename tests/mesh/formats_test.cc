#include <shapespace/files/read.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

class FormatsTest : public testing::FilesTest {};

TEST_F(FormatsTest, TheThreeFormatsGiveTheSameSoup) {
  const std::string vertices[] = {"0 0 0", "1.25 0 -3e-7", "1 1.000000001 0", "-0.1 1 0.3"};
  std::string obj, off = "OFF\n4 2 0\n";
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
      "property double z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  for (const std::string& v : vertices) {
    obj += "v " + v + "\n";
    off += v + "\n";
    ply += v + "\n";
  }
  const Soup a = ReadSoup(File("a.OBJ", obj + "f 1 2 3 4\nf 3 2 1\n"));
  const Soup b = ReadSoup(File("b.off", off + "4 0 1 2 3\n3 2 1 0\n"));
  const Soup c = ReadSoup(File("c.Ply", ply + "4 0 1 2 3\n3 2 1 0\n"));
  for (const Soup* other : {&b, &c}) {
    EXPECT_EQ(a.vertices, other->vertices);
    EXPECT_EQ(a.polygon_begin, other->polygon_begin);
    EXPECT_EQ(a.corners, other->corners);
  }
}

}  // namespace
}  // namespace shapespace
