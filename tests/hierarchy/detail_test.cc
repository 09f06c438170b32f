// Where vertices lie on a coarser mesh, and how neighbourhoods turn and stretch: each by what it is
// defined to be.

#include <shapespace/hierarchy/internal/detail.h>

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/mesh/internal/geometry.h>

#include "hierarchy/meshes.h"

namespace shapespace::internal {
namespace {

using testing::Noise;

// Two triangles whose corners come first, and two vertices that they carry.
struct CarriedVertices {
  CarriedVertices()
      : coarse(Connectivity::Make(4, {0, 3, 6}, {0, 1, 2, 1, 3, 2}, {})), first(3, 6), last(3, 6) {
    first.leftCols(4) << 0, 2, 0, 2, 0, 0, 2, 2, 0, 0, 0, 0.3;
    last.leftCols(4) = first.leftCols(4) + Noise(4, 0.2, 1);
    for (Shape* shape : {&first, &last}) shape->rightCols(2).setZero();
  }
  void Place(int triangle, const Eigen::Vector3d& in_first, const Eigen::Vector3d& in_last) {
    const Eigen::Vector3i corners = coarse->Triangles().col(triangle);
    const int v = 4 + triangle;
    for (int k = 0; k < 3; ++k) {
      first.col(v) += in_first(k) * first.col(corners(k));
      last.col(v) += in_last(k) * last.col(corners(k));
    }
  }
  std::shared_ptr<const Connectivity> coarse;
  Shape first, last;
};

TEST(FindCarriers, WeightsAreMeansOverThePosesOfThoseOfTheNearestPoint) {
  CarriedVertices mesh;
  const Eigen::Vector3d a(0.2, 0.3, 0.5), b(0.4, 0.3, 0.3), c(0.1, 0.2, 0.7), d(0.5, 0.2, 0.3);
  mesh.Place(0, a, b);
  mesh.Place(1, c, d);
  // Lifted off the triangles, which changes no nearest point.
  for (Shape* shape : {&mesh.first, &mesh.last}) {
    for (int f = 0; f < 2; ++f) {
      shape->col(4 + f) +=
          0.01 * UnitNormal(Shape(shape->leftCols(4)), mesh.coarse->Triangles().col(f));
    }
  }
  const Carriers carriers =
      FindCarriers(*mesh.coarse, {0, 1, 2, 3}, {0, 1, 2, 3, 0, 0}, {mesh.first, mesh.last});
  for (int v = 0; v < 4; ++v) {
    EXPECT_EQ(carriers.vertices.col(v), Eigen::Vector3i::Constant(v));
    EXPECT_EQ(carriers.weights.col(v), Eigen::Vector3d::UnitX());
  }
  for (int f = 0; f < 2; ++f) {
    EXPECT_EQ(carriers.vertices.col(4 + f), mesh.coarse->Triangles().col(f));
  }
  EXPECT_LT((carriers.weights.col(4) - (a + b) / 2).norm(), 1e-12);
  EXPECT_LT((carriers.weights.col(5) - (c + d) / 2).norm(), 1e-12);
}

// A body at rest, and moved as nothing rigid moves.
struct Moved {
  const testing::PosedMesh mesh = testing::Animal(300);
  const Connectivity& connectivity = *mesh.connectivity;
  const Shape rest = mesh.poses[0];
  const double size = rest.norm() / std::sqrt(rest.cols());
  const Shape moved = mesh.poses[1] + Noise(static_cast<int>(rest.cols()), 0.02 * size, 3);

  // By vertex: the sum of the normals of its triangles.
  Shape Normals(const Shape& shape) const {
    Shape normals = Shape::Zero(3, shape.cols());
    for (const Eigen::Vector3i t : connectivity.Triangles().colwise()) {
      for (const int v : t) normals.col(v) += AreaNormal(shape, t);
    }
    return normals;
  }
  // The sum over the edges at v of the squares of |map e - e'|.
  double Misfit(int v, const Eigen::Matrix3d& map) const {
    double sum = 0;
    for (const int e : connectivity.EdgesOfVertices()[v]) {
      const int w = connectivity.OtherEnd(e, v);
      sum += (map * (rest.col(w) - rest.col(v)) - (moved.col(w) - moved.col(v))).squaredNorm();
    }
    return sum;
  }
};

// Whatever other matrix is near, it is worse.
void ExpectLeast(const std::function<double(const Eigen::Matrix3d&)>& value,
                 const Eigen::Matrix3d& at, const std::vector<Eigen::Matrix3d>& others, int v) {
  for (const Eigen::Matrix3d& other : others) EXPECT_LT(value(at), value(other)) << v;
}

TEST(VertexRotations, FitEdgesAndNormalsBest) {
  const Moved body;
  const std::vector<Eigen::Matrix3d> rotations =
      VertexRotations(body.connectivity, body.rest, body.moved);
  const Shape before = body.Normals(body.rest), after = body.Normals(body.moved);
  for (int v = 0; v < body.rest.cols(); ++v) {
    EXPECT_LT((rotations[v] * rotations[v].transpose() - Eigen::Matrix3d::Identity()).norm(),
              1e-12);
    EXPECT_GT(rotations[v].determinant(), 0);
    // A normal counts as an edge that is as long as the root of the product of both.
    const double length = std::sqrt(before.col(v).norm() * after.col(v).norm());
    const auto value = [&](const Eigen::Matrix3d& rotation) {
      return body.Misfit(v, rotation) +
             (rotation * before.col(v) - after.col(v)).squaredNorm() / length;
    };
    std::vector<Eigen::Matrix3d> others;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double angle : {-1e-4, 1e-4}) {
        others.emplace_back(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)) * rotations[v]);
      }
    }
    ExpectLeast(value, rotations[v], others, v);
  }
}

TEST(VertexGradients, FitEdgesBestBesideATenthForTheRotation) {
  const Moved body;
  const std::vector<Eigen::Matrix3d> rotations =
      VertexRotations(body.connectivity, body.rest, body.moved);
  const std::vector<Eigen::Matrix3d> gradients =
      VertexGradients(body.connectivity, body.rest, body.moved);
  for (int v = 0; v < body.rest.cols(); ++v) {
    double squares = 0;
    for (const int e : body.connectivity.EdgesOfVertices()[v]) {
      squares += (body.rest.col(body.connectivity.OtherEnd(e, v)) - body.rest.col(v)).squaredNorm();
    }
    const auto value = [&](const Eigen::Matrix3d& map) {
      return body.Misfit(v, map) + 0.1 * squares * (map - rotations[v]).squaredNorm();
    };
    std::vector<Eigen::Matrix3d> others;
    for (int entry = 0; entry < 9; ++entry) {
      for (const double change : {-1e-4, 1e-4}) {
        others.push_back(gradients[v]);
        others.back()(entry) += change;
      }
    }
    ExpectLeast(value, gradients[v], others, v);
  }
}

}  // namespace
}  // namespace shapespace::internal
