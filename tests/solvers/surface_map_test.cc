#include <shapespace/correspondence/surface_map.h>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/correspondence/marker_file.h>

#include "mesh/files.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::Content;

// Two triangles of a square, seen from three vertices.
class SurfaceMapTest : public testing::FilesTest {
 protected:
  SurfaceMapTest() {
    triangles_.resize(3, 2);
    triangles_ << 0, 0, 1, 2, 2, 3;
    square_.resize(3, 4);
    square_ << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
    connectivity_ = Connectivity::FromTriangles(4, triangles_);
    points_.triangle.resize(3);
    points_.triangle << 0, 1, 1;
    points_.barycentric.resize(3, 3);
    points_.barycentric << 1, 0.25, 0, 0, 0.25, 0.5, 0, 0.5, 0.5;
  }

  void ExpectRefused(const std::string& text, const std::string& part) const {
    testing::ExpectError<FileError>([&] { ReadSurfaceMap(File("m.txt", text), 2, 2); },
                                    {Path("m.txt"), part});
  }

  Eigen::Matrix3Xi triangles_;
  Shape square_;
  std::shared_ptr<const Connectivity> connectivity_;
  SurfacePoints points_;
};

TEST_F(SurfaceMapTest, PullsLinearFunctionsExactly) {
  const Eigen::MatrixXd pulled = PullBack(points_, triangles_, square_);
  Eigen::MatrixXd wanted(3, 3);
  wanted << 0, 0.25, 0.5, 0, 0.75, 1, 0, 0, 0;
  EXPECT_TRUE(pulled.isApprox(wanted, 1e-15)) << pulled;
  EXPECT_THROW(PullBack(points_, triangles_, square_.leftCols(3)), MeshError);
  EXPECT_THROW(PullBack(points_, triangles_.leftCols(1), square_), MeshError);
}

TEST_F(SurfaceMapTest, CarriesOffsetsAlongRigidly) {
  Shape own = PullBack(points_, triangles_, square_);
  own.row(2).setConstant(0.3);  // above the square
  const Eigen::Matrix3d rotation = testing::Rotation(70, Eigen::Vector3d(1, 2, 3).normalized());
  const auto move = [&](const Shape& shape) -> Shape {
    return (rotation * shape).colwise() + Eigen::Vector3d(5, -1, 2);
  };
  EXPECT_TRUE(
      CarryAlong(points_, *connectivity_, square_, move(square_), own).isApprox(move(own), 1e-12));
  EXPECT_TRUE(CarryAlong(points_, *connectivity_, square_, square_, own).isApprox(own, 1e-14));
  EXPECT_THROW(CarryAlong(points_, *connectivity_, square_, square_, square_), MeshError);
}

TEST_F(SurfaceMapTest, AtACornerOnlyTheTrianglesThereTurnTheOffset) {
  Shape folded = square_;  // the second triangle stands upright on the diagonal
  folded.col(3) << 0.5, 0.5, std::sqrt(0.5);
  SurfacePoints corner;
  corner.triangle.setZero(1);
  corner.barycentric = Eigen::Vector3d::UnitY();
  const Shape above = Eigen::Vector3d(1, 0, 0.3);
  EXPECT_TRUE(CarryAlong(corner, *connectivity_, square_, folded, above).isApprox(above, 1e-12));
  // On the diagonal it leans over.
  corner.barycentric = Eigen::Vector3d::UnitZ();
  const Shape at_fold = Eigen::Vector3d(1, 1, 0.3);
  EXPECT_GT((CarryAlong(corner, *connectivity_, square_, folded, at_fold) - at_fold).norm(), 0.1);
}

TEST_F(SurfaceMapTest, FilesKeepEveryBit) {
  SurfaceMap map;
  map.to_target = map.to_template = points_;
  map.to_target.barycentric.col(1) << 1.0 / 3, 1.0 / 3, 1.0 / 3;
  map.round_trip = Eigen::Vector3d(0, 0.1, 1.0 / 7);
  map.gap = Eigen::Vector3d(1, 1.0 / 3, 0);
  WriteSurfaceMap(Path("map.txt"), map);
  const SurfaceMap read = ReadSurfaceMap(Path("map.txt"), 2, 2);
  EXPECT_EQ(read.to_target.triangle, map.to_target.triangle);
  EXPECT_EQ(read.to_target.barycentric, map.to_target.barycentric);
  EXPECT_EQ(read.to_template.barycentric, map.to_template.barycentric);
  EXPECT_EQ(read.round_trip, map.round_trip);
  EXPECT_EQ(read.gap, map.gap);
}

