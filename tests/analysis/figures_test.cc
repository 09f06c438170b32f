// Every figure of small bodies, against values that are known.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/analysis/deviation_sites.h>
#include <shapespace/analysis/distance.h>
#include <shapespace/analysis/intersections.h>
#include <shapespace/analysis/near_pairs.h>
#include <shapespace/analysis/path_intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/analysis/shape_error.h>
#include <shapespace/analysis/vertex_energy.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/sheet.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

using testing::PathOf;
using testing::Refuses;
using testing::Rotation;

// A path with the shapes as they are.
Path Through(const MetricOptions& options, const std::shared_ptr<const Connectivity>& connectivity,
             const std::vector<Shape>& shapes, std::vector<int> poses,
             std::vector<double> parameters) {
  Path path;
  path.metric = FreezeMetric(options, connectivity, {shapes.front()});
  path.shapes = shapes;
  path.motions.resize(shapes.size());
  path.poses = std::move(poses);
  path.parameters = std::move(parameters);
  return path;
}

// Segments of these lengths, side by side.
Shape Segments(const std::vector<double>& lengths) {
  Shape shape = Shape::Zero(3, 2 * static_cast<int>(lengths.size()));
  for (size_t e = 0; e < lengths.size(); ++e) {
    shape.col(2 * e).y() = shape.col(2 * e + 1).y() = static_cast<double>(e);
    shape.col(2 * e + 1).x() = lengths[e];
  }
  return shape;
}

std::shared_ptr<const Connectivity> SegmentsConnectivity(int count) {
  std::vector<std::pair<int, int>> segments;
  for (int e = 0; e < count; ++e) segments.emplace_back(2 * e, 2 * e + 1);
  return Connectivity::Make(2 * count, {0}, {}, segments);
}

TEST(MeasureQuality, AllFiguresOfSegmentsInTwoPieces) {
  const std::vector<double> times = {0, 0.25, 1, 1.5, 2.5, 3};
  const std::vector<int> poses = {0, 2, 5};
  const std::vector<std::vector<double>> lengths = {{1, 2, 3},       {1.2, 2, 2.7}, {2, 1, 3},
                                                    {2.5, 1.5, 3.1}, {3, 2, 2},     {4, 3, 1}};
  std::vector<Shape> shapes;
  for (const auto& of_shape : lengths) shapes.push_back(Segments(of_shape));
  const Path path =
      Through(MetricOptions::Isometric(), SegmentsConnectivity(3), shapes, poses, times);
  const PathQuality quality = MeasureQuality(path);
  const Eigen::VectorXd& area = path.metric->edge_area;
  double squares = 0, first_squares = 0, most = 0, first_most = 0;
  for (int i = 1; i < 6; ++i) {
    for (int e = 0; e < 3; ++e) {
      const double off = lengths[i][e] / lengths[0][e] - 1;
      first_squares += area(e) * off * off;
      first_most = std::max(first_most, std::abs(off));
    }
  }
  for (const auto& [i, a, b, t] :
       {std::make_tuple(1, 0, 2, 0.25), {3, 2, 5, 0.25}, {4, 2, 5, 0.75}}) {
    for (int e = 0; e < 3; ++e) {
      const double straight =
          std::sqrt((1 - t) * std::pow(lengths[a][e], 2) + t * std::pow(lengths[b][e], 2));
      const double off = lengths[i][e] / straight - 1;
      squares += area(e) * off * off;
      most = std::max(most, std::abs(off));
    }
  }
  EXPECT_EQ(quality.inner_shapes, 3);
  EXPECT_NEAR(quality.edge_rms, std::sqrt(squares / (3 * area.sum())), 1e-12);
  EXPECT_NEAR(quality.edge_max, most, 1e-6);
  EXPECT_NEAR(quality.first_rms, std::sqrt(first_squares / (5 * area.sum())), 1e-12);
  EXPECT_NEAR(quality.first_max, first_most, 1e-6);
  EXPECT_TRUE(std::isnan(quality.roughness));  // there is no hinge
  EXPECT_EQ(quality.folds, 0);
  const RmsAndMax third = DeviationFromFirst(path, 3);
  EXPECT_NEAR(third.max, 1.5, 1e-6);
  EXPECT_NEAR(third.rms, std::sqrt((area(0) * 2.25 + area(1) / 16 + area(2) / 900) / area.sum()),
              1e-12);
  EXPECT_EQ(DeviationFromFirst(path, 0).max, 0);
}

