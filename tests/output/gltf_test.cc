#include <shapespace/output/gltf.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/mesh/soup.h>
#include <shapespace/mesh/triangulate.h>
#include <shapespace/output/detail/key_shapes.h>
#include <shapespace/output/internal/colour.h>

#include "output/bodies.h"
#include "output/read_glb.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;

// Rounding errors of single precision, relative to the body's size: of two numbers and their sum.
constexpr double kPrecision = 4e-7;

// A path through `shapes`, as placed.
Path MakePath(const std::shared_ptr<const Connectivity>& connectivity,
              const std::vector<Shape>& shapes) {
  Path path;
  path.metric = FreezeMetric(MetricOptions(), connectivity, {shapes.front(), shapes.back()});
  path.provenance = "made by a test";
  const int count = static_cast<int>(shapes.size());
  for (int i = 0; i < count; ++i) {
    RigidMotion motion;
    motion.rotation = Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d(1, 2, 3).normalized());
    motion.translation = shapes[i].rowwise().mean();
    path.motions.push_back(motion);
    path.shapes.push_back(motion.rotation.transpose() * (shapes[i].colwise() - motion.translation) /
                          path.metric->unit);
    path.parameters.push_back(count > 1 ? i / (count - 1.0) : 0);
  }
  path.poses = {0};
  if (count > 1) path.poses.push_back(count - 1);
  return path;
}

// A sphere that is stretched, sheared and moved.
Path SpherePath(int count, const Eigen::Vector3d& place = Eigen::Vector3d::Zero(), int circles = 16,
                int around = 24) {
  const SimpleBody sphere = Sphere(1, circles, around);
  std::vector<Shape> shapes;
  for (int i = 0; i < count; ++i) {
    const double t = count > 1 ? i / (count - 1.0) : 0;
    Shape shape = sphere.shape;
    shape.row(1) *= 1 + t;
    shape.row(0) += t * t * shape.row(2);
    shapes.push_back(shape.colwise() + (place + t * Eigen::Vector3d(0.5, 0, 0.2)));
  }
  return MakePath(sphere.connectivity, shapes);
}

double Size(const Shape& shape) {
  return (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).maxCoeff();
}

double Distance(const Shape& a, const Shape& b) { return (a - b).cwiseAbs().maxCoeff(); }

// The time of key k on the way from the first shape: after the rest, which has two samples.
double TimeOf(const Glb& glb, int k) { return glb.Times()(1 + k); }

Shape Shown(const Glb& glb, double time) { return glb.InTheWorld(glb.Morphed("POSITION", time)); }

TEST(WriteGltfTest, ShowsEveryShapeAtItsTime) {
  Path path = SpherePath(6, {2, 0, -1});
  path.parameters = {0, 0.1, 0.2, 0.55, 0.6, 1};
  const GltfSummary summary = WriteGltf(GlbFile("path"), path);
  EXPECT_EQ(summary.keys, 6);
  EXPECT_FALSE(summary.subsampled);
  const Glb glb(GlbFile("path"));
  const double begin = TimeOf(glb, 0), end = TimeOf(glb, 5);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR((TimeOf(glb, i) - begin) / (end - begin), path.parameters[i], 1e-6);
    const Shape expected = path.Placed(i);
    EXPECT_LT(Distance(Shown(glb, TimeOf(glb, i)), expected), kPrecision * Size(expected)) << i;
  }
  EXPECT_LT(Distance(Shown(glb, (TimeOf(glb, 2) + TimeOf(glb, 3)) / 2),
                     (path.Placed(2) + path.Placed(3)) / 2),
            kPrecision * Size(path.Placed(3)));
}

