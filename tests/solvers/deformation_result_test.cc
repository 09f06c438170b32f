// What a deformation says of its result.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/analysis/intersections.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>

namespace shapespace {
namespace {

const ShapeFamily& TheBar() {
  static const ShapeFamily bar = MakeBar(6, 1, 1, 24, 4, 4);
  return bar;
}

/// One end of the bar stays, the other moves.
std::vector<DeformationHandle> HandlesAtEnds(const Eigen::Vector3d& motion) {
  const Shape rest = TheBar().pose(0);
  const double least = rest.row(0).minCoeff(), most = rest.row(0).maxCoeff();
  std::vector<DeformationHandle> handles(2);
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(0, v) < least + 0.3) handles[0].vertices.push_back(v);
    if (rest(0, v) > most - 0.3) handles[1].vertices.push_back(v);
  }
  handles[1].motion.translation = motion;
  return handles;
}

DeformationResult Move(const Eigen::Vector3d& motion, const DeformationOptions& options = {}) {
  return Deform(TheBar().connectivity, TheBar().pose(0), HandlesAtEnds(motion), options);
}

int WarningsWith(const std::string& word, const DeformationSummary& summary) {
  int count = 0;
  for (const std::string& warning : summary.warnings) {
    count += warning.find(word) != std::string::npos ? 1 : 0;
  }
  return count;
}

TEST(DeformationResult, SaysThatTheBodyPassesThroughItself) {
  const DeformationResult result = Move({-5.6, 0.1, 0});  // one end into the other
  const Shape rest = TheBar().pose(0);
  std::int64_t most = 0;
  for (int i = 0; i < result.path.NumShapes(); ++i) {
    most = std::max(most, CountIntersections(*TheBar().connectivity, result.path.Placed(i)));
  }
  EXPECT_GT(result.summary.intersections, 5);
  EXPECT_NEAR(result.summary.intersections, most - CountIntersections(*TheBar().connectivity, rest),
              2);  // rounding moves shapes
  EXPECT_EQ(WarningsWith("intersect", result.summary), 1);
  // What intersects itself at rest is no fault of the handles.
  const Shape crossed = result.path.Placed(result.path.NumShapes() - 1);
  std::vector<DeformationHandle> stay = HandlesAtEnds({0, 0, 0});
  const DeformationSummary summary = Deform(TheBar().connectivity, crossed, stay).summary;
  EXPECT_LE(summary.intersections, 5);
  EXPECT_EQ(WarningsWith("intersect", summary), 0);
}

TEST(DeformationResult, SaysThatEdgesAreTorn) {
  EXPECT_EQ(WarningsWith("longer by", Move({20, 0, 0}).summary), 1);
  EXPECT_TRUE(Move({1.5, 0.5, 0}).summary.warnings.empty());
  EXPECT_EQ(Move({1.5, 0.5, 0}).summary.intersections, 0);
}

// While handles are dragged nothing is counted, and a number says so.
TEST(DeformationResult, OfADeformerIsNotCounted) {
  Deformer deformer(TheBar().connectivity, TheBar().pose(0));
  const DeformationSummary summary = deformer.Deform(HandlesAtEnds({-5.6, 0.1, 0})).summary;
  EXPECT_TRUE(std::isnan(summary.intersections));
  EXPECT_EQ(WarningsWith("intersect", summary), 0);
}

TEST(DeformationResult, OfARepairIsCountedToo) {
  const Shape crossed = Move({-5.6, 0.1, 0}).path.Placed(5);
  RepairOptions options;
  options.deformation.balance = 1e-4;
  const RepairSummary summary =
      Repair(TheBar().connectivity, TheBar().pose(0), crossed, options).summary;
  EXPECT_GT(summary.deformation.intersections, 5);
  EXPECT_EQ(WarningsWith("intersect", summary.deformation), 1);
}

}  // namespace
}  // namespace shapespace
