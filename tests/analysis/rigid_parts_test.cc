#include <shapespace/analysis/rigid_parts.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/analysis/deviation_sites.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>

#include "support/motions.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

using testing::PathOf;
using testing::Rotation;

// A shape whose part at x > 0 is rotated about the y axis, with a bend distributed over [-width /
// 2, width / 2].
Shape BentAtOrigin(const Shape& rest, double degrees, double width) {
  Shape bent = rest;
  const double angle = degrees * M_PI / 180, curvature = angle / width;
  for (auto p : bent.colwise()) {
    const double along = std::clamp(p.x() + width / 2, 0.0, width);  // within the joint
    const double turned = curvature * along;
    const double beyond = std::max(0.0, p.x() - width / 2);
    const double before = std::min(p.x() + width / 2, 0.0);
    p = Eigen::Vector3d(
        before + std::sin(turned) / curvature + beyond * std::cos(turned) -
            p.z() * std::sin(turned),
        p.y(),
        (1 - std::cos(turned)) / curvature + beyond * std::sin(turned) + p.z() * std::cos(turned));
  }
  return bent;
}

struct BentBar {
  ShapeFamily body = MakeBar(6, 1, 1, 48, 8, 8);
  Shape rest = body.pose(0);
  std::vector<Shape> shapes;

  explicit BentBar(double degrees) {
    for (int i = 0; i < 5; ++i) {
      shapes.push_back(i == 0 ? rest : BentAtOrigin(rest, degrees * i / 4, 0.8));
    }
  }
};

std::vector<Shape> BendTube(const ShapeFamily& tube, double degrees) {
  std::vector<Shape> shapes;
  for (int i = 0; i < 6; ++i) shapes.push_back(tube.pose(degrees * i / 5));
  return shapes;
}

// The share of triangles that are in different parts; parts are matched by their rank in size.
double Mismatch(const Eigen::VectorXi& a, const Eigen::VectorXi& b) {
  return (a.array() != b.array()).cast<double>().mean();
}

TEST(FindRigidParts, ARigidCopyIsOnePart) {
  const SkinnedBody body = MakeQuadruped(2000);
  const Shape rest = body.pose("stride");
  const std::vector<Shape> shapes = {
      rest, (Rotation(50, {1, 2, 3}) * rest).colwise() + Eigen::Vector3d(1, 2, 3),
      (Rotation(120, {3, 1, 0}) * rest).colwise() + Eigen::Vector3d(-4, 2, 0)};
  const Path path = PathOf(body.connectivity, shapes);
  const RigidParts result = FindRigidParts(path);
  ASSERT_EQ(result.parts.size(), 1u);
  EXPECT_EQ(result.parts[0].num_triangles, body.connectivity->NumTriangles());
  EXPECT_EQ(result.parts[0].num_vertices, body.connectivity->NumVertices());
  EXPECT_NEAR(result.parts[0].area_share, 1, 1e-12);
  EXPECT_LT(result.parts[0].relative_residual, 1e-12);
  EXPECT_LT(result.parts[0].edge_deviation, 1e-12);
  EXPECT_LT(result.joint_share, 1e-12);
  EXPECT_TRUE(FindDeviationSites(path, result).empty());
}

TEST(FindRigidParts, AFoldIsTwoPartsThoughNoEdgeChanges) {
  const ShapeFamily sheet = MakeSheet(2, 1, 20, 10);
  const Shape flat = sheet.pose(0);
  std::vector<Shape> shapes = {flat, flat, flat};
  for (int i = 0; i < 3; ++i) {
    for (auto p : shapes[i].colwise()) {
      if (p.x() > 0) p = Rotation(-35 * i, Eigen::Vector3d::UnitY()) * p;
    }
  }
  const Path path = PathOf(sheet.connectivity, shapes);
  const RigidParts result = FindRigidParts(path);
  ASSERT_EQ(result.parts.size(), 2u);
  for (const RigidPart& part : result.parts) {
    EXPECT_NEAR(part.area_share, 0.5, 1e-12);
    EXPECT_LT(part.residual, 1e-12);
    EXPECT_NEAR(std::abs(part.centre.x()), 0.5, 1e-12);
  }
  EXPECT_NEAR(result.parts[1].turn, 70, 1e-9);
  EXPECT_TRUE(FindDeviationSites(path, result).empty());
}