TEST(WriteGltfTest, RunsThereAndBackWithRestsInTheGivenTime) {
  const Path path = SpherePath(4);
  GltfOptions options;
  options.duration = 7;
  WriteGltf(GlbFile("there-and-back"), path, options);
  const Glb glb(GlbFile("there-and-back"));
  const Eigen::MatrixXd times = glb.Times();
  EXPECT_EQ(times(0), 0);
  EXPECT_FLOAT_EQ(times(times.size() - 1), 7);
  for (const double t : {0.0, 0.3, 1.1, 2.2, 3.4}) {
    EXPECT_LT(Distance(Shown(glb, t), Shown(glb, 7 - t)), 1e-5) << t;
  }
  for (const double t : {0.0, 0.1, 6.9, 7.0}) {
    EXPECT_LT(Distance(Shown(glb, t), path.Placed(0)), 1e-6) << t;
  }
  for (const double t : {3.3, 3.5, 3.7}) {
    EXPECT_LT(Distance(Shown(glb, t), path.Placed(3)), 2e-6) << t;
  }
  const auto& accessor =
      glb.json["accessors"][glb.json["animations"][0]["samplers"][0]["input"].get<int>()];
  EXPECT_EQ(accessor["min"][0], 0);
  EXPECT_EQ(accessor["max"][0], 7);
}

TEST(WriteGltfTest, EachEndIsHeldForATenthOfTheTime) {
  const Path path = SpherePath(3);
  GltfOptions options;
  options.duration = 10;
  WriteGltf(GlbFile("holds"), path, options);
  const Glb glb(GlbFile("holds"));
  for (const double t : {0.0, 0.499, 9.501, 10.0}) {
    EXPECT_LT(Distance(Shown(glb, t), path.Placed(0)), 1e-6) << t;
  }
  for (const double t : {4.501, 5.0, 5.499}) {
    EXPECT_LT(Distance(Shown(glb, t), path.Placed(2)), 2e-6) << t;
  }
  for (const double t : {0.51, 9.49}) {
    EXPECT_GT(Distance(Shown(glb, t), path.Placed(0)), 1e-4) << t;
  }
}

TEST(WriteGltfTest, LoopsRunFromTheFirstToTheLastAllTheTime) {
  const Path path = SpherePath(5);
  GltfOptions options;
  options.duration = 8;
  options.playback = GltfPlayback::kLoop;
  WriteGltf(GlbFile("loop"), path, options);
  const Glb glb(GlbFile("loop"));
  EXPECT_EQ(glb.Times().maxCoeff(), 8);
  for (int i = 0; i < 5; ++i) {
    EXPECT_LT(Distance(Shown(glb, 2 * i), path.Placed(i)), 2e-6) << i;
  }
  EXPECT_LT(Distance(Shown(glb, 7), (path.Placed(3) + path.Placed(4)) / 2), 2e-6);
}

TEST(WriteGltfTest, OnceEndsWithAHold) {
  const Path path = SpherePath(4);
  GltfOptions options;
  options.duration = 10;
  options.playback = GltfPlayback::kOnce;
  WriteGltf(GlbFile("once"), path, options);
  const Glb glb(GlbFile("once"));
  EXPECT_EQ(glb.Times().maxCoeff(), 10);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(Distance(Shown(glb, 3 * i), path.Placed(i)), 2e-6) << i;
  }
  EXPECT_LT(Distance(Shown(glb, 9.5), path.Placed(3)), 2e-6);
  EXPECT_LT(Distance(Shown(glb, 10), path.Placed(3)), 2e-6);
}

TEST(WriteGltfTest, FramesASecondSetTheTimeBetweenShapes) {
  const Path path = SpherePath(7), long_path = SpherePath(65);
  GltfOptions options;
  options.fps = 4;
  for (const GltfPlayback playback :
       {GltfPlayback::kThereAndBack, GltfPlayback::kLoop, GltfPlayback::kOnce}) {
    options.playback = playback;
    WriteGltf(GlbFile("frames"), path, options);
    const Glb glb(GlbFile("frames"));
    const double begin = playback == GltfPlayback::kThereAndBack ? TimeOf(glb, 0) : 0;
    for (int i = 0; i < 7; ++i) {
      EXPECT_LT(Distance(Shown(glb, begin + i / 4.0), path.Placed(i)), 3e-6) << i;
    }
    // Also if the file does not contain all shapes.
    WriteGltf(GlbFile("frames-long"), long_path, options);
    const Glb long_glb(GlbFile("frames-long"));
    const double start = playback == GltfPlayback::kThereAndBack ? TimeOf(long_glb, 0) : 0;
    EXPECT_LT(Distance(Shown(long_glb, start + 16), long_path.Placed(64)), 3e-6);
    EXPECT_GT(Distance(Shown(long_glb, start + 15.5), long_path.Placed(64)), 1e-2);
  }
}

