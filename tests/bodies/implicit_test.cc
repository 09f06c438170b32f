#include <shapespace/bodies/detail/implicit.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/bodies/detail/marching_tetrahedra.h>
#include <shapespace/bodies/detail/remesh.h>

#include "bodies/measure.h"

namespace shapespace {
namespace {

using internal::Evaluate;
using internal::ImplicitValue;
using internal::RoundCone;

RoundCone Ball(const Eigen::Vector3d& centre, double radius, double blend = 0) {
  return {centre, centre + Eigen::Vector3d(1e-3, 0, 0), radius, radius, blend};
}

// A cone with ends of different radii, in a general position, flattened along a general direction.
RoundCone SlantedCone(double flatness) {
  return {{0.1, -0.2, 0.3}, {1.3, 0.5, -0.4}, 0.5, 0.2, 0.1, Eigen::Vector3d(1, 2, 2) / 3,
          flatness};
}

Eigen::Vector3d NumericalGradient(const std::vector<RoundCone>& cones,
                                  const Eigen::Vector3d& point) {
  Eigen::Vector3d gradient;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
    gradient(k) =
        (Evaluate(cones, point + step).value - Evaluate(cones, point - step).value) / 2e-6;
  }
  return gradient;
}

TEST(ImplicitTest, ARoundConeIsTheHullOfItsBalls) {
  // Along the x axis with radii 0.5 and 0.2; the tangent planes have a slope of 0.3 / 2.
  const RoundCone cone = {{0, 0, 0}, {2, 0, 0}, 0.5, 0.2};
  const auto value = [&](double x, double y, double z) {
    return Evaluate(cone, Eigen::Vector3d(x, y, z)).value;
  };
  EXPECT_NEAR(value(-1, 0, 0), 0.5, 1e-12);
  EXPECT_NEAR(value(2.7, 0, 0), 0.5, 1e-12);
  EXPECT_NEAR(value(-3, 0, 4), 5 - 0.5, 1e-12);
  EXPECT_NEAR(value(2, 0, 0), -0.2, 1e-6);
  const double sine = 0.3 / 2, cosine = std::sqrt(1 - sine * sine);
  // On the tangent cone above the middle of the axis, and one unit from it.
  const Eigen::Vector3d normal(sine, 0, cosine),
      touching = Eigen::Vector3d(1, 0, 0) + 0.35 * normal;
  const ImplicitValue on = Evaluate(cone, touching);
  EXPECT_NEAR(on.value, 0, 1e-12);
  EXPECT_NEAR(on.radius, 0.35, 1e-12);
  EXPECT_LT((on.gradient - normal).norm(), 1e-12);
  EXPECT_NEAR(Evaluate(cone, touching + normal).value, 1, 1e-12);
  EXPECT_NEAR(Evaluate(cone, touching + normal).radius, 0.35, 1e-12);
}

TEST(ImplicitTest, FlatnessShrinksADirection) {
  RoundCone ball = Ball({0, 0, 0}, 0.6);
  ball.flat = Eigen::Vector3d::UnitZ();
  ball.flatness = 0.25;
  EXPECT_NEAR(Evaluate(ball, Eigen::Vector3d(5e-4, 0, 0.15)).value, 0, 1e-6);
  EXPECT_NEAR(Evaluate(ball, Eigen::Vector3d(5e-4, 0, -0.25)).value, 0.4, 1e-6);
  EXPECT_NEAR(Evaluate(ball, Eigen::Vector3d(0, 0.6, 0)).value, 0, 1e-6);
  EXPECT_NEAR(Evaluate(ball, Eigen::Vector3d(0, 0.6, 0)).radius, 0.15, 1e-12);
}

TEST(ImplicitTest, GradientsAreDerivatives) {
  const std::vector<RoundCone> cones = {SlantedCone(0.6), Ball({0.4, 0.3, 0.2}, 0.4, 0.3),
                                        SlantedCone(1)};
  for (const size_t count : {1, 2, 3}) {
    const std::vector<RoundCone> first(cones.begin(), cones.begin() + count);
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0.9, 1.1, 0.7), Eigen::Vector3d(0.2, 0.5, 0.6),
          Eigen::Vector3d(1.5, 0.2, -0.3), Eigen::Vector3d(-0.4, 0.3, 0.1)}) {
      EXPECT_LT((Evaluate(first, point).gradient - NumericalGradient(first, point)).norm(), 1e-6)
          << count << ": " << point.transpose();
    }
  }
}

