#include <shapespace/path/anchor.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/path/internal/velocity.h>

#include "mesh/bodies.h"
#include "support/motions.h"
#include "support/path_of.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::Connected;
using testing::Distance;
using testing::Grid;
using testing::Noise;
using testing::PathOf;
using testing::Rotation;
using Vertices = std::vector<int>;

const Vertices kPart = {0, 1, 2, 5, 6, 7, 12};

Shape PartOf(const Shape& shape, const Vertices& part) { return shape(Eigen::all, part); }

/// Applies a small rigid motion that differs for every number.
Shape Moved(const Shape& shape, int number) {
  return (Rotation(20.0 * number, {1, number + 1.0, -2}) * shape).colwise() +
         Eigen::Vector3d(number, -1, 0.5 * number);
}

/// A crumpled grid of 25 vertices in seven shapes. `part` is rigid; each shape that is not one of
/// `poses` is moved.
Path PathWithRigidPart(const Vertices& part, const std::vector<int>& poses) {
  const Soup grid = Grid(4, 4);
  const Shape rest = grid.vertices + Noise(25, 0.3, 99);
  std::vector<Shape> shapes;
  for (int i = 0; i < 7; ++i) {
    Shape shape = rest + Noise(25, 0.2, i);
    shape(Eigen::all, part) = PartOf(rest, part);
    const bool is_pose = std::find(poses.begin(), poses.end(), i) != poses.end();
    shapes.push_back(is_pose ? shape : Moved(shape, i + 1));
  }
  Path path = PathOf(Connected(grid), shapes);
  path.poses = poses;
  path.extrapolated = poses.empty() ? 0 : 6 - poses.back();
  return path;
}

/// Lengths of all edges, one after the other.
Eigen::VectorXd Lengths(const Path& path, int i) {
  const Shape shape = path.Placed(i);
  const Eigen::Matrix2Xi& edges = path.metric->connectivity->Edges();
  return (shape(Eigen::all, edges.row(0)) - shape(Eigen::all, edges.row(1))).colwise().norm();
}

void ExpectStill(const Path& path, const Vertices& part, const Shape& where) {
  for (int i = 0; i < path.NumShapes(); ++i) {
    EXPECT_LT(Distance(PartOf(path.Placed(i), part), where), 1e-12) << i;
  }
}

