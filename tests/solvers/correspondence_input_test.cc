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

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::MessageOf;

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
  const std::string few =
      " too few: give at least three that do not lie on a line, better one at the end of every "
      "limb and a few on the trunk";
  EXPECT_EQ(message({{0, 0}, {5, 1}, {2, 2}}), "nothing was thrown");
  EXPECT_EQ(message({{0, 0}}), "1 marker is" + few);
  EXPECT_EQ(message({{0, 0}, {5, 1}}), "2 markers are" + few);
  EXPECT_EQ(message({{0, 0}, {5, 1}, {9, 2}}), "marker 3: the template has no vertex 10; it has 9");
  EXPECT_EQ(message({{0, 0}, {5, 9}, {2, 2}}), "marker 2: the target has no vertex 10; it has 9");
  EXPECT_EQ(message({{0, 0}, {5, -1}, {2, 2}}), "marker 2: the target has no vertex 0; it has 9");
  EXPECT_EQ(message({{0, 0}, {8, 1}, {2, 2}}),
            "marker 2: no triangle of the template uses vertex 9; name one on the surface");
  EXPECT_EQ(message({{0, 8}, {5, 1}, {2, 2}}),
            "marker 1: no triangle of the target uses vertex 9; name one on the surface");
  EXPECT_EQ(message({{0, 0}, {5, 7}, {2, 7}}),
            "marker 3 and marker 2 are on the same vertex 8 of the target; leave one of them out");
  EXPECT_EQ(message({{1, 0}, {5, 1}, {1, 2}}),
            "marker 3 and marker 1 are on the same vertex 2 of the template; leave one of them "
            "out");
  EXPECT_EQ(message({{0, 0}, {1, 1}, {2, 2}}),
            "the template has 2 components, and the one with vertex 5 has no marker, so its "
            "position is not determined; add one, or remove it from the mesh");
}

