#include <shapespace/metric/metric.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/path/energy.h>

#include "mesh/bodies.h"
#include "support/features.h"
#include "support/paths.h"
#include "support/stiffened.h"
#include "support/whiskered.h"

namespace shapespace {
namespace {

const double kPi = M_PI;

using testing::Get;

// Two triangles over the edge from (0,0,0) to (1,0,0), bent along it by `angle`.
Eigen::Matrix<double, 3, 4> Hinge(double angle) {
  Eigen::Matrix<double, 3, 4> x;
  x.col(0) = Eigen::Vector3d(0, 0, 0);
  x.col(1) = Eigen::Vector3d(1, 0, 0);
  x.col(2) = Eigen::Vector3d(0.4, 1, 0);
  x.col(3) = Eigen::Vector3d(0.7, -2 * std::cos(angle), -2 * std::sin(angle));
  return x;
}

TEST(Dihedral, AngleIsThatOfTheNormalsPositiveWhenConvex) {
  Dihedral dihedral;
  dihedral.normal_epsilon_squared = dihedral.edge_epsilon_squared = 1e-30;
  for (double angle : {0.0, 0.3, 1.5, 3.0, -0.3, -1.5, -3.0}) {
    EXPECT_NEAR(dihedral.Angle(Hinge(angle).data()), angle, 1e-14);
  }
}

// A hinge is weighted by the two poses that differ most, wherever they stand in the list.
TEST(Dihedral, WeightOfAllPairsIsTheLeastOfAnyPair) {
  const auto mesh = Connectivity::Make(4, {0, 3, 6}, {0, 1, 2, 1, 0, 3});
  const auto weight = [&](const std::vector<double>& angles, PosePairs pairs) {
    std::vector<Shape> poses;
    for (const double angle : angles) poses.emplace_back(Hinge(angle));
    return Get<Dihedral>(*FreezeMetric({}, mesh, poses, 0, pairs)).weights(0);
  };
  for (const std::vector<double>& angles :
       {std::vector<double>{0.1, 1.2, -0.4}, std::vector<double>{-1.9, 0.3, 1.4, 0.2, -0.7},
        std::vector<double>{1.0, 1.0, 1.0}, std::vector<double>{-1.5, -0.2, 0.9, 1.7, 2.0}}) {
    double least = weight({angles[0], angles[0]}, PosePairs::kConsecutive);
    for (const double a : angles) {
      for (const double b : angles) {
        least = std::min(least, weight({a, b}, PosePairs::kConsecutive));
      }
    }
    EXPECT_NEAR(weight(angles, PosePairs::kAll), least, 1e-12 * least);
  }
}

TEST(Dihedral, CollapsedHingesHaveFiniteValues) {
  Dihedral dihedral;
  dihedral.normal_epsilon_squared = dihedral.edge_epsilon_squared = 1e-20;
  const Eigen::Matrix<double, 3, 4> point = Eigen::Matrix<double, 3, 4>::Zero();
  double value[2];
  dihedral(point.data(), value);
  EXPECT_TRUE(std::isfinite(value[0]) && std::isfinite(value[1]));
  double k[4];
  const Eigen::Vector3d points[4] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  dihedral.ScalarRows(points, k);
  for (double entry : k) EXPECT_TRUE(std::isfinite(entry));
}

TEST(Dihedral, LeastChangeIsThatOfEqualAnglesAcrossTheWrap) {
  Dihedral dihedral;
  const auto at = [](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
  const Eigen::Vector2d a = at(3.0), b = at(-2.8);
  const double way = 2 * kPi - 5.8;  // the short way leads over pi
  double walked = 0;
  for (int i = 0; i < 5; ++i) {
    walked += (at(3.0 + way * (i + 1) / 5) - at(3.0 + way * i / 5)).squaredNorm();
  }
  EXPECT_NEAR(dihedral.LeastChange(a.data(), b.data(), 5), walked, 1e-14);
}

TEST(FreezeMetric, WeightsDoNotDependOnTheUnitOfLength) {
  const ShapeFamily bar = testing::Stiffened(MakeBar(6, 1, 1, 6, 2, 2));
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(60)};
  MetricOptions options;
  options.isometric = 1;
  options.volume = 0.3;
  options.strain = 0.1;
  const auto metric = FreezeMetric(options, bar.connectivity, poses);
  for (double scale : {1e-4, 1e4}) {
    const auto scaled =
        FreezeMetric(options, bar.connectivity, {scale * poses[0], scale * poses[1]});
    EXPECT_NEAR(scaled->unit, scale * metric->unit, 1e-12 * scale);
    ASSERT_EQ(scaled->features.size(), metric->features.size());
    EXPECT_TRUE(Get<EdgeLength>(*scaled).weights.isApprox(Get<EdgeLength>(*metric).weights, 1e-12));
    EXPECT_TRUE(Get<LogLength>(*scaled).weights.isApprox(Get<LogLength>(*metric).weights, 1e-12));
    EXPECT_TRUE(Get<PositionFeature>(*scaled).weights.isApprox(
        Get<PositionFeature>(*metric).weights, 1e-12));
    EXPECT_TRUE(Get<Dihedral>(*scaled).weights.isApprox(Get<Dihedral>(*metric).weights, 1e-12));
    EXPECT_NEAR(Get<VolumeFeature>(*scaled).reference, Get<VolumeFeature>(*metric).reference,
                1e-12);
  }
}

TEST(FreezeMetric, AreasAddUpToOne) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0)});
  EXPECT_NEAR(metric->vertex_area.sum(), 1, 1e-12);
  EXPECT_NEAR(metric->edge_area.sum(), 1, 1e-12);   // three edges a triangle, a third each
  EXPECT_NEAR(metric->hinge_area.sum(), 1, 1e-12);  // closed: every edge is a hinge
}

