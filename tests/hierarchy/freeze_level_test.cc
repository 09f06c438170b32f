#include <shapespace/hierarchy/freeze_level.h>

#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>

#include "support/features.h"
#include "support/own_features.h"

namespace shapespace {
namespace {

struct Levels {
  ShapeFamily bar = MakeBar(8, 1, 1, 32, 4, 4);
  Shape rest = bar.pose(0);
  Hierarchy hierarchy{bar.connectivity, {rest}};
};

TEST(RestrictField, KeepsConstantsAndTheRange) {
  const Levels levels;
  ASSERT_GT(levels.hierarchy.NumLevels(), 1);
  const int num_vertices = levels.bar.connectivity->NumVertices();
  const Eigen::VectorXd constant = Eigen::VectorXd::Constant(num_vertices, 3);
  Eigen::VectorXd halves(num_vertices);
  for (int v = 0; v < num_vertices; ++v) halves(v) = levels.rest(0, v) < 4 ? 1 : 100;
  for (int level = 0; level < levels.hierarchy.NumLevels(); ++level) {
    const Eigen::VectorXd same = levels.hierarchy.RestrictField(constant, level);
    EXPECT_TRUE(same.isApproxToConstant(3, 1e-13));
    const Eigen::VectorXd coarse = levels.hierarchy.RestrictField(halves, level);
    EXPECT_GE(coarse.minCoeff(), 1 - 1e-12);
    EXPECT_LE(coarse.maxCoeff(), 100 + 1e-12);
    // Away from the border between the halves, values do not depend on the other half.
    const Shape places = levels.hierarchy.Restrict(levels.rest, level);
    for (int v = 0; v < places.cols(); ++v) {
      if (places(0, v) > 1 && places(0, v) < 7) continue;
      EXPECT_NEAR(coarse(v), places(0, v) < 4 ? 1 : 100, 1e-10);
    }
  }
}

// Several vertices of the mesh collapse to a vertex of a coarse level; the mean is over all of
// them.
TEST(RestrictField, IsTheMeanOverTheVerticesThatAVertexStandsFor) {
  const Levels levels;
  Eigen::VectorXd field = Eigen::VectorXd::Ones(levels.bar.connectivity->NumVertices());
  std::vector<char> kept(field.size(), 0);
  for (const int v : levels.hierarchy.Vertices(0)) kept[v] = 1;
  for (int v = 0; v < field.size(); ++v) {
    if (!kept[v]) field(v) = 4;
  }
  const Eigen::VectorXd coarse = levels.hierarchy.RestrictField(field, 0);
  // The mean of the logarithm gives the share of the vertices that collapsed to a kept one.
  const double share = 1 - static_cast<double>(coarse.size()) / static_cast<double>(field.size());
  EXPECT_NEAR(coarse.array().log().mean() / std::log(4.0), share, 0.15);
  EXPECT_GT(coarse.minCoeff(), 1);
  EXPECT_LT(coarse.maxCoeff(), 4);
}

TEST(FreezeLevel, FreezesOwnFeaturesAndStiffnessOnEveryLevel) {
  const Levels levels;
  MetricOptions options = testing::OwnBlend();
  options.bending_stiffness.setConstant(levels.bar.connectivity->NumEdges(), 5);
  options.stiffness_on = StiffnessOn::kEdges;
  const auto finest = FreezeMetric(options, levels.bar.connectivity, {levels.rest});
  const Shape coarse = levels.hierarchy.Restrict(levels.rest / finest->unit, 0);
  const auto metric = FreezeLevel(*finest, levels.hierarchy, 0, {coarse});
  EXPECT_EQ(metric->unit, 1);
  EXPECT_EQ(testing::Get<testing::OwnStrain>(*metric).weights.size(),
            metric->connectivity->NumTriangles());
  options.bending_stiffness.resize(0);
  options.bending *= 5;
  const auto expected = FreezeMetric(options, metric->connectivity, {coarse}, 1);
  EXPECT_TRUE(testing::Get<Dihedral>(*metric).weights.isApprox(
      testing::Get<Dihedral>(*expected).weights, 1e-12));
}

}  // namespace
}  // namespace shapespace