TEST(MeasureQuality, TheGreatestSpeedIsThatOfAnyPiece) {
  const auto connectivity = SegmentsConnectivity(2);
  MetricOptions options;
  options.strain = 0;  // positions alone
  options.bending = 0;
  const Shape rest = Segments({1, 2});
  const auto speed = [&](const std::vector<double>& at) {
    std::vector<Shape> shapes;
    for (const double x : at) shapes.push_back(rest.colwise() + Eigen::Vector3d(x, 0, 0));
    return MeasureQuality(Through(options, connectivity, shapes, {0, 2, 4}, {0, 1, 2, 3, 4}))
        .speed_max;
  };
  EXPECT_NEAR(speed({0, 3, 4, 5, 6}), 1.5, 1e-9);
  EXPECT_NEAR(speed({0, 1, 2, 5, 6}), 1.5, 1e-9);
  EXPECT_NEAR(speed({0, 1, 2, 12, 22}), 1, 1e-9);
}

// One hinge.
struct Hinge {
  ShapeFamily sheet = MakeSheet(1, 1, 1, 1);
  Shape flat = sheet.pose(0);

  Shape Folded(double degrees) const {
    const Eigen::Vector4i hinge = sheet.connectivity->Hinges().col(0);
    const Eigen::Vector3d from = flat.col(hinge(0)), along = flat.col(hinge(1)) - from;
    Shape shape = flat;
    shape.col(hinge(3)) =
        from + Rotation(degrees, along) * Eigen::Vector3d(flat.col(hinge(3)) - from);
    return shape;
  }
};

TEST(MeasureQuality, FoldsAreBeyond120DegreesAnd40DegreesBeyondBothPoses) {
  const Hinge hinge;
  const auto folds = [&](double first, double between, double last) {
    return MeasureQuality(
               Through({}, hinge.sheet.connectivity,
                       {hinge.Folded(first), hinge.Folded(between), hinge.flat, hinge.Folded(last)},
                       {0, 3}, {0, 0.3, 0.6, 1}))
        .folds;
  };
  EXPECT_EQ(folds(0, 121, 0), 0.5);
  EXPECT_EQ(folds(0, -121, 0), 0.5);
  EXPECT_EQ(folds(0, 119, 0), 0);
  EXPECT_EQ(folds(80, 121, 0), 0.5);
  EXPECT_EQ(folds(82, 121, 0), 0);
  EXPECT_EQ(folds(0, 121, 82), 0);
  EXPECT_EQ(folds(0, 121, -82), 0);
  EXPECT_EQ(folds(-80, 121, 80), 0.5);
}

TEST(MeasureQuality, RoughnessIsTheMeanOverShapesAndHinges) {
  const ShapeFamily sheet = MakeSheet(2, 1, 4, 1);
  const Shape flat = sheet.pose(0);
  const auto folded = [&](double degrees) {
    Shape shape = flat;
    for (auto p : shape.colwise()) {
      if (p.x() > 0.4) {
        const Eigen::Vector3d crease(0.5, 0, 0);
        p = crease + Rotation(degrees, Eigen::Vector3d::UnitY()) * (p - crease).eval();
      }
    }
    return shape;
  };
  const Path path = Through({}, sheet.connectivity, {flat, folded(7), folded(-20), folded(40)},
                            {0, 3}, {0, 1, 3, 4});
  const Eigen::VectorXd angles = DihedralAngles(*sheet.connectivity, folded(40));
  double crease = 0;
  for (int h = 0; h < angles.size(); ++h) {
    if (std::abs(angles(h)) > 0.1) crease += path.metric->hinge_area(h);
  }
  ASSERT_GT(crease, 0);
  // 10 and 30 degrees are expected.
  EXPECT_NEAR(MeasureQuality(path).roughness,
              std::sqrt((9. + 2500.) / 2 * crease / path.metric->hinge_area.sum()), 1e-9);
}

