#include <shapespace/output/page.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/analysis/vertex_energy.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/body.h>
#include <shapespace/path/energy.h>

#include "mesh/files.h"
#include "output/bodies.h"
#include "output/read_page.h"
#include "support/message_of.h"
#include "support/path_of.h"
#include "support/threads.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::OnThreads;
using testing::PathOf;

constexpr char kTemplate[] = "<body><!-- scenes --></body>";

// A tube that bends, in `count` shapes.
Path BendingTube(int triangles, int count) {
  const ShapeFamily tube = MakeBody("tube", triangles);
  std::vector<Shape> shapes;
  for (int i = 0; i < count; ++i) shapes.push_back(tube.pose(90.0 * i / (count - 1)));
  return PathOf(tube.connectivity, shapes);
}

// A large triangle, two small ones that pass through it or are above it, and one beside it.
Shape PiercedTriangle(bool by_first, bool by_second) {
  Shape shape(3, 12);
  shape.leftCols<3>() << 0, 8, 0, 0, 0, 8, 0, 0, 0;
  for (int k = 1; k < 4; ++k) {
    shape.middleCols<3>(3 * k) << 0, 0.5, 0, 0, 0, 0.5, -1, 1, 1;
  }
  shape.middleCols<3>(3).colwise() += Eigen::Vector3d(1, 1, by_first ? 0 : 2);
  shape.middleCols<3>(6).colwise() += Eigen::Vector3d(3, 2, by_second ? 0 : 2);
  shape.middleCols<3>(9).colwise() += Eigen::Vector3d(8, 8, 0);
  return shape;
}

// Three poses of a tube in the plane, with the midpoints of its sides. The shapes there are blends.
PageSpace TubeSpace(int triangles = 300) {
  const ShapeFamily tube = MakeBody("tube", triangles);
  PageSpace space;
  space.connectivity = tube.connectivity;
  space.nodes = {tube.pose(0), tube.pose(120), tube.pose(0)};
  space.nodes[2].row(1) *= 1.6;
  space.names = {"straight", "bent", "wide"};
  space.parents = {{0, 1}, {1, 2}, {2, 0}};
  space.points.resize(2, 6);
  space.points.leftCols<3>() << 0, 4, 1, 0, 0, 3;
  for (int i = 0; i < 3; ++i) {
    const auto [a, b] = space.parents[i];
    space.nodes.push_back((space.nodes[a] + space.nodes[b]) / 2);
    space.points.col(3 + i) = (space.points.col(a) + space.points.col(b)) / 2;
  }
  space.triangles.resize(3, 4);
  space.triangles << 0, 3, 5, 3, 3, 1, 4, 4, 5, 4, 2, 5;
  space.name = "tubes.space";
  return space;
}

class PageTest : public testing::FilesTest {
 protected:
  DecodedScene Write(const PageScene& scene) const {
    WritePage(Path("page.html"), kTemplate, {scene});
    const std::vector<PageElement> elements = ReadPage(Path("page.html"));
    EXPECT_EQ(elements.size(), 1u);
    EXPECT_EQ(elements[0].type, "application/x-shapespace");
    return DecodedScene(elements[0].bytes);
  }

  std::string Refusal(const std::string& page, const std::vector<PageScene>& scenes) const {
    return MessageOf<InvalidOptions>([&] { WritePage(Path("no.html"), page, scenes); });
  }
};

TEST_F(PageTest, KeepsAPathToAStepOfItsBox) {
  shapespace::Path path = BendingTube(2000, 7);
  path.pose_names.assign(path.poses.size(), "bent");
  const DecodedScene scene = Write(PagePath{&path, "tube.path", "some/tube.path"});
  const Connectivity& connectivity = *path.metric->connectivity;
  EXPECT_EQ(scene.header["name"], "tube.path");
  EXPECT_EQ(scene.header["file"], "some/tube.path");
  EXPECT_EQ(scene.header["poseNames"], path.pose_names);
  ASSERT_EQ(scene.triangles.size(), 3u * connectivity.NumTriangles());
  EXPECT_TRUE(
      std::equal(scene.triangles.begin(), scene.triangles.end(), connectivity.Triangles().data()));
  ASSERT_EQ(scene.steps.size(), 7u);
  for (int i = 0; i < 7; ++i) {
    const double off = (scene.Shape(i) - path.Placed(i)).cwiseAbs().maxCoeff();
    EXPECT_LE(off, 0.5001 * scene.Step()) << i;
  }
}

