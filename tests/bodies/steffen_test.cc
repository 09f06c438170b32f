#include <shapespace/bodies/steffen.h>

#include <gtest/gtest.h>

#include <shapespace/files/read.h>
#include <shapespace/mesh/topology.h>

#include "bodies/measure.h"

namespace shapespace {
namespace {

// Whether the segment from p to q crosses the inside of a triangle.
bool Crosses(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a,
             const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double from = normal.dot(p - a), to = normal.dot(q - a);
  if (from * to >= 0) return false;
  const Eigen::Vector3d at = p + from / (from - to) * (q - p);
  return normal.dot((b - a).cross(at - a)) > 0 && normal.dot((c - b).cross(at - b)) > 0 &&
         normal.dot((a - c).cross(at - c)) > 0;
}

// Pairs of an edge and a triangle that intersect. Two triangles intersect if and only if an edge of
// one, without a common corner with the other, intersects the other.
int Crossings(const Connectivity& connectivity, const Shape& shape) {
  int crossings = 0;
  for (const auto& t : connectivity.Triangles().colwise()) {
    for (const auto& e : connectivity.Edges().colwise()) {
      if ((t.array() == e(0)).any() || (t.array() == e(1)).any()) continue;
      crossings += Crosses(shape.col(e(0)), shape.col(e(1)), shape.col(t(0)), shape.col(t(1)),
                           shape.col(t(2)));
    }
  }
  return crossings;
}

TEST(SteffenTest, IsAClosedSurfaceOfFourteenTriangles) {
  const ShapeFamily body = MakeSteffen();
  EXPECT_EQ(body.connectivity->NumVertices(), 9);
  EXPECT_EQ(body.connectivity->NumEdges(), 21);
  EXPECT_EQ(body.connectivity->NumTriangles(), 14);
  EXPECT_EQ(UnmatchedSides(*body.connectivity), 0);
  EXPECT_EQ(EulerCharacteristic(*body.connectivity), 2);
}

TEST(SteffenTest, KeepsEdgesAndVolumeWhileItMoves) {
  const ShapeFamily body = MakeSteffen();
  const Shape rest = body.pose(0);
  const double volume = VolumeOf(*body.connectivity, rest);
  EXPECT_GT(volume, 100);
  const Eigen::VectorXd rest_angles = HingeAngles(*body.connectivity, rest);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(rest_angles.size());
  for (int i = 0; i <= 100; ++i) {
    const Shape shape = body.pose(body.begin + (body.end - body.begin) * i / 100);
    const Eigen::VectorXd lengths = EdgeLengths(*body.connectivity, shape);
    for (double length : lengths) {
      EXPECT_NEAR(length, std::round(length), 1e-13 * length);  // all are whole numbers
    }
    EXPECT_NEAR(VolumeOf(*body.connectivity, shape), volume, 1e-12 * volume);
    const Eigen::VectorXd angles = HingeAngles(*body.connectivity, shape);
    for (int h = 0; h < moved.size(); ++h) {
      moved(h) = std::max(moved(h), std::abs(std::remainder(angles(h) - rest_angles(h), 360)));
    }
  }
  // The edge from 0 to 1 belongs to the rigid tetrahedron; all others fold.
  EXPECT_EQ((moved.array() > 2).count(), 20);
  EXPECT_GT(moved.maxCoeff(), 12);
}

TEST(SteffenTest, DoesNotCrossItselfWithinItsRange) {
  const ShapeFamily body = MakeSteffen();
  for (int i = 0; i <= 200; ++i) {
    const double angle = body.begin + (body.end - body.begin) * i / 200;
    EXPECT_EQ(Crossings(*body.connectivity, body.pose(angle)), 0) << angle;
  }
}

TEST(SteffenTest, HasAHalfTurnThatReversesTheFlex) {
  const ShapeFamily body = MakeSteffen();
  const int image[] = {1, 0, 3, 2, 5, 4, 7, 6, 8};
  for (double angle : {0.0, 3.0, 12.5}) {
    const Shape shape = body.pose(angle), other = body.pose(-angle);
    for (int v = 0; v < 9; ++v) {
      const Eigen::Vector3d turned(-shape(0, v), -shape(1, v), shape(2, v));
      EXPECT_LT((turned - other.col(image[v])).norm(), 1e-12);
    }
  }
}

TEST(SteffenTest, HasTheEdgesOfTheMeshInCirculation) {
  const std::string folder = SHAPESPACE_DATA_DIR;
  if (folder.empty()) GTEST_SKIP() << "no real meshes";
  const Soup soup = ReadSoup(folder + "/steffen/steffen_polyhedron.obj");
  const ShapeFamily body = MakeSteffen();
  ASSERT_EQ(soup.NumVertices(), 9);
  const auto other = Connectivity::Make(9, soup.polygon_begin, soup.corners);
  ASSERT_EQ(other->Edges(), body.connectivity->Edges());
  const Eigen::VectorXd lengths = EdgeLengths(*body.connectivity, body.pose(0));
  const Eigen::VectorXd theirs = EdgeLengths(*other, soup.vertices);
  EXPECT_LT((lengths - theirs).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace shapespace
