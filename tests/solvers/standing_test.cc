#include <shapespace/deformation/standing.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/path/internal/velocity.h>
#include <shapespace/spline/spline.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::Diameter;
using testing::Distance;
using testing::Listener;
using testing::MessageOf;
using testing::Names;

// A sheet that stands on its two ends, the feet, as a bridge. Its middle moves from pose to pose,
// and in pose 2 its right foot is lifted.
struct Bridge {
  ShapeFamily sheet = MakeSheet(2, 0.6, 12, 4);
  std::vector<int> left, right;
  std::vector<Shape> poses;

  Bridge() {
    const Shape rest = sheet.pose(100);
    const double low = rest.row(0).minCoeff(), high = rest.row(0).maxCoeff();
    const auto where = [&](double from, double to) {
      return testing::Where(rest,
                            [&](const Eigen::Vector3d& p) { return p(0) >= from && p(0) <= to; });
    };
    left = where(low, low + 0.02);
    right = where(high - 0.02, high);
    const std::vector<int> middle = where((low + high) / 2 - 0.1, (low + high) / 2 + 0.1);
    const Eigen::Vector3d ways[] = {{0.2, 0.1, 0.1}, {-0.1, 0, 0.05}, {-0.2, 0.1, -0.1}};
    poses.push_back(rest);
    for (int i = 0; i < 3; ++i) {
      std::vector<DeformationHandle> handles(3);
      handles[0].vertices = left;
      handles[1].vertices = right;
      if (i == 1) handles[1].motion.translation = {0.05, 0.2, 0.3};
      handles[2].vertices = middle;
      handles[2].motion.translation = ways[i];
      const Path path = Deform(sheet.connectivity, rest, handles).path;
      poses.push_back(path.Placed(path.NumShapes() - 1));
    }
  }

  Path Motion(bool smooth, int shapes) const {
    SplineOptions options;
    options.geodesic.shapes = shapes;
    options.geodesic.tolerance = 1e-9;
    options.ends = SplineEnds::kPeriodic;
    if (smooth) return Spline(sheet.connectivity, poses, options).path;
    return Interpolate(sheet.connectivity, poses, options.geodesic).path;
  }

  // The left foot stands throughout, and the right one except near pose 2.
  std::vector<StandingPart> Parts(int last) const {
    std::vector<std::pair<int, int>> steps = {{0, 1}};
    if (last > 3) steps.push_back({3, last});
    return {{"left", left, {{0, last}}}, {"right", right, steps}};
  }
};

const Bridge& TheBridge() {
  static const Bridge bridge;
  return bridge;
}

Shape PartOf(const Shape& shape, const std::vector<int>& part) { return shape(Eigen::all, part); }

TEST(Standing, PartsStandInTheirPlacesAndPosesStay) {
  const Bridge& bridge = TheBridge();
  for (const bool smooth : {false, true}) {
    const Path before = bridge.Motion(smooth, 7);
    Path path = before;
    const int last = static_cast<int>(path.poses.size()) - 1;
    const StandingSummary summary =
        HoldStandingParts(before, bridge.Parts(last), StandingDefaults(), &path);
    EXPECT_TRUE(summary.Converged());
    EXPECT_GT(summary.slide_before, 1e-3);
    EXPECT_LT(summary.slide, 1e-12);
    EXPECT_LT(summary.drift, 1e-12);
    for (int k = 0; k < path.NumShapes(); ++k) {
      EXPECT_LT(Distance(PartOf(path.Placed(k), bridge.left), PartOf(bridge.poses[0], bridge.left)),
                1e-12)
          << k;
    }
    for (int k = 0; k <= path.poses[1]; ++k) {
      EXPECT_LT(
          Distance(PartOf(path.Placed(k), bridge.right), PartOf(bridge.poses[0], bridge.right)),
          1e-12)
          << k;
    }
    for (const int k : path.poses) EXPECT_EQ(path.Placed(k), before.Placed(k));
    EXPECT_GT(Distance(PartOf(path.Placed(path.poses[2]), bridge.right),
                       PartOf(bridge.poses[0], bridge.right)),
              0.3);
    // Nothing else moves by more than the feet had to.
    EXPECT_LT(Distance(path, before), 3 * summary.slide_before * Diameter(bridge.poses[0]));
    EXPECT_LT(summary.edge_rms, 0.02);
  }
}