TEST_F(PageTest, TellsFiguresOfShapesAndSegments) {
  const shapespace::Path path = BendingTube(1000, 5);
  const DecodedScene scene = Write(PagePath{&path, "tube.path"});
  const PathQuality quality = MeasureQuality(path);
  double squares = 0, largest = 0;
  for (int i = 0; i < 5; ++i) {
    squares += std::pow(scene.header["rms"][i].get<double>(), 2) / 4;  // the first has none
    largest = std::max(largest, scene.header["max"][i].get<double>());
    const double end = scene.header["scaleEnd"];
    const Eigen::VectorXd shown = scene.shades[i].cast<double>() * end / 255;
    const Eigen::VectorXd wanted = EdgeDeviation(path, i).cwiseMin(end);
    EXPECT_LE((shown - wanted).cwiseAbs().maxCoeff(), 0.501 * end / 255) << i;
  }
  EXPECT_EQ(scene.header["rms"][0], 0);
  EXPECT_NEAR(std::sqrt(squares), quality.first_rms, 1e-12);
  EXPECT_EQ(largest, quality.first_max);
  ASSERT_EQ(scene.header["speeds"].size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const double bound = EnergyLowerBound(*path.metric, path.shapes[i], path.shapes[i + 1], 1);
    // The bound is twice the squared distance; a segment takes a quarter of the time.
    EXPECT_NEAR(scene.header["speeds"][i], bound / 2 * 16, 1e-9 * bound) << i;
  }
}

TEST_F(PageTest, HasEnergiesOfVerticesAndNearRigidParts) {
  const shapespace::Path path = BendingTube(1000, 5);
  const DecodedScene scene = Write(PagePath{&path, "tube.path"});
  const double end = scene.header["energyEnd"];
  const std::vector<Eigen::VectorXd> energies = VertexEnergy(path);
  ASSERT_EQ(scene.energy_shades.size(), 5u);
  int shown_at_end = 0;
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd shown = scene.energy_shades[i].cast<double>() * end / 255;
    EXPECT_LE((shown - energies[i].cwiseMin(end)).cwiseAbs().maxCoeff(), 0.501 * end / 255) << i;
    shown_at_end += (scene.energy_shades[i].array() == 255).count();
  }
  // The scale fits the values: some, but few, are beyond its end.
  EXPECT_LE(shown_at_end, 0.011 * 5 * scene.vertices);

  const RigidParts parts = FindRigidParts(path);
  ASSERT_GE(parts.parts.size(), 2u);
  EXPECT_EQ(scene.header["parts"], parts.parts.size());
  const auto colour_of = [&](int v) { return scene.part_colours.substr(3 * v, 3); };
  std::map<int, std::string> colours;
  for (int v = 0; v < scene.vertices; ++v) {
    const auto [known, is_new] = colours.emplace(parts.of_vertex[v], colour_of(v));
    EXPECT_EQ(colour_of(v), known->second) << v;
  }
  EXPECT_NE(colours.at(0), colours.at(1));
}

