#include <shapespace/exponential/transport.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <ceres/problem.h>
#include <ceres/solver.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/miura.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/steffen.h>
#include <shapespace/cost/tangent_projection.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/metric/feature_map.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::Distance;
using testing::MessageOf;
using testing::Noise;
using testing::Rotation;

TransportOptions Unaligned() {
  TransportOptions options;
  options.align = false;
  return options;
}

TransportOptions ThePapers() {
  TransportOptions options;
  options.connection = TransportConnection::kConstrainedProjection;
  return options;
}

// The path of unaligned shapes (user's unit), evenly spaced in time, so that rotations are in the
// shapes themselves.
Path AsTheyAre(const std::shared_ptr<const Connectivity>& connectivity,
               const std::vector<Shape>& shapes, const MetricOptions& options = {}) {
  Path path;
  path.metric = FreezeMetric(options, connectivity, {shapes.front()});
  for (const Shape& shape : shapes) path.shapes.push_back(shape / path.metric->unit);
  path.motions.resize(shapes.size());
  for (size_t i = 0; i < shapes.size(); ++i) {
    path.parameters.push_back(static_cast<double>(i) / (shapes.size() - 1));
  }
  path.poses = {0, static_cast<int>(shapes.size()) - 1};
  return path;
}

// From the body's pose at `first` to that at `last`.
Path Deforming(const ShapeFamily& body, double first, double last, int segments,
               const MetricOptions& options = {}) {
  std::vector<Shape> shapes;
  for (int i = 0; i <= segments; ++i) {
    shapes.push_back(body.pose(first + (last - first) * i / segments));
  }
  return AsTheyAre(body.connectivity, shapes, options);
}

const Eigen::Vector3d kAxis(1, 2, -0.5);

// The body's shape at `at`, rotated by an angle in degrees about an axis through the origin.
Path Turning(const ShapeFamily& body, double at, double degrees, int segments,
             const MetricOptions& options = {}, const Eigen::Vector3d& axis = kAxis) {
  std::vector<Shape> shapes;
  for (int i = 0; i <= segments; ++i) {
    shapes.push_back(Rotation(degrees * i / segments, axis) * body.pose(at));
  }
  return AsTheyAre(body.connectivity, shapes, options);
}

ShapeFamily Bar() { return MakeBar(6, 1, 1, 6, 1, 1); }

// One tangent along the body's own deformation, and one arbitrary.
std::vector<Tangent> SomeTangents(const ShapeFamily& body, double at) {
  const Shape shape = body.pose(at);
  const double size = testing::Diameter(shape);
  return {100 * (body.pose(at + 0.01) - shape) + Tangent::Constant(3, shape.cols(), 0.03 * size),
          Noise(static_cast<int>(shape.cols()), 0.1 * size, 3)};
}

// The largest relative change of a tangent's norm.
double NormChange(const TransportSummary& summary) {
  double largest = 0;
  for (size_t k = 0; k < summary.first_norm.size(); ++k) {
    largest = std::max(largest, std::abs(summary.last_norm[k] / summary.first_norm[k] - 1));
  }
  return largest;
}

// At constant speed, but with segments of different length: the paper's transport depends on time.
TEST(Transport, DoesNothingAlongATranslation) {
  for (const ShapeFamily& body : {Bar(), MakeSteffen(), MakeSheet(2, 1, 8, 4)}) {
    SCOPED_TRACE(body.name);
    std::vector<Shape> shapes;
    for (int i = 0; i < 4; ++i) {
      shapes.push_back(body.pose(5).colwise() + i * i * Eigen::Vector3d(0.5, -1, 2));
    }
    Path path = AsTheyAre(body.connectivity, shapes);
    for (double& t : path.parameters) t *= t;
    const std::vector<Tangent> tangents = SomeTangents(body, 5);
    for (const TransportOptions& options : {TransportOptions(), Unaligned(), ThePapers()}) {
      const auto [there, summary] = Transport(path, tangents, options);
      EXPECT_TRUE(summary.converged);
      ASSERT_EQ(there.size(), 2u);
      ASSERT_EQ(summary.steps.size(), 3u);
      // Edge lengths, whose weight in the paper's G is 1 / lambda times that of positions, have
      // rounding errors.
      const bool papers = options.connection == TransportConnection::kConstrainedProjection;
      for (int k : {0, 1}) {
        EXPECT_LT((there[k] - tangents[k]).norm(), (papers ? 1e-10 : 1e-12) * tangents[k].norm());
      }
    }
  }
}

