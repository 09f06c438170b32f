#include <shapespace/output/vertex_colours.h>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/output/frames.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

class VertexColoursTest : public testing::FilesTest {
 protected:
  // A grid that is stretched more and more towards one side.
  VertexColoursTest() {
    const Soup grid = testing::Grid(20, 4);
    Shape stretched = grid.vertices;
    stretched.row(0) = stretched.row(0).array() * (1 + 0.05 * stretched.row(0).array());
    path_ = testing::PathOf(testing::Connected(grid),
                            {grid.vertices, (grid.vertices + stretched) / 2, stretched});
  }

  shapespace::Path path_;
};

// Along the scale, blue becomes steadily less.
TEST_F(VertexColoursTest, LessBlueWhereTheDeviationIsGreater) {
  const ValueColours colours = ColourByDeviation(path_);
  ASSERT_EQ(colours.of_shapes.size(), 3u);
  const Eigen::RowVectorXd none = colours.of_shapes[0].row(2);
  EXPECT_EQ(none.minCoeff(), none.maxCoeff());
  const Eigen::VectorXd deviation = EdgeDeviation(path_, 2);
  const Eigen::RowVectorXd blue = colours.of_shapes[2].row(2);
  for (Eigen::Index a = 0; a < blue.size(); ++a) {
    EXPECT_LE(blue[a], none[0]);
    for (Eigen::Index b = 0; b < a; ++b) {
      if (deviation[a] > deviation[b] + 0.1 && deviation[a] < colours.scale_end) {
        EXPECT_LT(blue[a], blue[b]);
      }
    }
  }
  // There is one scale for all shapes, whose end is not reached at half the way.
  EXPECT_GT(colours.of_shapes[1].row(2).minCoeff(), blue.minCoeff() + 0.05);
  EXPECT_GE(colours.scale_end, 0.9 * deviation.maxCoeff());
}

TEST_F(VertexColoursTest, DeviationIsFromTheReference) {
  const ValueColours colours = ColourByDeviation(path_, path_.shapes[2]);
  EXPECT_EQ(colours.of_shapes[2].colwise().mean().minCoeff(),
            colours.of_shapes[2].colwise().mean().maxCoeff());
}

TEST_F(VertexColoursTest, FramesShowColoursInsteadOfMaterials) {
  Soup soup = FrameSoup(*path_.metric->connectivity);
  soup.appearance.materials = {{"red"}, std::vector<int>(soup.NumPolygons(), 0)};
  soup.appearance.groups = {{"left"}, std::vector<int>(soup.NumPolygons(), 0)};
  const ValueColours colours = ColourByDeviation(path_);
  for (const std::string pattern : {"%d.ply", "%d.obj"}) {
    WriteFrames(Path(pattern), path_.Placed(), soup, colours.of_shapes);
    for (int i = 0; i < 3; ++i) {
      const Soup read = ReadSoup(FrameName(Path(pattern), i));
      EXPECT_EQ(read.appearance.vertex_colours, colours.of_shapes[i]);
      EXPECT_TRUE(read.appearance.materials.names.empty());
      EXPECT_EQ(read.appearance.groups.names.size(), pattern == "%d.obj" ? 1u : 0u);
    }
  }
  EXPECT_THROW(WriteFrames(Path("x%d.ply"), path_.Placed(), soup, {colours.of_shapes[0]}),
               InvalidOptions);
}

TEST_F(VertexColoursTest, GroupsHaveDifferentColours) {
  const Eigen::MatrixXd colours = ColourByGroup((Eigen::VectorXi(5) << 0, 1, 2, 0, -1).finished());
  EXPECT_EQ(colours.col(0), colours.col(3));
  for (const auto& [a, b] : {std::make_pair(0, 1), {1, 2}, {0, 2}, {0, 4}, {1, 4}}) {
    EXPECT_GT((colours.col(a) - colours.col(b)).norm(), 0.2) << a << " " << b;
  }
  EXPECT_LT(colours.col(4).maxCoeff() - colours.col(4).minCoeff(), 0.05) << "grey for none";
}

TEST_F(VertexColoursTest, BonesHaveTheColoursOfGroupsMixedByWeights) {
  SkinnedPath path;
  path.bones = (Eigen::MatrixXi(2, 3) << 0, 1, 1, 0, 0, 0).finished();
  path.weights = (Eigen::MatrixXd(2, 3) << 1, 1, 0.5, 0, 0, 0.5).finished();
  const Eigen::MatrixXd colours = ColourByBone(path);
  const Eigen::MatrixXd groups = ColourByGroup(Eigen::Vector2i(0, 1));
  EXPECT_EQ(colours.leftCols(2), groups);
  for (int k = 0; k < 3; ++k) {
    const auto ends = std::minmax(groups(k, 0), groups(k, 1));
    EXPECT_GT(colours(k, 2), ends.first);
    EXPECT_LT(colours(k, 2), ends.second);
  }
}

}  // namespace
}  // namespace shapespace
