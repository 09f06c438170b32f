#include <shapespace/bodies/tube.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/body.h>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

TEST(TubeTest, IsAClosedSphereOfAboutTheTrianglesAskedFor) {
  for (int triangles : {50, 200, 201, 500, 1000, 5000, 20000, 200000}) {
    const ShapeFamily tube = MakeTube(triangles);
    EXPECT_NEAR(tube.connectivity->NumTriangles(), triangles, std::max(5.0, 0.04 * triangles));
    EXPECT_EQ(UnmatchedSides(*tube.connectivity), 0);
    EXPECT_EQ(EulerCharacteristic(*tube.connectivity), 2);
    EXPECT_EQ(tube.connectivity->NumHinges(), tube.connectivity->NumEdges());
  }
}

TEST(TubeTest, HasRoundishTrianglesAtRest) {
  for (int triangles : {200, 1000, 5000, 20000, 200000}) {
    const ShapeFamily tube = MakeTube(triangles);
    EXPECT_GT(SmallestAngle(*tube.connectivity, tube.pose(0)), 38) << triangles;
  }
}

TEST(TubeTest, VolumeOfAPlainOneApproachesACapsules) {
  const TubeForm capsule = {3, 0.5, 0.5, 0};
  const double pi = 180 / kDegrees;
  const double exact = pi * 0.25 * 3 + 4.0 / 3 * pi * 0.125;
  double previous = 0;
  for (int triangles : {1000, 4000, 16000}) {
    const ShapeFamily tube = MakeTube(triangles, capsule);
    const double lost = exact - VolumeOf(*tube.connectivity, tube.pose(0));
    EXPECT_GT(lost, 0);
    if (previous > 0) {
      EXPECT_NEAR(previous / lost, 4, 0.5);
    }
    previous = lost;
  }
  EXPECT_LT(previous / exact, 2e-3);
}

TEST(TubeTest, KeepsItsVolumeToSecondOrder) {
  double previous = 0;
  for (int triangles : {1000, 4000, 16000}) {
    const ShapeFamily tube = MakeTube(triangles);
    const double rest = VolumeOf(*tube.connectivity, tube.pose(tube.begin));
    const double lost = 1 - VolumeOf(*tube.connectivity, tube.pose(tube.end)) / rest;
    if (previous > 0) {
      EXPECT_NEAR(previous / lost, 4, 0.8);
    }
    previous = lost;
  }
  EXPECT_LT(std::abs(previous), 5e-4);
}

TEST(TubeTest, BaseStaysAndTipTurnsByTheAngle) {
  const TubeForm form;
  const ShapeFamily tube = MakeTube(5000, form);
  const int last = tube.connectivity->NumVertices() - 1;
  for (double angle : {0.0, 1e-3, 60.0, 150.0}) {
    const Shape bent = tube.pose(angle);
    EXPECT_TRUE(bent.col(0).isApprox(Eigen::Vector3d(-form.base_radius, 0, 0)));
    // The ring of five next to each pole: its centre and the pole are on the axis of the cap.
    const Eigen::Vector3d axis = bent.col(last) - bent.block<3, 5>(0, last - 5).rowwise().mean();
    EXPECT_NEAR(std::atan2(axis.z(), axis.x()) * kDegrees, angle, 1e-9);
    EXPECT_LT(bent.row(1).sum(), 1e-9);
  }
}

TEST(TubeTest, CentreLineDoesNotDependOnResolution) {
  // The tip pole is a vertex of every mesh.
  const Shape coarse = MakeTube(200).pose(150), fine = MakeTube(100000).pose(150);
  EXPECT_LT((coarse.rightCols(1) - fine.rightCols(1)).norm(), 1e-9);
}

TEST(TubeTest, BentToTheEndHasNoFolds) {
  for (const TubeForm& form : {TubeForm(), TubeForm{2, 0.8, 0.8, 0.1}, TubeForm{3, 0.3, 0.9, 0}}) {
    const ShapeFamily tube = MakeTube(20000, form);
    const Eigen::ArrayXd angles = HingeAngles(*tube.connectivity, tube.pose(tube.end));
    EXPECT_LT(angles.abs().maxCoeff(), 60) << "a fold has nearly 180";
  }
  EXPECT_EQ(MakeTube(5000).end, 150);
}

