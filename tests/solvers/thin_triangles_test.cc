// Caps, needles, and vertices that lie at one place in one of the poses.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/geodesic/detail/thin_vertices.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/minimise/internal/minimise.h>

#include "support/thin_triangles.h"

namespace shapespace {
namespace {

using testing::CapPlace;
using testing::NeedlePlace;
using testing::PosedMesh;
using testing::WithInnerVertices;

constexpr GeodesicSolver kBothLbfgs[] = {GeodesicSolver::kLbfgs, GeodesicSolver::kThreadedLbfgs};

PosedMesh StandingAndSitting() {
  const auto body = MakeQuadruped(600);
  return {body.connectivity, {body.pose("stand"), body.pose("sit")}};
}

GeodesicOptions SevenShapes(GeodesicSolver solver = GeodesicSolver::kAutomatic) {
  GeodesicOptions options;
  options.shapes = 7;
  options.solver = solver;
  return options;
}

double Diagonal(const Shape& shape) {
  return (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).norm();
}

// The greatest distance of the paths' first `count` vertices in the shapes' own frames, as a share
// of the size.
double Distance(const Path& a, const Path& b, const std::vector<int>& vertices) {
  double greatest = 0;
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(vertices.size());
  for (int i = 0; i < a.NumShapes(); ++i) {
    const Shape x = a.Placed(i)(Eigen::all, vertices), y = b.Placed(i)(Eigen::all, vertices);
    const Shape moved = FitRigidMotion(x, y, weights)(x);
    greatest = std::max(greatest, (moved - y).colwise().norm().maxCoeff() / Diagonal(y));
  }
  return greatest;
}

std::vector<int> FirstVertices(int count) {
  std::vector<int> vertices(count);
  for (int v = 0; v < count; ++v) vertices[v] = v;
  return vertices;
}

TEST(ThinTriangles, CapsChangeNeitherEnergyNorPath) {
  const PosedMesh healthy = StandingAndSitting();
  const Path without = Interpolate(healthy.connectivity, healthy.poses, SevenShapes()).path;
  for (const int every : {3, 30}) {
    for (const double height : {1e-2, 1e-3, 1e-4}) {
      const PosedMesh caps = WithInnerVertices(healthy, CapPlace(height), every);
      for (const GeodesicSolver solver : kBothLbfgs) {
        SCOPED_TRACE(height);
        const GeodesicResult result =
            Interpolate(caps.connectivity, caps.poses, SevenShapes(solver));
        EXPECT_TRUE(result.path.converged);
        EXPECT_LT(result.summary.Ratio(), 1.02);
        EXPECT_LT(
            Distance(result.path, without, FirstVertices(healthy.connectivity->NumVertices())),
            0.02);
      }
    }
  }
}

TEST(ThinTriangles, AFewCapsAreAsFlatAsTheyCanBeWritten) {
  const PosedMesh caps = WithInnerVertices(StandingAndSitting(), CapPlace(1e-6), 30);
  for (const GeodesicSolver solver : kBothLbfgs) {
    const GeodesicResult result = Interpolate(caps.connectivity, caps.poses, SevenShapes(solver));
    EXPECT_TRUE(result.path.converged);
    EXPECT_LT(result.summary.Ratio(), 1.02);
  }
}

TEST(ThinTriangles, ANeedleChangesNothing) {
  const auto sheet = MakeSheet(2, 1, 12, 6);
  const PosedMesh healthy = {sheet.connectivity, {sheet.pose(0), sheet.pose(150)}};
  const double ratio =
      Interpolate(healthy.connectivity, healthy.poses, SevenShapes()).summary.Ratio();
  for (const double length : {1e-3, 1e-6, 1e-8}) {
    const PosedMesh needle = WithInnerVertices(healthy, NeedlePlace(length), 1000);
    for (const double tolerance : {1e-4, 1e-8}) {
      SCOPED_TRACE(length);
      GeodesicOptions options = SevenShapes();
      options.tolerance = tolerance;
      const GeodesicResult result = Interpolate(needle.connectivity, needle.poses, options);
      EXPECT_TRUE(result.path.converged);
      EXPECT_LT(result.summary.Ratio(), 1.001 * ratio);
    }
  }
}

// A bar one of whose vertices is at the place of its neighbour in one pose, as after a merge.
PosedMesh Pinched(int edge, bool in_first) {
  const auto bar = MakeBar(4, 1, 1, 24, 6, 6);
  PosedMesh mesh = {bar.connectivity, {bar.pose(0), bar.pose(60)}};
  const Eigen::Vector2i ends = bar.connectivity->Edges().col(edge);
  Shape& pose = mesh.poses[in_first ? 0 : 1];
  pose.col(ends(0)) = pose.col(ends(1));
  return mesh;
}

TEST(ThinTriangles, AMergedVertexMovesNothingFarAway) {
  const auto bar = MakeBar(4, 1, 1, 24, 6, 6);
  const Path without =
      Interpolate(bar.connectivity, {bar.pose(0), bar.pose(60)}, SevenShapes()).path;
  const int num_edges = bar.connectivity->NumTriangleEdges();
  for (int i = 0; i < 12; ++i) {
    const int edge = (i * 389) % num_edges;
    SCOPED_TRACE(edge);
    const PosedMesh mesh = Pinched(edge, i % 2 == 0);
    const GeodesicResult result = Interpolate(mesh.connectivity, mesh.poses, SevenShapes());
    EXPECT_TRUE(result.path.converged);
    const Shape& rest = bar.pose(0);
    const Eigen::Vector3d place = rest.col(bar.connectivity->Edges()(0, edge));
    std::vector<int> far;
    for (int v = 0; v < rest.cols(); ++v) {
      if ((rest.col(v) - place).norm() > 0.1 * Diagonal(rest)) far.push_back(v);
    }
    EXPECT_LT(Distance(result.path, without, far), 0.005);
  }
}

// The legs of a body shrink to points in one pose, as where something is hidden.
TEST(ThinTriangles, APartThatCollapsesLeavesTheOthersAtRest) {
  const auto bar = MakeBar(4, 1, 1, 16, 3, 3);
  const Shape rest = bar.pose(0);
  Shape hidden = rest;
  std::vector<int> others;
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(0, v) > 1) {
      hidden.col(v) = Eigen::Vector3d(1, 0, 0);
    } else if (rest(0, v) < 0.5) {
      others.push_back(v);
    }
  }
  const GeodesicResult result = Interpolate(bar.connectivity, {rest, hidden}, SevenShapes());
  EXPECT_TRUE(result.path.converged);
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(others.size());
  const Shape expected = rest(Eigen::all, others);
  for (const Shape& shape : result.path.Placed()) {
    const Shape part = shape(Eigen::all, others);
    const Shape moved = FitRigidMotion(part, expected, weights)(part);
    EXPECT_LT((moved - expected).colwise().norm().maxCoeff(), 0.005 * Diagonal(rest));
  }
}

