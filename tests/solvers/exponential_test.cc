#include <shapespace/exponential/exponential.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/catenoid.h>
#include <shapespace/bodies/miura.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/skinned.h>
#include <shapespace/bodies/steffen.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/metric/feature_map.h>

#include "support/features.h"
#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"
#include "support/paths.h"
#include "support/runge_kutta.h"

namespace shapespace {
namespace {

using testing::Deforming;
using testing::Diameter;
using testing::Distance;
using testing::Listener;
using testing::MessageOf;
using testing::Motion;
using testing::Names;
using testing::Rotation;
using testing::Turning;
using Ending = ExponentialSummary::Ending;

constexpr GeodesicIntegrator kAllIntegrators[] = {GeodesicIntegrator::kVariational,
                                                  GeodesicIntegrator::kFirstIntegral};

ExponentialOptions Options(GeodesicIntegrator integrator, double tolerance = 1e-9) {
  ExponentialOptions options;
  options.integrator = integrator;
  options.tolerance = tolerance;
  return options;
}

ExponentialResult Shoot(
    const Motion& motion, int steps,
    const ExponentialOptions& options = Options(GeodesicIntegrator::kVariational)) {
  return Extrapolate(motion.metric, motion.shape, motion.velocity, steps, options);
}

Shape End(const Motion& motion, int steps) {
  return Exponential(motion.metric, motion.shape, motion.velocity, steps);
}

// The same by the other scheme.
Shape Exact(const Motion& motion, int steps) {
  return testing::RungeKutta(motion.metric, motion.shape, motion.velocity, steps).back();
}

MetricOptions Membrane(double lambda) {
  MetricOptions options = MetricOptions::Isometric();
  options.bending = 0;
  options.lambda = lambda;
  return options;
}

// Large motions: vertices move by a tenth of the body's size or more.
std::vector<Motion> TurningBodies() {
  return {Turning(MakeBar(6, 1, 1, 6, 1, 1), 30, 90, {}),
          Turning(MakeSheet(2, 1, 8, 4), 90, 90, {}), Turning(MakeBricard(), 0, 90, {})};
}

std::vector<Motion> DeformingBodies() {
  return {Deforming(MakeStrip(1, 0.9, 16), 5, 10, {}), Deforming(MakeBricard(), 0, 25, {}),
          Deforming(MakeSteffen(), 0, 10, {}), Deforming(MakeMiura(1, 1, 60, 3, 3), 40, 20, {}),
          Deforming(MakeCatenoid(0.8, 12, 4), 20, 40, {})};
}

std::vector<Motion> AllMotions() {
  std::vector<Motion> motions = TurningBodies();
  for (Motion& motion : DeformingBodies()) motions.push_back(motion);
  return motions;
}

TEST(Exponential, TranslatesExactly) {
  MetricOptions volume;
  volume.volume = 0.3;
  std::vector<Motion> motions = {Turning(MakeBar(6, 1, 1, 6, 1, 1), 30, 0, {}),
                                 Turning(MakeBar(6, 1, 1, 6, 1, 1), 30, 0, volume),
                                 Turning(MakeSheet(2, 1, 8, 4), 90, 0, {}),
                                 Turning(MakeSteffen(), 5, 0, {})};
  Shape edge = Shape::Zero(3, 2);
  edge.col(1) << 1, 2, 3;
  motions.push_back({"edge", FreezeMetric(Membrane(1e-4), testing::SingleEdge(), {edge}), edge,
                     Tangent::Zero(3, 2)});
  for (Motion& motion : motions) {
    SCOPED_TRACE(motion.name);
    const Eigen::Vector3d way(3, -4, 0.5);
    motion.velocity.colwise() += way;
    for (const GeodesicIntegrator integrator : kAllIntegrators) {
      if (integrator == GeodesicIntegrator::kFirstIntegral && motion.metric->options.volume > 0)
        continue;
      const auto [path, summary] = Shoot(motion, 4, Options(integrator));
      EXPECT_TRUE(summary.Converged()) << summary.FullReport();
      for (int i = 0; i <= 4; ++i) {
        EXPECT_EQ(path.parameters[i], i / 4.0);
        EXPECT_LT(Distance(path.Placed(i), motion.shape.colwise() + i / 4.0 * way),
                  1e-12 * Diameter(motion.shape));
      }
    }
  }
}

TEST(Exponential, IsAStraightLineInAFlatMetric) {
  MetricOptions flat;
  flat.strain = flat.bending = 0;
  flat.lambda = 1;
  for (const ShapeFamily& body :
       {MakeBar(6, 1, 1, 6, 1, 1), MakeSheet(2, 1, 8, 4), MakeSteffen()}) {
    SCOPED_TRACE(body.name);
    Motion motion = Turning(body, body.begin, 0, flat);
    // A short motion only, so that no edge vanishes.
    const double size = Diameter(motion.shape);
    motion.velocity = testing::Noise(static_cast<int>(motion.shape.cols()), 0.01 * size, 1);
    for (const GeodesicIntegrator integrator : kAllIntegrators) {
      const auto [path, summary] = Shoot(motion, 5, Options(integrator));
      EXPECT_TRUE(summary.Converged()) << summary.FullReport();
      for (int i = 0; i <= 5; ++i) {
        EXPECT_LT(Distance(path.Placed(i), motion.shape + i / 5.0 * motion.velocity), 1e-12 * size);
      }
    }
  }
}

TEST(Exponential, StaysWhereThereIsNoVelocity) {
  for (const GeodesicIntegrator integrator : kAllIntegrators) {
    const Motion motion = Turning(MakeBricard(), 10, 0, {});
    const auto [path, summary] = Shoot(motion, 3, Options(integrator));
    EXPECT_TRUE(summary.Converged());
    for (const Shape& shape : path.shapes) EXPECT_TRUE(shape == path.shapes[0]);
  }
}

// The integrator is derived from the discrete energy, and the Runge-Kutta scheme of the tests from
// the geodesic equation with the features' second derivatives. They agree in the limit, each with
// its own order.
TEST(Exponential, ConvergesWithItsOrderToTheSolutionOfTheGeodesicEquation) {
  for (const Motion& motion : AllMotions()) {
    SCOPED_TRACE(motion.name);
    const Shape exact = Exact(motion, 128);
    const double way = Distance(exact, motion.shape);
    const auto error = [&](const Shape& end) { return Distance(end, exact) / way; };
    const double coarse = error(End(motion, 8));
    EXPECT_LT(coarse, 1e-2);
    const double middle = error(End(motion, 16));
    const double fine = error(End(motion, 32));
    EXPECT_NEAR(std::log2(coarse / middle), 2, 0.1);
    EXPECT_NEAR(std::log2(middle / fine), 2, 0.1);

    const double coarse_4 = error(Exact(motion, 8));
    const double fine_4 = error(Exact(motion, 16));
    EXPECT_LT(coarse_4, 0.1 * coarse);
    EXPECT_NEAR(std::log2(coarse_4 / fine_4), 4, 0.3);
  }
}

// If the first step were an Euler step M + dt X, it alone would cause an error of second order.
TEST(Exponential, SetsOutWithAnErrorOfThirdOrder) {
  for (const Motion& motion : AllMotions()) {
    SCOPED_TRACE(motion.name);
    double previous = 0;
    for (double time : {1 / 8.0, 1 / 16.0, 1 / 32.0}) {
      const Motion short_one = motion.Times(time);
      const double error = Distance(End(short_one, 1), Exact(short_one, 16));
      if (previous > 0) {
        EXPECT_NEAR(std::log2(previous / error), 3, 0.25);
      }
      previous = error;
    }
  }
}

// A geodesic of an edge whose centroid rests, as a curve r(t), phi(t) in a plane: with h =
// r^2 phi' and the energy F = (w r^2 + c) r'^2 + c h^2 / r^2 constant (Clairaut), time and angle
// at a length r are integrals over it. By Simpson's rule.
struct Clairaut {
  double w, c, h, energy, start;