TEST(FreezeMetric, GraphsHaveTotalLengthOne) {
  const auto path = Connectivity::Make(3, {0}, {}, {{0, 1}, {1, 2}});
  Shape shape(3, 3);
  shape << 0, 1, 4, 0, 0, 0, 0, 0, 0;
  const auto metric = FreezeMetric({}, path, {shape});
  EXPECT_NEAR(metric->unit, 4, 1e-14);
  EXPECT_NEAR(metric->edge_area(0), 0.25, 1e-14);
  EXPECT_NEAR(metric->edge_area(1), 0.75, 1e-14);
  EXPECT_NEAR(metric->vertex_area(1), 0.5, 1e-14);
}

TEST(FreezeMetric, SegmentsWithoutTrianglesWeighAboutAsMuchAsEdgesOfTheSurface) {
  const testing::WhiskeredBar bar(12, 3);  // cells of about the segments' length
  const Shape pose = bar.Pose(0, {1, 0, 0});
  const auto metric = FreezeMetric({}, bar.connectivity, {pose});
  const int sides = bar.connectivity->NumTriangleEdges();
  const double mean = metric->edge_area.head(sides).mean();
  EXPECT_GT(metric->edge_area.tail(bar.kSegments).minCoeff(), mean / 4);
  EXPECT_LT(metric->edge_area.tail(bar.kSegments).maxCoeff(), 4 * mean);

  const auto scaled = FreezeMetric({}, bar.connectivity, {1e6 * pose});
  EXPECT_TRUE(scaled->edge_area.isApprox(metric->edge_area, 1e-12));
  EXPECT_TRUE(scaled->vertex_area.isApprox(metric->vertex_area, 1e-12));
}

// In a regular mesh, inner vertices have one area and inner edges another. An edge that is no side
// of a triangle has the area of its neighbours, whether it is a stiffener or a segment.
TEST(FreezeMetric, EdgesWithoutTrianglesWeighAsThoseBesideThem) {
  const Soup grid = testing::Grid(4, 4);
  const std::vector<std::pair<int, int>> others = {{7, 11}, {6, 18}};
  for (const bool stiffen : {true, false}) {
    const auto connectivity = Connectivity::Make(
        25, grid.polygon_begin, grid.corners, stiffen ? std::vector<std::pair<int, int>>() : others,
        stiffen ? others : std::vector<std::pair<int, int>>());
    const auto metric = FreezeMetric({}, connectivity, {grid.vertices});
    const Eigen::Matrix2Xi& edges = connectivity->Edges();
    int side = 0;
    while (edges.col(side) != Eigen::Vector2i(7, 12)) ASSERT_LT(++side, edges.cols());
    ASSERT_EQ(connectivity->NumEdges(), connectivity->NumTriangleEdges() + 2);
    for (const double area : metric->edge_area.tail(2)) {
      EXPECT_NEAR(area, metric->edge_area(side), 1e-14) << stiffen;
    }
  }
}