TEST(Transport, DoesNothingInAFlatMetric) {
  MetricOptions flat;
  flat.strain = flat.bending = 0;
  flat.lambda = 1;
  for (const Path& path :
       {Deforming(Bar(), 0, 90, 4, flat), Turning(MakeBricard(), 0, 90, 4, flat)}) {
    const Tangent x = Noise(static_cast<int>(path.shapes[0].cols()), 1, 4);
    const Tangent y = Transport(path, {x}, Unaligned()).tangents[0];
    EXPECT_LT((y - x).norm(), 1e-12 * x.norm());
  }
}

TEST(Transport, TurnsTangentsWithBodiesThatTurn) {
  for (const ShapeFamily& body : {Bar(), MakeBricard(), MakeSheet(2, 1, 8, 4)}) {
    SCOPED_TRACE(body.name);
    const std::vector<Tangent> tangents = SomeTangents(body, 5);
    for (int segments : {1, 4}) {
      const Path path = Turning(body, 5, 90, segments);
      const auto [there, summary] = Transport(path, tangents);
      EXPECT_TRUE(summary.converged);
      for (int k : {0, 1}) {
        const Tangent expected = Rotation(90, kAxis) * tangents[k];
        EXPECT_LT((there[k] - expected).norm(), 1e-10 * expected.norm());
      }
    }
  }
}

// The same if the path's shapes rest and its motions rotate.
TEST(Transport, TurnsTangentsWithTheRigidMotionThatThePathCarries) {
  const ShapeFamily body = MakeBricard();
  Path path = Turning(body, 5, 0, 3);
  for (int i = 0; i <= 3; ++i) {
    path.motions[i] = {Rotation(20 + 30 * i, kAxis), Eigen::Vector3d(i, 2, -i)};
  }
  for (const Tangent& tangent : SomeTangents(body, 5)) {
    const Tangent first = Rotation(20, kAxis) * tangent, last = Rotation(110, kAxis) * tangent;
    const auto [there, summary] = Transport(path, {first});
    EXPECT_LT((there[0] - last).norm(), 1e-12 * last.norm());
  }
}

// Without alignment, the connection itself must rotate the tangent. It does not rotate its rigid
// part, so there is no closed form; but norms are preserved, and the order is two.
TEST(Transport, IsOfSecondOrderAtLeastOnBodiesThatTurn) {
  for (const ShapeFamily& body : {Bar(), MakeBricard()}) {
    SCOPED_TRACE(body.name);
    for (const Tangent& x : SomeTangents(body, 5)) {
      const Tangent exact = Transport(Turning(body, 5, 90, 256), {x}, Unaligned()).tangents[0];
      double previous = 0;
      for (int segments : {4, 8, 16}) {
        const auto [there, summary] = Transport(Turning(body, 5, 90, segments), {x}, Unaligned());
        EXPECT_LT(NormChange(summary), 1e-2);
        const double error = (there[0] - exact).norm() / x.norm();
        if (previous > 0) {
          EXPECT_GT(std::log2(previous / error), 1.8);
        }
        previous = error;
      }
    }
  }
}