TEST(EdgeDeviation, IsTheMeanOverTheEdgesWeightedByTheirAreas) {
  const auto connectivity = Connectivity::Make(5, {0}, {}, {{0, 1}, {1, 2}, {2, 3}});
  Shape first = Shape::Zero(3, 5), now = first;
  first.row(0) << 0, 1, 3, 3, 9;
  now.row(0) << 0, 1.3, 2.5, 2.5, 7;  // the first edge is longer, the second shorter
  const auto metric = FreezeMetric(MetricOptions::Isometric(), connectivity, {first});
  const Eigen::VectorXd deviation = EdgeDeviation(*metric, first, now);
  const double a = metric->edge_area(0), b = metric->edge_area(1);
  ASSERT_GT(std::abs(a - b), 1e-3);
  EXPECT_NEAR(deviation(0), 0.3, 1e-12);
  EXPECT_NEAR(deviation(1), (a * 0.3 + b * 0.4) / (a + b), 1e-12);
  EXPECT_NEAR(deviation(2), 0.4, 1e-12);  // an edge without length does not count
  EXPECT_EQ(deviation(3), 0);
  EXPECT_EQ(deviation(4), 0);
}

TEST(CompareShapes, AHingeIsInvertedBeyond90DegreesOnTheShortWayRound) {
  const Hinge hinge;
  const auto metric = FreezeMetric({}, hinge.sheet.connectivity, {hinge.flat});
  const auto inverted = [&](double before, double after) {
    return CompareShapes(metric, hinge.Folded(before), hinge.Folded(after)).inverted_hinges;
  };
  EXPECT_EQ(inverted(0, 91), 1);
  EXPECT_EQ(inverted(0, -91), 1);
  EXPECT_EQ(inverted(0, 89), 0);
  EXPECT_EQ(inverted(60, -31), 1);
  EXPECT_EQ(inverted(60, -29), 0);
  EXPECT_EQ(inverted(170, -170), 0);
}

TEST(CompareShapes, ThePercentileIsThatOfTheEdges) {
  std::vector<double> before(201, 2), after;
  for (int e = 0; e <= 200; ++e) after.push_back(2 * (1 - 1e-3 * e));
  const auto connectivity = SegmentsConnectivity(201);
  const Shape reference = Segments(before);
  const auto metric = FreezeMetric(MetricOptions::Isometric(), connectivity, {reference});
  const ShapeError error = CompareShapes(metric, reference, Segments(after));
  EXPECT_NEAR(error.edge_max, 0.2, 1e-6);
  EXPECT_NEAR(error.edge_p99, 0.198, 1e-6);
  EXPECT_NEAR(error.edge_rms, std::sqrt(200 * 201 * 401 / 6. / 201) * 1e-3, 1e-9);
}

TEST(VertexEnergy, OfOneShapeIsNone) {
  const ShapeFamily sheet = MakeSheet(1, 1, 2, 2);
  const std::vector<Eigen::VectorXd> energies =
      VertexEnergy(Through({}, sheet.connectivity, {sheet.pose(0)}, {0}, {0}));
  ASSERT_EQ(energies.size(), 1u);
  EXPECT_EQ(energies[0], Eigen::VectorXd::Zero(9));
}

FourPoints Columns(const std::array<Eigen::Vector3d, 4>& points) {
  FourPoints result;
  for (int k = 0; k < 4; ++k) result.col(k) = points[k];
  return result;
}

TEST(NearestPointsTest, CoefficientsAreThoseOfTheNearestPoints) {
  const auto of_triangle = [](double x, double y, double z) -> Eigen::Vector4d {
    return NearestPoints(PairKind::kVertexTriangle,
                         Columns({Eigen::Vector3d(x, y, z), {0, 0, 0}, {3, 0, 0}, {0, 3, 0}}))
        .coefficients;
  };
  const auto expect = [](const Eigen::Vector4d& is, const Eigen::Vector4d& expected) {
    EXPECT_LT((is - expected).norm(), 1e-14) << is.transpose();
  };
  expect(of_triangle(1, 0.5, 2), {1, -1. / 2, -1. / 3, -1. / 6});
  expect(of_triangle(1, -3, 4), {1, -2. / 3, -1. / 3, 0});
  expect(of_triangle(3, 1.5, 1), {1, 0, -0.75, -0.25});
  expect(of_triangle(-1, 1, -2), {1, -2. / 3, 0, -1. / 3});
  const Separation edges = NearestPoints(
      PairKind::kEdgeEdge, Columns({Eigen::Vector3d(0, 0, 0), {4, 0, 0}, {1, -1, 3}, {1, 4, 3}}));
  expect(edges.coefficients, {0.75, 0.25, -0.8, -0.2});
  EXPECT_LT((edges.difference - Eigen::Vector3d(0, 0, -3)).norm(), 1e-14);
}

