// What the fit of a template is made of, each by itself: the quantities that it is defined to
// return.

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/correspondence/detail/coarse_body.h>
#include <shapespace/correspondence/detail/gradient_fit.h>
#include <shapespace/correspondence/detail/map_doubt.h>
#include <shapespace/correspondence/detail/smooth_stretch.h>
#include <shapespace/correspondence/detail/unfold.h>

namespace shapespace::internal {
namespace {

// A flat sheet whose inner vertices are moved in its plane, so that no triangle is like another.
struct UnevenSheet {
  static constexpr int kCells = 6;

  UnevenSheet() {
    const ShapeFamily sheet = MakeSheet(3, 2, kCells, kCells);
    connectivity = sheet.connectivity;
    shape = sheet.pose(0);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> share(-0.25, 0.25);
    for (int v = 0; v < shape.cols(); ++v) {
      if (std::abs(shape(0, v)) > 1.49 || std::abs(shape(1, v)) > 0.99) continue;
      inner.push_back(v);
      shape(0, v) += share(random) * 3 / kCells;
      shape(1, v) += share(random) * 2 / kCells;
    }
  }
  std::shared_ptr<const Connectivity> connectivity;
  Shape shape;
  std::vector<int> inner;
};

TEST(SmoothStretch, AUniformStretchComesBackExactly) {
  const UnevenSheet sheet;
  Eigen::Matrix3d stretch;
  stretch << 1.3, 0.2, 0, 0.2, 0.8, 0, 0, 0, 1;
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()));
  const Shape stretched = turn * stretch * sheet.shape;
  for (const double length : {0., 0.1, 1.}) {
    const SmoothStretch smooth(sheet.connectivity, sheet.shape, length);
    const auto triangles = smooth.StretchedTriangles(stretched);
    ASSERT_EQ(triangles.cols(), sheet.connectivity->NumTriangles());
    for (int f = 0; f < triangles.cols(); ++f) {
      const Eigen::Vector3i t = sheet.connectivity->Triangles().col(f);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d expected = stretch * (sheet.shape.col(t(k)) - sheet.shape.col(t(0)));
        EXPECT_LT((triangles.col(f).segment<3>(3 * k) - expected).norm(), 1e-8) << f;
      }
    }
  }
}

// The formula that Floater derives his weights from: in a plane each vertex is the mean of those
// around it.
TEST(CoarseBody, KeepsWhatIsPinnedAndAllOfASmallBody) {
  const SkinnedBody body = MakeQuadruped(3000);
  const FitBody whole(body.connectivity, body.pose("sit"));
  const std::vector<int> pinned = {7, 1000, 3, 7};
  const CoarseBody coarse = Coarsen(whole, 500, pinned);
  EXPECT_LT(coarse.body.connectivity->NumTriangles(), 2 * 500);
  EXPECT_TRUE(std::is_sorted(coarse.vertices.begin(), coarse.vertices.end()));
  for (const int v : pinned) EXPECT_EQ(coarse.vertices[coarse.IndexOf(v)], v);
  // Up to another frame, in which its own area is 1.
  const Shape before = whole.own(Eigen::all, coarse.vertices);
  EXPECT_LT((coarse.body.frame.Out(coarse.body.own) - before).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(Coarsen(whole, 2000, pinned).body.own, whole.own);
}

TEST(MeanValueWeights, EachVertexOfAPlaneIsTheMeanOfItsNeighbours) {
  const UnevenSheet sheet;
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()));
  const Shape turned = turn * sheet.shape;
  const MeanValueWeights weights(*sheet.connectivity, turned);
  ASSERT_EQ(sheet.inner.size(), 25u);
  for (const int v : sheet.inner) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double all = 0;
    int count = 0;
    weights.ForEach(v, [&](int w, double weight) {
      EXPECT_GT(weight, 0);
      sum += weight * turned.col(w);
      all += weight;
      ++count;
    });
    EXPECT_EQ(count, static_cast<int>(sheet.connectivity->EdgesOfVertices()[v].size()));
    EXPECT_LT((sum / all - turned.col(v)).norm(), 1e-13) << v;
  }
}

// Of a right angle with legs 1 and 2: half of it has the tangent 1.
TEST(MeanValueWeights, AreTangentsOfHalfTheAnglesByDistance) {
  const auto triangle = Connectivity::Make(3, {0, 3}, {0, 1, 2}, {});
  Shape shape(3, 3);
  shape << 0, 1, 0, 0, 0, 2, 0, 0, 0;
  const MeanValueWeights weights(*triangle, shape);
  weights.ForEach(0, [](int w, double weight) { EXPECT_NEAR(weight, w == 1 ? 1 : 0.5, 1e-15); });
  const double half = std::tan(std::atan(2) / 2);
  weights.ForEach(1, [&](int w, double weight) {
    EXPECT_NEAR(weight, w == 0 ? half : half / std::sqrt(5.), 1e-15);
  });
}