TEST(Transport, IsOfSecondOrderAtLeastOnBodiesThatBend) {
  const std::pair<ShapeFamily, double> cases[] = {{Bar(), 90},
                                                  {MakeSheet(2, 1, 8, 4), 120},
                                                  {MakeBricard(), 40},
                                                  {MakeMiura(1, 1, 60, 3, 3), 35}};
  for (const auto& [body, last] : cases) {
    SCOPED_TRACE(body.name);
    for (const TransportOptions& options : {TransportOptions(), Unaligned()}) {
      const std::vector<Tangent> tangents = SomeTangents(body, 10);
      const std::vector<Tangent> exact =
          Transport(Deforming(body, 10, last, 256), tangents, options).tangents;
      double previous[2] = {0, 0};
      for (int segments : {8, 16, 32}) {
        const auto [there, summary] =
            Transport(Deforming(body, 10, last, segments), tangents, options);
        EXPECT_LT(NormChange(summary), 1e-3);
        for (int k : {0, 1}) {
          const double error = (there[k] - exact[k]).norm() / exact[k].norm();
          EXPECT_LT(error, 0.1);
          if (previous[k] > 0) {
            EXPECT_GT(std::log2(previous[k] / error), 1.8);
          }
          previous[k] = error;
        }
      }
    }
  }
}

// For any number of segments and any rotation; the loss is of fourth order per segment, so of third
// order for the path.
TEST(Transport, NeverLengthensAndHardlyShortens) {
  const std::pair<ShapeFamily, double> cases[] = {
      {Bar(), 90}, {MakeSheet(2, 1, 8, 4), 120}, {MakeBricard(), 40}};
  for (const auto& [body, last] : cases) {
    SCOPED_TRACE(body.name);
    for (const TransportOptions& options : {TransportOptions(), Unaligned()}) {
      double previous[2] = {0, 0};
      for (int segments : {1, 2, 8, 16, 32}) {
        const TransportSummary summary =
            Transport(Deforming(body, 10, last, segments), SomeTangents(body, 10), options).summary;
        for (int k : {0, 1}) {
          const double loss = 1 - summary.last_norm[k] / summary.first_norm[k];
          EXPECT_GT(loss, -1e-10);
          if (segments > 8) {
            EXPECT_NEAR(std::log2(previous[k] / loss), 3, 0.3);
          }
          previous[k] = loss;
        }
      }
    }
  }
}