TEST(RelativeSpeedTest, IsTheSumOfTheGreatestOfBothElements) {
  FourPoints velocities = Columns({Eigen::Vector3d(-1, 0, 0), {3, 0, 0}, {-2, 6, 0}, {0, -6, 0}});
  velocities.colwise() += Eigen::Vector3d(70, -80, 90);
  EXPECT_NEAR(RelativeSpeed(PairKind::kVertexTriangle, velocities), 1 + std::sqrt(40.), 1e-12);
  EXPECT_NEAR(RelativeSpeed(PairKind::kEdgeEdge, velocities), 3 + std::sqrt(40.), 1e-12);
}

TEST(SafeStepTest, EnoughIsTheLeastDistanceWhereItIsLess) {
  const FourPoints points = Columns({Eigen::Vector3d(1, 1, 2), {0, 0, 0}, {3, 0, 0}, {0, 3, 0}});
  FourPoints velocities = FourPoints::Zero();
  velocities(2, 0) = -6;
  velocities.row(2).tail(3).setConstant(2);
  const auto step = [&](double kept, double enough) {
    return SafeStep(PairKind::kVertexTriangle, points, velocities, kept, enough);
  };
  EXPECT_NEAR(step(0.25, 0.1), 1.9 / 8, 1e-12);
  EXPECT_NEAR(step(0.25, 0.7), 1.5 / 8, 1e-12);
}

// Two triangles, the second above the first, and how near they come.
struct Two {
  std::shared_ptr<const Connectivity> connectivity =
      Connectivity::FromTriangles(6, (Eigen::Matrix3Xi(3, 2) << 0, 3, 1, 4, 2, 5).finished());
  static Shape At(double height) {
    Shape shape(3, 6);
    shape << 0, 3, 0, 0.2, 2.5, 0.1,  //
        0, 0, 3, 0.1, 0.2, 2,         //
        0, 0, 0, height, height, height;
    return shape;
  }
};

TEST(NearPairsTest, PairsAreNearFromTheTimeAtWhichTheirGapIsTheMargin) {
  const Two two;
  const NearPairs pairs(two.connectivity, {two.At(1)}, 6);
  const auto times = [&](double from, double to, float begin, float end) {
    const std::vector<NearPair> found = pairs.Find(two.At(from), two.At(to), 0, 0.25);
    EXPECT_FALSE(found.empty());
    for (const NearPair& pair : found) {
      EXPECT_NEAR(pair.begin, begin, 1e-6);
      EXPECT_LE(pair.begin, begin);
      EXPECT_NEAR(pair.end, end, 1e-6);
      EXPECT_GE(pair.end, end);
    }
    return found.size();
  };
  const size_t near = times(1, 0, 0.75f, 1);
  EXPECT_EQ(times(0, 1, 0, 0.25f), near);
  EXPECT_EQ(times(1, -1, 0.375f, 0.625f), near);
  EXPECT_EQ(times(0.1, 0.2, 0, 1), near);
  EXPECT_TRUE(pairs.Find(two.At(1), two.At(0.26), 0, 0.25).empty());
  EXPECT_TRUE(pairs.Find(two.At(-1), two.At(-0.26), 0, 0.25).empty());
}

TEST(NearPairsTest, TheExemptAreNeighboursInBothOrders) {
  const Two two;
  const NearPairs all(two.connectivity, {two.At(0.1)}, 6);
  const auto has = [](const NearPair& pair, int first, int second) {
    const int size = FirstElementSize(pair.kind);
    bool in_first = false, in_second = false;
    for (int i = 0; i < 4; ++i) {
      (i < size ? in_first : in_second) |= pair.vertices[i] == (i < size ? first : second);
    }
    return in_first && in_second;
  };
  size_t expected = 0;
  const std::vector<NearPair> found = all.Find(two.At(0.1), two.At(0.1), 0, 0.2);
  for (const NearPair& pair : found) expected += !has(pair, 1, 4) && !has(pair, 4, 1);
  ASSERT_LT(expected, found.size());
  for (const std::pair<int, int>& exempt : {std::make_pair(1, 4), std::make_pair(4, 1)}) {
    const NearPairs but(two.connectivity, {two.At(0.1)}, 6, {exempt});
    EXPECT_EQ(but.Find(two.At(0.1), two.At(0.1), 0, 0.2).size(), expected);
  }
}