// The greatest jump of velocity at a pose, as a share of the mean speed. The path is a cycle.
double GreatestJump(const Path& path) {
  const auto norm = [](const Shape& x) { return x.norm() / std::sqrt(x.cols()); };
  double way = 0, greatest = 0;
  for (int k = 1; k < path.NumShapes(); ++k) way += norm(path.Placed(k) - path.Placed(k - 1));
  for (size_t i = 0; i + 1 < path.poses.size(); ++i) {
    const int after = path.poses[i], before = i == 0 ? path.NumShapes() - 1 : after;
    greatest = std::max(greatest, norm(internal::OneSidedVelocity(path, after, 1) -
                                       internal::OneSidedVelocity(path, before, -1)));
  }
  return greatest / way;
}

TEST(Standing, ASmoothCycleStaysSmooth) {
  const Bridge& bridge = TheBridge();
  double before = 0;
  for (const int shapes : {7, 15, 31}) {
    Path path = bridge.Motion(true, shapes);
    // The right foot is at rest when the cycle begins, because it stood until its end.
    const std::vector<StandingPart> parts = {{"left", bridge.left, {{0, 4}}},
                                             {"right", {bridge.right[0]}, {{3, 4}}}};
    HoldStandingParts(path, parts, StandingDefaults(), &path);
    const double jump = GreatestJump(path);
    if (before > 0) {
      EXPECT_NEAR(before / jump, 4, 0.8) << shapes;
    } else {
      EXPECT_LT(jump, 0.2);
    }
    before = jump;
  }
}

// A sheet far away that belongs to the same mesh and has no part.
TEST(Standing, ComponentsWithoutAPartMoveAsOnThePath) {
  const Bridge& bridge = TheBridge();
  const int count = bridge.sheet.connectivity->NumVertices();
  const ShapeFamily other = MakeSheet(1, 1, 3, 3);
  const Eigen::Matrix3Xi &first = bridge.sheet.connectivity->Triangles(),
                         &second = other.connectivity->Triangles();
  Eigen::Matrix3Xi triangles(3, first.cols() + second.cols());
  triangles << first, (second.array() + count).matrix();
  const int all = count + other.connectivity->NumVertices();
  const auto both = Connectivity::FromTriangles(all, triangles);
  std::vector<Shape> poses;
  for (const Shape& pose : bridge.poses) {
    Shape joined(3, all);
    joined << pose,
        other.pose(10. * static_cast<double>(poses.size())).colwise() + Eigen::Vector3d(10, 0, 0);
    poses.push_back(joined);
  }
  SplineOptions options;
  options.geodesic.shapes = 3;
  const Path before = Spline(both, poses, options).path;
  Path path = before;
  const StandingSummary summary =
      HoldStandingParts(before, bridge.Parts(3), StandingDefaults(), &path);
  EXPECT_TRUE(summary.Converged());
  EXPECT_GT(summary.slide_before, 1e-3);
  EXPECT_LT(summary.slide, 1e-12);
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_NE(summary.warnings[0].find(std::to_string(count + 1)), std::string::npos);
  double moved = 0;
  for (int k = 0; k < path.NumShapes(); ++k) {
    EXPECT_LT(
        Distance(path.Placed(k).rightCols(all - count), before.Placed(k).rightCols(all - count)),
        1e-12)
        << k;
    moved = std::max(moved, Distance(path.Placed(k), before.Placed(k)));
  }
  EXPECT_GT(moved, 1e-3);
}