// An independent method: the covariant derivative along the path vanishes, so the products with
// fields of coordinates satisfy the ordinary differential equation G Y' = -J^T (dJ/dt) Y. It is
// solved by the Runge-Kutta method of fourth order, with the derivative of J from central
// differences.
Tangent FromItsEquation(const ShapeFamily& body, double first, double last,
                        const std::shared_ptr<const Metric>& metric, Tangent y, int steps) {
  const FeatureMap map(metric);
  const auto shape = [&](double t) -> Shape {
    return body.pose(first + (last - first) * t) / metric->unit;
  };
  const auto rate = [&](double t, const Tangent& x) -> Tangent {
    constexpr double kDifference = 1e-5;
    const FeatureDerivative derivative = map.Derivative(shape(t));
    const Eigen::VectorXd change = (map.Derivative(shape(t + kDifference)).Times(x) -
                                    map.Derivative(shape(t - kDifference)).Times(x)) /
                                   (2 * kDifference);
    const Tangent right = derivative.TransposeTimes(change);
    Eigen::MatrixXd matrix = derivative.MetricMatrix();
    const Eigen::VectorXd solution =
        matrix.selfadjointView<Eigen::Lower>().ldlt().solve(Eigen::VectorXd(right.reshaped()));
    return -solution.reshaped(3, x.cols());
  };
  const double dt = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    const Tangent a = rate(t, y), b = rate(t + dt / 2, y + dt / 2 * a);
    const Tangent c = rate(t + dt / 2, y + dt / 2 * b), d = rate(t + dt, y + dt * c);
    y += dt / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

TEST(Transport, SolvesTheEquationOfTheLeviCivitaConnection) {
  const std::pair<ShapeFamily, double> cases[] = {{Bar(), 90}, {MakeBricard(), 40}};
  for (const auto& [body, last] : cases) {
    SCOPED_TRACE(body.name);
    const Path path = Deforming(body, 10, last, 64);
    for (const Tangent& x : SomeTangents(body, 10)) {
      const Tangent expected = FromItsEquation(body, 10, last, path.metric, x, 32);
      const Tangent y = Transport(path, {x}, Unaligned()).tangents[0];
      EXPECT_LT((y - expected).norm(), 1e-3 * expected.norm());
      EXPECT_GT((x - expected).norm(), 0.01 * expected.norm());  // and is a significant change
    }
  }
}

// The tangent at a shape whose change of the features is nearest to a given one, by Ceres.
Tangent Nearest(const Metric& metric, const Shape& at, const Eigen::VectorXd& change) {
  Tangent y = Tangent::Zero(3, at.cols());
  ceres::Problem problem;
  cost::AddTangentProjection(metric, at, change, &y, &problem);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 0;
  options.initial_trust_region_radius = 1e16;  // the problem is linear
  options.max_num_iterations = 3;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return y;
}

TEST(TangentProjection, MakesStepsOfLeviCivitaTransport) {
  const ShapeFamily body = MakeBar(4, 1, 1, 6, 1, 1);
  const Path path = Deforming(body, 10, 40, 1);
  const FeatureMap map(path.metric);
  const Tangent x = SomeTangents(body, 10)[0] / path.metric->unit;
  const Shape &from = path.shapes[0], &to = path.shapes[1];
  const Eigen::VectorXd change = map.Derivative(from).Times(x);
  const auto onto = [&](const Shape& at, const Eigen::VectorXd& y) {
    return Eigen::VectorXd(map.Derivative(at).Times(Nearest(*path.metric, at, y)));
  };
  const Eigen::VectorXd there_and_back = onto(from, onto(to, change));
  const Tangent y = Nearest(*path.metric, to, 1.5 * change - 0.5 * there_and_back);
  const Tangent expected =
      Transport(path, {path.metric->unit * x}, Unaligned()).tangents[0] / path.metric->unit;
  EXPECT_LT((y - expected).norm(), 1e-6 * expected.norm());
  EXPECT_GT((x - expected).norm(), 1e-3 * expected.norm());  // there is something to transport

  Tangent any = x;
  ceres::Problem problem;
  EXPECT_THROW(
      cost::AddTangentProjection(*path.metric, to, Eigen::VectorXd::Zero(3), &any, &problem),
      MeshError);
}

TEST(Transport, IsLinearAndComesBackToSecondOrder) {
  for (const auto& [body, from, to] :
       {std::tuple(Bar(), 10, 90), std::tuple(MakeBricard(), -20, 40)}) {
    SCOPED_TRACE(body.name);
    const std::vector<Tangent> tangents = SomeTangents(body, from);
    const Tangent &x = tangents[0], &z = tangents[1];
    for (const TransportOptions& options : {TransportOptions(), Unaligned()}) {
      double previous = 0;
      for (int segments : {4, 8, 16}) {
        const Path path = Deforming(body, from, to, segments);
        Path back = path;
        std::reverse(back.shapes.begin(), back.shapes.end());
        const std::vector<Tangent> there = Transport(path, {x, z, 2 * x - 3 * z}, options).tangents;
        EXPECT_LT((there[2] - (2 * there[0] - 3 * there[1])).norm(), 1e-10 * there[2].norm());
        const Tangent again = Transport(back, {there[0]}, options).tangents[0];
        const double error = (again - x).norm() / x.norm();
        if (previous > 0) {
          EXPECT_GT(std::log2(previous / error), 1.8);
        }
        previous = error;
      }
    }
  }
}

TEST(Transport, ManyTangentsAtOnceAreAsOneByOne) {
  for (const TransportOptions& options : {TransportOptions(), Unaligned(), ThePapers()}) {
    for (const Path& path : {Deforming(Bar(), 10, 90, 3), Deforming(MakeBricard(), -20, 40, 3)}) {
      std::vector<Tangent> tangents;
      for (int k = 0; k < 4; ++k) {
        tangents.push_back(Noise(static_cast<int>(path.shapes[0].cols()), std::pow(10, k), k));
      }
      const TransportResult all = Transport(path, tangents, options);
      for (int k = 0; k < 4; ++k) {
        const TransportResult one = Transport(path, {tangents[k]}, options);
        EXPECT_TRUE(one.tangents[0] == all.tangents[k]);
        EXPECT_EQ(one.summary.last_norm[0], all.summary.last_norm[k]);
      }
    }
  }
}

// An edge of constant length corresponds to a point of a sphere and moves like one: along the edges
// of an octant, whose angles are right, tangents turn by a right angle.
TEST(Transport, TurnsByARightAngleRoundAnOctant) {
  const Eigen::Vector3d corners[] = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                     Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX()};
  for (double lambda : {1e-2, 1e-4, 1e-6}) {
    MetricOptions options;
    options.bending = 0;
    options.lambda = lambda;
    double first = 0;
    for (int segments : {4, 16}) {  // per leg
      std::vector<Shape> shapes;
      for (int leg = 0; leg < 3; ++leg) {
        const Eigen::Vector3d axis = corners[leg].cross(corners[leg + 1]);
        for (int i = leg == 0 ? 0 : 1; i <= segments; ++i) {
          const Eigen::Vector3d half = 0.5 * (Rotation(90.0 * i / segments, axis) * corners[leg]);
          shapes.emplace_back(3, 2);
          shapes.back() << -half, half;
        }
      }
      const Path path = AsTheyAre(testing::SingleEdge(), shapes, options);
      Tangent x(3, 2);
      x << -Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitY();
      const auto [there, summary] = Transport(path, {x}, Unaligned());
      EXPECT_LT(NormChange(summary), 0.1);
      const Eigen::Vector3d y = there[0].col(1) - there[0].col(0);
      const double angle = std::acos(y.dot(Eigen::Vector3d::UnitY()) / y.norm()) * 180 / M_PI;
      EXPECT_NEAR(angle, 90, 100 * lambda);
      EXPECT_GT(y.normalized().z(), 0.99);  // from towards y to towards z, the octant on the left
      if (first > 0) {
        EXPECT_NEAR(angle, first, 10 * lambda + 1e-9);
      }
      first = angle;
    }
  }
}