  template <typename Integrand>
  double Integrate(const Integrand& integrand, double end) const {
    constexpr int kIntervals = 2000;
    const double step = (end - start) / kIntervals;
    double sum = 0;
    for (int i = 0; i <= kIntervals; ++i) {
      sum += (i == 0 || i == kIntervals ? 1 : i % 2 == 1 ? 4 : 2) * integrand(start + i * step);
    }
    return sum * step / 3;
  }
  double Slowness(double r) const {  // dt / dr
    return std::sqrt((w * r * r + c) / (energy - c * h * h / (r * r)));
  }
  double Time(double end) const {
    return Integrate([&](double r) { return Slowness(r); }, end);
  }
  double Angle(double end) const {
    return Integrate([&](double r) { return h / (r * r) * Slowness(r); }, end);
  }
};

TEST(Exponential, MovesASingleEdgeAsClairautSays) {
  const double kLength = 1.5, kOutwards = 0.9, kSideways = 1.2, kLambda = 0.7;
  const Eigen::Vector3d along = Eigen::Vector3d(1, 2, -2).normalized();
  const Eigen::Vector3d across = along.cross(Eigen::Vector3d::UnitX()).normalized();
  Motion motion{"edge", nullptr, Shape(3, 2), Tangent(3, 2)};
  for (int k : {0, 1}) {
    const double sign = k == 0 ? -0.5 : 0.5;
    motion.shape.col(k) = sign * kLength * along;
    motion.velocity.col(k) = sign * (kOutwards * along + kSideways * across);
  }
  motion.metric = FreezeMetric(Membrane(kLambda), testing::SingleEdge(), {motion.shape});
  const double unit = motion.metric->unit;
  Clairaut exact{};
  exact.w = testing::Get<EdgeLength>(*motion.metric).weights(0);
  // Each vertex has half the speed of the edge's vector.
  exact.c = kLambda * motion.metric->vertex_area.sum() / 4;
  exact.start = kLength / unit;
  exact.h = exact.start * kSideways / unit;
  exact.energy = (exact.w * exact.start * exact.start + exact.c) * std::pow(kOutwards / unit, 2) +
                 exact.c * std::pow(kSideways / unit, 2);

  double previous[2] = {0, 0};
  for (int steps : {8, 16, 32}) {
    const auto [path, summary] =
        Shoot(motion, steps, Options(GeodesicIntegrator::kVariational, 1e-13));
    const Eigen::Vector3d edge = path.shapes.back().col(1) - path.shapes.back().col(0);
    EXPECT_LT(std::abs(edge.dot(along.cross(across))), 1e-12);
    const double r = edge.norm(), angle = std::atan2(edge.dot(across), edge.dot(along));
    EXPECT_GT(r, 1.2 * exact.start);
    EXPECT_GT(angle, 0.3);
    const double errors[2] = {std::abs(exact.Time(r) - 1), std::abs(exact.Angle(r) - angle)};
    for (int k : {0, 1}) {
      EXPECT_LT(errors[k], 1e-2);
      if (previous[k] > 0) {
        EXPECT_NEAR(previous[k] / errors[k], 4, 0.3) << k;
      }
      previous[k] = errors[k];
    }
  }
  const Shape last = Exact(motion, 64) / motion.metric->unit;
  EXPECT_NEAR(exact.Time((last.col(1) - last.col(0)).norm()), 1, 1e-7);
}

// All features except positions are invariant under rigid motion, so by Noether's theorem the
// discrete momenta are those of free points with masses A_p.
TEST(Exponential, KeepsTheMomentaOfFreePoints) {
  for (Motion motion : AllMotions()) {
    SCOPED_TRACE(motion.name);
    motion.velocity.colwise() += 0.3 * Diameter(motion.shape) * Eigen::Vector3d(1, 2, -2) / 3;
    motion.velocity += testing::Spin(*motion.metric, motion.shape, 40, {1, 0.3, 0});
    const Eigen::VectorXd& mass = motion.metric->vertex_area;
    const auto [path, summary] =
        Shoot(motion, 50, Options(GeodesicIntegrator::kVariational, 1e-13));
    EXPECT_TRUE(summary.Converged()) << summary.FullReport();
    Eigen::Vector3d linear[2], angular[2];
    for (int i = 0; i < 50; ++i) {
      const Shape &p = path.shapes[i], &q = path.shapes[i + 1];
      const int k = i == 0 ? 0 : 1;
      linear[k] = (q - p) * mass;
      angular[k].setZero();
      for (int v = 0; v < p.cols(); ++v) {
        const Eigen::Vector3d a = p.col(v), b = q.col(v);
        angular[k] += mass(v) * a.cross(b);
      }
      if (i == 0) continue;
      EXPECT_LT((linear[1] - linear[0]).norm(), 1e-11 * linear[0].norm());
      EXPECT_LT((angular[1] - angular[0]).norm(), 1e-11 * angular[0].norm());
      EXPECT_LT(summary.steps[i].momentum_drift, 1e-11);
    }
  }
}

// By symmetry the edge's centroid rests, so that only its angular momentum can change. The forces
// between its ends have no moment.
TEST(FirstIntegral, SaysHowMuchAngularMomentumItLoses) {
  const Eigen::Vector3d end = Eigen::Vector3d(1, 2, -2) / 3;
  Shape edge(3, 2);
  edge << -end, end;
  const auto metric = FreezeMetric(Membrane(0.7), testing::SingleEdge(), {edge});
  const Tangent spin = testing::Spin(*metric, edge, 90, {0.3, 1, 0.5});
  const auto [path, summary] =
      Extrapolate(metric, edge, spin, 8, Options(GeodesicIntegrator::kFirstIntegral));
  ASSERT_EQ(summary.steps.size(), 8u);
  const auto momentum = [&, &shapes = path.shapes](int i) {
    const Eigen::Vector3d a = shapes[i].col(1), b = shapes[i + 1].col(1);
    EXPECT_LT((shapes[i].col(0) + a).norm(), 1e-12);
    return Eigen::Vector3d(a.cross(b));
  };
  EXPECT_LT(momentum(7).norm(), 0.6 * momentum(0).norm());
  EXPECT_EQ(summary.steps.front().momentum_drift, 0);
  EXPECT_GT(summary.steps.back().momentum_drift, 0.3);
}

// A path between two poses of a body. Its tolerance is a relative decrease of the energy; the
// path's error is proportional to the tolerance's square root, and grows when shooting, so that
// 1e-15 is necessary. With larger tolerances the round trip is inaccurate because of the path, not
// because of the integrator.
LogarithmOptions Exactly(int shapes) {
  LogarithmOptions options;
  options.shapes = shapes;
  options.tolerance = 1e-15;
  return options;
}

struct BodyPair {
  ShapeFamily body;
  double first, last;
};

std::vector<BodyPair> BodyPairs() {
  return {{MakeBar(6, 1, 1, 6, 1, 1), 0, 90},
          {MakeSheet(2, 1, 8, 4), 0, 90},
          {MakeBricard(), 0, 25},
          {MakeSteffen(), -10, 5},
          {MakeMiura(1, 1, 60, 3, 3), 20, 45}};
}

TEST(Exponential, UndoesTheLogarithm) {
  for (const auto& [body, first, last] : BodyPairs()) {
    SCOPED_TRACE(body.name);
    const Shape from = body.pose(first).colwise() + Eigen::Vector3d(5, 6, 7);
    const Shape to = Rotation(30, {1, 2, 3}) * body.pose(last);
    const auto metric = FreezeMetric({}, body.connectivity, {from, to});
    for (int shapes : {3, 7}) {
      const Tangent velocity = Logarithm(metric, from, to, Exactly(shapes));
      const Shape end = Exponential(metric, from, velocity, shapes + 1);
      // Logarithms are of aligned shapes.
      const Shape expected = FitRigidMotion(to, from, metric->vertex_area)(to);
      EXPECT_LT(Distance(end, expected), 1e-6 * Diameter(to));
    }
  }
}

TEST(Extrapolate, FromTheFirstTwoShapesReturnsTheOthers) {
  for (const auto& [body, first, last] : BodyPairs()) {
    SCOPED_TRACE(body.name);
    for (int shapes : {3, 7}) {
      const Path path =
          Interpolate(body.connectivity, {body.pose(first), body.pose(last)}, Exactly(shapes)).path;
      const auto [again, summary] = Extrapolate(FirstShapes(path, 2), shapes);
      EXPECT_TRUE(summary.Converged());
      ASSERT_EQ(again.NumShapes(), path.NumShapes());
      EXPECT_EQ(again.extrapolated, shapes);
      EXPECT_EQ(Extrapolate(again, 1).path.extrapolated, shapes + 1);
      for (int i = 0; i < path.NumShapes(); ++i) {
        EXPECT_NEAR(again.parameters[i], path.parameters[i], 1e-14);
        EXPECT_LT(Distance(again.shapes[i], path.shapes[i]), 1e-6 * Diameter(path.shapes[i]));
      }
    }
  }
}

// On the path and on its continuation to three times its length.
// A bar that becomes longer at a constant rate.
TEST(Extrapolate, EdgesAreComparedWithTheFirstShapeOfThePath) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  const Shape rest = bar.pose(0);
  std::vector<Shape> shapes;
  for (const double stretch : {1.0, 1.1, 1.2}) {
    shapes.emplace_back(Eigen::Vector3d(stretch, 1, 1).asDiagonal() * rest);
  }
  const auto metric = FreezeMetric({}, bar.connectivity, {shapes.front(), shapes.back()});
  const auto [longer, summary] = Extrapolate(MakePath(metric, shapes), 2);
  ASSERT_EQ(summary.steps.size(), 2u);
  for (int i : {0, 1}) {
    const RmsAndMax deviation = DeviationFromFirst(longer, 3 + i);
    EXPECT_GT(deviation.max, 0.25 + 0.1 * i);
    EXPECT_NEAR(summary.steps[i].edge_max, deviation.max, 1e-6);
    EXPECT_NEAR(summary.steps[i].edge_rms, deviation.rms, 1e-6);
  }
}

TEST(Extrapolate, KeepsTheEnergyToSecondOrder) {
  for (const auto& [body, first, last] :
       {BodyPair{MakeBricard(), 0, 25}, BodyPair{MakeMiura(1, 1, 60, 3, 3), 20, 45}}) {
    SCOPED_TRACE(body.name);
    double previous = 0;
    for (int segments : {8, 16}) {
      const Path path =
          Interpolate(body.connectivity, {body.pose(first), body.pose(last)}, Exactly(segments - 1))
              .path;
      const auto [longer, summary] = Extrapolate(path, 2 * segments);
      EXPECT_TRUE(summary.Converged()) << summary.FullReport();
      const FeatureMap map(path.metric);
      std::vector<double> energies;
      for (int i = 0; i < 3 * segments; ++i) {
        energies.push_back(
            std::pow(segments, 2) *
            (map.Values(longer.shapes[i + 1]) - map.Values(longer.shapes[i])).squaredNorm());
        if (i >= segments) {
          EXPECT_NEAR(summary.steps[i - segments].energy, energies[i], 1e-9 * energies[i]);
        }
      }
      const auto [least, most] = std::minmax_element(energies.begin(), energies.end());
      const double spread = *most / *least - 1;
      EXPECT_LT(spread, 2e-3);
      if (previous > 0) {
        EXPECT_NEAR(previous / spread, 4, 0.5);
      }
      previous = spread;
    }
  }
}

// The diagonals of all cells parallel, in turns, and at random.
enum class Diagonals { kParallel, kInTurns, kRandom };

class SquashedStrip : public ::testing::TestWithParam<Diagonals> {};

// A strip of 5 by 1 that is half as long in the second pose stays a rectangle.
TEST_P(SquashedStrip, StaysARectangle) {
  constexpr int kLong = 20, kWide = 4;
  std::mt19937 random(4);
  const auto vertex = [](int i, int j) { return (kLong + 1) * j + i; };
  Shape rest = Shape::Zero(3, (kLong + 1) * (kWide + 1));
  for (int j = 0; j <= kWide; ++j) {
    for (int i = 0; i <= kLong; ++i) rest.col(vertex(i, j)) << 5.0 * i / kLong, 1.0 * j / kWide, 0;
  }
  std::vector<int> begin = {0}, corners;
  for (int j = 0; j < kWide; ++j) {
    for (int i = 0; i < kLong; ++i) {
      int quad[] = {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)};
      const bool other = GetParam() == Diagonals::kInTurns
                             ? (i + j) % 2 == 1
                             : GetParam() == Diagonals::kRandom && random() % 2 == 1;
      if (other) std::rotate(quad, quad + 1, quad + 4);
      corners.insert(corners.end(), {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
      begin.insert(begin.end(), {begin.back() + 3, begin.back() + 6});
    }
  }
  const auto strip = Connectivity::Make(static_cast<int>(rest.cols()), begin, corners);
  const Shape squashed = Eigen::Vector3d(0.5, 1, 1).asDiagonal() * rest;
  GeodesicOptions geodesic;
  geodesic.shapes = 3;
  geodesic.tolerance = 1e-10;
  const Path path = Interpolate(strip, {rest, squashed}, geodesic).path;
  const Path longer = Extrapolate(path, 8).path;
  for (int i = 0; i < longer.NumShapes(); ++i) {
    const Shape& shape = longer.shapes[i];
    const Eigen::Vector3d along = shape.col(vertex(kLong, 0)) - shape.col(vertex(0, 0));
    const Eigen::Vector3d across = shape.col(vertex(0, kWide)) - shape.col(vertex(0, 0));
    const double angle = std::acos(along.normalized().dot(across.normalized()));
    EXPECT_NEAR(angle * 180 / M_PI, 90, 0.1) << i;
    EXPECT_NEAR(along.norm() * longer.metric->unit, 5 * std::pow(0.5, longer.parameters[i]), 1e-3)
        << i;
    EXPECT_NEAR(across.norm() * longer.metric->unit, 1, 1e-3) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Extrapolate, SquashedStrip,
                         ::testing::Values(Diagonals::kParallel, Diagonals::kInTurns,
                                           Diagonals::kRandom));

// For a path that is a rigid motion only, and for one that also deforms.
TEST(Extrapolate, GoesOnWithTheRigidMotionAsAScrew) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  const Eigen::Vector3d axis(1, 2, 0.5), way(4, 5, 6);
  for (double last : {20.0, 20.0001, 50.0}) {
    GeodesicOptions geodesic;
    geodesic.shapes = 3;
    const Shape first = bar.pose(20);
    const Shape moved = (Rotation(40, axis) * bar.pose(last)).colwise() + way;
    const Path path = Interpolate(bar.connectivity, {first, moved}, geodesic).path;
    const auto [longer, summary] = Extrapolate(path, 4);
    EXPECT_TRUE(summary.Converged());
    ASSERT_EQ(longer.NumShapes(), 9);
    EXPECT_NEAR(longer.parameters.back(), 2, 1e-14);
    const Eigen::Matrix3d turn =
        longer.motions[4].rotation * longer.motions[0].rotation.transpose();
    EXPECT_LT((longer.motions[8].rotation - turn * longer.motions[4].rotation).norm(), 1e-10);
    EXPECT_LT((longer.motions[8].translation + longer.motions[0].translation -
               2 * longer.motions[4].translation)
                  .norm(),
              1e-10);
    if (last == 20) {
      const Eigen::Vector3d centre = Centroid(first, path.metric->vertex_area);
      const Eigen::Vector3d shift = Centroid(moved, path.metric->vertex_area) - centre;
      const Shape expected =
          (Rotation(80, axis) * (first.colwise() - centre)).colwise() + (centre + 2 * shift);
      EXPECT_LT(Distance(longer.Placed(8), expected), 1e-9);
    }
  }
}

// If only lengths have a cost and they permit a single motion of the body, that motion is the
// geodesic.
TEST(Exponential, FollowsExactIsometricFlexes) {
  for (const ShapeFamily& body : {MakeStrip(1, 0.9, 16), MakeBricard(), MakeSteffen()}) {
    SCOPED_TRACE(body.name);
    double previous = 0;
    for (double lambda : {1e-2, 1e-3, 1e-4}) {
      const Motion motion =
          Deforming(body, body.begin + 0.5 * (body.end - body.begin), 10, Membrane(lambda));
      const auto [path, summary] = Shoot(motion, 16);
      EXPECT_TRUE(summary.Converged()) << summary.FullReport();
      double largest = 0;
      for (const ExponentialSummary::Step& step : summary.steps) {
        largest = std::max(largest, step.edge_max);
      }
      EXPECT_LT(largest, 3 * lambda);
      if (previous > 0) {
        EXPECT_NEAR(previous / largest, 10, 1);
      }
      previous = largest;
    }
  }
  // The Miura fold's parallelograms are stiff only within their planes, so the deviation is
  // proportional to the square root of the tolerance.
  for (double lambda : {1e-2, 1e-3, 1e-4}) {
    const auto [path, summary] =
        Shoot(Deforming(MakeMiura(1, 1, 60, 3, 3), 40, 20, Membrane(lambda)), 16);
    EXPECT_TRUE(summary.Converged());
    EXPECT_LT(summary.steps.back().edge_max, 0.01 * std::sqrt(lambda));
  }
}

// According to the paper's (7), a_j = x_j (G x)_j is constant for every coordinate j. In fact only
// the sum over all j is.
TEST(FirstIntegral, IsNoneOfTheGeodesicEquation) {
  for (const Motion& motion : TurningBodies()) {
    SCOPED_TRACE(motion.name);
    const int steps = 64;
    const auto [path, summary] = Shoot(motion, steps);
    const FeatureMap map(motion.metric);
    Tangent first, last;
    for (int i : {1, steps - 1}) {
      const Tangent x = steps / 2.0 * (path.shapes[i + 1] - path.shapes[i - 1]);
      const FeatureDerivative derivative = map.Derivative(path.shapes[i]);
      (i == 1 ? first : last) = x.cwiseProduct(derivative.TransposeTimes(derivative.Times(x)));
    }
    EXPECT_GT((last - first).lpNorm<1>(), 0.1 * first.lpNorm<1>());
    for (const ExponentialSummary::Step& step : summary.steps) {
      EXPECT_NEAR(step.energy, summary.steps[0].energy, 1e-5 * step.energy);
    }
  }
}

TEST(FirstIntegral, DoesNotConverge) {
  for (const Motion& motion : {TurningBodies()[0], TurningBodies()[1]}) {
    SCOPED_TRACE(motion.name);
    const Shape exact = Exact(motion, 64);
    for (const FirstIntegralSolver solver :
         {FirstIntegralSolver::kLbfgs, FirstIntegralSolver::kLevenbergMarquardt}) {
      ExponentialOptions options = Options(GeodesicIntegrator::kFirstIntegral);
      options.first_integral_solver = solver;
      for (int steps : {8, 16, 32}) {
        const auto [path, summary] = Shoot(motion, steps, options);
        const double error = Distance(path.Placed(steps), exact);
        EXPECT_GT(error, 0.3 * Distance(motion.shape, exact)) << steps;
        for (const ExponentialSummary::Step& step : summary.steps) {
          EXPECT_EQ(step.converged, step.residual <= options.tolerance);
        }
      }
    }
  }
}

TEST(Exponential, BothSolversOfStepsAgree) {
  for (const Motion& motion : {TurningBodies()[0], TurningBodies()[1], DeformingBodies()[1],
                               Deforming(MakeTube(100), 30, 60, {})}) {
    SCOPED_TRACE(motion.name);
    ExponentialOptions options = Options(GeodesicIntegrator::kVariational, 1e-10);
    options.solver = StepSolver::kNewtonKrylov;
    const ExponentialResult newton = Shoot(motion, 8, options);
    options.solver = StepSolver::kCeres;
    const ExponentialResult ceres = Shoot(motion, 8, options);
    EXPECT_TRUE(newton.summary.Converged()) << newton.summary.FullReport();
    EXPECT_TRUE(ceres.summary.Converged()) << ceres.summary.FullReport();
    for (int i = 0; i <= 8; ++i) {
      EXPECT_LT(Distance(newton.path.shapes[i], ceres.path.shapes[i]), 1e-9);
    }
    EXPECT_GT(newton.summary.steps[0].krylov_iterations, 0);
    EXPECT_EQ(ceres.summary.steps[0].krylov_iterations, 0);
  }
}

TEST(Exponential, CommutesWithRotationTranslationAndScale) {
  const Eigen::Matrix3d turn = Rotation(70, {1, 2, -1});
  for (const Motion& motion : {TurningBodies()[0], DeformingBodies()[3], DeformingBodies()[4]}) {
    SCOPED_TRACE(motion.name);
    const Shape end = End(motion, 8);
    for (double scale : {1e-4, 1.0, 1e4}) {
      const Eigen::Vector3d way = scale * Eigen::Vector3d(3, -8, 5);
      const auto move = [&](const Shape& x) -> Shape { return scale * (turn * x); };
      Motion moved = motion;
      moved.shape = move(motion.shape).colwise() + way;
      moved.velocity = move(motion.velocity);
      moved.metric =
          FreezeMetric(motion.metric->options, motion.metric->connectivity, {moved.shape});
      EXPECT_LT(Distance(End(moved, 8), move(end).colwise() + way), 1e-9 * scale * Diameter(end));
    }
  }
}

TEST(Exponential, DoesNotDependOnTheOrderOfVertices) {
  for (const Motion& motion : {TurningBodies()[0], DeformingBodies()[4]}) {
    SCOPED_TRACE(motion.name);
    std::vector<int> to(motion.shape.cols());
    std::iota(to.begin(), to.end(), 0);
    std::shuffle(to.begin(), to.end(), std::mt19937(1));
    Eigen::Matrix3Xi triangles = motion.metric->connectivity->Triangles();
    for (int& v : triangles.reshaped()) v = to[v];
    const auto renumber = [&](const Shape& x) {
      Shape y(3, x.cols());
      for (int v = 0; v < x.cols(); ++v) y.col(to[v]) = x.col(v);
      return y;
    };
    Motion other = motion;
    other.shape = renumber(motion.shape);
    other.velocity = renumber(motion.velocity);
    other.metric = FreezeMetric(motion.metric->options,
                                Connectivity::FromTriangles(static_cast<int>(to.size()), triangles),
                                {other.shape});
    EXPECT_LT(Distance(End(other, 8), renumber(End(motion, 8))), 1e-9 * Diameter(motion.shape));
  }
}

// A body that is compressed along z (or y), at a rate at which straight motion would make it flat
// at time 1 / rate.
Motion Crushed(const ShapeFamily& body, double rate) {
  Motion motion = Turning(body, body.begin, 0, MetricOptions::Isometric());
  const int axis = body.name == "sheet" ? 1 : 2;
  motion.velocity.row(axis) = -rate * motion.shape.row(axis);
  return motion;
}

// Either it ends with an explanation, or its shapes have warnings.
TEST(Exponential, NeverTakesACrushedBodyForASuccess) {
  int stopped = 0, flagged = 0;
  for (const ShapeFamily& body :
       {MakeBar(6, 1, 1, 6, 1, 1), MakeSheet(2, 1, 8, 4), MakeSteffen(), MakeTube(100)}) {
    for (double rate : {2.0, 10.0, 100.0}) {
      for (int steps : {1, 2, 8}) {
        SCOPED_TRACE(::testing::Message() << body.name << ", rate " << rate << ", steps " << steps);
        const auto [path, summary] = Shoot(Crushed(body, rate), steps);
        for (const Shape& shape : path.shapes) EXPECT_TRUE(shape.allFinite());
        EXPECT_FALSE(summary.Converged()) << summary.FullReport();
        ASSERT_FALSE(summary.warnings.empty());
        EXPECT_EQ(path.NumShapes(), 1 + static_cast<int>(summary.steps.size()));
        EXPECT_EQ(path.extrapolated, static_cast<int>(summary.steps.size()));
        if (summary.ending == Ending::kDegenerate) {
          EXPECT_LT(path.NumShapes(), 1 + steps);
          EXPECT_EQ(summary.stopped.rfind("step ", 0), 0u) << summary.stopped;
          EXPECT_NE(summary.warnings.back().find(summary.stopped), std::string::npos);
          ++stopped;
        } else {
          EXPECT_EQ(path.NumShapes(), 1 + steps);
          ++flagged;
        }
      }
    }
  }
  EXPECT_GT(stopped, 0);
  EXPECT_GT(flagged, 0);
}

// This path, continued to three times its length, ends where further bending would make triangles
// collapse, and there is no nearby shape to continue with. Resting there would be a wrong result.
TEST(Extrapolate, EndsWhereTheMotionComesToAHalt) {
  const ShapeFamily tube = MakeTube(100);
  LogarithmOptions options = Exactly(7);
  options.metric = MetricOptions::Isometric();
  const Path path = Interpolate(tube.connectivity, {tube.pose(0), tube.pose(60)}, options).path;
  const auto [longer, summary] = Extrapolate(path, 16);
  EXPECT_EQ(summary.ending, Ending::kDegenerate) << summary.FullReport();
  EXPECT_TRUE(Names(summary.stopped, {"halt"})) << summary.stopped;
  EXPECT_GT(summary.steps.size(), 8u);
  for (const ExponentialSummary::Step& step : summary.steps) {
    EXPECT_GT(step.energy, 0.5 * summary.steps[0].energy);
  }
}

TEST(Exponential, ThrowsWhereTheGeodesicEndsEarly) {
  const Motion motion = Crushed(MakeSteffen(), 100);
  EXPECT_TRUE(Names(MessageOf<SolverError>([&] { End(motion, 8); }), {"stopped"}));
}

// Extrapolate continues on coarser meshes and reports that; the end shape alone could not.
TEST(Exponential, RefusesEndsThatWereNotMadeOnTheMeshItself) {
  const SkinnedBody animal = MakeSkinnedBody("quadruped", 1000);
  GeodesicOptions options;
  options.metric = MetricOptions::Isometric();
  options.shapes = 7;
  const Path path =
      Interpolate(animal.connectivity, {animal.pose("stand"), animal.pose("rear")}, options).path;
  const Tangent velocity = 2 * InitialVelocity(path);
  const auto [longer, summary] = Extrapolate(path.metric, path.Placed(0), velocity, 16);
  EXPECT_EQ(summary.ending, Ending::kComplete) << summary.FullReport();
  EXPECT_FALSE(summary.Converged());
  const std::string message =
      MessageOf<SolverError>([&] { Exponential(path.metric, path.Placed(0), velocity, 16); });
  EXPECT_TRUE(Names(message, {"mesh itself"}));
}

TEST(Logarithm, RefusesPathsThatDidNotConverge) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(60)});
  LogarithmOptions options;
  options.max_iterations = 1;
  const std::string message =
      MessageOf<SolverError>([&] { Logarithm(metric, bar.pose(0), bar.pose(60), options); });
  EXPECT_TRUE(Names(message, {"converge"}));
}