// Cells of the surface are unit squares, 16 for its 25 vertices.
TEST(FreezeMetric, AChainOfAnyLengthIsAStripAsWideAsTheSurfacesCells) {
  for (const int length : {3, 60}) {
    const Soup grid = testing::Grid(4, 4);
    Shape pose(3, 25 + length);
    pose.leftCols(25) = grid.vertices;
    std::vector<std::pair<int, int>> chain;
    for (int k = 0; k < length; ++k) {
      pose.col(25 + k) = grid.vertices.col(24) + (k + 1) * Eigen::Vector3d::UnitZ();
      chain.emplace_back(24 + k, 25 + k);
    }
    const auto connectivity =
        Connectivity::Make(25 + length, grid.polygon_begin, grid.corners, chain);
    const auto metric = FreezeMetric({}, connectivity, {pose});
    EXPECT_NEAR(metric->vertex_area(25) / metric->vertex_area(12), 0.8, 1e-12) << length;
  }
}

// A chain between two triangles, and the same mesh with its vertices and elements in reverse.
TEST(FreezeMetric, AreasOfSegmentsDoNotDependOnTheOrderOfVertices) {
  const int count = 8;
  const auto there =
      Connectivity::Make(count, {0, 3, 6}, {0, 1, 2, 5, 6, 7}, {{2, 3}, {3, 4}, {4, 5}});
  const auto back =
      Connectivity::Make(count, {0, 3, 6}, {0, 1, 2, 5, 6, 7}, {{4, 5}, {3, 4}, {2, 3}});
  Shape shape(3, count);
  shape << 0, 0, 1, 2, 3.5, 4, 6, 6,  //
      -1, 1, 0, 0, 0, 0, -2, 2,       //
      0, 0, 0, 1, 0, 0, 0, 0;
  const Shape reversed = shape.rowwise().reverse();
  const auto metric = FreezeMetric({}, there, {shape});
  const auto other = FreezeMetric({}, back, {reversed});
  EXPECT_TRUE(other->vertex_area.isApprox(metric->vertex_area.reverse(), 1e-14));
  for (int e = 0; e < there->NumEdges(); ++e) {
    const Eigen::Vector2i edge = there->Edges().col(e);
    int twin = 0;
    while (back->Edges().col(twin) != Eigen::Vector2i(count - 1 - edge(1), count - 1 - edge(0))) {
      ASSERT_LT(++twin, back->NumEdges());
    }
    EXPECT_NEAR(other->edge_area(twin), metric->edge_area(e), 1e-14) << e;
    EXPECT_GT(metric->edge_area(e), 1e-3) << e;
  }
}

// With the paper's w_e = 1 the meaning of lambda depends on the resolution; with area weights it
// does not.
TEST(FreezeMetric, RatioOfPartsSurvivesRefinementWithAreaWeightsOnly) {
  const auto ratio = [](int n, const MetricOptions& options) {
    const ShapeFamily bar = MakeBar(6, 1, 1, 6 * n, n, n);
    const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(90)});
    std::vector<Shape> shapes;
    for (int i = 0; i <= 8; ++i) shapes.push_back(bar.pose(90 * i / 8.0) / metric->unit);
    PathEnergy energy(metric, 7);
    std::vector<double> unknowns(energy.Size());
    energy.Load(shapes, unknowns.data());
    const std::vector<double> parts = energy.Parts(unknowns.data());
    return parts[0] / parts[1];
  };
  MetricOptions area = MetricOptions::Isometric();
  area.bending = 0;
  MetricOptions uniform = area;
  uniform.weights = Weighting::kUniform;
  EXPECT_NEAR(ratio(4, area) / ratio(2, area), 1, 0.15);
  EXPECT_NEAR(ratio(8, area) / ratio(4, area), 1, 0.1);
  EXPECT_GT(ratio(2, uniform) / ratio(4, uniform), 3);
}

