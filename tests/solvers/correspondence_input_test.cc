// What is checked and measured before a correspondence is fitted.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/correspondence/detail/check_input.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/correspondence/detail/marker_distances.h>
#include <shapespace/correspondence/detail/similarity.h>
#include <shapespace/correspondence/landmark_file.h>
#include <shapespace/correspondence/marker_file.h>
#include <shapespace/correspondence/surface_map.h>
#include <shapespace/matching/internal/check_body.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Refuses;

// Two squares side by side, of two triangles each, and a vertex that no triangle uses.
std::shared_ptr<const Connectivity> TwoSquares() {
  Eigen::Matrix3Xi triangles(3, 4);
  triangles << 0, 0, 4, 4, 1, 2, 5, 6, 2, 3, 6, 7;
  return Connectivity::FromTriangles(9, triangles);
}

TEST(CheckMarkers, NamesTheMarkerTheVertexAndTheMesh) {
  const auto squares = TwoSquares();
  const auto message = [&](const std::vector<CorrespondenceMarker>& markers) {
    return MessageOf<MeshError>([&] { internal::CheckMarkers(markers, *squares, *squares); });
  };
  EXPECT_EQ(message({{0, 0}, {5, 1}, {2, 2}}), "nothing was thrown");
  EXPECT_TRUE(Names(message({{0, 0}}), {"1 marker"}));
  EXPECT_TRUE(Names(message({{0, 0}, {5, 1}}), {"2 markers"}));
  EXPECT_TRUE(
      Names(message({{0, 0}, {5, 1}, {9, 2}}), {"marker 3:", "template", "vertex 10", "9"}));
  EXPECT_TRUE(Names(message({{0, 0}, {5, 9}, {2, 2}}), {"marker 2:", "target", "vertex 10", "9"}));
  EXPECT_TRUE(Names(message({{0, 0}, {5, -1}, {2, 2}}), {"marker 2:", "target", "vertex 0", "9"}));
  EXPECT_TRUE(Names(message({{0, 0}, {8, 1}, {2, 2}}), {"marker 2:", "template", "vertex 9"}));
  EXPECT_TRUE(Names(message({{0, 8}, {5, 1}, {2, 2}}), {"marker 1:", "target", "vertex 9"}));
  EXPECT_TRUE(
      Names(message({{0, 0}, {5, 7}, {2, 7}}), {"marker 3", "marker 2", "vertex 8 of the target"}));
  EXPECT_TRUE(Names(message({{1, 0}, {5, 1}, {1, 2}}),
                    {"marker 3", "marker 1", "vertex 2 of the template"}));
}

TEST(CheckBody, NamesTheBodyAndItsNumbers) {
  const auto squares = TwoSquares();
  Shape shape = Shape::Random(3, 9);
  const auto message = [&](const Connectivity& connectivity, const Shape& of) {
    return MessageOf<MeshError>([&] { internal::CheckBody("target", connectivity, of); });
  };
  EXPECT_EQ(message(*squares, shape), "nothing was thrown");
  EXPECT_EQ(message(*squares, 1e-100 * shape), "nothing was thrown");
  EXPECT_TRUE(Names(message(*squares, shape.leftCols(8)), {"target", "9", "8"}));
  EXPECT_TRUE(Names(message(*Connectivity::FromTriangles(9, Eigen::Matrix3Xi(3, 0)), shape),
                    {"target", "triangles"}));
  Shape line = shape;
  line.bottomRows(2).setZero();
  EXPECT_TRUE(Names(message(*squares, line), {"target", "area"}));
  shape(1, 4) = -1e300;
  EXPECT_TRUE(Names(message(*squares, shape), {"target", "coordinate"}));
}

TEST(WarnOfTopology, CountsComponentsAndBorders) {
  const auto squares = TwoSquares();
  const auto one = Connectivity::FromTriangles(9, squares->Triangles().leftCols(2));
  const auto warnings = [](const Connectivity& first, const Connectivity& second,
                           const std::vector<CorrespondenceMarker>& markers) {
    std::vector<std::string> result;
    internal::WarnOfTopology(first, second, markers, &result);
    return result;
  };
  EXPECT_TRUE(warnings(*squares, *squares, {{0, 0}, {5, 5}}).empty());
  EXPECT_TRUE(testing::EachNames(
      warnings(*one, *squares, {{0, 6}}),
      {{"target", "2 components", "1 of them"}, {"template has 1", "target 2"}}));
  EXPECT_TRUE(testing::EachNames(warnings(*squares, *one, {{0, 0}, {5, 1}}),
                                 {{"template has 2", "target 1"}}));
}

TEST(Without, KeepsTheOthersInTheirOrder) {
  const std::vector<CorrespondenceMarker> kept =
      internal::Without({{5, 9}, {4, 8}, {3, 7}, {2, 6}}, {{2, 1, 0, -1}, {0, 1, 0, -1}});
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].template_vertex, 4);
  EXPECT_EQ(kept[0].target_vertex, 8);
  EXPECT_EQ(kept[1].template_vertex, 2);
}