struct RingOfVertices {
  double x, radius;
  int count;
};

// The rings of a straight tube, from the base to the tip; the poles have one vertex each.
std::vector<RingOfVertices> RingsOf(const Shape& straight) {
  std::vector<RingOfVertices> rings;
  for (const Eigen::Vector3d p : straight.colwise()) {
    if (rings.empty() || std::abs(p.x() - rings.back().x) > 1e-9) rings.push_back({p.x(), 0, 0});
    rings.back().radius = std::hypot(p.y(), p.z());
    ++rings.back().count;
  }
  return rings;
}

// Along the surface, also where that is steep.
TEST(TubeTest, RingsAreAtDistancesInProportionToTheirRadii) {
  const TubeForm cone = {2, 0.2, 1, 0};
  const ShapeFamily tube = MakeTube(6000, cone);
  double least = 1e9, greatest = 0;
  const std::vector<RingOfVertices> rings = RingsOf(tube.pose(0));
  int tested = 0;
  for (size_t i = 0; i + 1 < rings.size(); ++i) {
    const RingOfVertices &a = rings[i], &b = rings[i + 1];
    if (a.x < -1e-9 || b.x > cone.length + 1e-9) continue;
    ++tested;
    const double ratio = std::hypot(b.x - a.x, b.radius - a.radius) / (a.radius + b.radius);
    least = std::min(least, ratio);
    greatest = std::max(greatest, ratio);
  }
  EXPECT_GT(tested, 20);
  EXPECT_LT(greatest / least, 1.02);
}

TEST(TubeTest, LatitudesOfCapsAreMeansOfEqualStepsAndAStereographicProjection) {
  const TubeForm form = {3, 0.5, 0.8, 0};
  const ShapeFamily tube = MakeTube(3000, form);
  std::vector<RingOfVertices> rings = RingsOf(tube.pose(0));
  for (const bool at_tip : {false, true}) {
    const double radius = at_tip ? form.tip_radius : form.base_radius;
    int m = 0;  // latitudes from the pole to the equator
    while (std::abs(rings[m].radius - radius) > 1e-9) ++m;
    ASSERT_GT(m, 3);
    for (int j = 1; j <= m; ++j) {
      const double equal = M_PI / 2 * j / m, stereographic = 2 * std::atan(1.0 * j / m);
      EXPECT_NEAR(rings[j].radius, radius * std::sin((equal + stereographic) / 2), 1e-9) << j;
      EXPECT_EQ(rings[j].count, 5 * j);
    }
    EXPECT_EQ(rings[0].count, 1);
    std::reverse(rings.begin(), rings.end());
  }
}

TEST(TubeTest, RefusesBadArguments) {
  EXPECT_TRUE(testing::Names(Refusal([] { MakeTube(-1); }), {"triangles:", "-1", "0", "20000000"}));
  EXPECT_TRUE(testing::Names(Refusal([] {
                               MakeTube(1000, {6, 0.5, 0, 0});
                             }),
                             {"tip_radius:", "0"}));
  EXPECT_TRUE(testing::Names(Refusal([] {
                               MakeTube(1000, {6, 0.5, 0.5, -0.1});
                             }),
                             {"knuckle:", "0"}));
  EXPECT_TRUE(testing::Names(Refusal([] {
                               MakeTube(1000, {1, 1e-3, 100, 0});
                             }),
                             {"length:", "10000"}));
}

TEST(TubeTest, ExtremeFormsGiveFiniteShapes) {
  for (const TubeForm& form : {TubeForm{1e84, 1e80, 1e80, 0}, TubeForm{1e-80, 1e-76, 1e-76, 1e-80},
                               TubeForm{1, 1e-2, 1e2, 1}, TubeForm{100, 0.01, 100, 0}}) {
    const ShapeFamily tube = MakeTube(1000, form);
    const Shape bent = tube.pose(tube.end);
    EXPECT_TRUE(bent.allFinite());
    EXPECT_GT(SmallestAngle(*tube.connectivity, bent), 0);
  }
}

}  // namespace
}  // namespace shapespace