TEST(CheckBody, NamesTheBodyAndItsNumbers) {
  const auto squares = TwoSquares();
  Shape shape = Shape::Random(3, 9);
  const auto message = [&](const Connectivity& connectivity, const Shape& of) {
    return MessageOf<MeshError>([&] { internal::CheckBody("target", connectivity, of); });
  };
  EXPECT_EQ(message(*squares, shape), "nothing was thrown");
  EXPECT_EQ(message(*squares, 1e-100 * shape), "nothing was thrown");
  EXPECT_EQ(message(*squares, shape.leftCols(8)), "the target has 9 vertices, its shape 8");
  EXPECT_EQ(message(*Connectivity::FromTriangles(9, Eigen::Matrix3Xi(3, 0)), shape),
            "the target has no triangles; correspondence needs a surface");
  Shape line = shape;
  line.bottomRows(2).setZero();
  EXPECT_EQ(message(*squares, line), "the target has no area");
  shape(1, 4) = -1e300;
  EXPECT_EQ(message(*squares, shape), "the target has a coordinate that is enormous or not finite");
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
  EXPECT_EQ(warnings(*one, *squares, {{0, 6}}),
            (std::vector<std::string>{
                "the target has 2 components, 1 of them without a marker: nothing is mapped onto "
                "those",
                "the template has 1 border, the target 2: over a hole the template follows the "
                "surface around it"}));
  EXPECT_EQ(warnings(*squares, *one, {{0, 0}, {5, 1}}),
            std::vector<std::string>{"the template has 2 borders, the target 1: over a hole the "
                                     "template follows the surface around it"});
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
  EXPECT_NE(MessageOf<MeshError>([&] {
              internal::CheckPlacement(points, -moved);
            }).find("the markers fit a mirror image of the template"),
            std::string::npos);
  Shape line = points;
  line.row(1) = 2 * line.row(0);
  line.row(2) = -line.row(0);
  const auto placement = [](const Shape& from, const Shape& to) {
    return MessageOf<MeshError>([&] { internal::CheckPlacement(from, to); });
  };
  EXPECT_EQ(placement(points, moved), "nothing was thrown");
  const std::string rest = ", so its rotation is not determined; add one beside the line";
  EXPECT_EQ(placement(line, moved), "the markers lie on one line of the template" + rest);
  EXPECT_EQ(placement(points, line), "the markers lie on one line of the target" + rest);
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
  EXPECT_EQ(MessageOf<FileError>([&] { ReadSurfaceMap(file, 8, 4); }),
            file + ":7: a line begins with a triangle from 1 to 4");
  EXPECT_EQ(MessageOf<FileError>([&] { ReadSurfaceMap(file, 7, 5); }),
            file + ":10: a line begins with a triangle from 1 to 7");
  Eigen::Matrix3Xi triangles(3, 1);
  triangles << 0, 1, 2;
  EXPECT_EQ(MessageOf<MeshError>(
                [&] { PullBack(map.to_target, triangles, Eigen::MatrixXd::Zero(1, 3)); }),
            "the points lie on triangle 5 of a mesh that has 1; was it made for the other "
            "direction?");
  EXPECT_EQ(MessageOf<MeshError>(
                [&] { PullBack(map.to_target, triangles, Eigen::MatrixXd::Zero(1, 2)); }),
            "the function has 2 columns; it needs one for each vertex");
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
  const std::string holds = "; a line holds a vertex of the template and one of the target";
  EXPECT_EQ(message("4 5\n"), "nothing was thrown");
  EXPECT_EQ(message("# two\n\n5 4\n"), file +
                                           ":3: '5' is neither a vertex number from 1 to 4 nor a "
                                           "group of " +
                                           first.names[0] + holds);
  EXPECT_EQ(message("1 2\n# two\n4 6\n"), file +
                                              ":3: '6' is neither a vertex number from 1 to 5 "
                                              "nor a group of " +
                                              second.names[0] + holds);
  EXPECT_EQ(message("1 1\n2 2\n\n3 2\n"),
            file + ":4: shares a vertex with marker 2 of this file; leave one of them out");
  EXPECT_EQ(message("1 1\n2 2\n2 3\n"),
            file + ":3: shares a vertex with marker 2 of this file; leave one of them out");
  EXPECT_EQ(message("\n1 # 2\n"), file + ":2: there is one word only" + holds);
  EXPECT_EQ(message("1 2 x\n"), file + ":1: 'x' is too much" + holds);
  const auto markers = ReadMarkers(File("m.txt", "4 5\n1 3\n"), first, second);
  ASSERT_EQ(markers.size(), 2u);
  EXPECT_EQ(markers[0].template_vertex, 3);
  EXPECT_EQ(markers[0].target_vertex, 4);
  EXPECT_EQ(MessageOf<FileError>([&] { ReadMarkers("a.mrk.json", first, second); }),
            "a.mrk.json: has landmarks of one mesh; name such a file for each of the two");
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
  EXPECT_EQ(message("c.fcsv", "# CoordinateSystem = LPS\n# columns = x,y,z\n1,2,3\n"),
            ":2: there is no column label");
  EXPECT_EQ(message("c.fcsv", "# CoordinateSystem = LPS\n# columns = x,z,label\n1,2,3\n"),
            ":2: there is no column y");
  EXPECT_EQ(message("c.fcsv", "# v\n\n1,2,3,4\n"),
            ":3: no line '# CoordinateSystem = LPS', or RAS, is above the points; add the one in "
            "which they are");
  EXPECT_EQ(message("c.txt", "# x y z\n1 2 3\n\n4 5 6 7\n"),
            ":4: landmark 2: '7' is too much; a line holds x, y and z");
  EXPECT_EQ(message("c.txt", "# x y z\n"), ": there is no landmark in it");
  const std::string head = R"({"markups": [{"coordinateSystem": "LPS", "controlPoints": [)";
  EXPECT_EQ(message("c.json", head + R"({"positionStatus": "undefined"}, 5]}]})"),
            ": markups.controlPoints (point 2): must be an object, { }");
  EXPECT_EQ(message("c.json", R"({"markups": [{"coordinateSystem": "0", "controlPoints": 1}]})"),
            ": markups.controlPoints: must be a list, [ ]");
  EXPECT_EQ(message("c.json", R"({"markups": [7]})"),
            ": markups: its entry must be an object, { }");
  EXPECT_EQ(message("c.json", R"({"markups": [1, 2, 3]})"),
            ": markups: 3 lists of points are in the file; save one list in a file");
}

}  // namespace
}  // namespace shapespace
