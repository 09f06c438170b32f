#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include <shapespace/exponential/exponential.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/statistics/average.h>

#include "properties/compare.h"
#include "properties/methods.h"
#include "properties/random_body.h"

namespace shapespace {
namespace {

using testing::AccurateGeodesic;
using testing::AreCongruent;
using testing::AreNear;
using testing::BodyKind;
using testing::ForAllKinds;
using testing::Off;
using testing::RandomBody;
using testing::Reversed;

// The root of the scaled energy, which is the length of a path of constant speed.
double LengthOf(const GeodesicResult& geodesic) { return std::sqrt(geodesic.summary.energy); }

TEST(RandomGeodesic, BackwardsIsTheReverse) {
  ForAllKinds({1, 2}, 3, [](const RandomBody& body) {
    const GeodesicOptions options = AccurateGeodesic(body, 3);
    const Path there = Interpolate(body.connectivity, body.poses, options).path;
    const Path back = Interpolate(body.connectivity, Reversed(body.poses), options).path;
    EXPECT_TRUE(AreNear(body, back.Placed(), Reversed(there.Placed()), 1e-5));
  });
}

// With half as many segments and under the same metric, the geodesic from the middle to the end is
// the second half. The middle is not turned onto the end exactly as both are when they are aligned
// on their own, which makes a difference in the cost of position.
TEST(RandomGeodesic, FromTheMiddleIsTheSecondHalf) {
  ForAllKinds({1, 2}, 2, [](const RandomBody& body) {
    const auto metric = FreezeMetric(body.metric, body.connectivity, body.poses);
    const GeodesicResult whole = Interpolate(metric, body.poses, AccurateGeodesic(body, 7));
    const std::vector<Shape> shapes = whole.path.Placed();
    const GeodesicResult half =
        Interpolate(metric, {shapes[4], shapes[8]}, AccurateGeodesic(body, 3));
    EXPECT_TRUE(AreCongruent(body, half.path.Placed(), {shapes.begin() + 4, shapes.end()}, 1e-4));
    EXPECT_NEAR(LengthOf(half) / LengthOf(whole), 0.5, 1e-4);
  });
}

// The distance of two poses is the length of their geodesic. Under one metric it is symmetric, and
// no way round by a third pose is shorter. With eight segments a length is short by about a share
// of 1/8^2 times a small constant.
TEST(RandomGeodesic, LengthsAreDistances) {
  ForAllKinds({1, 2}, 3, [](const RandomBody& body) {
    const Interpolator geodesics(body.connectivity, body.poses, AccurateGeodesic(body, 7));
    const auto length = [&](int i, int j) {
      return LengthOf(geodesics.Between(body.poses[i], body.poses[j]));
    };
    const double ab = length(0, 1), bc = length(1, 2), ca = length(2, 0);
    EXPECT_NEAR(length(1, 0) / ab, 1, 1e-6);
    EXPECT_NEAR(length(2, 1) / bc, 1, 1e-6);
    EXPECT_LT(std::max({ab, bc, ca}), (1 + 1e-3) * (ab + bc + ca) / 2);
    EXPECT_GT(ab, 0);
  });
}

// A body whose triangles are divided in four, in the same poses.
struct Divided {
  Divided(const Connectivity& coarse, const std::vector<Shape>& coarse_poses) {
    const int vertices = coarse.NumVertices(), edges = coarse.NumEdges();
    for (const Shape& shape : coarse_poses) {
      poses.emplace_back(3, vertices + edges);
      poses.back() << shape,
          (shape(Eigen::all, coarse.Edges().row(0)) + shape(Eigen::all, coarse.Edges().row(1))) / 2;
    }
    const auto middle = [&](int a, int b) {
      for (const int e : coarse.EdgesOfVertices()[a]) {
        if (coarse.OtherEnd(e, a) == b) return vertices + e;
      }
      return -1;
    };
    Eigen::Matrix3Xi triangles(3, 4 * coarse.NumTriangles());
    for (int t = 0; t < coarse.NumTriangles(); ++t) {
      const Eigen::Vector3i c = coarse.Triangles().col(t);
      const int x = middle(c(0), c(1)), y = middle(c(1), c(2)), z = middle(c(2), c(0));
      triangles.middleCols<4>(4 * t) << c(0), x, z, x,  //
          x, c(1), y, y,                                //
          z, y, c(2), z;
    }
    connectivity = Connectivity::FromTriangles(vertices + edges, triangles);
  }
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
};

// Of a motion in a plane, lengths of geodesics converge when the triangles are divided, from above:
// a finer mesh can do whatever a coarser one does, and flat hinges cost nothing.
TEST(RandomGeodesic, LengthsInAPlaneConvergeWhenTrianglesAreDivided) {
  for (const BodyKind kind : {BodyKind::kSheet, BodyKind::kDelaunay}) {
    for (const int seed : {1, 2, 3}) {
      RandomBody body = testing::MakeRandomBody(kind, seed, 1);
      SCOPED_TRACE(body.name);
      body.metric = {};
      // Polygons with more corners have stiffness of their own.
      body.connectivity = Connectivity::FromTriangles(body.connectivity->NumVertices(),
                                                      body.connectivity->Triangles());
      Shape flat = body.poses[0].colwise() - body.poses[0].rowwise().mean();
      flat =
          Eigen::JacobiSVD<Eigen::MatrixXd>(flat, Eigen::ComputeThinU).matrixU().transpose() * flat;
      flat /= flat.row(0).cwiseAbs().maxCoeff();
      flat.row(2).setZero();
      Shape bent = flat;
      for (int v = 0; v < flat.cols(); ++v) {
        const double x = flat(0, v), y = flat(1, v);
        bent(0, v) += 0.15 * std::sin(2 * y + seed) + 0.1 * x * x;
        bent(1, v) *= 1 + 0.2 * std::sin(1.5 * x - seed);
      }
      body.poses = {flat, bent};
      std::vector<double> lengths;
      for (int division = 0; division < 3; ++division) {
        lengths.push_back(
            LengthOf(Interpolate(body.connectivity, body.poses, AccurateGeodesic(body, 3))));
        const Divided divided(*body.connectivity, body.poses);
        body.connectivity = divided.connectivity;
        body.poses = divided.poses;
      }
      EXPECT_LT(lengths[1], lengths[0]);
      EXPECT_LT(lengths[2], lengths[1]);
      EXPECT_LT(lengths[1] - lengths[2], 0.7 * (lengths[0] - lengths[1]));
      EXPECT_LT(lengths[0] - lengths[1], 1e-3 * lengths[1]);
    }
  }
}

// With as many steps as the path has segments, the exponential map repeats the path. It is a
// continuation from the first segment, which makes errors of the path larger; so graphs, of which
// some parts hardly cost anything to move, are left out.
TEST(RandomLogarithm, IsUndoneByTheExponentialMap) {
  ForAllKinds({1, 2}, 2, [](const RandomBody& body) {
    if (body.connectivity->IsGraph()) return;
    const auto metric = FreezeMetric(body.metric, body.connectivity, body.poses);
    LogarithmOptions options;
    options.shapes = 3;
    const Tangent velocity = Logarithm(metric, body.poses[0], body.poses[1], options);
    const Shape end = Exponential(metric, body.poses[0], velocity, 4);
    EXPECT_TRUE(AreCongruent(body, {end}, {body.poses[1]}, 3e-4));
  });
}

TEST(RandomAverage, DoesNotDependOnTheOrderOfPoses) {
  ForAllKinds({1, 2}, 4, [](const RandomBody& body) {
    AverageOptions options;
    options.certify = false;
    options.tolerance = 1e-12;
    options.max_iterations = 5000;
    options.geodesic.metric = body.metric;
    const Shape mean = Average(body.connectivity, body.poses, options).shape;
    const std::vector<Shape> poses = {body.poses[2], body.poses[0], body.poses[3], body.poses[1]};
    EXPECT_TRUE(
        AreCongruent(body, {Average(body.connectivity, poses, options).shape}, {mean}, 1e-5));
  });
}

}  // namespace
}  // namespace shapespace