TEST_F(SurfaceMapTest, DamagedFilesAreRefusedByLine) {
  const std::string good = "to_target 1\n1 1 0 0 0.5\nto_template 1\n2 0 1 0 0.25\n";
  EXPECT_EQ(ReadSurfaceMap(File("good.txt", good), 2, 2).to_template.triangle(0), 1);
  ExpectRefused("to_template 1\n", "m.txt:1: expected 'to_target'");
  ExpectRefused("to_target 99999999999\n", "m.txt:1: 'to_target' ");
  ExpectRefused("to_target 1\n3 1 0 0 0.5\n", "m.txt:2: ");
  ExpectRefused("to_target 1\n1 1 0 x 0.5\n", "m.txt:2: 'x' ");
  ExpectRefused("to_target 1\n1 1 0 0 nan\n", "m.txt:2: 'nan' ");
  ExpectRefused("to_target 1\n1 1 0 0\n", "m.txt:2: ");
  ExpectRefused("to_target 1\n1 0,5 0,5 0 0\n", "comma");
  ExpectRefused("to_target 1\n0 1 0 0 0\n", "number 1");
  ExpectRefused("to_target 1\n1 1 1 0 0.5\n", "m.txt:2: the three barycentric");
  ExpectRefused("to_target 1\n1 1 0.0001 0 0.5\n", "m.txt:2: the three barycentric");
  ExpectRefused("to_target 1\n1 1.0001 -0.0001 0 0.5\n", "m.txt:2: the three barycentric");
  ExpectRefused("to_target 1\n1 1 0 0 0.5 7\n", "m.txt:2: ");
  ExpectRefused("to_target 1\n1 1 0 0 0.5\n", "'to_template'");
}

class MarkerFileTest : public testing::FilesTest {
 protected:
  MarkerFileTest() {
    File("square.obj",
         "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 3 3\nv 4 3 3\nv 3 4 3\n"
         "g sheet\nf 1 2 3\nf 1 3 4\ng nose\nf 5 6 7\n");
    mesh_ = ReadPoses({Path("square.obj")});
  }

  void ExpectRefused(const std::string& text, const std::string& part) const {
    testing::ExpectError<FileError>([&] { ReadMarkers(File("m.txt", text), mesh_, mesh_); },
                                    {Path("m.txt"), part});
  }

  Poses mesh_;
};

TEST_F(MarkerFileTest, AZeroTellsThatTheFileCountsFromZero) {
  for (const std::string text : {"0 0\n1 1\n", "1 1\n2 0\n", "nose 0\n"}) {
    ExpectRefused(text, "number 1");
  }
}

TEST_F(MarkerFileTest, ReadsNumbersAndNamesOfGroups) {
  const std::vector<CorrespondenceMarker> markers = ReadMarkers(
      File("m.txt", "# two columns\n1 2\n\n 3 4  # corners\nnose nose\n"), mesh_, mesh_);
  ASSERT_EQ(markers.size(), 3u);
  EXPECT_EQ(markers[0].template_vertex, 0);
  EXPECT_EQ(markers[0].target_vertex, 1);
  EXPECT_EQ(markers[1].target_vertex, 3);
  EXPECT_EQ(markers[2].template_vertex, 4);  // the right angle is nearest to the middle
  EXPECT_EQ(ReadMarkers(File("w.txt",
                             "\xEF\xBB\xBF"
                             "1 2\r\n3 4\r\n"),
                        mesh_, mesh_)
                .size(),
            2u);
}

TEST_F(MarkerFileTest, WrongLinesAreNamed) {
  ExpectRefused("1 2\n1\n", "m.txt:2: ");
  ExpectRefused("1 2 3\n", "m.txt:1: '3' ");
  ExpectRefused("0 2\n", "m.txt:1: '0' ");
  ExpectRefused("1 8\n", "m.txt:1: '8' ");
  ExpectRefused("1 tail\n", "m.txt:1: 'tail' ");
  ExpectRefused("1 2\n3 4\n5 2\n", "marker 1");
}

}  // namespace
}  // namespace shapespace
