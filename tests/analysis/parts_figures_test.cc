// Figures of several parts, and the regions and lengths that they are made of.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <shapespace/analysis/detail/region_merger.h>
#include <shapespace/analysis/detail/straight_lengths.h>
#include <shapespace/analysis/deviation_sites.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/bodies/sheet.h>

#include "support/motions.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

using testing::PathOf;
using testing::Rotation;

// Two sheets that are not connected, of areas 8 and 3, both about their own centres.
struct TwoSheets {
  ShapeFamily large = MakeSheet(4, 2, 16, 8), small = MakeSheet(1, 3, 4, 12);
  int split = large.connectivity->NumVertices();
  std::shared_ptr<const Connectivity> connectivity;

  TwoSheets() {
    const Eigen::Matrix3Xi &a = large.connectivity->Triangles(),
                           &b = small.connectivity->Triangles();
    Eigen::Matrix3Xi triangles(3, a.cols() + b.cols());
    triangles << b.array() + split, a;  // the small one first
    connectivity =
        Connectivity::FromTriangles(split + small.connectivity->NumVertices(), triangles);
  }

  Shape Scaled(double of_large, double of_small, double turn_large, double turn_small) const {
    Shape shape(3, connectivity->NumVertices());
    const Eigen::Vector3d axis(1, 2, 2);
    shape << Rotation(turn_large, axis) * of_large * large.pose(0),
        (Rotation(turn_small, axis) * of_small * small.pose(0)).colwise() +
            Eigen::Vector3d(9, -1, 4);
    return shape;
  }
};

// Over the corners of all triangles, of which all have one area: the root mean square of the
// distance from the origin.
double RootMeanSquare(const ShapeFamily& sheet) {
  const Shape shape = sheet.pose(0);
  double sum = 0;
  for (const int v : sheet.connectivity->Triangles().reshaped()) sum += shape.col(v).squaredNorm();
  return std::sqrt(sum / sheet.connectivity->Triangles().size());
}

TEST(FindRigidParts, FiguresOfTwoPartsThatGrowAndTurnDifferently) {
  const TwoSheets sheets;
  const Path path =
      PathOf(sheets.connectivity, {sheets.Scaled(1, 1, 0, 0), sheets.Scaled(1.01, 0.99, 10, 25),
                                   sheets.Scaled(1.02, 1.03, 5, -40)});
  const RigidParts result = FindRigidParts(path);
  ASSERT_EQ(result.parts.size(), 2u);
  const double areas[] = {8 * (1 + 1.01 * 1.01 + 1.02 * 1.02), 3 * (1 + 0.99 * 0.99 + 1.03 * 1.03)};
  const double growths[] = {std::sqrt((1e-4 + 4e-4) / 2), std::sqrt((1e-4 + 9e-4) / 2)};
  const double sizes[] = {RootMeanSquare(sheets.large), RootMeanSquare(sheets.small)};
  for (int k = 0; k < 2; ++k) {
    const RigidPart& part = result.parts[k];
    const double share = areas[k] / (areas[0] + areas[1]);
    EXPECT_NEAR(part.area_share, share, 1e-9);
    EXPECT_NEAR(part.edge_deviation, growths[k], 1e-9);
    EXPECT_NEAR(part.residual, growths[k] * sizes[k], 1e-8);
    EXPECT_NEAR(part.relative_residual, part.residual / path.metric->unit / std::sqrt(share), 1e-8);
  }
  EXPECT_EQ(result.parts[0].num_triangles, 2 * 16 * 8);
  EXPECT_EQ(result.parts[1].num_triangles, 2 * 4 * 12);
  EXPECT_EQ(result.parts[1].num_vertices, 5 * 13);
  EXPECT_LT(result.parts[0].turn, 1e-5);
  EXPECT_NEAR(result.parts[1].turn, 45, 1e-6);
  EXPECT_EQ(result.of_triangle(0), 1);
  EXPECT_EQ(result.of_vertex(0), 0);
  EXPECT_LT(result.joint_share, 1e-12);
  // Regions below the least share belong to the joints.
  RigidPartsOptions options;
  options.least_share = 0.5;
  const RigidParts one = FindRigidParts(path, options);
  ASSERT_EQ(one.parts.size(), 1u);
  EXPECT_NEAR(one.joint_share, areas[1] / (areas[0] + areas[1]), 1e-9);
  EXPECT_EQ(one.of_triangle(0), RigidParts::kJoint);
  // A limit between the edge deviations of the two in their worst shapes, 0.02 and 0.03.
  options = {};
  options.most_deviation = 0.029;
  EXPECT_EQ(FindRigidParts(path, options).parts.size(), 1u);
  options.most_deviation = 0.031;
  EXPECT_EQ(FindRigidParts(path, options).parts.size(), 2u);
}

