#include <shapespace/analysis/quality.h>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/sheet.h>

namespace shapespace {
namespace {

Path MakePath(const ShapeFamily& body, const std::vector<Shape>& shapes,
              const MetricOptions& options = {}) {
  Path path;
  path.metric = FreezeMetric(options, body.connectivity, {shapes.front(), shapes.back()});
  path.shapes = shapes;
  for (size_t i = 0; i < shapes.size(); ++i) {
    path.parameters.push_back(static_cast<double>(i) / (shapes.size() - 1));
  }
  path.motions.resize(shapes.size());
  path.poses = {0, static_cast<int>(shapes.size()) - 1};
  return path;
}

TEST(MeasureQuality, IsZeroOnAnExactIsometricFlex) {
  const ShapeFamily strip = MakeStrip(1, 1, 20);
  std::vector<Shape> shapes;
  for (int i = 0; i <= 4; ++i) shapes.push_back(strip.pose(strip.end * i / 4));
  const PathQuality quality = MeasureQuality(MakePath(strip, shapes));
  EXPECT_LT(quality.edge_max, 1e-12);
  EXPECT_LT(quality.first_max, 1e-12);
  EXPECT_LT(quality.roughness, 1e-6);  // the hinges' angles are the parameter itself
  EXPECT_EQ(quality.folds, 0);
}

TEST(MeasureQuality, SeesAScaledShapeAsThatMuchDeviation) {
  const ShapeFamily sheet = MakeSheet(1, 1, 6, 6);
  const Shape flat = sheet.pose(0);
  const PathQuality quality =
      MeasureQuality(MakePath(sheet, {flat, 1.1 * flat, 2 * flat}, MetricOptions::Isometric()));
  const double expected = std::sqrt(0.5 * 1 + 0.5 * 4);  // between |e|^2 and 4 |e|^2, half way
  EXPECT_NEAR(quality.edge_max, std::abs(1.1 / expected - 1), 1e-6);
  EXPECT_NEAR(quality.edge_rms, std::abs(1.1 / expected - 1), 1e-6);
  EXPECT_NEAR(quality.first_max, 1, 1e-6);                          // of the last shape
  EXPECT_NEAR(quality.first_rms, std::sqrt((1 + 0.01) / 2), 1e-6);  // of both
}

// Such triangles are accepted with a warning, by --allow_nonmanifold.
TEST(MeasureQuality, OfATriangleWithAVertexTwiceTakesItsSides) {
  ShapeFamily body;
  Eigen::Matrix3Xi triangles(3, 2);
  triangles.col(0) << 0, 1, 2;
  triangles.col(1) << 1, 2, 1;
  body.connectivity = Connectivity::FromTriangles(3, triangles);
  Shape shape(3, 3);
  shape << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  const PathQuality quality = MeasureQuality(MakePath(body, {shape, shape, shape}));
  EXPECT_NEAR(quality.edge_max, 0, 1e-6);
}

// Segments, of which each is longer than the one before by a thousandth of its first length; in the
// last shape they have their first lengths again.
TEST(MeasureQuality, OneInAHundredDeviatesMoreThanThe99thPercentile) {
  constexpr int kSegments = 1001;
  ShapeFamily chain;
  std::vector<std::pair<int, int>> segments;
  Shape first = Shape::Zero(3, 2 * kSegments), longer = first;
  for (int e = 0; e < kSegments; ++e) {
    segments.emplace_back(2 * e, 2 * e + 1);
    first(0, 2 * e + 1) = 1;
    longer(0, 2 * e + 1) = 1 + 1e-3 * (2 * e % kSegments);
  }
  chain.connectivity = Connectivity::Make(2 * kSegments, {0}, {}, segments);
  const PathQuality quality =
      MeasureQuality(MakePath(chain, {first, longer, first}, MetricOptions::Isometric()));
  EXPECT_NEAR(quality.edge_max, 1, 1e-6);
  EXPECT_NEAR(quality.edge_p99, 0.99, 0.0015);
  EXPECT_NEAR(quality.first_max, 1, 1e-6);
  EXPECT_NEAR(quality.first_p99, 0.98, 0.0015);  // of both shapes, of which one does not deviate
}

// Under a cost of strain, the logarithmic strains of equilateral triangles that are stretched along
// two fixed directions change at a constant rate if the factors are powers of t, and so do the
// logarithms of the lengths of segments along these directions. Under a cost of edge lengths,
// squared lengths change at a constant rate if the squares of the factors do.
TEST(MeasureQuality, IsZeroWhereEveryElementMovesOnItsStraightLine) {
  const double high = std::sqrt(0.75);
  Shape rest(3, 8);
  rest << 0, 1, 0.5, 1.5, 1, 3, 4, 4,       //
      0, 0, high, high, 2 * high, 0, 0, 1,  //
      0, 0, 0, 0, 0, 0, 0, 0;
  const auto connectivity =
      Connectivity::Make(8, {0, 3, 6, 9}, {0, 1, 2, 1, 3, 2, 2, 3, 4}, {{5, 6}, {6, 7}});
  const auto stretched = [&](double x, double y) -> Shape {
    return Eigen::Vector3d(x, y, 1).asDiagonal() * rest;
  };
  const std::vector<double> times = {0, 0.3, 0.5, 1};
  std::vector<Shape> by_strain, by_length, rigid(times.size(), rest);
  for (const double t : times) {
    by_strain.push_back(stretched(std::pow(2, t), std::pow(0.7, t)));
    by_length.push_back(stretched(std::sqrt(1 + 3 * t), std::sqrt(1 - 0.51 * t)));
  }
  const auto edges_off = [&](const std::vector<Shape>& shapes, const MetricOptions& options) {
    Path path;
    path.metric = FreezeMetric(options, connectivity, {shapes.front(), shapes.back()});
    for (const Shape& shape : shapes) path.shapes.push_back(shape / path.metric->unit);
    path.parameters = times;
    path.motions.resize(times.size());
    path.poses = {0, 3};
    return MeasureQuality(path).edge_max;
  };
  EXPECT_LT(edges_off(by_strain, MetricOptions::Strain()), 1e-7);
  EXPECT_LT(edges_off(by_length, MetricOptions::Isometric()), 1e-12);
  EXPECT_GT(edges_off(by_length, MetricOptions::Strain()), 0.02);
  EXPECT_GT(edges_off(by_strain, MetricOptions::Isometric()), 0.02);
  MetricOptions both;
  both.isometric = 0.3;
  both.strain = 0.7;
  EXPECT_LT(edges_off(rigid, both), 1e-12);
  EXPECT_GT(edges_off(by_strain, both), 1e-3);
  EXPECT_LT(edges_off(by_strain, both), 0.5 * edges_off(by_strain, MetricOptions::Isometric()));
}

TEST(MeasureQuality, FiguresOfInnerShapesAreOfThoseBetweenPosesOnly) {
  const ShapeFamily sheet = MakeSheet(1, 1, 6, 6);
  const Shape flat = sheet.pose(0), rolled = sheet.pose(20);
  const Path between = MakePath(sheet, {flat, 1.1 * rolled, 2 * flat});
  const PathQuality inner = MeasureQuality(between);
  EXPECT_EQ(inner.inner_shapes, 1);
  EXPECT_GT(inner.edge_rms, 0.1);
  EXPECT_GT(inner.roughness, 0.1);
  Path beyond = between;
  for (const double scale : {3, 5}) {
    beyond.shapes.push_back(scale * flat);
    beyond.parameters.push_back(beyond.parameters.back() + 0.5);
    beyond.motions.emplace_back();
  }
  beyond.extrapolated = 2;
  const PathQuality all = MeasureQuality(beyond);
  EXPECT_EQ(all.inner_shapes, 1);
  EXPECT_EQ(all.edge_rms, inner.edge_rms);
  EXPECT_EQ(all.edge_max, inner.edge_max);
  EXPECT_EQ(all.roughness, inner.roughness);
  EXPECT_EQ(all.folds, inner.folds);
  EXPECT_EQ(all.speed_max, inner.speed_max);
  EXPECT_NEAR(all.first_max, 4, 1e-6);  // 5 times as long, against the first
  // Shapes with a pose on one side only, or on none, are not inner shapes.
  beyond.poses = {1};
  beyond.extrapolated = 3;
  EXPECT_EQ(MeasureQuality(beyond).inner_shapes, 0);
  EXPECT_TRUE(std::isnan(MeasureQuality(beyond).edge_max));
  beyond.poses.clear();
  EXPECT_TRUE(std::isnan(MeasureQuality(beyond).roughness));
}

// With a metric of positions alone, the speed of a rigid motion is the body's speed.
TEST(GreatestSpeed, IsTheFastestSegmentOverTheMean) {
  const ShapeFamily sheet = MakeSheet(1, 1, 6, 6);
  const Shape flat = sheet.pose(0);
  MetricOptions options;
  options.strain = options.bending = 0;
  const auto metric = FreezeMetric(options, sheet.connectivity, {flat});
  const auto at = [&](double x) -> Shape { return flat.colwise() + Eigen::Vector3d(x, 0, 0); };
  const std::vector<Shape> waits = {at(0), at(1), at(2), at(4)};
  EXPECT_NEAR(GreatestSpeed(*metric, waits, {0, 1, 2, 3}), 1.5, 1e-12);
  EXPECT_NEAR(GreatestSpeed(*metric, waits, {0, 1, 2, 4}), 1, 1e-12);
  EXPECT_EQ(GreatestSpeed(*metric, {flat, flat, flat}, {0, 0.5, 1}), 1);
  const auto rigid = FreezeMetric(MetricOptions::Rigid(), sheet.connectivity, {flat});
  EXPECT_TRUE(std::isnan(GreatestSpeed(*rigid, waits, {0, 1, 2, 3})));
}

TEST(MeasureQuality, CountsFoldsThatThePosesDoNotHave) {
  const ShapeFamily sheet = MakeSheet(1, 1, 1, 1);  // two triangles, one hinge
  ASSERT_EQ(sheet.connectivity->NumHinges(), 1);
  const Shape flat = sheet.pose(0);
  const Eigen::Vector4i hinge = sheet.connectivity->Hinges().col(0);
  Shape folded = flat;  // one triangle onto the other
  folded.col(hinge(3)) = folded.col(hinge(2)) + Eigen::Vector3d(0, 0, 0.01);
  const PathQuality quality = MeasureQuality(MakePath(sheet, {flat, folded, flat}));
  EXPECT_EQ(quality.folds, 1);
  EXPECT_GT(quality.roughness, 170);
  // A fold that both ends have is not counted.
  EXPECT_EQ(MeasureQuality(MakePath(sheet, {folded, folded, folded})).folds, 0);
}

// A hinge is folded by 170 degrees to one side in the one pose and to the other side in the other.
TEST(MeasureQuality, AnglesOfHingesGoTheShortWayRound) {
  const ShapeFamily sheet = MakeSheet(1, 1, 1, 1);
  const Shape flat = sheet.pose(0);
  const Eigen::Vector4i hinge = sheet.connectivity->Hinges().col(0);
  const auto folded = [&](double degrees) {
    const Eigen::Vector3d from = flat.col(hinge(0)), along = flat.col(hinge(1)) - from;
    Shape shape = flat;
    shape.col(hinge(3)) = from + Eigen::AngleAxisd(degrees * M_PI / 180, along.normalized()) *
                                     Eigen::Vector3d(flat.col(hinge(3)) - from);
    return shape;
  };
  const auto roughness = [&](double degrees) {
    return MeasureQuality(MakePath(sheet, {folded(170), folded(degrees), folded(190)})).roughness;
  };
  EXPECT_LT(roughness(180), 1e-6);
  EXPECT_NEAR(roughness(177), 3, 1e-6);
  EXPECT_NEAR(roughness(0), 180, 1e-6);
}

TEST(EdgeDeviation, IsLocal) {
  const ShapeFamily sheet = MakeSheet(1, 1, 10, 10);
  const Shape flat = sheet.pose(0);
  Shape bumped = flat;
  bumped.col(0) += Eigen::Vector3d(0, 0, 0.1);
  const Path path = MakePath(sheet, {flat, bumped, flat});
  const Eigen::VectorXd deviation = EdgeDeviation(path, 1);
  EXPECT_GT(deviation(0), 0.1);
  int touched = 0;
  for (double d : deviation) touched += d > 1e-9;
  EXPECT_LT(touched, 8);  // the vertex and its neighbours
  EXPECT_EQ(EdgeDeviation(path, 2).maxCoeff(), 0);
}

}  // namespace
}  // namespace shapespace