TEST(Anchor, WhatStandsStillInThePosesStandsStillInAllShapes) {
  for (const std::vector<int>& poses :
       {std::vector<int>{0, 6}, {0, 3, 6}, {0, 4}, {0}, {3}, {2, 4}, std::vector<int>{}}) {
    Path path = PathWithRigidPart(kPart, poses);
    const Path before = path;
    Anchor(&path, kPart);
    ExpectStill(path, kPart, PartOf(before.Placed(poses.empty() ? 0 : poses[0]), kPart));
    for (int i = 0; i < path.NumShapes(); ++i) {
      EXPECT_TRUE(path.shapes[i] == before.shapes[i]);
      EXPECT_LT((Lengths(path, i) - Lengths(before, i)).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_NEAR(path.motions[i].rotation.determinant(), 1, 1e-12);
    }
    for (const int i : poses) {
      EXPECT_TRUE(path.motions[i].rotation == before.motions[i].rotation);
      EXPECT_TRUE(path.motions[i].translation == before.motions[i].translation);
    }
    const Path once = path;
    Anchor(&path, kPart);
    for (int i = 0; i < path.NumShapes(); ++i) {
      EXPECT_LT(Distance(path.Placed(i), once.Placed(i)), 1e-12);
    }
  }
}

TEST(Anchor, APartThatIsElsewhereInTheNextPoseGoesThereRigidlyAndOnBeyondIt) {
  Path path = PathWithRigidPart(kPart, {0, 4});
  const Shape rest = PartOf(path.Placed(0), kPart);
  const Eigen::VectorXd weights = path.metric->vertex_area(kPart);
  const Eigen::Vector3d centre = Centroid(rest, weights), axis = {1, -2, 0.5}, way = {3, 1, -2};
  const RigidMotion move = {Rotation(100, axis), centre + way - Rotation(100, axis) * centre};
  path.motions[4].translation = move(path.motions[4].translation);
  path.motions[4].rotation = move.rotation * path.motions[4].rotation;
  Anchor(&path, kPart);
  for (int i = 0; i < 7; ++i) {
    const double t = i / 4.0;
    const Shape wanted =
        (Rotation(100 * t, axis) * (rest.colwise() - centre)).colwise() + (centre + t * way);
    EXPECT_LT(Distance(PartOf(path.Placed(i), kPart), wanted), 1e-12) << i;
  }
}

TEST(Anchor, APartThatDeformsIsMetAtThePoses) {
  // Two shapes, shortly after one pose and shortly before the other.
  const Soup grid = Grid(4, 4);
  const Shape first = grid.vertices + Noise(25, 0.2, 1), last = grid.vertices + Noise(25, 0.2, 2);
  Path path = PathOf(Connected(grid), {first, Moved(first, 1), Moved(last, 2), last});
  path.parameters = {0, 1e-9, 1 - 1e-9, 1};
  Anchor(&path, kPart);
  EXPECT_LT(Distance(path.Placed(1), first), 1e-8);
  EXPECT_LT(Distance(path.Placed(2), last), 1e-8);
}

// The rotation is unique for a part in a plane, and so is a reflection that fits as well.
TEST(Anchor, APartInAPlaneHoldsABodyWithoutMirroringIt) {
  const Soup grid = Grid(4, 4);
  for (int seed = 0; seed < 12; ++seed) {
    Shape rest = grid.vertices + Noise(25, 0.4, seed);
    for (const int v : kPart) rest(2, v) = 0;
    rest = Rotation(25 * seed, {1, 2, seed + 1.0}) * rest;
    Path path =
        PathOf(Connected(grid), {rest, Moved(rest, 1), Moved(rest, 2), Moved(rest, 3), rest});
    Anchor(&path, kPart);
    for (int i = 0; i < path.NumShapes(); ++i) {
      EXPECT_NEAR(path.motions[i].rotation.determinant(), 1, 1e-12) << seed << ", " << i;
      EXPECT_LT(Distance(path.Placed(i), rest), 1e-12) << seed << ", " << i;
    }
  }
}

// In the plane, the best rotation from a part onto one that is scaled and turned is that turn.
TEST(Anchor, BeyondThePosesAPartThatShrinksGoesOnAsInTheLastPose) {
  const Soup grid = Grid(4, 4);
  const Vertices part = {6, 7, 8, 11, 12, 13, 16, 17, 18};  // about the middle of the grid
  const Eigen::Vector3d middle(2, 2, 0), way(1, -3, 2);
  const auto at = [&](double t, double scale) -> Shape {
    return (scale * Rotation(40 * t, {0, 0, 1}) * (grid.vertices.colwise() - middle)).colwise() +
           (middle + t * way);
  };
  std::vector<Shape> shapes = {at(0, 1), Moved(at(0.5, 0.6), 1), at(1, 0.3)};
  for (const int i : {3, 4}) shapes.push_back(Moved(at(1, 0.3), i));
  Path path = PathOf(Connected(grid), shapes);
  path.poses = {0, 2};
  path.extrapolated = 2;
  Anchor(&path, part);
  for (const int i : {1, 2, 3, 4}) {
    EXPECT_LT(Distance(path.Placed(i), at(0.5 * i, i == 1 ? 0.6 : 0.3)), 1e-12) << i;
  }
}

TEST(Anchor, ASingleVertexIsHeldWithoutTurningAnything) {
  Path path = PathWithRigidPart({7}, {0, 6});
  const Path before = path;
  Anchor(&path, {7});
  ExpectStill(path, {7}, path.Placed(0).col(7));
  for (int i = 0; i < 7; ++i) {
    EXPECT_LT((path.motions[i].rotation - before.motions[i].rotation).norm(), 1e-14);
  }
}

TEST(Anchor, ALineIsHeldByTheLeastTurn) {
  const Vertices part = {7, 13};
  Path path = PathWithRigidPart(part, {0, 6});
  const Path before = path;
  Anchor(&path, part);
  const Shape line = PartOf(path.Placed(0), part);
  ExpectStill(path, part, line);
  for (int i = 1; i < 6; ++i) {
    const Shape other = PartOf(before.Placed(i), part);
    const Eigen::Vector3d a = (other.col(1) - other.col(0)).normalized();
    const Eigen::Vector3d b = (line.col(1) - line.col(0)).normalized();
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(path.motions[i].rotation * before.motions[i].rotation.transpose()));
    EXPECT_NEAR(turn.angle(), std::atan2(a.cross(b).norm(), a.dot(b)), 1e-9) << i;
  }
}