TEST(FindDeviationSites, PartsComeInOrderOfTheLengthOfTheirBorder) {
  const ShapeFamily sheet = MakeSheet(2, 1, 20, 10);
  const Shape flat = sheet.pose(0);
  Eigen::Index top = 0;
  (flat.colwise() - Eigen::Vector3d(0.2, 0, 0)).colwise().squaredNorm().minCoeff(&top);
  Shape bumped = flat;
  bumped(2, top) += 0.2;
  const Path path = PathOf(sheet.connectivity, {flat, bumped});
  // Of the edges at the bump most are on one side of a line beside it.
  for (const double to_left : {0.05, -0.05}) {
    for (const bool left_first : {true, false}) {
      RigidParts parts;
      parts.parts.resize(3);
      parts.of_vertex.resize(flat.cols());
      for (int v = 0; v < flat.cols(); ++v) {
        const bool left = flat(0, v) < flat(0, top) + to_left;
        parts.of_vertex(v) = left == left_first ? 0 : 1;
        if (std::abs(flat(0, v) - flat(0, top)) > 0.6) parts.of_vertex(v) = 2;
      }
      const std::vector<DeviationSite> sites = FindDeviationSites(path, parts);
      ASSERT_EQ(sites.size(), 1u);
      const int more = (to_left > 0) == left_first ? 0 : 1;
      EXPECT_EQ(sites[0].parts, (std::vector<int>{more, 1 - more}));
      parts.of_vertex =
          (parts.of_vertex.array() == 1 - more).select(RigidParts::kJoint, parts.of_vertex);
      EXPECT_EQ(FindDeviationSites(path, parts)[0].parts, (std::vector<int>{more}));
    }
  }
}

// Of an equilateral triangle and a segment that grow evenly, by different factors.
TEST(StraightLengths, OfTwoCostsAreTheMeanByTheirCoefficients) {
  Shape first(3, 5);
  first << 0, 1, 0.5, 3, 4,  //
      0, 0, std::sqrt(0.75), 0, 0, 0, 0, 0, 0, 0;
  const auto connectivity = Connectivity::Make(5, {0, 3}, {0, 1, 2}, {{3, 4}});
  Shape last = first;
  last.leftCols(3) *= 2;
  last.rightCols(2) *= 3;
  const auto squared_at = [&](double isometric, double strain, double t) {
    MetricOptions options;
    options.isometric = isometric;
    options.strain = strain;
    const auto metric = FreezeMetric(options, connectivity, {first, last});
    const double unit = metric->unit;
    return Eigen::VectorXd(
        unit * unit * internal::StraightLengths(metric, first / unit, last / unit).SquaredAt(t));
  };
  const double t = 0.3;
  const Eigen::Vector2d by_length(1 + 3 * t, 1 + 8 * t);
  const Eigen::Vector2d by_strain(std::pow(4, t), std::pow(9, t));
  const struct {
    double isometric, strain, share;
  } cases[] = {{1, 0, 0}, {0, 1, 1}, {0.3, 0.5, 0.625}, {3, 1, 0.25}};
  for (const auto& [isometric, strain, share] : cases) {
    const Eigen::VectorXd squared = squared_at(isometric, strain, t);
    const Eigen::Vector2d expected = (1 - share) * by_length + share * by_strain;
    ASSERT_EQ(squared.size(), 4);
    for (int e = 0; e < 3; ++e) EXPECT_NEAR(squared(e), expected(0), 1e-9) << share;
    EXPECT_NEAR(squared(3), expected(1), 1e-9) << share;
    EXPECT_NEAR(squared_at(isometric, strain, 0)(3), 1, 1e-9);
    EXPECT_NEAR(squared_at(isometric, strain, 1)(2), 4, 1e-9);
  }
}