// A solve with a preconditioner that misses the stiffness of half of the unknowns. Its steps become
// small long before the minimum.
TEST(ThinTriangles, WhatRemainsIsNeverFarAboveTheToleranceOfASolveThatHasConverged) {
  const auto bar = MakeBar(4, 1, 1, 6, 1, 1);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(70)});
  PathEnergy energy(metric, 3);
  const internal::Cholesky factor(internal::ScalarMetric(*metric, {bar.pose(0) / metric->unit}, 0));
  const internal::CholeskyFactor<float> single(factor);
  for (const double stiffness : {1e3, 1e6, 1e9}) {
    const internal::Objective stiff = [&](const double* x, double* gradient) {
      double value = 0;
      for (size_t i = 0; i < energy.Size(); ++i) {
        const double weight = i % 8 < 3 ? (i / 8 % 2 == 0 ? 1 : stiffness) : 0;
        const double off = x[i] - std::sin(static_cast<double>(i));
        value += weight * off * off;
        if (gradient != nullptr) gradient[i] = 2 * weight * off;
      }
      return value;
    };
    for (const bool own : {false, true}) {
      internal::MinimiseOptions options;
      options.max_iterations = 30;
      options.trusted_remaining = 10;
      std::vector<double> unknowns(energy.Size());
      internal::ChangeOfVariables variables(factor, energy);
      internal::Preconditioner preconditioner(single, energy);
      const internal::MinimiseResult result =
          own ? internal::MinimiseThreadedLbfgs(stiff, internal::PreconditionOf(&preconditioner),
                                                options, &unknowns)
              : internal::MinimiseLbfgs(stiff, &variables, options, &unknowns);
      if (result.termination == Termination::kConverged) {
        EXPECT_LE(result.remaining, options.trusted_remaining * options.tolerance);
      }
      EXPECT_LT(result.energy, result.initial_energy);
    }
  }
}

// Any affine motion of the neighbours carries such a vertex with it.
TEST(ThinVertices, ArePlacedAsInThePoses) {
  const PosedMesh mesh = WithInnerVertices(StandingAndSitting(), CapPlace(1e-3), 3);
  const internal::ThinVertices thin(*mesh.connectivity, mesh.poses);
  ASSERT_FALSE(thin.Empty());
  Eigen::Matrix3d stretch;
  stretch << 1.1, 0.2, 0, 0, 0.9, 0.1, 0, 0, 1.2;
  const int first = StandingAndSitting().connectivity->NumVertices();
  Shape expected = stretch * mesh.poses[0], shape = expected;
  shape.rightCols(shape.cols() - first).array() += 0.01;
  thin.Place(mesh.poses[0], mesh.poses[1], 0, &shape);
  EXPECT_LT((shape - expected).cwiseAbs().maxCoeff(), 1e-10);
  shape.rightCols(shape.cols() - first).setZero();
  shape.leftCols(first) = mesh.poses[1].leftCols(first);
  thin.Place(mesh.poses[0], mesh.poses[1], 1, &shape);
  EXPECT_LT((shape - mesh.poses[1]).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(ThinVertices, OfHealthyBodiesThereAreNone) {
  const PosedMesh mesh = StandingAndSitting();
  EXPECT_TRUE(internal::ThinVertices(*mesh.connectivity, mesh.poses).Empty());
}

}  // namespace
}  // namespace shapespace