MarkerDistances NoMarkers(Eigen::Index on_template, Eigen::Index on_target) {
  return {Eigen::MatrixXf::Zero(on_template, 1), Eigen::MatrixXf::Zero(on_target, 1)};
}

// Two triangles of a target that lie on each other, the second one upside down and half as large.
TEST(TurnedTriangles, AreThoseAgainstTheSumOfTheNormalsAtTheirCorners) {
  const auto sheets = Connectivity::Make(6, {0, 3, 6}, {0, 1, 2, 3, 5, 4}, {});
  Shape place(3, 6);
  place << 0, 2, 0, 0, 1, 0, 0, 0, 2, 0, 0, 2, 0, 0, 0, 0.1, 0.1, 0.1;
  const MarkerDistances distances = NoMarkers(3, 6);
  const Target target(sheets, place, distances);
  const Level level = {Connectivity::Make(3, {0, 3}, {0, 1, 2}, {}), {0, 1, 2}, {}};
  const Shape up = place.leftCols(3);
  Shape down = up;
  down.col(1).swap(down.col(2));
  const auto turned = [&](const Shape& shape, std::vector<int> triangles) {
    std::vector<ClosestPoint> closest(3);
    for (int k = 0; k < 3; ++k) closest[k].triangle = triangles[k];
    return static_cast<bool>(TurnedTriangles(level, shape, target, closest)[0]);
  };
  for (const std::vector<int>& mostly_up :
       {std::vector<int>{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
    EXPECT_FALSE(turned(up, mostly_up));
    EXPECT_TRUE(turned(down, mostly_up));
  }
  EXPECT_TRUE(turned(up, {1, 1, 1}));
  EXPECT_FALSE(turned(down, {1, 1, 1}));
}

TEST(Target, NormalsAreInterpolatedBetweenThoseOfTheCorners) {
  const ShapeFamily tube = MakeTube(200);
  const Shape shape = tube.pose(40);
  const MarkerDistances distances = NoMarkers(shape.cols(), shape.cols());
  const Target target(tube.connectivity, shape, distances);
  const auto cosine = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.normalized().dot(b.normalized());
  };
  for (const int f : {0, 17, 93}) {
    const Eigen::Vector3i t = tube.connectivity->Triangles().col(f);
    ClosestPoint at;
    at.triangle = f;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d here = target.GetVertexNormals().col(t(k)),
                            next = target.GetVertexNormals().col(t((k + 1) % 3));
      at.barycentric = Eigen::Vector3d::Unit(k);
      EXPECT_LT((target.NormalAt(at) - here.normalized()).norm(), 1e-14);
      // In the middle of a side, as near to the one end's as to the other's, and between them.
      at.barycentric = 0.5 * (Eigen::Vector3d::Unit(k) + Eigen::Vector3d::Unit((k + 1) % 3));
      const Eigen::Vector3d middle = target.NormalAt(at);
      EXPECT_NEAR(middle.norm(), 1, 1e-14);
      EXPECT_NEAR(cosine(middle, here), cosine(middle, next), 1e-12);
      EXPECT_NEAR(middle.dot(here.cross(next)), 0, 1e-12);
    }
  }
}

// Neither an affine map of what is held nor a translation costs anything in the term that it leaves
// free.
TEST(GradientFit, CarriesAffineMapsOfWhatIsHeldToAllVertices) {
  const ShapeFamily tube = MakeTube(200);
  const Shape rest = tube.pose(40);
  Eigen::Matrix3d map;
  map << 1.2, 0.1, -0.2, 0.3, 0.9, 0.1, 0, -0.2, 1.1;
  std::vector<int> held;
  for (int v = 0; v < rest.cols(); v += 9) held.push_back(v);
  const Shape mapped = (map * rest).colwise() + Eigen::Vector3d(1, 2, 3);
  const Shape fitted = GradientFit(*tube.connectivity, rest, held, 0)(mapped(Eigen::all, held));
  EXPECT_LT((fitted - mapped).norm(), 1e-6 * mapped.norm());
  EXPECT_EQ(fitted.col(held[1]), mapped.col(held[1]));
}