// The default is stricter than for a path that is only viewed.
TEST(Logarithm, IsUndoneByTheExponentialMapByDefault) {
  for (const auto& [body, first, last] : BodyPairs()) {
    SCOPED_TRACE(body.name);
    const Shape from = body.pose(first), to = body.pose(last);
    const auto metric = FreezeMetric({}, body.connectivity, {from, to});
    const Shape end = Exponential(metric, from, Logarithm(metric, from, to));
    EXPECT_LT(Distance(end, FitRigidMotion(to, from, metric->vertex_area)(to)),
              1e-5 * Diameter(to));
  }
}

// A path to a deformed copy of a body in another position and orientation.
Path Moving(const ShapeFamily& body, double first, double last, double degrees, int shapes) {
  const Shape from = Rotation(50, {2, 0, 1}) * body.pose(first);
  const Shape turned = Rotation(degrees, {1, 2, 0.5}) * (Rotation(50, {2, 0, 1}) * body.pose(last));
  const Shape to = turned.colwise() + Eigen::Vector3d(4, 5, 6);
  return Interpolate(body.connectivity, {from, to}, Exactly(shapes)).path;
}

TEST(InitialVelocity, OfAScrewMotionIsTheScrews) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  const Path path = Moving(bar, 20, 20, 40, 3);
  const Shape first = path.Placed(0);
  const Eigen::VectorXd& area = path.metric->vertex_area;
  const Eigen::Vector3d shift = Centroid(path.Placed(4), area) - Centroid(first, area);
  const Tangent expected = testing::Spin(*path.metric, first, 40, {1, 2, 0.5}).colwise() + shift;
  EXPECT_LT(Distance(InitialVelocity(path), expected), 1e-6 * Diameter(first));
}