TEST(FindRigidParts, AVertexOnTheCreaseIsOfTheLargerPart) {
  const ShapeFamily sheet = MakeSheet(2, 1, 20, 10);
  const Shape flat = sheet.pose(0);
  for (const double crease : {-0.3, 0.3}) {
    Shape folded = flat;
    for (auto p : folded.colwise()) {
      const Eigen::Vector3d from(crease, 0, 0);
      if (p.x() > crease) p = from + Rotation(-70, Eigen::Vector3d::UnitY()) * (p - from).eval();
    }
    const RigidParts result = FindRigidParts(PathOf(sheet.connectivity, {flat, folded}));
    ASSERT_EQ(result.parts.size(), 2u);
    for (int v = 0; v < flat.cols(); ++v) {
      const double to_larger = (flat(0, v) - crease) * (crease < 0 ? 1 : -1);
      EXPECT_EQ(result.of_vertex(v), to_larger > -1e-9 ? 0 : 1) << crease << ", vertex " << v;
    }
  }
}

TEST(FindRigidParts, ABarBentAtOneJointIsTwoPartsAndTheJoint) {
  const BentBar bar(60);
  const Path path = PathOf(bar.body.connectivity, bar.shapes);
  const RigidParts result = FindRigidParts(path);
  ASSERT_EQ(result.parts.size(), 2u);
  EXPECT_NEAR(result.parts[1].turn, 60, 1);
  EXPECT_GT(result.joint_share, 0.02);
  EXPECT_LT(result.joint_share, 0.8 / 6);
  const int left = result.parts[0].centre.x() < 0 ? 0 : 1;
  for (int v = 0; v < bar.rest.cols(); ++v) {
    if (std::abs(bar.rest(0, v)) > 0.5) {
      EXPECT_EQ(result.of_vertex(v), bar.rest(0, v) < 0 ? left : 1 - left) << v;
    }
  }
  // The inner and the outer side of the joint; the middle line keeps its length.
  const std::vector<DeviationSite> sites = FindDeviationSites(path, result);
  ASSERT_EQ(sites.size(), 2u);
  double share = 0;
  for (const DeviationSite& site : sites) {
    EXPECT_LT(std::abs(site.position.x()), 0.4);
    EXPECT_NEAR(std::abs(site.position.z()), 0.5, 1e-9);
    EXPECT_EQ(std::set<int>(site.parts.begin(), site.parts.end()), (std::set<int>{0, 1}));
    share += site.share;
  }
  EXPECT_GT(share, 0.8);
  EXPECT_LT(share, 1 + 1e-12);
}

TEST(FindDeviationSites, TheSitesComeInOrderOfTheirShare) {
  const ShapeFamily sheet = MakeSheet(2, 1, 20, 10);
  const Shape flat = sheet.pose(0);
  Shape bumped = flat;
  std::vector<int> bumps;  // by number; the middle one is the highest
  for (const auto& [x, height] : {std::make_pair(-0.6, 0.06), {0.0, 0.15}, {0.6, 0.1}}) {
    Eigen::Index v = 0;
    (flat.colwise() - Eigen::Vector3d(x, 0, 0)).colwise().squaredNorm().minCoeff(&v);
    bumped(2, v) += height;
    bumps.push_back(static_cast<int>(v));
  }
  ASSERT_TRUE(std::is_sorted(bumps.begin(), bumps.end()));
  const Path path = PathOf(sheet.connectivity, {flat, bumped});
  std::vector<int> found;
  std::vector<double> shares;
  for (const DeviationSite& site : FindDeviationSites(path, FindRigidParts(path))) {
    found.push_back(site.vertex);
    shares.push_back(site.share);
  }
  EXPECT_EQ(found, (std::vector<int>{bumps[1], bumps[2], bumps[0]}));
  EXPECT_TRUE(std::is_sorted(shares.rbegin(), shares.rend()));
}

TEST(FindRigidParts, TheResidualIsWhatABestMotionLeaves) {
  // With all of the bar as one part that is scaled by 1 + s about its centre, the residual is s
  // times the root mean square distance from the centre.
  const ShapeFamily bar = MakeBar(2, 2, 2, 6, 6, 6);
  const Shape rest = bar.pose(0);
  const Path path = PathOf(bar.connectivity, {rest, 1.01 * rest});
  const RigidParts result = FindRigidParts(path);
  ASSERT_EQ(result.parts.size(), 1u);
  EXPECT_NEAR(result.parts[0].edge_deviation, 0.01, 1e-9);
  // For a cube's surface of half side 1 the mean square distance from the centre is 1 + 2 / 3, here
  // of cells of half side 1 / 6, sampled at their corners.
  EXPECT_NEAR(result.parts[0].residual, 0.01 * std::sqrt(5. / 3), 2e-4);
  EXPECT_NEAR(result.parts[0].relative_residual, result.parts[0].residual / std::sqrt(24.), 1e-4);
}