TEST_F(PageTest, MarksTheVerticesOfTrianglesThatIntersect) {
  Eigen::Matrix3Xi triangles(3, 4);
  triangles << 0, 3, 6, 9, 1, 4, 7, 10, 2, 5, 8, 11;
  const shapespace::Path path = PathOf(
      Connectivity::FromTriangles(12, triangles),
      {PiercedTriangle(true, false), PiercedTriangle(false, false), PiercedTriangle(true, true)});
  const DecodedScene scene = Write(PagePath{&path, ""});
  ASSERT_EQ(scene.intersecting.size(), 3u);
  EXPECT_EQ(scene.header["intersections"][0]["pairs"], 1);
  EXPECT_EQ(scene.intersecting[0], (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(scene.header["intersections"][1]["pairs"], 0);
  EXPECT_TRUE(scene.intersecting[1].empty());
  EXPECT_EQ(scene.header["intersections"][2]["pairs"], 2);
  EXPECT_EQ(scene.intersecting[2], (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST_F(PageTest, SpheresIntersectOnTheirCommonCircleOnAnyNumberOfThreads) {
  const SimpleBody sphere = Sphere(1, 30, 60);
  const Eigen::Matrix3Xi& triangles = sphere.connectivity->Triangles();
  const auto size = static_cast<int>(sphere.shape.cols());
  Eigen::Matrix3Xi both(3, 2 * triangles.cols());
  both << triangles, triangles.array() + size;
  const double distances[] = {1.1, 1.3, 1.5, 1.7, 2.1};
  const Eigen::Vector3d direction(0.8, 0.36, 0.48);
  std::vector<Shape> shapes;
  for (const double distance : distances) {
    shapes.emplace_back(3, 2 * size);
    shapes.back() << sphere.shape, sphere.shape.colwise() + distance * direction;
  }
  const shapespace::Path path = PathOf(Connectivity::FromTriangles(2 * size, both), shapes);
  const std::vector<std::string> pages = OnThreads([&] {
    return MakePage(kTemplate, {PagePath{&path, ""}});
  });
  for (const std::string& page : pages) EXPECT_EQ(page, pages[0]);
  const DecodedScene scene = Write(PagePath{&path, ""});
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(scene.intersecting[i].size(), 60u) << i;
    for (const int v : scene.intersecting[i]) {
      // Edges have a length of up to .11 times the square root of 2.
      EXPECT_NEAR(direction.dot(shapes[i].col(v)), distances[i] / 2, 0.16) << i << ", " << v;
    }
  }
  EXPECT_TRUE(scene.intersecting[4].empty());
}

TEST_F(PageTest, MetricsWithoutBoundHaveSpeedsToo) {
  shapespace::Path path = BendingTube(300, 3);
  path.metric = FreezeMetric(MetricOptions::Rigid(), path.metric->connectivity,
                             {path.Placed(0), path.Placed(2)});
  const DecodedScene scene = Write(PagePath{&path, "tube.path"});
  EXPECT_GT(scene.header["speeds"][0].get<double>(), 0);
  EXPECT_TRUE(scene.header["energyEnd"].is_null());
}

TEST_F(PageTest, SmoothMotionTakesAQuarterOfItsBytes) {
  const shapespace::Path path = BendingTube(20000, 17);
  WritePage(Path("page.html"), kTemplate, {PagePath{&path, ""}});
  const double vertices = path.metric->connectivity->NumVertices();
  EXPECT_LT(ReadPage(Path("page.html"))[0].bytes.size(), 0.25 * 17 * vertices * 6);
}

TEST_F(PageTest, NothingIsLostFarFromTheOriginNorAtAnyScale) {
  const ShapeFamily tube = MakeBody("tube", 600);
  const std::vector<Shape> shapes = {tube.pose(0), tube.pose(40), tube.pose(80)};
  const shapespace::Path path = PathOf(tube.connectivity, shapes);
  const DecodedScene here = Write(PagePath{&path, ""});
  const std::pair<double, double> cases[] = {{1, 1e6}, {1e-3, 0}, {1e3, 1e6}};
  for (const auto& [scale, distance] : cases) {
    std::vector<Shape> moved;
    for (const Shape& shape : shapes) {
      moved.push_back((scale * shape).array() + scale * distance);
    }
    const shapespace::Path there_path = PathOf(tube.connectivity, moved);
    const DecodedScene there = Write(PagePath{&there_path, ""});
    for (int i = 0; i < 3; ++i) {
      EXPECT_LE((there.steps[i] - here.steps[i]).cwiseAbs().maxCoeff(), 1) << scale << distance;
    }
    EXPECT_NEAR(there.header["scaleEnd"], here.header["scaleEnd"], 1e-9);
  }
}

TEST_F(PageTest, KeepsASpace) {
  const PageSpace space = TubeSpace();
  const DecodedScene scene = Write(space);
  EXPECT_EQ(scene.header["kind"], "space");
  EXPECT_EQ(scene.header["names"][1], "bent");
  EXPECT_EQ(scene.header["points"][1], (std::vector<double>{4, 0}));
  EXPECT_EQ(scene.header["planeTriangles"][3], (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(scene.header["parents"][2], (std::vector<int>{2, 0}));
  ASSERT_EQ(scene.steps.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LE((scene.Shape(i) - space.nodes[i]).cwiseAbs().maxCoeff(), 0.5001 * scene.Step()) << i;
  }
}

TEST_F(PageTest, KeepsAMesh) {
  const ShapeFamily tube = MakeBody("tube", 300);
  const PageMesh mesh{tube.connectivity, tube.pose(70), {}, "tube.obj", "some/tube.obj", {7, 3}};
  const DecodedScene scene = Write(mesh);
  EXPECT_EQ(scene.header["kind"], "mesh");
  EXPECT_EQ(scene.header["file"], "some/tube.obj");
  EXPECT_EQ(scene.header["markers"], (std::vector<int>{7, 3}));
  ASSERT_EQ(scene.steps.size(), 1u);
  EXPECT_LE((scene.Shape(0) - mesh.shape).cwiseAbs().maxCoeff(), 0.5001 * scene.Step());
}

TEST_F(PageTest, AShapeBetweenItsParentsTakesLittle) {
  PageSpace space = TubeSpace(8000);
  const auto bytes = [&] {
    WritePage(Path("page.html"), kTemplate, {space});
    return ReadPage(Path("page.html"))[0].bytes.size();
  };
  const size_t all = bytes();
  space.nodes.resize(3);
  space.points = space.points.leftCols<3>().eval();
  space.triangles.resize(3, 1);
  space.triangles << 0, 1, 2;
  space.parents.clear();
  const size_t poses = bytes();
  EXPECT_LT(all - poses, 0.2 * poses);
}

TEST_F(PageTest, GraphsKeepTheirSegments) {
  const auto graph = Connectivity::Make(4, {0}, {}, {{0, 1}, {1, 2}, {2, 3}});
  Shape shape(3, 4), bent(3, 4);
  shape << 0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0;
  bent << 0, 1, 1, 2, 0, 0, 1, 1, 0, 0, 0, 0;
  const shapespace::Path path = PathOf(graph, {shape, bent});
  const DecodedScene scene = Write(PagePath{&path, ""});
  EXPECT_TRUE(scene.triangles.empty());
  EXPECT_EQ(scene.segments, (std::vector<int>{0, 1, 1, 2, 2, 3}));
  EXPECT_TRUE(scene.header["intersections"].is_null());
}

TEST_F(PageTest, KeepsVertexColours) {
  shapespace::Path path = BendingTube(100, 2);
  const int vertices = path.metric->connectivity->NumVertices();
  path.appearance.vertex_colours = Eigen::MatrixXd::Zero(4, vertices);
  path.appearance.vertex_colours(1, 2) = 0.4;
  const DecodedScene scene = Write(PagePath{&path, ""});
  ASSERT_EQ(scene.colours.size(), 3u * vertices);
  EXPECT_EQ(scene.colours[2 * 3 + 1], 102);
}

TEST_F(PageTest, EmbedsGlbFilesAsTheyAre) {
  for (const std::string& bytes :
       {std::string("glTF"), std::string("gl\0T\xff", 5), std::string("123456")}) {
    WritePage(Path("page.html"), kTemplate, {PageGlb{bytes, "a \"b\" & c.glb"}});
    const std::vector<PageElement> elements = ReadPage(Path("page.html"));
    EXPECT_EQ(elements[0].type, "model/gltf-binary");
    EXPECT_EQ(elements[0].name, "a &quot;b&quot; &amp; c.glb");
    EXPECT_EQ(elements[0].bytes, bytes);
  }
}

TEST_F(PageTest, TwoScenesStandInTheirOrder) {
  const shapespace::Path path = BendingTube(100, 2);
  WritePage(Path("page.html"), kTemplate, {PageGlb{"glTF", "a"}, PagePath{&path, "b"}});
  const std::vector<PageElement> elements = ReadPage(Path("page.html"));
  ASSERT_EQ(elements.size(), 2u);
  EXPECT_EQ(elements[0].name, "a");
  EXPECT_EQ(elements[1].name, "b");
}

TEST_F(PageTest, RefusesWhatMakesNoPage) {
  const PageGlb glb{"glTF", "a"};
  EXPECT_EQ(Refusal("<body></body>", {glb}).find("page_template: "), 0u);
  EXPECT_EQ(Refusal(std::string(kTemplate) + kTemplate, {glb}).find("page_template: "), 0u);
  EXPECT_EQ(Refusal(kTemplate, {}).find("scenes: "), 0u);
  EXPECT_EQ(Refusal(kTemplate, {glb, glb, glb}).find("scenes: "), 0u);
  EXPECT_EQ(Refusal(kTemplate, {glb, TubeSpace()}).find("scenes: "), 0u);
  EXPECT_EQ(Refusal(kTemplate, {glb, PageMesh()}).find("scenes: "), 0u);
  EXPECT_FALSE(std::filesystem::exists(Path("no.html")));
}

TEST_F(PageTest, RefusesWhatIsNotValid) {
  shapespace::Path path = BendingTube(100, 3);
  path.parameters.pop_back();
  const auto refused = [&](const PageScene& scene) {
    const std::string message =
        MessageOf<MeshError>([&] { WritePage(Path("no.html"), kTemplate, {scene}); });
    EXPECT_EQ(message.find("bad: "), 0u) << message;
  };
  refused(PagePath{&path, "bad"});
  refused(PageMesh{nullptr, Shape(), {}, "bad"});
  for (const int marker : {-1, path.metric->connectivity->NumVertices()}) {
    refused(PageMesh{path.metric->connectivity, path.shapes[0], {}, "bad", "bad.obj", {marker}});
  }
  refused(PageMesh{path.metric->connectivity, Shape::Zero(3, 1), {}, "bad"});
  PageSpace space = TubeSpace();
  space.name = "bad";
  const PageSpace good = space;
  (space = good).parents[0] = {0, 3};  // itself
  refused(space);
  (space = good).triangles(0, 0) = 6;
  refused(space);
  (space = good).nodes[4](0, 0) = NAN;
  refused(space);
  (space = good).nodes[4] = Shape::Zero(3, 1);
  refused(space);
  (space = good).names.pop_back();
  refused(space);
  (space = good).points(0, 0) = INFINITY;
  refused(space);
  (space = good).vertex_colours = Eigen::MatrixXd::Constant(3, 1, 0.5);
  refused(space);
  EXPECT_FALSE(std::filesystem::exists(Path("no.html")));
}

// For tests of the page itself: template and folder are environment variables.
TEST_F(PageTest, WritesSpacesForOtherTests) {
  const char* const folder = std::getenv("SHAPESPACE_PAGE_DIR");
  const char* const page = std::getenv("SHAPESPACE_PAGE_TEMPLATE");
  if (folder == nullptr || page == nullptr) GTEST_SKIP() << "SHAPESPACE_PAGE_DIR is not set";
  const std::string viewer = internal::ReadFile(page);
  WritePage(std::string(folder) + "/space.html", viewer, {TubeSpace(2000)});
  PageSpace line = TubeSpace(500);
  line.names.pop_back();
  line.nodes.resize(2);
  line.points = line.points.leftCols<2>().eval();
  line.parents.clear();
  line.triangles.resize(3, 0);
  line.segments.resize(2, 1);
  line.segments << 0, 1;
  line.name = "line.space";
  WritePage(std::string(folder) + "/line.html", viewer, {line});
  for (const char* name : {"/space.html", "/line.html"}) {
    EXPECT_GT(internal::ReadFile(folder + std::string(name)).size(), viewer.size()) << name;
  }
}

}  // namespace
}  // namespace shapespace