TEST(Transport, CommutesWithRotationTranslationAndScale) {
  const ShapeFamily body = MakeBricard();
  const Eigen::Matrix3d turn = Rotation(70, {1, -2, 1});
  const std::vector<Tangent> tangents = SomeTangents(body, -20);
  const Path path = Deforming(body, -20, 40, 4);
  for (const TransportOptions& options : {TransportOptions(), Unaligned(), ThePapers()}) {
    const std::vector<Tangent> there = Transport(path, tangents, options).tangents;
    for (double scale : {1e-4, 1.0, 1e4}) {
      std::vector<Shape> shapes;
      for (const Shape& shape : path.Placed()) {
        shapes.push_back((scale * turn * shape).colwise() + scale * Eigen::Vector3d(4, 5, 6));
      }
      const Path moved = AsTheyAre(body.connectivity, shapes);
      for (int k : {0, 1}) {
        const Tangent expected = scale * turn * there[k];
        const Tangent y = Transport(moved, {scale * turn * tangents[k]}, options).tangents[0];
        EXPECT_LT((y - expected).norm(), 1e-9 * expected.norm());
      }
    }
  }
}

// This is the definition of a geodesic.
TEST(Transport, CarriesTheVelocityOfAGeodesicToItsVelocity) {
  for (const testing::Motion& motion :
       {testing::Turning(Bar(), 30, 60, {}), testing::Deforming(MakeBricard(), 0, 25, {})}) {
    SCOPED_TRACE(motion.name);
    const Path exact = Extrapolate(motion.metric, motion.shape, motion.velocity, 256).path;
    Path back = exact;
    std::reverse(back.shapes.begin(), back.shapes.end());
    const Tangent last = -InitialVelocity(back);
    double previous = 0;
    for (int segments : {4, 8, 16}) {
      Path path = exact;
      path.shapes.clear();
      path.motions.resize(segments + 1);
      path.parameters.clear();
      for (int i = 0; i <= segments; ++i) {
        path.shapes.push_back(exact.shapes[256 / segments * i]);
        path.parameters.push_back(static_cast<double>(i) / segments);
      }
      const Tangent there = Transport(path, {motion.velocity}, Unaligned()).tangents[0];
      const double error = (there - last).norm() / last.norm();
      if (previous > 0) {
        EXPECT_GT(std::log2(previous / error), 1.8);
      }
      previous = error;
    }
    EXPECT_LT(previous, 1e-2);
  }
}