TEST(Anchor, ThreeVerticesInALineAreALineToo) {
  const Soup grid = Grid(4, 4);
  const Vertices part = {0, 1, 2};
  std::vector<Shape> shapes;
  for (int i = 0; i < 5; ++i) {
    Shape shape = grid.vertices + Noise(25, 0.2, i);
    shape(Eigen::all, part) << 0.1, 0.2, 0.4, 0.3, 0.6, 1.2, 0.7, 1.4, 2.8;
    shapes.push_back(i % 4 == 0 ? shape : Moved(shape, i));
  }
  Path path = PathOf(Connected(grid), shapes);
  const Path before = path;
  Anchor(&path, part);
  ExpectStill(path, part, PartOf(shapes[0], part));
  for (int i = 1; i < 4; ++i) {
    const Shape other = PartOf(before.Placed(i), part);
    const Eigen::Vector3d a = (other.col(2) - other.col(0)).normalized();
    const Eigen::Vector3d b = (shapes[0].col(2) - shapes[0].col(0)).normalized();
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(path.motions[i].rotation * before.motions[i].rotation.transpose()));
    EXPECT_NEAR(turn.angle(), std::atan2(a.cross(b).norm(), a.dot(b)), 1e-9) << i;
  }
}

// The greatest jump of the part's velocity at an inner pose, as a share of the mean speed.
double GreatestJump(const Path& path, const Vertices& part) {
  double way = 0, greatest = 0;
  for (int i = 1; i < path.NumShapes(); ++i) {
    way += (PartOf(path.Placed(i), part) - PartOf(path.Placed(i - 1), part)).norm();
  }
  for (size_t i = 1; i + 1 < path.poses.size(); ++i) {
    const Shape jump = internal::OneSidedVelocity(path, path.poses[i], 1) -
                       internal::OneSidedVelocity(path, path.poses[i], -1);
    greatest = std::max(greatest, PartOf(jump, part).norm());
  }
  return greatest / way;
}

TEST(Anchor, OnASmoothPathThePartMovesSmoothlyAndStillStands) {
  // The body turns and moves with a velocity that is zero at none of its poses; in the second and
  // the third pose it is at the same place.
  const Soup grid = Grid(4, 4);
  for (const int segments : {48, 96}) {
    std::vector<Shape> shapes;
    for (int i = 0; i <= segments; ++i) {
      const double t = static_cast<double>(i) / segments;
      const double at = 10 * t * (t - 1.0 / 3) * (t - 2.0 / 3);
      shapes.push_back((Rotation(40 * at, {1, 2, 3}) * grid.vertices).colwise() +
                       at * Eigen::Vector3d(1, -2, 1));
    }
    Path path = PathOf(Connected(grid), shapes);
    path.poses = {0, segments / 3, 2 * segments / 3, segments};
    Path corners = path;
    Anchor(&corners, kPart);
    EXPECT_GT(GreatestJump(corners, kPart), 0.5);
    path.smooth = true;
    Anchor(&path, kPart);
    EXPECT_LT(GreatestJump(path, kPart), segments == 48 ? 0.03 : 0.0075);
    for (int i = path.poses[1]; i <= path.poses[2]; ++i) {
      EXPECT_LT(Distance(PartOf(path.Placed(i), kPart), PartOf(shapes[path.poses[1]], kPart)), 1e-9)
          << i;
    }
  }
}

TEST(Anchor, OnASmoothCycleThePartMovesSmoothlyWhereTheCycleCloses) {
  const Soup grid = Grid(4, 4);
  const int segments = 96;
  std::vector<Shape> shapes;
  for (int i = 0; i <= segments; ++i) {
    const double t = 2 * M_PI * i / segments;
    shapes.push_back((Rotation(30 * std::sin(t + 1), {1, 2, 3}) * grid.vertices).colwise() +
                     Eigen::Vector3d(std::cos(t), std::sin(t), std::sin(2 * t)));
  }
  Path path = PathOf(Connected(grid), shapes);
  path.poses = {0, segments / 3, 2 * segments / 3, segments};
  path.smooth = true;
  Anchor(&path, kPart);
  const Shape jump =
      internal::OneSidedVelocity(path, 0, 1) - internal::OneSidedVelocity(path, segments, -1);
  const Shape before = internal::OneSidedVelocity(path, segments, -1);
  EXPECT_LT(PartOf(jump, kPart).norm(), 0.01 * PartOf(before, kPart).norm());
}