TEST(RegionMerger, TheLastShapeAndUpToSevenEvenlySpacedOthersDecide) {
  using Shapes = std::vector<int>;
  EXPECT_EQ(internal::DecidingShapes(1), Shapes());
  EXPECT_EQ(internal::DecidingShapes(2), Shapes{1});
  EXPECT_EQ(internal::DecidingShapes(4), (Shapes{1, 2, 3}));
  EXPECT_EQ(internal::DecidingShapes(9), (Shapes{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(internal::DecidingShapes(12), (Shapes{1, 2, 4, 5, 6, 8, 9, 11}));
  EXPECT_EQ(internal::DecidingShapes(17), (Shapes{2, 4, 6, 8, 10, 12, 14, 16}));
}

// Of two triangles with a common edge, in shapes without any symmetry.
Path TwoTriangles() {
  const auto connectivity = Connectivity::Make(4, {0, 3, 6}, {0, 1, 2, 2, 1, 3});
  Shape a(3, 4), b(3, 4), c(3, 4);
  a << 0, 2, 0.5, 3, 0, 0.1, 1.5, 2.5, 0, 0, 0.2, 0.1;
  b << 0.1, 2.1, 0.4, 2.9, 0, 0, 1.6, 2.4, 0, 0.1, 0.1, 0.9;
  c << 0, 1.9, 0.6, 2.8, 0.1, 0, 1.4, 2.6, 0.1, 0, 0.3, 1.4;
  Path path = PathOf(connectivity, {a, b, c});
  path.shapes = {a, b, c};  // in this unit
  return path;
}

double AreaOf(const Shape& shape, const std::vector<int>& t) {
  const Eigen::Vector3d u = shape.col(t[1]) - shape.col(t[0]),
                        v = shape.col(t[2]) - shape.col(t[0]);
  return u.cross(v).norm() / 2;
}

TEST(RegionMerger, AreasAreMeansOverTheShapesAndTheFirst) {
  const Path path = TwoTriangles();
  const auto share = [&](const std::vector<int>& shapes) {
    double first = 0, second = 0;
    for (const int i : shapes) {
      first += AreaOf(path.shapes[i], {0, 1, 2});
      second += AreaOf(path.shapes[i], {2, 1, 3});
    }
    return first / (first + second);
  };
  EXPECT_NEAR(internal::MeanAreas(path, {})(0), share({0}), 1e-12);
  EXPECT_NEAR(internal::MeanAreas(path, {2})(0), share({0, 2}), 1e-12);
  EXPECT_NEAR(internal::MeanAreas(path, {1, 2})(0), share({0, 1, 2}), 1e-12);
  EXPECT_NEAR(internal::MeanAreas(path, {1, 2}).sum(), 1, 1e-12);
}

// Weighted points under their best rigid motion, by singular values (Kabsch).
double Residual(const Shape& from, const Shape& to, const Eigen::VectorXd& weights) {
  const Eigen::Vector3d p = from * weights / weights.sum(), q = to * weights / weights.sum();
  const Shape a = from.colwise() - p, b = to.colwise() - q;
  const Eigen::Matrix3d products = a * weights.asDiagonal() * b.transpose();
  Eigen::Vector3d sizes = products.jacobiSvd().singularValues();
  if (products.determinant() < 0) sizes(2) *= -1;
  return a.colwise().squaredNorm().dot(weights) + b.colwise().squaredNorm().dot(weights) -
         2 * sizes.sum();
}

// They are, as long as the loss of the worst shape is at most the square of the tolerance times
// that of the size and the area of the smaller region.
TEST(RegionMerger, TwoTrianglesAreOneRegionUpToATolerance) {
  const Path path = TwoTriangles();
  const Eigen::VectorXd area = internal::MeanAreas(path, {1, 2});
  const std::vector<int> corners = {0, 1, 2, 2, 1, 3};
  Eigen::VectorXd weights(6);
  weights << Eigen::Vector3d::Constant(area(0) / 3), Eigen::Vector3d::Constant(area(1) / 3);
  double loss = 0;
  for (const int i : {1, 2}) {
    const Shape from = path.shapes[0](Eigen::all, corners),
                to = path.shapes[i](Eigen::all, corners);
    loss = std::max(loss, Residual(from, to, weights) -
                              Residual(from.leftCols(3), to.leftCols(3), weights.head(3)) -
                              Residual(from.rightCols(3), to.rightCols(3), weights.tail(3)));
  }
  const double smaller = area.minCoeff();
  ASSERT_GT(loss, 1e-4);
  for (const double least_share : {0.003, 0.9}) {
    const double limit = std::sqrt(loss / (std::max(smaller, least_share) * smaller));
    for (const double factor : {0.999, 1.001}) {
      RigidPartsOptions options;
      options.least_share = least_share;
      options.tolerance = factor * limit;
      int count = 0;
      const std::vector<int> regions = internal::RegionMerger(path, options).Run(&count);
      EXPECT_EQ(count, factor < 1 ? 2 : 1) << limit;
      EXPECT_EQ(regions, (factor < 1 ? std::vector<int>{0, 1} : std::vector<int>{0, 0}));
    }
  }
}

}  // namespace
}  // namespace shapespace