// The paper's transport preserves the product with the path's velocity, and nothing else.
TEST(Transport, WithoutCostOfPositionIsAsWithASmallOne) {
  for (const ShapeFamily& body : {Bar(), MakeSteffen(), MakeSheet(2, 1, 8, 4)}) {
    SCOPED_TRACE(body.name);
    const std::vector<Tangent> tangents = SomeTangents(body, 0);
    const auto transport = [&](double lambda) {
      MetricOptions metric = MetricOptions::Isometric();
      metric.lambda = lambda;
      return Transport(Deforming(body, 0, 5, 8, metric), tangents);
    };
    const auto [without, summary] = transport(0);
    EXPECT_TRUE(summary.converged);
    EXPECT_LT(NormChange(summary), 1e-3);
    const std::vector<Tangent> with = transport(1e-5).tangents;
    for (int k : {0, 1}) EXPECT_LT((without[k] - with[k]).norm(), 1e-2 * with[k].norm());
  }
}

TEST(PapersTransport, KeepsTheProductWithTheVelocity) {
  for (const ShapeFamily& body : {Bar(), MakeBricard()}) {
    SCOPED_TRACE(body.name);
    const int segments = 8;
    const Path path = Deforming(body, 10, 40, segments);
    const FeatureMap map(path.metric);
    // <Y, G gamma'> at a shape, with gamma' of the segment that begins, or at the last shape ends,
    // there.
    const auto product = [&](int shape, const Tangent& y) {
      const int begin = std::min(shape, segments - 1);
      const FeatureDerivative derivative = map.Derivative(path.shapes[shape]);
      return derivative.Times(y).dot(derivative.Times(path.shapes[begin + 1] - path.shapes[begin]));
    };
    for (const Tangent& x : SomeTangents(body, 10)) {
      const Tangent y = Transport(path, {x}, ThePapers()).tangents[0];
      EXPECT_GT((y - x).norm(), 1e-4 * x.norm());
      EXPECT_NEAR(product(segments, y), product(0, x), 1e-6 * std::abs(product(0, x)));
    }
  }
}

TEST(PapersTransport, DoesNotKeepNormsNorConverge) {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  for (const ShapeFamily& body : {Bar(), MakeSheet(2, 1, 8, 4)}) {
    SCOPED_TRACE(body.name);
    // A tangent that bends the body in its first position. It does not rotate with the body, so
    // later it stretches it.
    const Tangent bend = 100 * (body.pose(5.01) - body.pose(5));
    const Tangent exact =
        Transport(Turning(body, 5, 90, 128, {}, axis), {bend}, Unaligned()).tangents[0];
    double first = 0;
    for (int segments : {8, 32, 128}) {
      const Path path = Turning(body, 5, 90, segments, {}, axis);
      const auto [there, summary] = Transport(path, {bend}, ThePapers());
      const double growth = summary.last_norm[0] / summary.first_norm[0];
      const double error = (there[0] - exact).norm() / bend.norm();
      EXPECT_GT(growth, 1.1);
      EXPECT_GT(error, 0.02);
      if (segments == 8) {
        first = error;
        const Tangent better = Transport(path, {bend}, Unaligned()).tangents[0];
        EXPECT_LT((better - exact).norm(), 0.01 * error * bend.norm());
      }
      EXPECT_NEAR(error, first, 0.01 * first);
    }
  }
}