TEST(FindRigidParts, AFingerHasThreeBones) {
  const ShapeFamily tube = MakeTube(3000);
  const Path path = PathOf(tube.connectivity, BendTube(tube, 110));
  const RigidParts result = FindRigidParts(path);
  // The joints are wide: parts of them may be nearly rigid too, but are smaller.
  ASSERT_GE(result.parts.size(), 3u);
  std::vector<RigidPart> bones(result.parts.begin(), result.parts.begin() + 3);
  std::sort(bones.begin(), bones.end(),
            [](const RigidPart& a, const RigidPart& b) { return a.centre.x() < b.centre.x(); });
  EXPECT_LT(bones[0].centre.x(), 2);
  EXPECT_NEAR(bones[1].centre.x(), 3, 1);
  EXPECT_GT(bones[2].centre.x(), 4);
  EXPECT_NEAR(std::abs(bones[2].turn - bones[0].turn), 110, 4);
  const double bones_share = bones[0].area_share + bones[1].area_share + bones[2].area_share;
  EXPECT_GT(bones_share, 0.4);
  for (size_t i = 3; i < result.parts.size(); ++i) {
    EXPECT_LT(result.parts[i].area_share, 0.5 * result.parts[2].area_share);
  }
}

TEST(FindRigidParts, FindsTheLimbsOfAnAnimal) {
  const SkinnedBody body = MakeQuadruped(6000);
  std::vector<Shape> shapes;
  for (int i = 0; i < 5; ++i) shapes.push_back(body.between("stand", "rear", i / 4.));
  const Path path = PathOf(body.connectivity, shapes);
  const RigidParts result = FindRigidParts(path);
  const Shape& rest = shapes[0];
  const auto part_at = [&](double x, double y, double z) {
    int nearest;
    (rest.colwise() - Eigen::Vector3d(x, y, z)).colwise().squaredNorm().minCoeff(&nearest);
    return result.of_vertex(nearest);
  };
  Eigen::Index highest, foremost, hindmost;
  rest.row(1).maxCoeff(&highest);
  rest.row(2).maxCoeff(&foremost);
  rest.row(2).minCoeff(&hindmost);
  const int trunk = part_at(0, 1.2, 0), head = result.of_vertex(foremost);
  EXPECT_EQ(trunk, 0);
  EXPECT_EQ(result.of_vertex(highest), head);  // the ears have no joint
  // It faces +z, its left side to +x. The pose turns the head by 14 + 18 + 16 degrees, the tail by
  // 20, the paws by the sum of four or three joints, and bends the back by 10 in all.
  const struct {
    int part;
    double turn;
  } limbs[] = {{head, 48},
               {result.of_vertex(hindmost), 20},
               {part_at(0.145, 0, 0.4), -30 + 70 + 30 + 20},
               {part_at(-0.145, 0, 0.4), -5 + 60 + 30 + 20},
               {part_at(0.145, 0, -0.4), 30 + 34 - 20},
               {part_at(-0.145, 0, -0.4), 20 + 38 - 18}};
  std::set<int> different = {trunk};
  for (const auto& limb : limbs) {
    ASSERT_NE(limb.part, RigidParts::kJoint);
    EXPECT_NEAR(result.parts[limb.part].turn, limb.turn, 14);
    different.insert(limb.part);
  }
  EXPECT_EQ(different.size(), 7u);
  EXPECT_LT(result.joint_share, 0.35);
  for (const RigidPart& part : result.parts) EXPECT_LT(part.relative_residual, 0.05);
}