TEST(GradientFit, WithOneVertexHeldTheBodyKeepsItsShape) {
  const ShapeFamily tube = MakeTube(200);
  const Shape rest = tube.pose(40);
  const Eigen::Vector3d way(0.5, -0.2, 0.1);
  for (const double identity : {kIdentity, 1.}) {
    const Shape fitted = GradientFit(*tube.connectivity, rest, {7}, identity)(rest.col(7) + way);
    EXPECT_LT((fitted - (rest.colwise() + way)).norm(), 1e-4 * rest.norm()) << identity;
  }
}

// A flat sheet, as a body of fits.
struct FlatSheet {
  ShapeFamily sheet = MakeSheet(3, 1, 30, 10);
  FitBody body{sheet.connectivity, sheet.pose(0)};

  int Count() const { return sheet.connectivity->NumVertices(); }
  int At(double x, double y) const {
    Eigen::Index nearest;
    (body.shape.colwise() - Eigen::Vector3d(x, y, 0)).colwise().squaredNorm().minCoeff(&nearest);
    return static_cast<int>(nearest);
  }
};

// Three maps of a sheet to itself: one that keeps all in place, one that costs little more and
// exchanges its ends, and one that costs twice as much and mirrors it. In doubt are the ends.
TEST(MapDoubt, NamesThePartsThatACheapMapSendsElsewhere) {
  const FlatSheet sheet;
  const FitBody& body = sheet.body;
  const int count = sheet.Count();
  const auto mirrored = [&](int v) { return sheet.At(-body.shape(0, v), body.shape(1, v)); };
  const auto is_end = [&](int v) { return std::abs(body.shape(0, v)) > 1; };
  std::vector<CandidateFit> fits(3);
  for (int v = 0; v < count; ++v) {
    fits[0].to_target.push_back(v);
    fits[1].to_target.push_back(is_end(v) ? mirrored(v) : v);
    fits[2].to_target.push_back(mirrored(v));
  }
  for (size_t i = 0; i < fits.size(); ++i) {
    fits[i].figures = {1, 1, 1};
    fits[i].deformation = std::vector<double>{1, 1.2, 2}[i] - kAlike;
  }
  const MapDoubt doubt(body, body.own, fits);
  ASSERT_EQ(doubt.parts.size(), 2u);
  for (int v = 0; v < count; ++v) EXPECT_EQ(doubt.part_of[v] >= 0, is_end(v)) << v;
  for (const auto& part : doubt.parts) {
    EXPECT_NEAR(part.share, 1 / 6., 0.03);
    EXPECT_NEAR(part.cost, 1.2, 1e-12);
    // The corner or side that is farthest from its other image.
    EXPECT_NEAR(std::abs(body.shape(0, part.vertex)), 1.5, 1e-12);
    EXPECT_EQ(part.target_vertex, part.vertex);
    EXPECT_EQ(part.other_vertex, mirrored(part.vertex));
  }
  EXPECT_NE(doubt.part_of[doubt.parts[0].vertex], doubt.part_of[doubt.parts[1].vertex]);
  EXPECT_NEAR(Certainty(body.own, fits), 1.2, 1e-12);
  fits.resize(1);
  EXPECT_TRUE(std::isnan(Certainty(body.own, fits)));
  EXPECT_TRUE(MapDoubt(body, body.own, fits).parts.empty());
}

// The target is the left half of a sheet. Two maps of it, which cost nearly the same, say nothing
// of the right half, which is not in doubt.
TEST(MapDoubt, WhatAPartLacksIsNotInDoubt) {
  const FlatSheet sheet;
  const FitBody& body = sheet.body;
  std::vector<int> all, left, upside_down;
  for (int v = 0; v < sheet.Count(); ++v) {
    all.push_back(v);
    if (body.shape(0, v) > 0) continue;
    left.push_back(v);
    upside_down.push_back(sheet.At(body.shape(0, v), -body.shape(1, v)));
  }
  std::vector<CandidateFit> fits(2);
  fits[0].to_target = InverseOf(body.own, all, left);
  fits[1].to_target = InverseOf(body.own, all, upside_down);
  for (CandidateFit& fit : fits) {
    fit.figures = {1, 1, 1};
    fit.deformation = 1;
  }
  const MapDoubt doubt(body, body.own(Eigen::all, left), fits);
  EXPECT_EQ(doubt.parts.size(), 2u);
  for (const int v : all) {
    if (body.shape(0, v) > 0.1) {
      EXPECT_EQ(fits[0].to_target[v], -1);
      EXPECT_EQ(doubt.part_of[v], -1);
    } else if (std::abs(body.shape(1, v)) > 0.3 && body.shape(0, v) <= 0) {
      EXPECT_GE(doubt.part_of[v], 0);
    }
  }
}

}  // namespace
}  // namespace shapespace::internal