// Also for a path of two shapes, which has no key in between whose time could change.
TEST(WriteGltfTest, EasedMotionsAreSlowAtBothEnds) {
  for (const int count : {2, 6}) {
    const Path path = SpherePath(count);
    GltfOptions options;
    options.duration = 1;
    options.playback = GltfPlayback::kLoop;
    options.ease = true;
    WriteGltf(GlbFile("eased"), path, options);
    options.ease = false;
    WriteGltf(GlbFile("even"), path, options);
    const Glb eased(GlbFile("eased")), even(GlbFile("even"));
    for (const double tau : {0.0, 0.03, 0.1, 0.3, 0.5, 0.77, 0.98, 1.0}) {
      const double t = 0.5 * (1 - std::cos(EIGEN_PI * tau));
      EXPECT_LT(Distance(Shown(eased, tau), Shown(even, t)), 2e-3) << tau;
    }
    for (int i = 0; i < count; ++i) {
      const double tau = std::acos(1 - 2 * path.parameters[i]) / EIGEN_PI;
      EXPECT_LT(Distance(Shown(eased, tau), path.Placed(i)), 2e-5) << i;
    }
  }
}

TEST(WriteGltfTest, TimesRiseHoweverCloseTheShapes) {
  Path path = SpherePath(5);
  path.parameters = {0, 1e-12, 0.5, 1 - 1e-15, 1};
  WriteGltf(GlbFile("close"), path);
  const Eigen::MatrixXd times = Glb(GlbFile("close")).Times();
  for (Eigen::Index s = 1; s < times.size(); ++s) EXPECT_GT(times(s), times(s - 1)) << s;
}

TEST(WriteGltfTest, NormalsStandOnTheSurface) {
  const SimpleBody sphere = Sphere(1, 40, 80);
  const Eigen::Vector3d axes(1, 2, 0.5);
  WriteGltf(GlbFile("normals"),
            MakePath(sphere.connectivity, {sphere.shape, axes.asDiagonal() * sphere.shape}));
  const Glb glb(GlbFile("normals"));
  const Eigen::MatrixXd first = glb.Morphed("NORMAL", 0), last = glb.Morphed("NORMAL", 2);
  for (int v = 80; v < 39 * 80; ++v) {  // all but the poles
    EXPECT_NEAR(first.col(v).norm(), 1, 1e-6);
    EXPECT_NEAR(last.col(v).norm(), 1, 1e-6);
    EXPECT_GT(first.col(v).dot(sphere.shape.col(v)), 0.995) << v;
    const Eigen::Vector3d normal = sphere.shape.col(v).cwiseQuotient(axes).normalized();
    EXPECT_GT(last.col(v).dot(normal), 0.99) << v;
  }
}

TEST(WriteGltfTest, NormalsAreUnitVectorsWhereThereIsNoSurface) {
  // An unused vertex, and a triangle that collapses on the way.
  const auto connectivity =
      Connectivity::FromTriangles(7, (Eigen::Matrix3Xi(3, 2) << 0, 3, 1, 4, 2, 5).finished());
  Shape first = Shape::Random(3, 7), last = first;
  last.col(4) = last.col(5) = last.col(3);
  WriteGltf(GlbFile("degenerate"), MakePath(connectivity, {first, last}));
  const Glb glb(GlbFile("degenerate"));
  for (const double time : {0.0, 2.0}) {
    const Eigen::MatrixXd normals = glb.Morphed("NORMAL", time);
    for (int v = 0; v < 7; ++v) EXPECT_NEAR(normals.col(v).norm(), 1, 1e-6) << time << " " << v;
  }
}