// A geodesic's rotation slows down when the body extends farther from the axis, and its discrete
// steps rotate by the sine of the angle; a path's rigid motion does neither.
TEST(InitialVelocity, LeadsToTheSecondShape) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  const auto error = [](const Path& path) {
    const Tangent velocity = path.parameters[1] * InitialVelocity(path);
    return Distance(Exponential(path.metric, path.Placed(0), velocity, 1), path.Placed(1)) /
           Diameter(path.Placed(0));
  };
  const double coarse = error(Moving(bar, 20, 50, 60, 3)), fine = error(Moving(bar, 20, 50, 60, 7));
  EXPECT_LT(coarse, 1e-2);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);

  Path straight = Moving(bar, 20, 50, 60, 3);
  straight.motions[1].rotation = straight.motions[0].rotation;
  EXPECT_LT(error(straight), 1e-9);
}

// The motion of a path does not depend on its position.
TEST(InitialVelocity, TurnsWithThePath) {
  Path path = Moving(MakeBar(6, 1, 1, 6, 1, 1), 20, 60, 40, 3);
  const Eigen::Matrix3d turn = testing::Rotation(70, {1, -2, 1});
  const Tangent expected = turn * InitialVelocity(path);
  for (RigidMotion& motion : path.motions) {
    motion.rotation = turn * motion.rotation;
    motion.translation = turn * motion.translation;
  }
  EXPECT_LT(Distance(InitialVelocity(path), expected), 1e-9 * Diameter(expected));
}