TEST(Standing, IntervalsWithoutAStandingPartAreAsTheyWere) {
  const Bridge& bridge = TheBridge();
  const Path before = bridge.Motion(false, 3);
  Path path = before;
  const StandingSummary summary =
      HoldStandingParts(before, {{"", bridge.right, {{0, 1}}}}, StandingDefaults(), &path);
  EXPECT_EQ(summary.shapes, 3);
  for (int k = path.poses[1]; k < path.NumShapes(); ++k) {
    EXPECT_EQ(path.Placed(k), before.Placed(k)) << k;
  }
}

TEST(Standing, APartThatIsElsewhereInTheNextPoseGoesThereAndIsToldOf) {
  const Bridge& bridge = TheBridge();
  Path path = bridge.Motion(true, 7);
  const Shape first = PartOf(bridge.poses[1], bridge.right);
  const Shape last = PartOf(bridge.poses[2], bridge.right);
  const StandingSummary summary =
      HoldStandingParts(path, {{"", bridge.right, {{1, 2}}}}, StandingDefaults(), &path);
  EXPECT_NEAR(summary.drift, Distance(first, last) / Diameter(bridge.poses[0]), 1e-9);
  const Shape half = PartOf(path.Placed((path.poses[1] + path.poses[2]) / 2), bridge.right);
  EXPECT_LT(Distance(half, (first + last) / 2), 1e-9);
}

TEST(Standing, HoldsAtOtherTimes) {
  const Bridge& bridge = TheBridge();
  const Path whole = bridge.Motion(true, 7);
  Path shown = Resample(whole, {0.03, 0.1, 0.9});
  HoldStandingParts(whole, bridge.Parts(4), StandingDefaults(), &shown);
  for (int k = 0; k < 3; ++k) {
    for (const auto& part : {bridge.left, bridge.right}) {
      EXPECT_LT(Distance(PartOf(shown.Placed(k), part), PartOf(bridge.poses[0], part)), 1e-12) << k;
    }
  }
}

// A path that was resampled may have nothing but poses.
TEST(Standing, TakesAPathOfPosesAlone) {
  const Bridge& bridge = TheBridge();
  const Path path = bridge.Motion(true, 7);
  Path whole = Resample(path, {0, 1});
  ASSERT_TRUE(whole.smooth);
  Path shown = Resample(whole, {0.25, 0.5});
  const std::vector<StandingPart> parts = {{"", bridge.left, {{0, 1}}}};
  EXPECT_EQ(HoldStandingParts(whole, parts, StandingDefaults(), &shown).shapes, 2);
}

TEST(Standing, CommutesWithScaleAndPlace) {
  const Bridge& bridge = TheBridge();
  const Path path = bridge.Motion(true, 3);
  Path held = path, moved = path;
  const Eigen::Vector3d way(1e6, -2e6, 3e6);
  auto metric = std::make_shared<Metric>(*path.metric);
  metric->unit *= 1000;
  moved.metric = metric;
  for (RigidMotion& motion : moved.motions) motion.translation = 1000 * motion.translation + way;
  HoldStandingParts(path, bridge.Parts(4), StandingDefaults(), &held);
  HoldStandingParts(moved, bridge.Parts(4), StandingDefaults(), &moved);
  for (int k = 0; k < path.NumShapes(); ++k) {
    const Shape expected = (1000 * held.Placed(k)).colwise() + way;
    EXPECT_LT(Distance(moved.Placed(k), expected), 1e-4 * 1000) << k;
  }
}

// The shapes of the last interval are as they are to be and converge, those before do not.
TEST(Standing, AShapeThatDoesNotConvergeIsToldOfWhateverFollows) {
  const Bridge& bridge = TheBridge();
  GeodesicOptions motion;
  motion.shapes = 3;
  const Path before = Interpolate(bridge.sheet.connectivity,
                                  {bridge.poses[0], bridge.poses[1], bridge.poses[1]}, motion)
                          .path;
  DeformationOptions options = StandingDefaults();
  Path path = before;
  const std::vector<StandingPart> parts = {{"left", bridge.left, {{0, 2}}}};
  EXPECT_TRUE(HoldStandingParts(before, parts, options, &path).Converged());
  options.max_iterations = 5;
  path = before;
  EXPECT_FALSE(HoldStandingParts(before, parts, options, &path).Converged());
}