TEST(WriteGltfTest, BoundsAreThoseOfThePositions) {
  WriteGltf(GlbFile("bounds"), SpherePath(3));
  const Glb glb(GlbFile("bounds"));
  std::vector<int> accessors = {glb.Primitive()["attributes"]["POSITION"]};
  for (const auto& target : glb.Primitive()["targets"]) accessors.push_back(target["POSITION"]);
  EXPECT_EQ(accessors.size(), 3u);
  for (const int index : accessors) {
    const Eigen::MatrixXd values = glb.Read(index);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(glb.json["accessors"][index]["min"][k], values.row(k).minCoeff());
      EXPECT_EQ(glb.json["accessors"][index]["max"][k], values.row(k).maxCoeff());
    }
  }
}

TEST(WriteGltfTest, LongPathsAreSubsampledWithPosesAndEnds) {
  Path path = SpherePath(100);
  path.poses = {0, 37, 99};
  const GltfSummary summary = WriteGltf(GlbFile("long"), path);
  EXPECT_EQ(summary.keys, 32);
  EXPECT_TRUE(summary.subsampled);
  const Glb glb(GlbFile("long"));
  EXPECT_EQ(glb.Primitive()["targets"].size(), 31u);
  EXPECT_EQ(glb.json["asset"]["extras"]["shapes"], 100);
  const double begin = TimeOf(glb, 0), end = TimeOf(glb, 31);
  for (const int pose : path.poses) {
    const double time = begin + path.parameters[pose] * (end - begin);
    EXPECT_LT(Distance(Shown(glb, time), path.Placed(pose)), 2e-6) << pose;
  }
  for (int k = 1; k < 32; ++k) {
    EXPECT_LT((TimeOf(glb, k) - TimeOf(glb, k - 1)) / (end - begin), 4.01 / 99);
  }
}

