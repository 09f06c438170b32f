#include <shapespace/mesh/arrays.h>

#include <array>
#include <cstdint>
#include <limits>

#include <shapespace/files/read.h>

#include "mesh/bodies.h"
#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::Cube;
using testing::ExpectError;

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXi CornersOf(const Soup& cube) {
  return Eigen::Map<const Eigen::MatrixXi>(cube.corners.data(), 4, cube.NumPolygons());
}

TEST(ArraysTest, EveryOrderInMemoryAndBothLayoutsMakeTheSameMesh) {
  const Soup cube = Cube();
  const Eigen::MatrixXi corners = CornersOf(cube);
  const Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> long_rows =
      corners.transpose().cast<std::int64_t>();
  const RowMatrix rows = cube.vertices.transpose();
  const Eigen::MatrixXd columns = rows;
  const Eigen::MatrixXf floats = columns.cast<float>();
  const Eigen::Ref<const Eigen::MatrixXd> reference = columns;
  for (const Soup& soup : {MakeSoup(cube.vertices, corners, Layout::kColumns),
                           MakeSoup(rows, long_rows, Layout::kRows),
                           MakeSoup(columns, corners.transpose(), Layout::kRows),
                           MakeSoup(floats, long_rows, Layout::kRows),
                           MakeSoup(reference, corners.transpose(), Layout::kRows)}) {
    EXPECT_EQ(soup.vertices, cube.vertices);
    EXPECT_EQ(soup.corners, cube.corners);
    EXPECT_EQ(soup.polygon_begin, cube.polygon_begin);
  }
}

TEST(ArraysTest, AnArrayInMemoryIsReadInPlaceOrder) {
  const std::array<double, 9> points = {1, 2, 3, 4, 5, 6, 7, 8, 10};  // numpy: three rows
  const std::array<std::uint32_t, 3> triangle = {2, 0, 1};
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> vertices(
      points.data(), 3, 3);
  const Eigen::Map<const Eigen::Matrix<std::uint32_t, Eigen::Dynamic, 3, Eigen::RowMajor>> faces(
      triangle.data(), 1, 3);
  const Soup soup = MakeSoup(vertices, faces, Layout::kRows);
  EXPECT_EQ(soup.vertices.col(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(soup.corners, (std::vector<int>{2, 0, 1}));
  // The same square matrices are another mesh in the other layout.
  EXPECT_EQ(MakeSoup(vertices, faces.transpose(), Layout::kColumns).vertices.col(1),
            Eigen::Vector3d(2, 5, 8));
}

TEST(ArraysTest, PosesOfArraysPassTheChecksOfFiles) {
  const Soup cube = Cube();
  const Eigen::MatrixXi corners = CornersOf(cube);
  const Shape stretched = 2 * cube.vertices;
  const auto soup = [&](const Shape& shape, const Eigen::MatrixXi& faces, const char* name) {
    return MakeSoup(shape, faces, Layout::kColumns, name);
  };
  const Poses poses =
      MakePoses({soup(cube.vertices, corners, "rest"), soup(stretched, corners, "large")});
  EXPECT_EQ(poses.names, (std::vector<std::string>{"rest", "large"}));
  EXPECT_EQ(poses.shapes[1], stretched);
  EXPECT_EQ(poses.connectivity->Corners(), cube.corners);

  Eigen::MatrixXi outside = corners;
  outside(2, 4) = 8;
  ExpectError<MeshError>([&] { MakePoses({soup(stretched, outside, "rest")}); },
                         {"rest", "polygon 5"});
  Shape broken = stretched;
  broken(1, 3) = std::numeric_limits<double>::quiet_NaN();
  ExpectError<MeshError>(
      [&] {
        MakePoses({soup(stretched, corners, "rest"), soup(broken, corners, "broken")});
      },
      {"broken", "vertex 4"});
  ExpectError<MismatchError>(
      [&] {
        MakePoses(
            {soup(stretched, corners, "rest"), soup(stretched, corners.leftCols(5), "other")});
      },
      {"other"});
  ExpectError<MeshError>([] { MakePoses({}); }, {"no pose"});
}

TEST(ArraysTest, WhatIsNoMeshIsNamed) {
  const Soup cube = Cube();
  const Eigen::MatrixXi corners = CornersOf(cube);
  ExpectError<MeshError>([&] { MakeSoup(cube.vertices, corners, Layout::kRows, "cube"); },
                         {"cube", "3 x 8", "n x 3", "layout"});
  ExpectError<MeshError>(
      [&] { MakeSoup(cube.vertices, Eigen::MatrixXi::Zero(2, 5), Layout::kColumns, "cube"); },
      {"cube", "2 x 5", "three"});
  for (const std::int64_t index : {std::int64_t{-1}, std::int64_t{1} << 32}) {
    Eigen::Matrix<std::int64_t, 3, 1> face(0, 1, index);
    ExpectError<MeshError>([&] { MakeSoup(cube.vertices, face, Layout::kColumns, "cube"); },
                           {"cube", "polygon 1", std::to_string(index), "from 0 to 7"});
  }
}

}  // namespace
}  // namespace shapespace