TEST(NearPairsTest, LengthsAreMeansOverEdgesAndShapes) {
  const auto connectivity =
      Connectivity::FromTriangles(3, (Eigen::Matrix3Xi(3, 1) << 0, 1, 2).finished());
  Shape shape = Shape::Zero(3, 3);
  shape(0, 1) = 3;
  shape(1, 2) = 4;  // sides of 3, 4 and 5
  const NearPairs pairs(connectivity, {shape, 3 * shape}, 3);
  EXPECT_NEAR(pairs.Length(0), 7, 1e-12);
  EXPECT_NEAR(pairs.Length(1), 8, 1e-12);
  EXPECT_NEAR(pairs.Length(2), 9, 1e-12);
  EXPECT_NEAR(pairs.Length(NearPair{PairKind::kVertexTriangle, {2, 1, 0, 1}, 0, 1}), 7, 1e-12);
  EXPECT_NEAR(pairs.Length(NearPair{PairKind::kEdgeEdge, {2, 1, 1, 2}, 0, 1}), 8, 1e-12);
  EXPECT_TRUE(Refuses<MeshError>(
      [&] {
        NearPairs(connectivity, {shape, Shape::Zero(3, 4)}, 3);
      },
      {"contact:"}));
}

// A triangle in the middle that passes through two others or one of them or none.
struct Three {
  std::shared_ptr<const Connectivity> connectivity = Connectivity::FromTriangles(
      9, (Eigen::Matrix3Xi(3, 3) << 0, 3, 6, 1, 4, 7, 2, 5, 8).finished());
  static Shape Pairs(int count) {
    Shape shape(3, 9);
    const double reach = count > 0 ? 1.2 : 0.2, below = count > 1 ? -1.2 : -0.2;
    shape << 0, 3, 0, 0.5, 0.7, 0.5, 0, 3, 0,  //
        0, 0, 3, 0.5, 0.5, 0.9, 0, 0, 3,       //
        1, 1, 1, below, reach, reach, -1, -1, -1;
    return shape;
  }
};