// A sheet of 5 x 5 vertices, of which only the centre moves, by `way` cells to the side. One step
// of the paper's scheme moves it exactly that far.
ExponentialResult PushMiddle(double way) {
  const ShapeFamily sheet = MakeSheet(1, 1, 4, 4);
  const Shape flat = sheet.pose(0);
  int middle = 0;
  (flat.colwise() - flat.rowwise().mean()).colwise().norm().minCoeff(&middle);
  Tangent velocity = Tangent::Zero(3, flat.cols());
  velocity(0, middle) = 0.25 * way;
  const auto metric = FreezeMetric({}, sheet.connectivity, {flat});
  return Extrapolate(metric, flat, velocity, 1, Options(GeodesicIntegrator::kFirstIntegral));
}

TEST(Extrapolate, StopsWhereTheSurfaceTurnsInsideOut) {
  const ExponentialSummary inside = PushMiddle(0.7).summary, over = PushMiddle(1.5).summary;
  EXPECT_EQ(inside.ending, Ending::kComplete) << inside.stopped;
  EXPECT_EQ(over.ending, Ending::kDegenerate);
  EXPECT_TRUE(Names(over.stopped, {"inside out"})) << over.stopped;
}

TEST(Extrapolate, StopsWhereAnEdgeVanishes) {
  const ExponentialSummary summary = PushMiddle(1).summary;
  EXPECT_EQ(summary.ending, Ending::kDegenerate);
  EXPECT_TRUE(Names(summary.stopped, {"edge between vertices"})) << summary.stopped;
  EXPECT_NE(summary.stopped.find("vanishes"), std::string::npos) << summary.stopped;
}