TEST(FreezeMetric, TheRigidMetricWeighsVerticesByAreaOrAlike) {
  const ShapeFamily sheet = MakeSheet(1, 1, 4, 4);
  MetricOptions options = MetricOptions::Rigid();
  options.rigid = 2;
  const auto weights = [&] {
    return FreezeMetric(options, sheet.connectivity, {sheet.pose(0)})->rigid.weights;
  };
  EXPECT_NEAR(weights().sum(), 2, 1e-12);  // the area is 1 in the metric's unit
  EXPECT_GT(weights().maxCoeff(), 2 * weights().minCoeff());
  options.weights = Weighting::kUniform;
  EXPECT_EQ(weights().minCoeff(), 2);
  EXPECT_EQ(weights().maxCoeff(), 2);
}

TEST(FreezeMetric, HingesFoldedOrJumpingInThePosesAreLetGo) {
  const auto hinge = Connectivity::Make(4, {0, 3, 6}, {0, 1, 2, 1, 0, 3});
  const auto weight = [&](double first, double last) {
    const auto metric = FreezeMetric({}, hinge, {Hinge(first), Hinge(last)});
    return Get<Dihedral>(*metric).weights(0);
  };
  const double calm = weight(0, 0.01);
  EXPECT_NEAR(weight(0, kPi / 3) / calm, 0.5, 1e-3);           // u = 1
  EXPECT_NEAR(weight(0, 2 * kPi / 3) / calm, 1 / 17.0, 1e-3);  // u = 2
  EXPECT_LT(weight(2.6, 2.6) / calm, 0.03);                    // folded in both, no jump
  EXPECT_NEAR(weight(2, 2) / calm, 1, 1e-3);                   // 115 degrees is no fold yet
  EXPECT_NEAR(weight(3, -3) / weight(3, 3), 1, 1e-9);          // the jump is 16 degrees, not 344
}

TEST(FreezeMetric, TheEnclosedVolumeIsThatOfTheBodyFarFromTheOrigin) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  MetricOptions options;
  options.volume = 1;
  const Shape near = bar.pose(30);
  const Shape far = near.colwise() + 1e6 * Eigen::Vector3d(1, -2, 3);
  EXPECT_NEAR(Get<VolumeFeature>(*FreezeMetric(options, bar.connectivity, {far})).reference,
              Get<VolumeFeature>(*FreezeMetric(options, bar.connectivity, {near})).reference, 1e-9);
}

TEST(FreezeMetric, SaysThatNothingBendsWhereNoTrianglesOrSegmentsFollowEachOther) {
  MetricOptions options;
  options.bending = 1e-3;
  Shape points(3, 3);
  points << 0, 1, 1, 0, 0, 1, 0, 0, 0;
  const auto segment = Connectivity::Make(3, {0}, {}, {{0, 1}});
  EXPECT_EQ(FreezeMetric(options, segment, {points})->options.bending, 0);
  const auto curve = Connectivity::Make(3, {0}, {}, {{0, 1}, {1, 2}});
  EXPECT_EQ(FreezeMetric(options, curve, {points})->options.bending, 1e-3);
  const auto triangle = Connectivity::Make(3, {0, 3}, {0, 1, 2});
  EXPECT_EQ(FreezeMetric(options, triangle, {points})->options.bending, 0);
  const ShapeFamily sheet = MakeSheet(1, 1, 3, 3);
  EXPECT_EQ(FreezeMetric(options, sheet.connectivity, {sheet.pose(0)})->options.bending, 1e-3);
}

TEST(FreezeMetric, RefusesWhatItCannotFreeze) {
  const ShapeFamily sheet = MakeSheet(1, 1, 3, 3);
  const Shape flat = sheet.pose(0);
  EXPECT_THROW(FreezeMetric({}, sheet.connectivity, {}), MeshError);
  EXPECT_THROW(FreezeMetric({}, sheet.connectivity, {flat.leftCols(4)}), MeshError);
  EXPECT_THROW(FreezeMetric({}, sheet.connectivity, {0 * flat}), MeshError);
  Shape broken = flat;
  broken(1, 2) = std::nan("");
  EXPECT_THROW(FreezeMetric({}, sheet.connectivity, {broken}), MeshError);
  for (const double scale : {1e150, 1e-150}) {
    EXPECT_THROW(FreezeMetric({}, sheet.connectivity, {scale * flat}), MeshError);
  }
  MetricOptions options;
  options.volume = 1;  // a sheet encloses none
  EXPECT_THROW(FreezeMetric(options, sheet.connectivity, {flat}), InvalidOptions);
}