TEST(FindIntersections, ListsPairsInAscendingOrder) {
  const Three three;
  using Pairs = std::vector<std::pair<int, int>>;
  EXPECT_EQ(FindIntersections(*three.connectivity, three.Pairs(2)), (Pairs{{0, 1}, {1, 2}}));
  EXPECT_EQ(FindIntersections(*three.connectivity, three.Pairs(1)), (Pairs{{0, 1}}));
  EXPECT_EQ(CountIntersections(*three.connectivity,
                               std::vector<Shape>{three.Pairs(2), three.Pairs(0), three.Pairs(1)}),
            (std::vector<std::int64_t>{2, 0, 1}));
  EXPECT_TRUE(Refuses<MeshError>([&] { FindIntersections(*three.connectivity, Shape::Zero(3, 8)); },
                                 {"intersections:", "8", "9"}));
  const Shape nowhere = Shape::Constant(3, 9, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(Refuses<MeshError>([&] { FindIntersections(*three.connectivity, nowhere); },
                                 {"intersections:"}));
}

TEST(MeasureIntersections, TheMostAreOfOneShapeAndTheMeansOfInnerShapes) {
  const Three three;
  std::vector<Shape> shapes;
  for (const int count : {1, 2, 1, 0, 2, 1}) shapes.push_back(three.Pairs(count));
  Path path = PathOf(three.connectivity, shapes);
  path.poses = {0, 3, 5};
  const PathIntersections figures = MeasureIntersections(path);
  EXPECT_EQ(figures.pairs, (std::vector<std::int64_t>{1, 2, 1, 0, 2, 1}));
  EXPECT_EQ(figures.poses_max, 1);
  EXPECT_EQ(figures.inner_max, 2);
  EXPECT_NEAR(figures.inner_mean, 5. / 3, 1e-12);
  EXPECT_NEAR(figures.beyond_poses, 2. / 3, 1e-12);
}

TEST(FindRigidParts, AllFiguresOfAFoldOffTheMiddleAndTheOrigin) {
  const ShapeFamily sheet = MakeSheet(2, 1, 20, 10);
  const Eigen::Vector3d place(5, -2, 3);
  std::vector<Shape> shapes;
  for (const double degrees : {0., -80., -30.}) {
    Shape shape = sheet.pose(0);
    for (auto p : shape.colwise()) {
      const Eigen::Vector3d crease(0.4, 0, 0);
      if (p.x() > 0.4) {
        p = crease + Rotation(degrees, Eigen::Vector3d::UnitY()) * (p - crease).eval();
      }
    }
    shapes.push_back(10 * (shape.colwise() + place));
  }
  const RigidParts result = FindRigidParts(PathOf(sheet.connectivity, shapes));
  ASSERT_EQ(result.parts.size(), 2u);
  const RigidPart &large = result.parts[0], &small = result.parts[1];
  EXPECT_EQ(large.num_triangles, 280);
  EXPECT_EQ(small.num_triangles, 120);
  EXPECT_EQ(large.num_vertices, 15 * 11);
  EXPECT_EQ(small.num_vertices, 6 * 11);
  EXPECT_NEAR(large.area_share, 0.7, 1e-9);
  EXPECT_NEAR(small.area_share, 0.3, 1e-9);
  EXPECT_LT((large.centre - 10 * (place - Eigen::Vector3d(0.3, 0, 0))).norm(), 1e-8);
  EXPECT_LT((small.centre - 10 * (place + Eigen::Vector3d(0.7, 0, 0))).norm(), 1e-8);
  EXPECT_EQ(large.turn, 0);
  EXPECT_NEAR(small.turn, 80, 1e-6);
  EXPECT_LT(result.joint_share, 1e-9);
  for (const RigidPart& part : result.parts) {
    EXPECT_LT(part.relative_residual, 1e-9);
    EXPECT_LT(part.edge_deviation, 1e-9);
  }
}

TEST(RigidPartsOptions, SayWhichFieldIsOutOfItsRange) {
  RigidPartsOptions options;
  options.tolerance = options.least_share = 1;
  options.Validate();
  options.tolerance = 1.001;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { options.Validate(); }, {"tolerance:", "0", "1"}));
  options.tolerance = 0.1;
  options.least_share = 1.001;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { options.Validate(); }, {"least_share:", "0", "1"}));
  options.least_share = 0.1;
  options.most_deviation = -1;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { options.Validate(); }, {"most_deviation:"}));
}

TEST(FindDeviationSites, AllFiguresOfABumpThatGoesBack) {
  const ShapeFamily sheet = MakeSheet(2, 1, 20, 10);
  const Eigen::Vector3d place(5, -2, 3);
  const Shape flat = 10 * (sheet.pose(0).colwise() + place);
  Eigen::Index top = 0;
  (flat.colwise() - 10 * (place + Eigen::Vector3d(0.4, 0.2, 0)))
      .colwise()
      .squaredNorm()
      .minCoeff(&top);
  std::vector<Shape> shapes = {flat, flat, flat};
  shapes[1](2, top) += 2;
  shapes[2](2, top) += 1;
  const Path path = PathOf(sheet.connectivity, shapes);
  const std::vector<DeviationSite> sites = FindDeviationSites(path, FindRigidParts(path));
  ASSERT_EQ(sites.size(), 1u);
  const Eigen::VectorXd deviation = EdgeDeviation(path, 1), &area = path.metric->vertex_area;
  EXPECT_EQ(sites[0].vertex, top);
  EXPECT_LT((sites[0].position - flat.col(top)).norm(), 1e-9);
  EXPECT_NEAR(sites[0].largest, deviation(top), 1e-12);
  const double total = deviation.cwiseAbs2().dot(area);
  double share = 0, area_share = 0;
  for (int v = 0; v < area.size(); ++v) {
    if (deviation(v) * deviation(v) <= total / area.sum()) continue;
    share += area(v) * deviation(v) * deviation(v) / total;
    area_share += area(v) / area.sum();
  }
  EXPECT_NEAR(sites[0].share, share, 1e-9);
  EXPECT_NEAR(sites[0].area_share, area_share, 1e-9);
  EXPECT_LT(area_share, 0.06);
}

}  // namespace
}  // namespace shapespace