// Where the paper's scheme goes on far, it gains energy, which geodesics keep.
TEST(Extrapolate, WarnsWhereTheEnergyRises) {
  const ShapeFamily tube = MakeTube(300);
  GeodesicOptions coarse;
  coarse.metric = MetricOptions::Isometric();
  coarse.shapes = 1;
  const Path path =
      FirstShapes(Interpolate(tube.connectivity, {tube.pose(0), tube.pose(60)}, coarse).path, 2);
  const auto warns = [&](GeodesicIntegrator integrator) {
    const ExponentialSummary summary = Extrapolate(path, 30, Options(integrator)).summary;
    double greatest = 0;
    for (const auto& step : summary.steps) greatest = std::max(greatest, step.energy);
    const bool rises = greatest > 2 * summary.steps.front().energy;
    bool warned = false;
    for (const std::string& warning : summary.warnings) {
      warned = warned || warning.find("the energy of a segment") == 0;
    }
    EXPECT_EQ(warned, rises);
    return warned;
  };
  EXPECT_TRUE(warns(GeodesicIntegrator::kFirstIntegral));
  EXPECT_FALSE(warns(GeodesicIntegrator::kVariational));
}

TEST(Extrapolate, RefusesWhatCannotBeShot) {
  const Motion motion = DeformingBodies()[1];
  const auto refusal = [&](void (*change)(ExponentialOptions*)) {
    ExponentialOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { Shoot(motion, 3, options); });
  };
  for (double tolerance : {0.0, -1.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    ExponentialOptions options;
    options.tolerance = tolerance;
    EXPECT_EQ(MessageOf<InvalidOptions>([&] { Shoot(motion, 3, options); }).find("tolerance:"), 0u);
  }
  EXPECT_EQ(refusal([](ExponentialOptions* o) { o->max_iterations = 0; }).find("max_iterations:"),
            0u);
  EXPECT_EQ(MessageOf<InvalidOptions>([&] { Shoot(motion, 0); }).find("steps:"), 0u);

  Motion broken = motion;
  broken.velocity(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_NE(MessageOf<MeshError>([&] { Shoot(broken, 3); }).find("velocity"), std::string::npos);
  broken = motion;
  broken.shape(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(MessageOf<MeshError>([&] { Shoot(broken, 3); }).find("shape"), std::string::npos);
  broken = motion;
  broken.velocity.conservativeResize(3, 5);
  EXPECT_THROW(Shoot(broken, 3), MeshError);
  const Path one = FirstShapes(Shoot(motion, 2).path, 1);
  EXPECT_THROW(Extrapolate(one, 3), MeshError);
  EXPECT_THROW(InitialVelocity(one), MeshError);
}

TEST(Extrapolate, RefusesRigidMetrics) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  GeodesicOptions options;
  options.shapes = 3;
  options.metric = MetricOptions::Rigid();
  const Path path = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(30)}, options).path;
  for (const GeodesicIntegrator integrator : kAllIntegrators) {
    const std::string message =
        MessageOf<InvalidOptions>([&] { Extrapolate(path, 2, Options(integrator)); });
    EXPECT_NE(message.find("rigid"), std::string::npos) << message;
  }
  EXPECT_THROW(InitialVelocity(path), InvalidOptions);
  EXPECT_THROW(Logarithm(path.metric, bar.pose(0), bar.pose(30)), InvalidOptions);
}