TEST(MetricOptions, ValidateNamesTheField) {
  const auto message = [](const MetricOptions& options) -> std::string {
    try {
      options.Validate();
    } catch (const InvalidOptions& error) {
      return error.what();
    }
    return "valid";
  };
  EXPECT_EQ(message({}), "valid");
  EXPECT_EQ(message(MetricOptions::Rigid()), "valid");
  EXPECT_EQ(message(MetricOptions::Paper()), "valid");
  MetricOptions options;
  options.bending = -1;
  EXPECT_EQ(message(options).rfind("bending:", 0), 0u) << message(options);
  options = {};
  options.lambda = std::nan("");
  EXPECT_EQ(message(options).rfind("lambda:", 0), 0u) << message(options);
  options = {};
  options.strain = options.lambda = 0;
  EXPECT_EQ(message(options).rfind("isometric", 0), 0u) << message(options);
  options.features = {{"one of one's own", 1}};
  EXPECT_EQ(message(options), "valid");
}

TEST(AngularVelocity, SolvesTheNormalEquationsAndLeavesOutTheAxisOfALine) {
  const Shape points = testing::Noise(7, 1, 1);
  const Eigen::Vector3d spin(0.3, -0.2, 0.5);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const auto& p : points.colwise()) {
    inertia += p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose();
    moment += p.cross(spin.cross(p));
  }
  EXPECT_TRUE(AngularVelocity(inertia, moment).isApprox(spin, 1e-12));

  const Eigen::Vector3d line = Eigen::Vector3d(1, 2, 2) / 3;
  const Eigen::Matrix3d degenerate = Eigen::Matrix3d::Identity() - line * line.transpose();
  const Eigen::Vector3d c = AngularVelocity(degenerate, degenerate * spin);
  EXPECT_NEAR(c.dot(line), 0, 1e-12);
  EXPECT_TRUE((degenerate * c).isApprox(degenerate * spin, 1e-12));
}

// One vertex in the interior of a sheet moves nearly onto a neighbour, so that an edge has a
// hundred-thousandth of the others' length, and the two triangles at it are slivers. None of them
// may make its neighbourhood rigid.
TEST(FreezeMetric, SliversAndShortEdgesWeighNoMoreThanTheyHaveTo) {
  const ShapeFamily sheet = MakeSheet(1, 1, 6, 6);
  Shape shape = sheet.pose(0);
  const Eigen::Matrix2Xi& edges = sheet.connectivity->Edges();
  int inner = 0;
  const auto is_inner = [&](int v) { return shape.col(v).head<2>().cwiseAbs().maxCoeff() < 0.3; };
  while (!is_inner(edges(0, inner)) || !is_inner(edges(1, inner))) ++inner;
  const int from = edges(0, inner), to = edges(1, inner);
  const auto before = FreezeMetric(MetricOptions::Isometric(), sheet.connectivity, {shape});
  shape.col(from) += (1 - 1e-5) * (shape.col(to) - shape.col(from));
  const auto after = FreezeMetric(MetricOptions::Isometric(), sheet.connectivity, {shape});
  const auto heaviest = [](const auto& feature) { return feature.weights.maxCoeff(); };
  // An edge of a thousandth of the others' length has a million times their weight.
  EXPECT_LT(heaviest(Get<EdgeLength>(*after)), 1e7 * heaviest(Get<EdgeLength>(*before)));
}

// The weight of a hinge along thin triangles grows with their aspect ratio.
TEST(FreezeMetric, HingesOfSliversWeighNoMoreThanThoseOfThinTriangles) {
  const auto heaviest = [](double width) {
    const ShapeFamily sheet = MakeSheet(1, width, 4, 4);
    const auto metric = FreezeMetric({}, sheet.connectivity, {sheet.pose(0)});
    return Get<Dihedral>(*metric).weights.maxCoeff();
  };
  EXPECT_NEAR(heaviest(1e-4) / heaviest(1e-2), 1, 1e-9);
}

}  // namespace
}  // namespace shapespace