TEST(Transport, RefusesWhatCannotBeTransported) {
  const ShapeFamily body = MakeBricard();
  const Path path = Deforming(body, -20, 40, 3);
  const Tangent x = SomeTangents(body, -20)[0];
  const auto refusal = [&](void (*change)(TransportOptions*)) {
    TransportOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { Transport(path, {x}, options); });
  };
  EXPECT_EQ(refusal([](TransportOptions* o) { o->tolerance = 0; }).find("tolerance:"), 0u);
  EXPECT_EQ(refusal([](TransportOptions* o) { o->tolerance = NAN; }).find("tolerance:"), 0u);
  EXPECT_EQ(refusal([](TransportOptions* o) { o->tolerance = 1; }).find("tolerance:"), 0u);
  EXPECT_EQ(refusal([](TransportOptions* o) { o->max_iterations = 0; }).find("max_iterations:"),
            0u);
  Tangent broken = x;
  broken(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Transport(path, {x, broken}), MeshError);
  EXPECT_THROW(Transport(path, {Tangent::Zero(3, 5)}), MeshError);
  EXPECT_THROW(Transport(FirstShapes(path, 1), {x}), MeshError);

  const Path rigid = Deforming(body, -20, 40, 3, MetricOptions::Rigid());
  EXPECT_NE(MessageOf<InvalidOptions>([&] { Transport(rigid, {x}); }).find("rigid"),
            std::string::npos);
  // The paper's constraint needs a velocity.
  EXPECT_THROW(Transport(Turning(body, -20, 0, 3), {x}, ThePapers()), SolverError);
  EXPECT_TRUE(Transport(Turning(body, -20, 0, 3), {x}).tangents[0].isApprox(x, 1e-14));
}

TEST(Transport, SaysSoWhereTheSolverRunsOut) {
  MetricOptions metric;
  metric.volume = 0.3;
  TransportOptions options;
  const Path path = Deforming(Bar(), 10, 40, 3, metric);
  const std::vector<Tangent> tangents = SomeTangents(Bar(), 10);
  EXPECT_TRUE(Transport(path, tangents, options).summary.converged);
  options.max_iterations = 1;
  options.tolerance = 1e-15;  // less than one iteration leaves
  const TransportSummary summary = Transport(path, tangents, options).summary;
  EXPECT_FALSE(summary.converged);
  EXPECT_GT(summary.steps[0].residual, options.tolerance);
}

TEST(Transport, ConvergesIfEveryResidualIsWithinTheTolerance) {
  MetricOptions metric;
  metric.volume = 0.3;
  TransportOptions options;
  options.max_iterations = 1;
  const Path path = Deforming(Bar(), 10, 40, 3, metric);
  const std::vector<Tangent> tangents = SomeTangents(Bar(), 10);
  double reached = 0;
  for (const auto& step : Transport(path, tangents, options).summary.steps) {
    reached = std::max(reached, step.residual);
  }
  for (const double share : {0.1, 0.9, 1.1}) {
    options.tolerance = share * reached;
    EXPECT_EQ(Transport(path, tangents, options).summary.converged, share > 1) << share;
  }
}

class Stop final : public Progress {
 public:
  bool Report(const std::string&, int done, int) override { return done < 1; }
};

TEST(Transport, CanBeCancelled) {
  const ShapeFamily body = MakeBricard();
  Stop progress;
  EXPECT_THROW(Transport(Deforming(body, -20, 40, 3), SomeTangents(body, -20), {}, &progress),
               Cancelled);
}

}  // namespace
}  // namespace shapespace