TEST(KeyShapesTest, KeepsAllThatFit) {
  EXPECT_EQ(internal::KeyShapes(4, {0, 3}, 32), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(internal::KeyShapes(1, {0}, 32), (std::vector<int>{0}));
  EXPECT_EQ(internal::KeyShapes(32, {0, 7, 31}, 32).size(), 32u);
}

TEST(KeyShapesTest, KeepsPosesAndFillsTheWidestGaps) {
  EXPECT_EQ(internal::KeyShapes(101, {0, 100}, 5), (std::vector<int>{0, 25, 50, 75, 100}));
  EXPECT_EQ(internal::KeyShapes(101, {0, 3, 100}, 5), (std::vector<int>{0, 3, 35, 68, 100}));
  // The path continues beyond its poses.
  EXPECT_EQ(internal::KeyShapes(101, {40, 60}, 4), (std::vector<int>{0, 40, 60, 100}));
}

TEST(KeyShapesTest, OfTooManyPosesKeepsTheEnds) {
  std::vector<int> poses;
  for (int i = 0; i < 50; ++i) poses.push_back(2 * i + 1);
  EXPECT_EQ(internal::KeyShapes(200, poses, 4), (std::vector<int>{0, 33, 67, 199}));
}

TEST(WriteGltfTest, OneShapeIsAStill) {
  const Path path = SpherePath(1);
  EXPECT_EQ(WriteGltf(GlbFile("still"), path).keys, 1);
  const Glb glb(GlbFile("still"));
  EXPECT_FALSE(glb.json.contains("animations"));
  EXPECT_FALSE(glb.Primitive().contains("targets"));
  const Shape shown = glb.InTheWorld(glb.Read(glb.Primitive()["attributes"]["POSITION"]));
  EXPECT_LT(Distance(shown, path.Placed(0)), 1e-6);
}

TEST(WriteGltfTest, PolygonsAreTriangulatedAndSeenFromBothSides) {
  const SimpleBody box = Box(1, 2, 3);
  WriteGltf(GlbFile("box"), MakePath(box.connectivity, {box.shape, 2 * box.shape}));
  const Glb glb(GlbFile("box"));
  EXPECT_EQ(glb.Primitive()["mode"], 4);
  const Eigen::MatrixXd indices = glb.Indices();
  ASSERT_EQ(indices.size(), 36);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(indices(i), box.connectivity->Triangles()(i)) << i;
  const auto& material = glb.json["materials"][glb.Primitive()["material"].get<int>()];
  EXPECT_EQ(material["doubleSided"], true);
}

// A star, one polygon; a fan from any corner would cover parts outside of it.
TEST(WriteGltfTest, ConcavePolygonsAreFilledOnce) {
  constexpr int kCorners = 10;
  Soup soup;
  soup.vertices.resize(3, kCorners);
  for (int v = 0; v < kCorners; ++v) {
    const double angle = 2 * EIGEN_PI * v / kCorners, radius = v % 2 == 0 ? 1 : 0.3;
    soup.vertices.col(v) << radius * std::cos(angle), radius * std::sin(angle), 0;
    soup.corners.push_back(v);
  }
  soup.polygon_begin.push_back(kCorners);
  const auto connectivity =
      Connectivity::Make(kCorners, soup.polygon_begin, soup.corners, {}, {},
                         Triangulate(soup.polygon_begin, soup.corners, {soup.vertices}));
  WriteGltf(GlbFile("star"), MakePath(connectivity, {soup.vertices, 2 * soup.vertices}));
  const Glb glb(GlbFile("star"));
  const Eigen::MatrixXd indices = glb.Indices();
  ASSERT_EQ(indices.size(), 3 * (kCorners - 2));
  const double area = kCorners * 0.5 * 0.3 * std::sin(2 * EIGEN_PI / kCorners);
  for (const double time : {TimeOf(glb, 0), TimeOf(glb, 1)}) {
    const Shape shape = Shown(glb, time);
    double sum = 0;
    for (int i = 0; i < indices.size(); i += 3) {
      const auto corner = [&](int k) -> Eigen::Vector3d { return shape.col(indices(i + k)); };
      const double twice = (corner(1) - corner(0)).cross(corner(2) - corner(0)).z();
      EXPECT_GT(twice, 0) << "triangle " << i / 3;
      sum += twice / 2;
    }
    EXPECT_NEAR(sum, time == TimeOf(glb, 0) ? area : 4 * area, 1e-5);
  }
}

TEST(WriteGltfTest, FacetsAreShadedFlat) {
  const auto has_normals = [](const Path& path) {
    WriteGltf(GlbFile("facets"), path);
    const Glb glb(GlbFile("facets"));
    const bool normals = glb.Primitive()["attributes"].contains("NORMAL");
    EXPECT_EQ(glb.Primitive()["targets"][0].contains("NORMAL"), normals);
    return normals;
  };
  EXPECT_TRUE(has_normals(SpherePath(2)));
  const SimpleBody box = Box(1, 2, 3);
  EXPECT_FALSE(has_normals(MakePath(box.connectivity, {box.shape, 2 * box.shape})));
  // A strip of paper, folded like a fan from being flat.
  std::vector<int> begin = {0}, corners;
  Shape flat(3, 12);
  for (int i = 0; i < 6; ++i) {
    flat.col(2 * i) << i, 0, 0;
    flat.col(2 * i + 1) << i, 1, 0;
    if (i == 5) break;
    for (const int k : {0, 2, 3, 1}) corners.push_back(2 * i + k);
    begin.push_back(4 * (i + 1));
  }
  const auto strip = Connectivity::Make(12, begin, corners);
  const auto folded = [&](double degrees) {
    Shape shape = flat;
    for (int v = 0; v < 12; ++v) {
      shape(0, v) *= std::cos(degrees * EIGEN_PI / 180);
      shape(2, v) = v / 2 % 2 * std::sin(degrees * EIGEN_PI / 180);
    }
    return shape;
  };
  EXPECT_TRUE(has_normals(MakePath(strip, {flat, folded(10)})));
  EXPECT_FALSE(has_normals(MakePath(strip, {flat, folded(40)})));
}

TEST(WriteGltfTest, GraphsAreLines) {
  const auto graph = Connectivity::Make(4, {0}, {}, {{0, 1}, {1, 2}, {1, 3}}, {{0, 3}});
  const Shape first = Shape::Random(3, 4);
  Shape last = first;
  last.col(2) += Eigen::Vector3d(0, 1, 2);
  const Path path = MakePath(graph, {first, last});
  GltfOptions options;
  options.colour_by_deviation = true;
  WriteGltf(GlbFile("graph"), path, options);
  const Glb glb(GlbFile("graph"));
  EXPECT_EQ(glb.Primitive()["mode"], 1);
  EXPECT_FALSE(glb.Primitive()["attributes"].contains("NORMAL"));
  EXPECT_FALSE(glb.Primitive()["targets"][0].contains("NORMAL"));
  EXPECT_EQ(glb.Indices(), (Eigen::RowVectorXd(6) << 0, 1, 1, 2, 1, 3).finished());
  EXPECT_LT(Distance(Shown(glb, 2), last), 1e-6);
}

TEST(WriteGltfTest, ZPointsUpIfAskedTo) {
  const Path path = SpherePath(2, {1, 2, 3});
  GltfOptions options;
  options.up = 'z';
  WriteGltf(GlbFile("z-up"), path, options);
  const Shape last = path.Placed(1);
  Shape expected(3, last.cols());
  expected << last.row(0), last.row(2), -last.row(1);
  EXPECT_LT(Distance(Shown(Glb(GlbFile("z-up")), 2), expected), 2e-6);
}

TEST(WriteGltfTest, UnitsBecomeMetres) {
  const Path path = SpherePath(2, {1, 2, 3});
  GltfOptions options;
  options.unit = 0.001;
  options.up = 'z';
  WriteGltf(GlbFile("millimetres"), path, options);
  const Shape last = 0.001 * path.Placed(1);
  Shape expected(3, last.cols());
  expected << last.row(0), last.row(2), -last.row(1);
  EXPECT_LT(Distance(Shown(Glb(GlbFile("millimetres")), 2), expected), 2e-9);
}

TEST(WriteGltfTest, FarFromTheOriginNothingIsLost) {
  const Path path = SpherePath(3, {1e6, -1e6, 1e6});
  WriteGltf(GlbFile("far"), path);
  const Glb glb(GlbFile("far"));
  for (int i = 0; i < 3; ++i) {
    const Shape expected = path.Placed(i);
    EXPECT_LT(Distance(Shown(glb, TimeOf(glb, i)), expected), 1e-6 * Size(expected));
  }
}

TEST(WriteGltfTest, IndicesHaveSixteenBitsWhereTheyFit) {
  const auto component_type = [](int vertices) {
    const auto connectivity =
        Connectivity::FromTriangles(vertices, Eigen::Vector3i(0, 1, vertices - 1));
    Shape shape = Shape::Zero(3, vertices);
    shape.col(1).x() = shape.col(vertices - 1).y() = 1;
    WriteGltf(GlbFile("indices"), MakePath(connectivity, {shape}));
    const Glb glb(GlbFile("indices"));
    EXPECT_EQ(glb.Indices()(2), vertices - 1);
    return glb.json["accessors"][glb.Primitive()["indices"].get<int>()]["componentType"];
  };
  EXPECT_EQ(component_type(65535), 5123);
  EXPECT_EQ(component_type(65536), 5125);
}

TEST(WriteGltfTest, IsNoLargerThanItsArrays) {
  const GltfSummary summary = WriteGltf(GlbFile("size"), SpherePath(17, {0, 0, 0}, 40, 80));
  EXPECT_EQ(summary.bytes, std::filesystem::file_size(GlbFile("size")));
  const double vertices = 40 * 80, triangles = 39 * 80 * 2;
  const double arrays = 24 * vertices * 17 + 6 * triangles;
  EXPECT_GT(summary.bytes, arrays);
  EXPECT_LT(summary.bytes, 1.02 * arrays);
}

TEST(WriteGltfTest, ColoursShowTheLargestDeviationOnTheWay) {
  // The upper half is twice as large in the middle of the path, and back to its size at the end.
  const SimpleBody sphere = Sphere(1);
  Shape middle = sphere.shape;
  for (int v = 0; v < middle.cols(); ++v) {
    if (middle(1, v) > 0) middle.col(v) *= 2;
  }
  const Path path = MakePath(sphere.connectivity, {sphere.shape, middle, sphere.shape});
  const GltfSummary plain = WriteGltf(GlbFile("plain"), path);
  EXPECT_EQ(plain.colour_end, 0);
  EXPECT_FALSE(Glb(GlbFile("plain")).Primitive()["attributes"].contains("COLOR_0"));

  GltfOptions options;
  options.colour_by_deviation = true;
  const GltfSummary summary = WriteGltf(GlbFile("coloured"), path, options);
  const Glb glb(GlbFile("coloured"));
  EXPECT_EQ(glb.json["asset"]["extras"]["last_colour_deviation"], summary.colour_end);
  EXPECT_GE(summary.colour_end, 1);
  const Eigen::MatrixXd colours = glb.Read(glb.Primitive()["attributes"]["COLOR_0"]);
  for (int v = 0; v < middle.cols(); ++v) {
    const double y = sphere.shape(1, v);
    if (std::abs(y) < 0.1) continue;  // beside the seam
    const double deviation = y > 0 ? 1 : 0;
    const internal::Colour expected =
        internal::ValueColour(static_cast<float>(deviation / summary.colour_end));
    EXPECT_LT((colours.col(v) - expected.cast<double>()).norm(), 0.02) << v;
  }
  EXPECT_FALSE(glb.json["materials"][0]["pbrMetallicRoughness"].contains("baseColorFactor"))
      << "vertex colours are multiplied by it";
}

TEST(WriteGltfTest, DeviationMayBeFromAShapeThatIsNotShown) {
  const SimpleBody sphere = Sphere(1);
  const Path path = MakePath(sphere.connectivity, {sphere.shape, sphere.shape});
  GltfOptions options;
  options.colour_by_deviation = true;
  options.reference = 0.5 * path.shapes[0];
  EXPECT_DOUBLE_EQ(WriteGltf(GlbFile("reference"), path, options).colour_end, 1);
}

TEST(WriteGltfTest, ColoursShowGroups) {
  const SimpleBody sphere = Sphere(1);
  const Path path = MakePath(sphere.connectivity, {sphere.shape, 2 * sphere.shape});
  GltfOptions options;
  options.groups = Eigen::VectorXi::LinSpaced(sphere.shape.cols(), -1, 12);
  WriteGltf(GlbFile("groups"), path, options);
  const Glb glb(GlbFile("groups"));
  const Eigen::MatrixXd colours = glb.Read(glb.Primitive()["attributes"]["COLOR_0"]);
  for (int v = 0; v < sphere.shape.cols(); ++v) {
    const internal::Colour expected = internal::GroupColour(options.groups(v));
    EXPECT_LT((colours.col(v) - expected.cast<double>()).norm(), 0.02) << v;
  }
  EXPECT_FALSE(glb.json["materials"][0]["pbrMetallicRoughness"].contains("baseColorFactor"));
}

TEST(WriteGltfTest, SaysWhatItIsAndWhereItIsFrom) {
  Path path = SpherePath(2);
  path.provenance = "from \"a\xff.obj\" and \xc3\xa9.obj";
  WriteGltf(GlbFile("provenance"), path);
  const Glb glb(GlbFile("provenance"));
  EXPECT_EQ(glb.json["asset"]["version"], "2.0");
  EXPECT_EQ(glb.json["asset"]["generator"].get<std::string>().substr(0, 11), "shapespace ");
  const auto& extras = glb.json["asset"]["extras"];
  EXPECT_EQ(extras["metric"], DescribeMetric(path.metric->options));
  EXPECT_EQ(extras["shapes"], 2);
  EXPECT_EQ(extras["provenance"], "from \"a\xef\xbf\xbd.obj\" and \xc3\xa9.obj");
}

TEST(WriteGltfTest, NamesTheOptionThatIsWrong) {
  const Path path = SpherePath(2);
  const auto message = [&](const std::function<void(GltfOptions*)>& change) {
    GltfOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { WriteGltf("never.glb", path, options); });
  };
  using O = GltfOptions;
  EXPECT_TRUE(Names(message([](O* o) { o->up = 'x'; }), {"up:", "'x'", "'y'", "'z'"}));
  EXPECT_TRUE(Names(message([](O* o) { o->unit = 0; }), {"unit:", "1e-12", "1e+12"}));
  EXPECT_TRUE(Names(message([](O* o) { o->unit = -1; }), {"unit:", "1e-12", "1e+12"}));
  EXPECT_EQ(message([](O* o) { o->unit = std::nan(""); }).find("unit:"), 0u);
  EXPECT_TRUE(Names(message([](O* o) { o->duration = 0; }), {"duration:", "0.1", "3600"}));
  EXPECT_TRUE(Names(message([](O* o) { o->fps = -1; }), {"fps:", "0.01", "1000"}));
  EXPECT_EQ(message([](O* o) { o->fps = std::nan(""); }).find("fps:"), 0u);
  EXPECT_TRUE(Names(message([](O* o) { o->groups.setZero(3); }), {"groups:", "3"}));
  EXPECT_TRUE(Names(message([](O* o) {
                      o->colour_by_deviation = true;
                      o->reference.setZero(3, 3);
                    }),
                    {"reference:", "3"}));
  EXPECT_TRUE(Names(message([&](O* o) {
                      o->colour_by_deviation = true;
                      o->groups.setZero(path.shapes[0].cols());
                    }),
                    {"groups:"}));
  EXPECT_FALSE(std::filesystem::exists("never.glb"));
}

