#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/mesh/surface.h>
#include <shapespace/mesh/volume.h>

#include "mesh/bodies.h"

namespace shapespace {
namespace {

using testing::Connected;
using testing::Cube;
using testing::Grid;
using testing::Torus;

TEST(VolumeTest, IsTheSameFarFromTheOrigin) {
  const Soup cube = Cube();
  const auto connectivity = Connected(cube);
  EXPECT_NEAR(EnclosedVolume(connectivity->Triangles(), cube.vertices), 1, 1e-14);
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()));
  const Shape far = (turn * cube.vertices).colwise() + Eigen::Vector3d(1e6, 2e6, -3e6);
  EXPECT_NEAR(EnclosedVolume(connectivity->Triangles(), far), 1, 1e-8);
}

TEST(VolumeTest, ClosedMeshesAreClosedInWhateverOrderTheirTrianglesStand) {
  // Two cubes with a common edge, which has four triangles, are closed.
  const Soup cube = Cube();
  std::vector<std::vector<int>> polygons;
  const auto add = [&](const std::vector<int>& to) {
    for (int p = 0; p < cube.NumPolygons(); ++p) {
      polygons.emplace_back();
      for (int k = 0; k < 4; ++k) polygons.back().push_back(to[cube.corners[4 * p + k]]);
    }
  };
  add({0, 1, 2, 3, 4, 5, 6, 7});
  add({3, 8, 9, 10, 7, 11, 12, 13});  // beyond the edge 3-7
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    std::shuffle(polygons.begin(), polygons.end(), random);
    EXPECT_TRUE(IsClosed(Connected(testing::MakeSoup(Shape::Zero(3, 14), polygons))->Triangles()))
        << trial;
  }
  polygons.pop_back();
  EXPECT_FALSE(IsClosed(Connected(testing::MakeSoup(Shape::Zero(3, 14), polygons))->Triangles()));
}

TEST(VolumeTest, OpenAndInconsistentlyWoundMeshesAndGraphsAreNotClosed) {
  EXPECT_FALSE(IsClosed(Connected(Grid(2, 2))->Triangles()));
  EXPECT_FALSE(IsClosed(Connectivity::Make(2, {0}, {}, {{0, 1}})->Triangles()));
  Soup cube = Cube();
  EXPECT_TRUE(IsClosed(Connected(cube)->Triangles()));
  std::reverse(cube.corners.begin(), cube.corners.begin() + 4);
  EXPECT_FALSE(IsClosed(Connected(cube)->Triangles()));
}

TEST(VolumeTest, ClosedBodiesThatAreInsideOutAreTold) {
  const Soup torus = Torus(12, 8), sheet = Grid(4, 4);
  const auto closed = Connected(torus);
  Shape flipped = torus.vertices;
  flipped.row(2) *= -1;
  EXPECT_TRUE(IsInsideOut(closed->Triangles(), torus.vertices, flipped));
  EXPECT_TRUE(IsInsideOut(closed->Triangles(), flipped, torus.vertices));
  EXPECT_FALSE(IsInsideOut(closed->Triangles(), flipped, flipped));  // inside out, but both alike
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(3, Eigen::Vector3d(1, 2, 3).normalized()));
  EXPECT_FALSE(IsInsideOut(closed->Triangles(), torus.vertices, 100 * (turn * torus.vertices)));
  // So flat that its sides can be exchanged.
  Shape leaf = torus.vertices, turned_leaf = leaf;
  leaf.row(2) *= 0.001;
  turned_leaf.row(2) *= -0.001;
  EXPECT_FALSE(IsInsideOut(closed->Triangles(), leaf, turned_leaf));
  Shape flipped_sheet = sheet.vertices;
  flipped_sheet.row(0) *= -1;
  EXPECT_FALSE(IsInsideOut(Connected(sheet)->Triangles(), sheet.vertices, flipped_sheet));
}

TEST(VolumeTest, OnlyClosedBodiesThatAreNotFlatEncloseAVolume) {
  Soup box = Cube();
  const Eigen::Matrix3Xi triangles = Connected(box)->Triangles();
  const auto sized = [&](double x, double y, double z) -> Shape {
    return Eigen::Vector3d(x, y, z).asDiagonal() * box.vertices;
  };
  EXPECT_NEAR(EnclosedVolume(triangles, sized(2, 3, 5)), 30, 1e-12);
  EXPECT_NEAR(EnclosedVolume(triangles, sized(2, -3, 5)), -30, 1e-12);
  EXPECT_TRUE(EnclosesVolume(triangles, sized(2, 3, 5)));
  EXPECT_TRUE(EnclosesVolume(triangles, sized(2, -3, 5)));
  EXPECT_TRUE(EnclosesVolume(triangles, sized(2, 3, 1e-4)));
  EXPECT_FALSE(EnclosesVolume(triangles, sized(2, 3, 1e-8)));
  EXPECT_FALSE(EnclosesVolume(triangles, sized(0, 0, 0)));
  EXPECT_FALSE(EnclosesVolume(triangles.leftCols(11), sized(2, 3, 5)));
}

TEST(VolumeTest, NormalsOfVerticesAreMeansByAreaAndZeroWhereNoTriangleIs) {
  Shape shape(3, 5);
  shape << 0, 2, 0, 0, 7, 0, 0, 1, 0, 8, 0, 0, 0, 3, 9;
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 0, 1, 2, 2, 3;
  const Shape normals = VertexNormals(*Connectivity::FromTriangles(5, triangles), shape);
  Shape expected(3, 5);
  expected << 3 / std::sqrt(13), 0, 3 / std::sqrt(13), 1, 0,  //
      0, 0, 0, 0, 0,                                          //
      2 / std::sqrt(13), 1, 2 / std::sqrt(13), 0, 0;
  EXPECT_LT((normals - expected).norm(), 1e-13);
}

}  // namespace
}  // namespace shapespace