TEST(ImplicitTest, AFilletIsASixthOfItsWidthDeepInTheMiddle) {
  const RoundCone first = Ball({-1, 0, 0}, 0.7), second = Ball({1, 0, 0}, 0.3, 0.6);
  const Eigen::Vector3d equal(0.2, 0, 0);  // 0.5 from both
  const ImplicitValue both = Evaluate({first, second}, equal);
  EXPECT_NEAR(both.value, 0.5 - 0.6 / 6, 1e-3);
  EXPECT_NEAR(both.radius, 0.5, 1e-3);  // the mean
  // Where one is nearer than the other by the width or more, it is alone.
  const Eigen::Vector3d left(-0.5, 0.9, 0.2);
  EXPECT_EQ(Evaluate({first, second}, left).value, Evaluate(first, left).value);
  EXPECT_EQ(Evaluate({first, second}, left).radius, 0.7);
  const Eigen::Vector3d right(1.2, 0.3, 0.1);
  EXPECT_EQ(Evaluate({first, second}, right).value, Evaluate(second, right).value);
  // Half of the width nearer: an overlap of 1/2, whose cube is 1/8 and half of whose square is 1/8.
  const Eigen::Vector3d nearer_second(0.35, 0, 0);  // 0.65 and 0.35
  const ImplicitValue part = Evaluate({first, second}, nearer_second);
  EXPECT_NEAR(part.value, 0.35 - 0.6 / 6 / 8, 2e-3);
  EXPECT_NEAR(part.radius, 0.3 * 7 / 8 + 0.7 / 8, 2e-3);
}

TEST(ImplicitTest, ProjectionEndsOnTheSurfaceNearby) {
  const std::vector<RoundCone> cones = {SlantedCone(0.7), Ball({0.4, 0.3, 0.2}, 0.4, 0.2)};
  for (const Eigen::Vector3d& start :
       {Eigen::Vector3d(0.5, 0.9, 0.4), Eigen::Vector3d(1.3, 0.7, -0.5),
        Eigen::Vector3d(0, -0.3, 0.1), Eigen::Vector3d(0.3, 0.3, -0.1)}) {
    Eigen::Vector3d point = start;
    const ImplicitValue here = internal::Project(cones, &point);
    EXPECT_LT(std::abs(Evaluate(cones, point).value), 1e-3 * here.radius) << start.transpose();
    const double away = std::abs(Evaluate(cones, start).value);
    EXPECT_LT((point - start).norm(), 2 * away + 1e-3) << start.transpose();
  }
  // No step is longer than half of the radius, and there are four.
  Eigen::Vector3d far(100, 0, 0);
  internal::Project({Ball({0, 0, 0}, 0.4)}, &far);
  EXPECT_NEAR(far.x(), 100 - 4 * 0.2, 1e-9);
}

TEST(MarchTest, ABallIsAClosedSurfaceWithItsVolume) {
  const Eigen::Vector3d centre(3, -2, 0.5);
  const internal::TriangleMesh mesh = internal::March({Ball(centre, 0.5)}, 0.06);
  const int count = static_cast<int>(mesh.points.size());
  const auto connectivity = internal::ConnectivityOf(count, mesh.triangles);
  Shape shape(3, count);
  for (int v = 0; v < count; ++v) shape.col(v) = mesh.points[v] - centre;
  EXPECT_EQ(UnmatchedSides(*connectivity), 0);
  EXPECT_EQ(EulerCharacteristic(*connectivity), 2);
  EXPECT_NEAR(VolumeOf(*connectivity, shape), 4.0 / 3 * M_PI * 0.125, 0.01);
  EXPECT_NEAR(shape.colwise().norm().minCoeff(), 0.5, 0.006);
  EXPECT_NEAR(shape.colwise().norm().maxCoeff(), 0.5, 0.006);
}

TEST(RemeshTest, VerticesAreOnTheSurfaceAndTrianglesAreSmallerWhereItIsThin) {
  const std::vector<RoundCone> cones = {{{0, 0, 0}, {2, 0, 0}, 0.6, 0.15}};
  const internal::TriangleMesh mesh = internal::Remesh(internal::March(cones, 0.1), cones, 1500);
  EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), 1500, 100);
  for (const Eigen::Vector3d& point : mesh.points) {
    EXPECT_LT(std::abs(Evaluate(cones, point).value), 1e-3);
  }
  double thick = 0, thin = 0;
  int num_thick = 0, num_thin = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.points[t(0)];
    const double length = (mesh.points[t(1)] - a).norm();
    if (a.x() < 0) thick += length, ++num_thick;
    if (a.x() > 1.9) thin += length, ++num_thin;
  }
  // The lengths are as the radii to the power of 0.65, within the limit of gradation.
  EXPECT_NEAR((thick / num_thick) / (thin / num_thin), std::pow(0.6 / 0.17, 0.65), 0.35);
}

}  // namespace
}  // namespace shapespace