TEST(CompareReflection, IsNoErrorForACopyOrAMirrorImage) {
  Shape points(3, 5);
  points << 0, 1, 3, -1, 2, 0, 2, 1, 5, -2, 1, 0, 4, 2, 3;
  const Shape moved =
      (2.5 * testing::Rotation(70, {1, 2, 3}) * points).colwise() + Eigen::Vector3d(10, -20, 5);
  const internal::SimilarityErrors copy = internal::CompareReflection(points, moved);
  EXPECT_LT(copy.proper, 1e-7);
  EXPECT_GT(copy.reflected, 0.1);
  const internal::SimilarityErrors image = internal::CompareReflection(points, -moved);
  EXPECT_LT(image.reflected, 1e-7);
  EXPECT_NEAR(image.proper, copy.reflected, 1e-12);
  EXPECT_LT(testing::Distance(internal::MovedOnto(points, moved / 2.5, points), moved / 2.5),
            1e-10);
  EXPECT_TRUE(
      Refuses<MeshError>([&] { internal::CheckPlacement(points, -moved); }, {"mirror image"}));
  Shape line = points;
  line.row(1) = 2 * line.row(0);
  line.row(2) = -line.row(0);
  const auto placement = [](const Shape& from, const Shape& to) {
    return MessageOf<MeshError>([&] { internal::CheckPlacement(from, to); });
  };
  EXPECT_EQ(placement(points, moved), "nothing was thrown");
  EXPECT_TRUE(Names(placement(line, moved), {"template"}));
  EXPECT_TRUE(Names(placement(points, line), {"target"}));
  // A hundredth of the length beside it is enough.
  line << -10, -5, 5, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0;
  line(1, 4) = 0.05;
  EXPECT_TRUE(internal::AreCollinear(line));
  line(1, 4) = 0.5;
  EXPECT_FALSE(internal::AreCollinear(line));
}

TEST(MarkerDistances, AreThoseAlongEdges) {
  const auto squares = TwoSquares();
  Shape shape(3, 9);
  shape << 0, 3, 3, 0, 10, 11, 11, 10, 50, 0, 0, 4, 4, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0;
  const Eigen::MatrixXf distances = internal::DistancesFrom(*squares, shape, {1, 3});
  const float infinity = std::numeric_limits<float>::infinity();
  Eigen::MatrixXf expected(9, 2);
  expected << 3, 4, 0, 7, 4, 3, 7, 0, infinity, infinity, infinity, infinity, infinity, infinity,
      infinity, infinity, infinity, infinity;
  EXPECT_EQ(distances, expected);
  EXPECT_EQ(internal::NearestOf(*squares, shape, {1, 3, 6}),
            (std::vector<int>{1, 1, 3, 3, 6, 6, 6, 6, -1}));
  const Eigen::VectorXd areas = internal::VertexAreas(*squares, shape);
  // Triangles of 6, 6, 0.5 and 0.5.
  Eigen::VectorXd of_vertices(9);
  of_vertices << 12, 6, 12, 6, 1, 0.5, 1, 0.5, 0;
  EXPECT_LT((areas - of_vertices / 39).cwiseAbs().maxCoeff(), 1e-15);
}

class CorrespondenceFileTest : public testing::FilesTest {};

TEST_F(CorrespondenceFileTest, MapsAreWrittenAsLinesOfVertices) {
  SurfaceMap map;
  map.to_target.triangle = Eigen::Vector2i(4, 0);
  map.to_target.barycentric.resize(3, 2);
  map.to_target.barycentric << 0.5, 0, 0.25, 1, 0.25, 0;
  map.round_trip = Eigen::Vector2d(0.125, 0);
  map.to_template.triangle.setConstant(1, 7);
  map.to_template.barycentric = Eigen::Vector3d(0.125, 0.125, 0.75);
  map.gap = Eigen::VectorXd::Constant(1, 0.375);
  const std::string file = Path("map.txt");
  WriteSurfaceMap(file, map);
  const std::string text = testing::Content(file);
  EXPECT_EQ(text.substr(text.find("to_target 2")),
            "to_target 2\n5 0.5 0.25 0.25 0.125\n1 0 1 0 0\nto_template 1\n8 0.125 0.125 0.75 "
            "0.375\n");
  EXPECT_EQ(text.rfind("# shapespace map. Each line is a vertex of this mesh", 0), 0u);
  // The numbers of triangles are those of the two meshes.
  const SurfaceMap read = ReadSurfaceMap(file, 8, 5);
  EXPECT_EQ(read.to_target.triangle, map.to_target.triangle);
  EXPECT_EQ(read.to_template.triangle, map.to_template.triangle);
  EXPECT_TRUE(Refuses<FileError>([&] { ReadSurfaceMap(file, 8, 4); }, {file + ":7:", "1", "4"}));
  EXPECT_TRUE(Refuses<FileError>([&] { ReadSurfaceMap(file, 7, 5); }, {file + ":10:", "1", "7"}));
  Eigen::Matrix3Xi triangles(3, 1);
  triangles << 0, 1, 2;
  EXPECT_TRUE(
      Refuses<MeshError>([&] { PullBack(map.to_target, triangles, Eigen::MatrixXd::Zero(1, 3)); },
                         {"triangle 5", "1"}));
  EXPECT_TRUE(Refuses<MeshError>(
      [&] { PullBack(map.to_target, triangles, Eigen::MatrixXd::Zero(1, 2)); }, {"2"}));
}