TEST(Standing, WhenStoppedThePathIsAsItWas) {
  const Bridge& bridge = TheBridge();
  const Path before = bridge.Motion(true, 3);
  for (const int last : {1, 5}) {
    Path path = before;
    Listener progress(last);
    const StandingSummary summary =
        HoldStandingParts(before, bridge.Parts(4), StandingDefaults(), &path, &progress);
    EXPECT_EQ(summary.termination, Termination::kCancelled);
    EXPECT_FALSE(summary.Converged());
    EXPECT_EQ(path.shapes, before.shapes);
    EXPECT_NE(summary.warnings.back().find("stopped"), std::string::npos);
  }
}

TEST(Standing, RefusesPartsThatCannotStand) {
  const auto message = [](const std::vector<StandingPart>& parts) {
    return MessageOf<InvalidOptions>([&] { CheckStandingParts(parts, 10, 4); });
  };
  EXPECT_EQ(message({{"", {1, 2}, {{0, 1}, {2, 3}}}}), "nothing was thrown");
  EXPECT_TRUE(Names(message({}), {"parts:"}));
  EXPECT_TRUE(Names(message({{"foot", {}, {{0, 1}}}}), {"part 1"}));
  EXPECT_TRUE(Names(message({{"", {10}, {{0, 1}}}}), {"10", "0", "9"}));
  EXPECT_TRUE(Names(message({{"", {1}, {{0, 1}}}, {"", {2, 1}, {{0, 1}}}}),
                    {"part 2:", "vertex 2", "1", "part 1"}));
  EXPECT_NE(message({{"", {1, 1}, {{0, 1}}}}).find("already"), std::string::npos);
  EXPECT_TRUE(Names(message({{"", {1}, {}}}), {"part 1:"}));
  for (const std::vector<std::pair<int, int>>& poses : {std::vector<std::pair<int, int>>{{1, 1}},
                                                        {{2, 1}},
                                                        {{0, 4}},
                                                        {{-1, 2}},
                                                        {{0, 2}, {2, 3}}}) {
    EXPECT_TRUE(Names(message({{"", {1}, poses}}), {"4"}));
  }
}

TEST(Standing, PartsAreReadFromJson) {
  const Bridge& bridge = TheBridge();
  const auto read = [&](const std::string& text) {
    return ReadStandingParts(text, bridge.poses[0], *bridge.sheet.connectivity, {});
  };
  const std::vector<StandingPart> parts = read(
      R"([{"name": "left", "select": {"vertices": [1, [4, 5]]}, "poses": [2, 4]},
          {"select": {"vertices": [2]}, "poses": [[1, 2], [3, 4]]}])");
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "left");
  EXPECT_EQ(parts[0].vertices, (std::vector<int>{0, 3, 4}));
  EXPECT_EQ(parts[0].poses, (std::vector<std::pair<int, int>>{{1, 3}}));
  EXPECT_EQ(parts[1].poses, (std::vector<std::pair<int, int>>{{0, 1}, {2, 3}}));
  const auto message = [&](const std::string& text) {
    return MessageOf<InvalidOptions>([&] { read(text); });
  };
  EXPECT_TRUE(Names(message(R"([{"poses": [1, 2]}])"), {"part 1:"}));
  EXPECT_NE(message(R"([{"select": {"vertices": [1]}}])").find("poses"), std::string::npos);
  for (const char* poses :
       {"[1]", "[1, 2, 3]", "[0, 2]", "[1, 2.5]", "[]", "[[1, 2], 3]", "\"x\""}) {
    const std::string text =
        R"([{"select": {"vertices": [1]}, "poses": )" + std::string(poses) + "}]";
    EXPECT_TRUE(Names(message(text), {"part 1:"})) << poses;
  }
}

}  // namespace
}  // namespace shapespace