TEST(WriteGltfTest, NamesWhatIsWrongWithThePath) {
  const auto message = [](const std::function<void(Path*)>& change) {
    Path path = SpherePath(3);
    change(&path);
    return MessageOf<MeshError>([&] { WriteGltf("a.glb", path); });
  };
  using P = Path;
  EXPECT_TRUE(Names(message([](P* p) { p->shapes.clear(); }), {"a.glb:"}));
  EXPECT_TRUE(Names(message([](P* p) { p->shapes[1](2, 5) = std::nan(""); }),
                    {"a.glb:", "shape 1", "vertex 5"}));
  EXPECT_TRUE(Names(message([](P* p) { p->shapes[2] = Shape::Zero(3, 7); }),
                    {"a.glb:", "shape 2", "7", "384"}));
  EXPECT_TRUE(Names(message([](P* p) { p->parameters[2] = p->parameters[1]; }), {"a.glb:"}));
  EXPECT_TRUE(Names(message([](P* p) { p->motions.pop_back(); }), {"3"}));
  EXPECT_TRUE(Names(message([](P* p) { p->poses = {0, 3}; }), {"a.glb:", "pose 3", "3"}));
  for (const double scale : {1e40, 1e-40}) {
    EXPECT_TRUE(Names(message([&](P* p) {
                        for (Shape& shape : p->shapes) shape *= scale;
                        for (RigidMotion& motion : p->motions) motion.translation *= scale;
                      }),
                      {"unit of length"}));
  }
  EXPECT_FALSE(std::filesystem::exists("a.glb"));
}

TEST(WriteGltfTest, AFileThatCannotBeWrittenIsNamed) {
  const std::string file = ::testing::TempDir() + "no_folder";
  std::ofstream(file) << "a file";
  const std::string message =
      MessageOf<FileError>([&] { WriteGltf(file + "/a.glb", SpherePath(2)); });
  EXPECT_EQ(message.find(file + "/a.glb: "), 0u) << message;
}

}  // namespace
}  // namespace shapespace
