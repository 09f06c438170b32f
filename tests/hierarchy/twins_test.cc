#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/hierarchy/hierarchy.h>

#include "support/cut_body.h"

namespace shapespace {
namespace {

using testing::CutBody;

// Where many collapses cost the same, rounding would decide which comes first.
Shape Uneven(const Shape& shape) {
  std::srand(1);
  return shape + 0.02 * Shape::Random(3, shape.cols());
}

class TwinsOfLevels : public ::testing::Test {
 protected:
  const ShapeFamily bar_ = MakeBar(6, 1, 1, 24, 4, 4);
  const CutBody cut_ = testing::CutIntoPolygons(*bar_.connectivity);
  const std::vector<Shape> whole_ = {Uneven(bar_.pose(0)), Uneven(bar_.pose(50))};
  const std::vector<Shape> poses_ = {cut_.Of(whole_[0]), cut_.Of(whole_[1])};
  const HierarchyOptions options_ = {100, {cut_.LastCopy(7)}};  // pinned by its twin
  const Hierarchy hierarchy_{testing::Joined(cut_, *bar_.connectivity), poses_, options_};
};

TEST_F(TwinsOfLevels, AreOnTheFinestLevelOnly) {
  const Hierarchy expected(bar_.connectivity, whole_, {100, {7}});
  ASSERT_EQ(hierarchy_.NumLevels(), expected.NumLevels());
  ASSERT_GT(expected.NumLevels(), 2);
  for (int level = 0; level + 1 < expected.NumLevels(); ++level) {
    EXPECT_EQ(hierarchy_.Vertices(level), expected.Vertices(level));
    EXPECT_EQ(hierarchy_.LevelConnectivity(level)->Triangles(),
              expected.LevelConnectivity(level)->Triangles());
    EXPECT_TRUE(hierarchy_.LevelConnectivity(level)->Twins().empty());
  }
}

TEST_F(TwinsOfLevels, AreLiftedWithTheirRepresentatives) {
  const int level = hierarchy_.NumLevels() - 2;
  Shape coarse = hierarchy_.Restrict(poses_[1], level);
  coarse.row(2).array() += coarse.row(0).array().square();
  const Shape lifted = hierarchy_.Lift(coarse, level, poses_[0], poses_[1], 0.3);
  EXPECT_TRUE(cut_.HasNoGap(lifted));
  const Hierarchy expected(bar_.connectivity, whole_, {100, {7}});
  const Shape of_whole = expected.Lift(coarse, level, whole_[0], whole_[1], 0.3);
  EXPECT_LT((lifted.leftCols(of_whole.cols()) - of_whole).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(TwinsOfLevels, CountNothingInMeansOfFields) {
  const Hierarchy expected(bar_.connectivity, whole_, {100, {7}});
  const int vertices = bar_.connectivity->NumVertices();
  Eigen::VectorXd field = Eigen::VectorXd::Constant(cut_.source.size(), 1e6);
  field.head(vertices) = Eigen::VectorXd::LinSpaced(vertices, 1, 9);
  for (int level = 0; level < expected.NumLevels(); ++level) {
    const Eigen::VectorXd found = hierarchy_.RestrictField(field, level);
    const Eigen::VectorXd wanted = expected.RestrictField(field.head(vertices), level);
    EXPECT_LT((found.head(wanted.size()) - wanted).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT(found.maxCoeff(), 10);
  }
}

}  // namespace
}  // namespace shapespace
