#include <shapespace/bodies/bar.h>
#include <shapespace/files/read.h>
#include <shapespace/files/write.h>

#include "support/cut_body.h"
#include "tools/run.h"

namespace shapespace {
namespace {

using testing::CutBody;
using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;
using testing::ToolsTest;

// A bar of which every triangle has vertices of its own, in two poses and every format that does
// not merge vertices.
class SeamsTest : public ToolsTest {
 protected:
  SeamsTest() {
    for (const char* extension : {".obj", ".ply", ".off"}) {
      for (int i = 0; i < 2; ++i) {
        const Soup soup = cut_.AsSoup(bar_.pose(40.0 * i));
        WriteMesh(Path("bar" + std::to_string(i) + extension), soup.vertices, soup);
      }
    }
    File("handles.json",
         R"({"handles": [{"name": "left", "select": {"halfspace": {"point": [-2.4, 0, 0],
             "normal": [-1, 0, 0]}}, "fixed": true},
             {"name": "right", "select": {"halfspace": {"point": [2.4, 0, 0],
             "normal": [1, 0, 0]}}, "translation": [0, 0, 1]}]})");
  }

  const ShapeFamily bar_ = MakeBar(6, 1, 1, 9, 2, 2);
  const CutBody cut_ = testing::CutIntoPolygons(*bar_.connectivity);
};

TEST_F(SeamsTest, OutputsHaveTheVerticesOfTheInputAndNoGap) {
  for (const std::string extension : {".obj", ".ply", ".off"}) {
    const Outcome outcome =
        Run("shape-interpolate", {"bar0" + extension, "bar1" + extension, "--shapes", "1",
                                  "--output", "moved%d" + extension});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    ExpectContains(outcome.err, "pairs of vertices");
    for (const char* number : {"0", "1", "2"}) {
      const Soup moved = ReadSoup(Path("moved" + std::string(number) + extension));
      EXPECT_EQ(moved.corners, cut_.corners);
      EXPECT_TRUE(cut_.HasNoGap(moved.vertices));
    }
  }
}

TEST_F(SeamsTest, HandlesMoveTheWholeBodyUnlessSeamsAreOpen) {
  const auto deform = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> arguments = {"bar0.obj", "--handles", "handles.json", "--output",
                                          "deformed.obj"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Outcome outcome = Run("shape-deform", arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return cut_.HasNoGap(ReadSoup(Path("deformed.obj")).vertices);
  };
  EXPECT_TRUE(deform({}));
  EXPECT_FALSE(deform({"--open_seams"}));
}

TEST_F(SeamsTest, InspectionTellsOfTheWholeBody) {
  const Outcome whole = Run("shape-inspect", {"bar0.obj", "bar1.obj"});
  EXPECT_EQ(whole.code, 0) << whole.err;
  ExpectContains(whole.out, "components (1)");
  ExpectContains(whole.out, "boundary loops (0)");
  ExpectContains(whole.out, "pairs of vertices");
  const Outcome open = Run("shape-inspect", {"bar0.obj", "--open_seams"});
  EXPECT_EQ(open.code, 0) << open.err;
  ExpectLacks(open.out, "components (1)");
  ExpectLacks(open.out, "pairs of vertices");
}

}  // namespace
}  // namespace shapespace