TEST(Anchor, DoesTheSameInAnyFrameAndUnit) {
  const Path path = PathWithRigidPart(kPart, {0, 4});
  Path anchored = path;
  Anchor(&anchored, kPart);
  for (const double distance : {1.0, 1e6}) {
    for (const double scale : {1e-3, 1.0, 1e4}) {
      const Eigen::Vector3d shift = distance * Eigen::Vector3d(1, -0.3, 0.7);
      const auto move = [&](const Shape& shape) -> Shape {
        return (scale * Rotation(77, {2, 1, 1}) * shape).colwise() + shift;
      };
      std::vector<Shape> shapes;
      for (int i = 0; i < 7; ++i) shapes.push_back(move(path.Placed(i)));
      Path other = PathOf(path.metric->connectivity, shapes);
      other.poses = path.poses;
      other.extrapolated = path.extrapolated;
      Anchor(&other, kPart);
      for (int i = 0; i < 7; ++i) {
        const double tolerance = 1e-12 * std::max(distance, scale);
        EXPECT_LT(Distance(other.Placed(i), move(anchored.Placed(i))), tolerance)
            << i << " at " << distance << " scaled by " << scale;
      }
    }
  }
}

TEST(Anchor, HoldsForAPathAtOtherTimesWithoutItsPoses) {
  const Path path = PathWithRigidPart(kPart, {0, 4});
  Path anchored = path;
  Anchor(&anchored, kPart);
  Path shown = Resample(path, {path.parameters[1], 0.4, path.parameters[3], path.parameters[5]});
  ASSERT_TRUE(shown.poses.empty());
  Anchor(path, kPart, &shown);
  EXPECT_LT(Distance(shown.Placed(0), anchored.Placed(1)), 1e-12);
  EXPECT_LT(Distance(shown.Placed(2), anchored.Placed(3)), 1e-12);
  EXPECT_LT(Distance(shown.Placed(3), anchored.Placed(5)), 1e-12);
}

TEST(Anchor, RefusesVerticesThatAreNotThere) {
  Path path = PathWithRigidPart(kPart, {0, 6});
  EXPECT_THROW(Anchor(&path, {}), InvalidOptions);
  EXPECT_THROW(Anchor(&path, {25}), InvalidOptions);
  EXPECT_THROW(Anchor(&path, {-1}), InvalidOptions);
}

TEST(Ground, PutsTheLowestVertexOnTheGround) {
  for (int axis = 0; axis < 3; ++axis) {
    Path path = PathWithRigidPart(kPart, {0, 6});
    const Path before = path;
    Ground(&path, axis, 2.5);
    for (int i = 0; i < 7; ++i) {
      EXPECT_NEAR(path.Placed(i).row(axis).minCoeff(), 2.5, 1e-12);
      Shape change = path.Placed(i) - before.Placed(i);
      EXPECT_NEAR(change.row(axis).maxCoeff(), change.row(axis).minCoeff(), 1e-12);
      change.row(axis).setZero();
      EXPECT_LT(change.norm(), 1e-12);
    }
  }
}

TEST(Ground, LooksAtVerticesOfTheBodyOnly) {
  Shape shape = Shape::Zero(3, 4);
  shape.rightCols(2) << 1, 0, 2, -9, 0, 0;
  // The last vertex, far below, belongs to no edge.
  const auto chain = Connectivity::Make(4, {0}, {}, {{0, 1}, {1, 2}});
  shape.col(1) = Eigen::Vector3d(1, 0, 0);
  Path path = PathOf(chain, {shape, shape});
  Ground(&path, 1, 1);
  EXPECT_NEAR(path.Placed(0)(1, 0), 1, 1e-12);
  EXPECT_NEAR(path.Placed(1)(1, 3), -8, 1e-12);
}

TEST(Ground, RefusesOtherAxesAndHeights) {
  Path path = PathWithRigidPart(kPart, {0, 6});
  EXPECT_THROW(Ground(&path, 3, 0), InvalidOptions);
  EXPECT_THROW(Ground(&path, -1, 0), InvalidOptions);
  EXPECT_THROW(Ground(&path, 1, std::nan("")), InvalidOptions);
  EXPECT_THROW(Ground(&path, 1, HUGE_VAL), InvalidOptions);
}

}  // namespace
}  // namespace shapespace
