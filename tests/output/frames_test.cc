#include <shapespace/output/frames.h>

#include <shapespace/path/path_file.h>

#include "mesh/files.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

class FramesTest : public testing::FilesTest {};

// Stiffeners are edges of the metric, not of the mesh, and frames of a path file must not have
// them.
TEST_F(FramesTest, GraphsWithStiffenersGoThroughPathFilesAsTheyWere) {
  using Pairs = std::vector<std::pair<int, int>>;
  const Pairs segments = {{0, 1}, {3, 2}, {2, 1}};
  const auto graph = Connectivity::Make(4, {0}, {}, segments, {{0, 2}, {1, 3}});
  Shape first(3, 4), last(3, 4);
  first << 0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0;
  last << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  const std::string file = Path("stick.path");
  WritePath(file, testing::PathOf(graph, {first, last}));
  const shapespace::Path read = ReadPath(file);
  EXPECT_EQ(read.metric->connectivity->NumEdges(), 5);
  EXPECT_EQ(FrameSoup(*read.metric->connectivity).segments, segments);
}

TEST_F(FramesTest, SegmentsBesidePolygonsAreKeptToo) {
  const auto flag = Connectivity::Make(5, {0, 4}, {0, 1, 2, 3}, {{3, 4}});
  const Soup plain = FrameSoup(*flag);
  EXPECT_EQ(plain.segments, (std::vector<std::pair<int, int>>{{3, 4}}));
  EXPECT_EQ(plain.corners, (std::vector<int>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace shapespace