// Without a cost of position rigid motions cost nothing. Momentum is conserved nevertheless, so
// that bodies fly on as under a small cost.
TEST(Extrapolate, PathsWithoutCostOfPositionGoOnToo) {
  for (const auto& [body, first, last] : BodyPairs()) {
    SCOPED_TRACE(body.name);
    const std::vector<Shape> poses = {body.pose(first), body.pose(last)};
    const auto extrapolate = [&, &connectivity = body.connectivity](double lambda) {
      GeodesicOptions options = Exactly(7);
      options.metric = MetricOptions::Isometric();
      options.metric.lambda = lambda;
      const Path path = Interpolate(connectivity, poses, options).path;
      return Extrapolate(FirstShapes(path, 5), 4);
    };
    const auto [without, summary] = extrapolate(0);
    EXPECT_TRUE(summary.Converged()) << summary.FullReport();
    EXPECT_EQ(without.metric->options.lambda, 0);
    EXPECT_LT(Distance(without, extrapolate(1e-5).path), 1e-3 * Diameter(body.pose(first)));
  }
}

TEST(Extrapolate, ContinuesADeformation) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 18, 3, 3);
  const Shape rest = bar.pose(0);
  DeformationHandle left, right;
  left.vertices = testing::Where(rest, [](const auto& p) { return p.x() < -2.7; });
  right.vertices = testing::Where(rest, [](const auto& p) { return p.x() > 2.7; });
  right.motion.axis = Eigen::Vector3d::UnitX();
  right.motion.angle = M_PI / 3;
  DeformationOptions options;
  options.tolerance = 1e-9;
  const Path path = Deform(bar.connectivity, rest, {left, right}, options).path;
  const auto [longer, summary] = Extrapolate(path, 5);
  EXPECT_TRUE(summary.Converged()) << summary.FullReport();
  const auto twist = [&](const Shape& shape) {
    const Shape ends = shape(Eigen::all, right.vertices);
    const RigidMotion motion =
        FitRigidMotion(rest(Eigen::all, left.vertices), shape(Eigen::all, left.vertices),
                       Eigen::VectorXd::Ones(left.vertices.size()));
    const RigidMotion end = FitRigidMotion(motion(rest(Eigen::all, right.vertices)), ends,
                                           Eigen::VectorXd::Ones(right.vertices.size()));
    return Eigen::AngleAxisd(end.rotation).angle() * 180 / M_PI;
  };
  EXPECT_NEAR(twist(longer.Placed(5)), 60, 0.1);
  EXPECT_NEAR(twist(longer.Placed(10)), 120, 5);
}

TEST(Logarithm, WithoutCostOfPositionIsUndoneByTheExponentialMap) {
  MetricOptions options = MetricOptions::Isometric();
  options.lambda = 0;
  for (const auto& [body, first, last] : BodyPairs()) {
    SCOPED_TRACE(body.name);
    const Shape from = body.pose(first), to = body.pose(last);
    const auto metric = FreezeMetric(options, body.connectivity, {from, to});
    const Shape end = Exponential(metric, from, Logarithm(metric, from, to, Exactly(7)), 8);
    EXPECT_LT(Distance(end, FitRigidMotion(to, end, metric->vertex_area)(to)), 1e-5 * Diameter(to));
  }
}