TEST_F(CorrespondenceFileTest, LinesOfMarkersAreCountedWithCommentsAndEmptyOnes) {
  File("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  File("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\nf 1 3 4\nf 4 3 5\n");
  const Poses first = ReadPoses({Path("a.obj")}), second = ReadPoses({Path("b.obj")});
  const auto message = [&](const std::string& text) {
    File("m.txt", text);
    return MessageOf<FileError>([&] { ReadMarkers(Path("m.txt"), first, second); });
  };
  const std::string file = Path("m.txt");
  EXPECT_EQ(message("4 5\n"), "nothing was thrown");
  EXPECT_TRUE(Names(message("# two\n\n5 4\n"), {file + ":3:", "'5'", "1", "4", first.names[0]}));
  EXPECT_TRUE(
      Names(message("1 2\n# two\n4 6\n"), {file + ":3:", "'6'", "1", "5", second.names[0]}));
  EXPECT_TRUE(Names(message("1 1\n2 2\n\n3 2\n"), {file + ":4:", "marker 2"}));
  EXPECT_TRUE(Names(message("1 1\n2 2\n2 3\n"), {file + ":3:", "marker 2"}));
  EXPECT_TRUE(Names(message("\n1 # 2\n"), {file + ":2:"}));
  EXPECT_TRUE(Names(message("1 2 x\n"), {file + ":1:", "'x'"}));
  const auto markers = ReadMarkers(File("m.txt", "4 5\n1 3\n"), first, second);
  ASSERT_EQ(markers.size(), 2u);
  EXPECT_EQ(markers[0].template_vertex, 3);
  EXPECT_EQ(markers[0].target_vertex, 4);
  EXPECT_TRUE(
      Refuses<FileError>([&] { ReadMarkers("a.mrk.json", first, second); }, {"a.mrk.json:"}));
}

TEST_F(CorrespondenceFileTest, LandmarksComeFromTheirColumnsAndInTheirSystem) {
  const std::string columns = "# columns = label,z,id,y,x\n";
  const auto lps = ReadLandmarks(File(
      "a.fcsv", "# CoordinateSystem = 1\n# remark\n" + columns + "nose,3,7,2,1\n\n,6,7,5,4\n"));
  ASSERT_EQ(lps.size(), 2u);
  EXPECT_EQ(lps[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(lps[0].label, "nose");
  EXPECT_EQ(lps[1].position, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(lps[1].label, "");
  const auto ras = ReadLandmarks(File("b.fcsv",
                                      "# CoordinateSystem = RAS\n9,1,2,3,0,0,0,1,1,1,0,ear\n"
                                      "9,4,5,6\n"));
  EXPECT_EQ(ras[0].position, Eigen::Vector3d(-1, -2, 3));
  EXPECT_EQ(ras[0].label, "ear");
  EXPECT_EQ(ras[1].position, Eigen::Vector3d(-4, -5, 6));
  EXPECT_EQ(ras[1].label, "");
  const auto message = [&](const std::string& name, const std::string& text) {
    File(name, text);
    const std::string whole = MessageOf<FileError>([&] { ReadLandmarks(Path(name)); });
    const std::string begin = Path(name);
    EXPECT_EQ(whole.rfind(begin, 0), 0u) << whole;
    return whole.substr(std::min(whole.size(), begin.size()));
  };
  EXPECT_TRUE(Names(message("c.fcsv", "# CoordinateSystem = LPS\n# columns = x,y,z\n1,2,3\n"),
                    {":2:", "column label"}));
  EXPECT_TRUE(Names(message("c.fcsv", "# CoordinateSystem = LPS\n# columns = x,z,label\n1,2,3\n"),
                    {":2:", "column y"}));
  EXPECT_TRUE(
      Names(message("c.fcsv", "# v\n\n1,2,3,4\n"), {":3:", "'# CoordinateSystem = LPS'", "RAS"}));
  EXPECT_TRUE(Names(message("c.txt", "# x y z\n1 2 3\n\n4 5 6 7\n"), {":4:", "landmark 2", "'7'"}));
  EXPECT_TRUE(Names(message("c.txt", "# x y z\n"), {"landmark"}));
  const std::string head = R"({"markups": [{"coordinateSystem": "LPS", "controlPoints": [)";
  EXPECT_TRUE(Names(message("c.json", head + R"({"positionStatus": "undefined"}, 5]}]})"),
                    {"markups.controlPoints", "point 2"}));
  EXPECT_TRUE(
      Names(message("c.json", R"({"markups": [{"coordinateSystem": "0", "controlPoints": 1}]})"),
            {"markups.controlPoints"}));
  EXPECT_TRUE(Names(message("c.json", R"({"markups": [7]})"), {"markups"}));
  EXPECT_TRUE(Names(message("c.json", R"({"markups": [1, 2, 3]})"), {"markups", "3"}));
}

}  // namespace
}  // namespace shapespace