TEST(FindRigidParts, DoesNotDependOnScaleOrPlace) {
  const ShapeFamily tube = MakeTube(2000);
  const std::vector<Shape> shapes = BendTube(tube, 90);
  const RigidParts plain = FindRigidParts(PathOf(tube.connectivity, shapes));
  for (const double scale : {1e-4, 1e4}) {
    std::vector<Shape> moved;
    for (size_t i = 0; i < shapes.size(); ++i) {
      moved.push_back((scale * Rotation(40. * i, {1, 1, 2}) * shapes[i]).colwise() +
                      scale * Eigen::Vector3d(i, 3, -5));
    }
    Path path = PathOf(tube.connectivity, moved);
    // Nor on the rigid motions that the path stores.
    for (size_t i = 0; i < path.shapes.size(); ++i) {
      path.shapes[i] = Rotation(70. * i, {0, 1, 3}) * path.shapes[i];
    }
    const RigidParts result = FindRigidParts(path);
    ASSERT_EQ(result.parts.size(), plain.parts.size());
    EXPECT_LT(Mismatch(result.of_triangle, plain.of_triangle), 0.01);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(result.parts[k].residual / (scale * plain.parts[k].residual), 1, 0.02);
      EXPECT_NEAR(result.parts[k].turn, plain.parts[k].turn, 0.5);
    }
  }
}

TEST(FindRigidParts, DoesNotDependOnNumbering) {
  const ShapeFamily tube = MakeTube(2000);
  const std::vector<Shape> shapes = BendTube(tube, 90);
  const RigidParts plain = FindRigidParts(PathOf(tube.connectivity, shapes));
  const int count = tube.connectivity->NumVertices();
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::vector<Shape> renumbered(shapes.size(), Shape(3, count));
  for (size_t i = 0; i < shapes.size(); ++i) {
    for (int v = 0; v < count; ++v) renumbered[i].col(order[v]) = shapes[i].col(v);
  }
  Eigen::Matrix3Xi triangles = tube.connectivity->Triangles().rowwise().reverse();
  for (int& v : triangles.reshaped()) v = order[v];
  const RigidParts result =
      FindRigidParts(PathOf(Connectivity::FromTriangles(count, triangles), renumbered));
  ASSERT_EQ(result.parts.size(), plain.parts.size());
  EXPECT_LT(Mismatch(result.of_triangle.reverse(), plain.of_triangle), 0.01);
}

TEST(FindRigidParts, TheToleranceDecidesWhatABendIs) {
  const BentBar bar(8);
  const Path path = PathOf(bar.body.connectivity, bar.shapes);
  EXPECT_EQ(FindRigidParts(path).parts.size(), 1u);
  RigidPartsOptions options;
  options.tolerance = 0.02;
  EXPECT_GE(FindRigidParts(path, options).parts.size(), 2u);
}

TEST(FindRigidParts, WhatIsTooSmallOrTooStrainedIsNoPart) {
  const ShapeFamily bar = MakeBar(2, 2, 2, 6, 6, 6);
  const Shape rest = bar.pose(0);
  const RigidParts strained = FindRigidParts(
      PathOf(bar.connectivity, {rest, Eigen::Vector3d(2, 0.5, 1).asDiagonal() * rest}));
  EXPECT_TRUE(strained.parts.empty());
  EXPECT_EQ(strained.joint_share, 1);
  RigidPartsOptions options;
  options.least_share = 0.6;
  const BentBar bent(60);
  EXPECT_TRUE(FindRigidParts(PathOf(bent.body.connectivity, bent.shapes), options).parts.empty());
}

TEST(FindRigidParts, AGraphHasNone) {
  const auto graph = Connectivity::Make(3, {0}, {}, {{0, 1}, {1, 2}});
  Shape shape(3, 3);
  shape << 0, 1, 2, 0, 0, 0, 0, 0, 0;
  const RigidParts result = FindRigidParts(PathOf(graph, {shape, shape}));
  EXPECT_TRUE(result.parts.empty());
  EXPECT_EQ(result.of_vertex, Eigen::Vector3i::Constant(RigidParts::kJoint));
}

TEST(FindRigidParts, RefusesBadOptions) {
  const BentBar bar(10);
  const Path path = PathOf(bar.body.connectivity, bar.shapes);
  for (const auto member : {&RigidPartsOptions::tolerance, &RigidPartsOptions::least_share,
                            &RigidPartsOptions::most_deviation}) {
    RigidPartsOptions options;
    options.*member = 0;
    EXPECT_THROW(FindRigidParts(path, options), InvalidOptions);
    options.*member = std::nan("");
    EXPECT_THROW(FindRigidParts(path, options), InvalidOptions);
  }
}

}  // namespace
}  // namespace shapespace