TEST(Extrapolate, SaysThatTrapezoidPathsGoOnInMidpointForm) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  GeodesicOptions options;
  options.shapes = 3;
  options.metric.discretization = Discretization::kTrapezoid;
  const Path path = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(30)}, options).path;
  const auto [longer, summary] = Extrapolate(path, 2);
  ASSERT_FALSE(summary.warnings.empty());
  EXPECT_NE(summary.warnings[0].find("trapezoid"), std::string::npos);
  // The continuation is as if the metric had been in midpoint form from the beginning.
  Path midpoint = path;
  Metric metric = *path.metric;
  metric.options.discretization = Discretization::kMidpoint;
  midpoint.metric = std::make_shared<const Metric>(metric);
  const auto [expected, silent] = Extrapolate(midpoint, 2);
  EXPECT_TRUE(silent.warnings.empty());
  EXPECT_TRUE(longer.shapes.back() == expected.shapes.back());
}

TEST(Extrapolate, KeepsTheStepsMadeBeforeItIsCancelled) {
  const Motion motion = DeformingBodies()[1];
  const auto shoot = [&](Progress* progress) {
    return Extrapolate(motion.metric, motion.shape, motion.velocity, 4, {}, progress);
  };
  Listener all;
  int reports_before_the_third = 0;
  all.on_report = [&](const std::string&, int done) { reports_before_the_third += done < 2; };
  const Path whole = shoot(&all).path;
  EXPECT_EQ(all.shares, (std::vector<double>{0, .25, .5, .75}));
  ASSERT_GT(reports_before_the_third, 2);  // also within steps

  for (const int last : {1, 2}) {
    Listener early(last);
    EXPECT_THROW(shoot(&early), Cancelled);
  }
  for (const int last : {1, 2}) {  // before the third step, and within it
    Listener later(reports_before_the_third + last);
    const auto [path, summary] = shoot(&later);
    EXPECT_EQ(summary.ending, ExponentialSummary::Ending::kCancelled);
    EXPECT_FALSE(summary.Converged());
    EXPECT_TRUE(Names(summary.stopped, {"step 3:"}));
    EXPECT_EQ(summary.requested_steps, 4);
    ASSERT_EQ(path.NumShapes(), 3);
    EXPECT_EQ(path.extrapolated, 2);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(path.shapes[i] == whole.shapes[i]) << i;
  }
}

TEST(Exponential, CanBeCancelledAtAnyStep) {
  const Motion motion = DeformingBodies()[1];
  Listener all;
  Exponential(motion.metric, motion.shape, motion.velocity, 8, {}, &all);
  for (const int last : {1, all.reports / 2, all.reports}) {
    Listener progress(last);
    EXPECT_THROW(Exponential(motion.metric, motion.shape, motion.velocity, 8, {}, &progress),
                 Cancelled);
  }
}

TEST(Logarithm, CanBeCancelled) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(60)});
  for (const int last : {1, 4}) {
    Listener progress(last);
    EXPECT_THROW(Logarithm(metric, bar.pose(0), bar.pose(60), {}, &progress), Cancelled);
  }
}

// The same motions under triangle strain: any values belong to a triangle, so no step needs a
// coarser mesh.
TEST(Extrapolate, MakesEveryStepOnTheMeshUnderStrain) {
  const SkinnedBody animal = MakeSkinnedBody("quadruped", 1000);
  for (const char* pose : {"rear", "stride"}) {
    SCOPED_TRACE(pose);
    GeodesicOptions options;
    options.metric = MetricOptions::Strain();
    options.shapes = 7;
    options.tolerance = 1e-6;
    const Path path =
        Interpolate(animal.connectivity, {animal.pose("stand"), animal.pose(pose)}, options).path;
    const ExponentialSummary summary = Extrapolate(path, 8).summary;
    EXPECT_TRUE(summary.Converged()) << summary.FullReport();
    for (const ExponentialSummary::Step& step : summary.steps) {
      EXPECT_NEAR(step.energy / summary.steps.front().energy, 1, 1e-3);
    }
  }
}

// The discrete Euler-Lagrange equation is symmetric in time, also for steps so long that some need
// increments: shooting back from the last two shapes returns to the first.
TEST(Extrapolate, LongStepsLeadBackToo) {
  const SkinnedBody animal = MakeSkinnedBody("quadruped", 1000);
  int increments = 0;
  for (const char* pose : {"sit", "stride"}) {
    SCOPED_TRACE(pose);
    GeodesicOptions options = Exactly(1);
    options.metric = MetricOptions::Strain();
    const Path path =
        Interpolate(animal.connectivity, {animal.pose("stand"), animal.pose(pose)}, options).path;
    const auto [longer, summary] = Extrapolate(path, 10);
    EXPECT_TRUE(summary.Converged()) << summary.FullReport();
    for (const ExponentialSummary::Step& step : summary.steps) {
      increments = std::max(increments, step.increments);
      EXPECT_NEAR(step.energy / summary.steps.front().energy, 1, 2e-2);
    }

    Path reverse = longer;
    std::reverse(reverse.shapes.begin(), reverse.shapes.end());
    const auto [back, back_summary] = Extrapolate(FirstShapes(reverse, 2), reverse.NumShapes() - 2);
    EXPECT_TRUE(back_summary.Converged()) << back_summary.FullReport();
    for (int i = 0; i < back.NumShapes(); ++i) {
      EXPECT_LT(Distance(back.shapes[i], reverse.shapes[i]), 1e-6 * Diameter(path.shapes[0])) << i;
    }
  }
  EXPECT_GT(increments, 1);
}

// If a step has no solution on the mesh, that of a coarser mesh is lifted with detail. On geodesics
// the energy of segments is constant; if the motion of the detail were used as a momentum, it would
// grow.
TEST(Extrapolate, KeepsTheEnergyAcrossStepsOfCoarserMeshes) {
  const SkinnedBody animal = MakeSkinnedBody("quadruped", 1000);
  for (const char* pose : {"rear", "stride"}) {
    SCOPED_TRACE(pose);
    GeodesicOptions options;
    options.metric = MetricOptions::Isometric();
    options.shapes = 7;
    options.tolerance = 1e-8;
    const Path path =
        Interpolate(animal.connectivity, {animal.pose("stand"), animal.pose(pose)}, options).path;
    const ExponentialSummary summary = Extrapolate(path, 16).summary;
    EXPECT_EQ(summary.ending, ExponentialSummary::Ending::kComplete) << summary.FullReport();
    int coarse = 0;
    for (const ExponentialSummary::Step& step : summary.steps) {
      coarse += step.vertices < summary.vertices;
    }
    EXPECT_GT(coarse, 0);
    EXPECT_NEAR(summary.steps.back().energy / summary.steps.front().energy, 1, 0.1);
  }
}

}  // namespace
}  // namespace shapespace
