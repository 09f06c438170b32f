// The figures of shooting, corrections and transports, each worked out from the path, and their
// warnings and refusals.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/memory.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/metric/feature_map.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"
#include "support/path_of.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::Distance;
using testing::Listener;
using testing::MessageOf;
using testing::Motion;
using testing::Names;
using testing::Noise;
using testing::Refuses;
using Ending = ExponentialSummary::Ending;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

ExponentialOptions ThePapersScheme() {
  ExponentialOptions options;
  options.integrator = GeodesicIntegrator::kFirstIntegral;
  return options;
}

ShapeFamily BarInDetail() { return MakeBar(6, 1, 1, 6, 1, 1); }

// Three shapes of a bar that bends and is moved, at times 0, 0.3 and 1.
Path UnevenPath() {
  const ShapeFamily bar = BarInDetail();
  std::vector<Shape> shapes;
  for (const double t : {0.0, 0.3, 1.0}) {
    shapes.emplace_back(bar.pose(10 + 20 * t).colwise() + t * Eigen::Vector3d(3, -1, 2));
  }
  Path path =
      MakePath(FreezeMetric({}, bar.connectivity, {shapes[0], shapes[2]}), shapes, {0, 0.3, 1});
  path.provenance = "a test";
  return path;
}

// The sums over all vertices of the momenta and of their moments, for the step to shape i + 1, and
// what a change of these is compared with.
struct MomentaInDetail {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  double size = 0, moment = 0;
};

MomentaInDetail MomentaOfStep(const Path& path, int i) {
  const FeatureMap map(path.metric);
  const Shape& at = path.shapes[i];
  const Tangent p =
      map.Derivative(at).TransposeTimes(map.Values(path.shapes[i + 1]) - map.Values(at));
  MomentaInDetail all;
  for (int v = 0; v < at.cols(); ++v) {
    all.linear += p.col(v);
    all.angular += Eigen::Vector3d(at.col(v)).cross(Eigen::Vector3d(p.col(v)));
    all.size += p.col(v).norm();
    all.moment += at.col(v).norm() * p.col(v).norm();
  }
  return all;
}

void ExpectRowsOf(const Path& path, const ExponentialSummary& summary, double step) {
  const FeatureMap map(path.metric);
  const int begin = path.NumShapes() - 1 - static_cast<int>(summary.steps.size());
  const MomentaInDetail first = MomentaOfStep(path, begin);
  for (size_t k = 0; k < summary.steps.size(); ++k) {
    SCOPED_TRACE(k);
    const int i = begin + static_cast<int>(k);
    const ExponentialSummary::Step& row = summary.steps[k];
    EXPECT_NEAR(row.t, path.parameters[begin] + (k + 1.0) * step, 1e-12);
    EXPECT_EQ(row.t, path.parameters[i + 1]);
    EXPECT_EQ(row.vertices, path.shapes[0].cols());
    const double energy =
        (map.Values(path.shapes[i + 1]) - map.Values(path.shapes[i])).squaredNorm() / step / step;
    EXPECT_NEAR(row.energy, energy, 1e-9 * energy);
    const MomentaInDetail now = MomentaOfStep(path, i);
    const double drift = std::max((now.linear - first.linear).norm() / first.size,
                                  (now.angular - first.angular).norm() / first.moment);
    EXPECT_NEAR(row.momentum_drift, drift, 1e-9 + 1e-6 * drift);
    const RmsAndMax edges = DeviationFromFirst(path, i + 1);
    EXPECT_NEAR(row.edge_rms, edges.rms, 1e-6);
    EXPECT_NEAR(row.edge_max, edges.max, 1e-6);
    EXPECT_EQ(row.inverted, 0);
    EXPECT_GT(row.seconds, 0);
  }
}

TEST(Extrapolate, GoesOnWithTheStepOfTheLastSegment) {
  Path path = UnevenPath();
  const auto [longer, summary] = Extrapolate(path, 2);
  EXPECT_EQ(longer.provenance, "a test; extrapolated");
  EXPECT_EQ(longer.poses, path.poses);
  EXPECT_EQ(longer.extrapolated, 2);
  EXPECT_TRUE(longer.converged);
  EXPECT_EQ(summary.ending, Ending::kComplete);
  EXPECT_EQ(summary.integrator, GeodesicIntegrator::kVariational);
  EXPECT_EQ(summary.vertices, 28);
  EXPECT_EQ(summary.requested_steps, 2);
  EXPECT_EQ(summary.metric, DescribeMetric(path.metric->options));
  EXPECT_TRUE(summary.warnings.empty());
  EXPECT_EQ(summary.factorisations, 2);  // one for each step
  EXPECT_GT(summary.factor_seconds, 0);
  EXPECT_GT(summary.total_seconds, summary.factor_seconds);
  EXPECT_EQ(summary.uncertified_segments, -1);
  EXPECT_TRUE(std::isnan(summary.contact_distance));
  ASSERT_EQ(summary.steps.size(), 2u);
  ExpectRowsOf(longer, summary, 0.7);
  for (const auto& step : summary.steps) {
    EXPECT_TRUE(step.converged);
    EXPECT_EQ(step.increments, 1);
    EXPECT_GT(step.iterations, 0);
    EXPECT_GE(step.krylov_iterations, step.iterations);
    EXPECT_LE(step.residual, 1e-9);
  }
  // The centroid goes on on its line.
  const Eigen::Vector3d way = path.motions[2].translation - path.motions[1].translation;
  for (const int i : {3, 4}) {
    EXPECT_LT((longer.motions[i].translation - path.motions[2].translation - (i - 2) * way).norm(),
              1e-9);
  }
  path.converged = false;
  EXPECT_FALSE(Extrapolate(path, 2).path.converged);
}

TEST(Extrapolate, FiguresOfThePapersSchemeAreThoseOfItsPath) {
  const Motion motion = testing::Deforming(MakeBricard(), 0, 25, {});
  Motion turning = motion;
  turning.velocity += testing::Spin(*motion.metric, motion.shape, 60, {1, 2, 3});
  const auto [path, summary] =
      Extrapolate(turning.metric, turning.shape, turning.velocity, 4, ThePapersScheme());
  EXPECT_EQ(path.provenance, "shot from a shape");
  EXPECT_EQ(path.poses, std::vector<int>{0});
  EXPECT_EQ(path.extrapolated, 4);
  EXPECT_EQ(path.metric, turning.metric);
  EXPECT_EQ(path.parameters, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  for (const RigidMotion& place : path.motions) {
    EXPECT_EQ(place.rotation, Eigen::Matrix3d::Identity());
    EXPECT_EQ(place.translation, path.motions[0].translation);
  }
  EXPECT_LT(
      (path.motions[0].translation - Centroid(turning.shape, turning.metric->vertex_area)).norm(),
      1e-12);
  EXPECT_LT(Distance(path.Placed(0), turning.shape), 1e-12);
  EXPECT_LT(Distance(path.Placed(1), turning.shape + turning.velocity / 4), 1e-12);
  EXPECT_EQ(summary.integrator, GeodesicIntegrator::kFirstIntegral);
  EXPECT_EQ(summary.factorisations, 0);
  ASSERT_EQ(summary.steps.size(), 4u);
  ExpectRowsOf(path, summary, 0.25);
  EXPECT_GT(summary.steps[3].momentum_drift, 1e-6);
}

TEST(Extrapolate, SaysHowManyStepsDidNotConverge) {
  const Motion motion = testing::Deforming(MakeBricard(), 0, 25, {});
  ExponentialOptions options = ThePapersScheme();
  options.max_iterations = 1;
  const auto [path, summary] =
      Extrapolate(motion.metric, motion.shape, motion.velocity, 3, options);
  ASSERT_EQ(summary.steps.size(), 3u);
  int open = 0;
  for (const auto& step : summary.steps) {
    EXPECT_LE(step.iterations, 1);
    open += !step.converged;
  }
  ASSERT_GT(open, 0);
  ASSERT_FALSE(summary.warnings.empty());
  EXPECT_TRUE(Names(summary.warnings[0], {std::to_string(open), "3"}));
  EXPECT_FALSE(path.converged);
}

// A sheet of 4 x 4 cells, whose middle moves by `way` cells to the side in one step.
ExponentialSummary PushTheMiddle(double way, std::string* edge = nullptr) {
  const ShapeFamily sheet = MakeSheet(1, 1, 4, 4);
  const Shape flat = sheet.pose(0);
  int middle = 0, beside = 0;
  const Eigen::Vector3d centre = flat.rowwise().mean();
  const Eigen::Vector3d right = centre + Eigen::Vector3d(0.25, 0, 0);
  (flat.colwise() - centre).colwise().norm().minCoeff(&middle);
  (flat.colwise() - right).colwise().norm().minCoeff(&beside);
  if (edge != nullptr) {
    *edge = std::to_string(std::min(middle, beside) + 1) + " and " +
            std::to_string(std::max(middle, beside) + 1);
  }
  Tangent velocity = Tangent::Zero(3, flat.cols());
  velocity(0, middle) = 0.25 * way;
  const auto metric = FreezeMetric({}, sheet.connectivity, {flat});
  return Extrapolate(metric, flat, velocity, 1, ThePapersScheme()).summary;
}

// Of 32 triangles, the two beyond the middle turn over.
TEST(Extrapolate, SaysWhereAndWhyItStops) {
  const ExponentialSummary over = PushTheMiddle(1.5);
  EXPECT_TRUE(Names(over.stopped, {"step 1:", "6"}));
  ASSERT_EQ(over.warnings.size(), 1u);
  EXPECT_TRUE(Names(over.warnings[0], {over.stopped}));
  EXPECT_EQ(over.ending, Ending::kDegenerate);
  EXPECT_TRUE(over.steps.empty());
  std::string edge;
  const ExponentialSummary onto = PushTheMiddle(1, &edge);
  EXPECT_TRUE(Names(onto.stopped, {"step 1:", edge}));
}

TEST(Extrapolate, RefusalsNameTheFieldAndTheRemedy) {
  const Motion motion = testing::Deforming(MakeBricard(), 0, 25, {});
  const auto refusal = [&](const Shape& shape, const Tangent& velocity, int steps,
                           const ExponentialOptions& options) {
    return MessageOf<Error>([&] { Extrapolate(motion.metric, shape, velocity, steps, options); });
  };
  EXPECT_TRUE(Names(refusal(motion.shape, motion.velocity, 0, {}), {"steps:", "1"}));
  EXPECT_TRUE(Names(refusal(Shape::Zero(3, 5), motion.velocity, 2, {}), {"shape"}));
  EXPECT_TRUE(Names(refusal(motion.shape, Tangent::Zero(3, 7), 2, {}), {"velocity"}));
  ExponentialOptions options;
  options.stop_at_contact = options.slide_at_contact = true;
  EXPECT_TRUE(Names(refusal(motion.shape, motion.velocity, 2, options),
                    {"slide_at_contact:", "stop_at_contact"}));
  const std::string one = "a path needs at least two shapes to have a direction";
  const Path path = FirstShapes(UnevenPath(), 1);
  EXPECT_EQ(MessageOf<MeshError>([&] { Extrapolate(path, 2); }), one);
  EXPECT_EQ(MessageOf<MeshError>([&] { InitialVelocity(path); }), one);
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { Extrapolate(UnevenPath(), 0); }, {"steps:", "1"}));
}

TEST(InitialVelocity, IsPerUnitOfThePathsTime) {
  Path path = UnevenPath();
  const Tangent velocity = InitialVelocity(path);
  // The centroid moves by (3, -1, 2) in a unit of time.
  const Eigen::Vector3d drift = Centroid(velocity, path.metric->vertex_area);
  EXPECT_LT((drift - (path.motions[1].translation - path.motions[0].translation) / 0.3).norm(),
            1e-6);
  path.parameters = {0.5, 0.8, 1};
  EXPECT_LT(Distance(InitialVelocity(path), velocity), 1e-9);
  path.parameters = {0, 0.6, 1};
  EXPECT_LT(Distance(2 * InitialVelocity(path), velocity), 1e-9);
}

// A bar on its way to a shape that is twice as long, in four segments.
Path Lengthening() {
  const ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  std::vector<Shape> shapes;
  for (int i = 0; i <= 4; ++i) {
    shapes.emplace_back(Eigen::Vector3d(1 + 0.25 * i, 1, 1).asDiagonal() * bar.pose(0));
  }
  return testing::PathOf(bar.connectivity, shapes);
}

double RmsDistanceOf(const Shape& a, const Shape& b, const Eigen::VectorXd& area) {
  double sum = 0;
  for (int v = 0; v < a.cols(); ++v) sum += area(v) * (a.col(v) - b.col(v)).squaredNorm();
  return std::sqrt(sum / area.sum());
}

TEST(CorrectPath, FiguresAreThoseOfBothPaths) {
  Path given = Lengthening();
  CorrectionOptions options;
  options.mu = 2;
  const auto [path, summary] = CorrectPath(given, options);
  const Eigen::VectorXd& area = given.metric->vertex_area;
  EXPECT_EQ(summary.mode, CorrectionMode::kProximal);
  EXPECT_EQ(summary.mu, 2);
  EXPECT_EQ(summary.vertices, 20);
  EXPECT_EQ(summary.shapes, 4);
  EXPECT_EQ(summary.termination, Termination::kConverged);
  EXPECT_GT(summary.iterations, 0);
  EXPECT_GE(summary.evaluations, summary.iterations);
  EXPECT_GT(summary.total_seconds, 0);
  double squares = 0;
  for (int i = 1; i <= 4; ++i) {
    squares += std::pow(RmsDistanceOf(path.shapes[i], given.shapes[i], area), 2);
  }
  EXPECT_NEAR(summary.distance, std::sqrt(squares / 4), 1e-9);
  const auto deformation = [&](const Path& of) {
    const RigidMotion fit = FitRigidMotion(of.shapes[4], of.shapes[0], area);
    return RmsDistanceOf(fit(of.shapes[4]), of.shapes[0], area);
  };
  EXPECT_NEAR(summary.deformation_left, deformation(path) / deformation(given), 1e-9);
  MetricOptions lengths = MetricOptions::Isometric();
  lengths.lambda = lengths.bending = 0;
  const auto metric = FreezeMetric(lengths, given.metric->connectivity, {given.shapes[0]}, 1);
  const FeatureMap map(metric);
  const auto energy = [&](const Path& of) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      sum += (map.Values(of.shapes[i + 1]) - map.Values(of.shapes[i])).squaredNorm();
    }
    return 4 * sum;
  };
  EXPECT_NEAR(summary.initial_energy, energy(given), 1e-9 * energy(given));
  EXPECT_NEAR(summary.energy, energy(path), 1e-9 * energy(given));
  for (const bool before : {true, false}) {
    const PathQuality expected = MeasureQuality(before ? given : path);
    const PathQuality& found = before ? summary.initial_quality : summary.quality;
    EXPECT_EQ(found.first_rms, expected.first_rms);
    EXPECT_EQ(found.first_p99, expected.first_p99);
    EXPECT_EQ(found.edge_max, expected.edge_max);
  }
  given.converged = false;
  EXPECT_FALSE(CorrectPath(given, options).path.converged);
}

TEST(CorrectPath, NamesTheRemedyOfAPathThatCollapses) {
  const Path given = Lengthening();
  CorrectionOptions options;
  options.tolerance = 1e-6;
  for (const CorrectionMode mode : {CorrectionMode::kProximal, CorrectionMode::kPaper}) {
    options.mode = mode;
    options.mu = mode == CorrectionMode::kPaper ? 3 : 0;
    const CorrectionSummary summary = CorrectPath(given, options).summary;
    EXPECT_EQ(summary.mu, 0);
    EXPECT_LT(summary.deformation_left, 0.1);
    ASSERT_EQ(summary.warnings.size(), 1u);
    char share[32];
    std::snprintf(share, sizeof share, "%.2g", 100 * summary.deformation_left);
    EXPECT_TRUE(Names(summary.warnings[0], {std::string(share) + "%",
                                            mode == CorrectionMode::kPaper ? "kProximal" : "mu"}));
  }
}

TEST(CorrectPath, SaysWhyItEnded) {
  CorrectionOptions options;
  options.max_iterations = 1;
  options.tolerance = 1e-12;
  const auto [path, summary] = CorrectPath(Lengthening(), options);
  EXPECT_EQ(summary.termination, Termination::kMaxIterations);
  EXPECT_FALSE(path.converged);
  ASSERT_FALSE(summary.warnings.empty());
  EXPECT_TRUE(Names(summary.warnings[0], {"max_iterations"}));
  Listener later(3);
  options.max_iterations = 100;
  const CorrectionSummary stopped = CorrectPath(Lengthening(), options, &later).summary;
  EXPECT_EQ(stopped.termination, Termination::kCancelled);
  ASSERT_FALSE(stopped.warnings.empty());
  EXPECT_TRUE(Names(stopped.warnings[0], {"cancelled:"}));
  EXPECT_TRUE(
      Refuses<MeshError>([] { CorrectPath(FirstShapes(Lengthening(), 1)); }, {"two shapes"}));
  for (const double mu : {-1.0, kNoNumber, std::numeric_limits<double>::infinity()}) {
    options.mu = mu;
    EXPECT_TRUE(
        Refuses<InvalidOptions>([&] { CorrectPath(Lengthening(), options); }, {"mu:", "0"}));
  }
}

// The volume couples all vertices, so that the solver iterates.
TEST(Transport, FiguresAreThoseOfAllTangents) {
  const ShapeFamily bar = BarInDetail();
  MetricOptions options;
  options.volume = 0.3;
  const std::vector<Shape> shapes = {3 * bar.pose(10), 3 * bar.pose(25), 3 * bar.pose(45)};
  const Path path = MakePath(FreezeMetric(options, bar.connectivity, {shapes[0]}), shapes);
  const int count = bar.connectivity->NumVertices();
  const std::vector<Tangent> tangents = {shapes[1] - shapes[0], Noise(count, 0.3, 3),
                                         Tangent::Constant(3, count, 0.1)};
  Listener listener;
  std::vector<int> done;
  listener.on_report = [&](const std::string& stage, int segment) {
    EXPECT_EQ(stage, "transporting");
    done.push_back(segment);
  };
  const auto [carried, summary] = Transport(path, tangents, {}, &listener);
  EXPECT_EQ(done, (std::vector<int>{0, 1}));
  EXPECT_TRUE(summary.converged);
  EXPECT_EQ(summary.metric, DescribeMetric(path.metric->options));
  EXPECT_EQ(summary.estimated_bytes, internal::TransportBytes(*path.metric, 3));
  ASSERT_EQ(summary.steps.size(), 2u);
  ASSERT_EQ(summary.first_norm.size(), 3u);
  ASSERT_EQ(summary.last_norm.size(), 3u);
  const FeatureMap map(path.metric);
  const auto norm = [&](int i, const Tangent& x) {
    const Tangent own = path.motions[i].rotation.transpose() * x / path.metric->unit;
    return map.Derivative(path.shapes[i]).Times(own).norm();
  };
  for (size_t k = 0; k < tangents.size(); ++k) {
    EXPECT_NEAR(summary.first_norm[k], norm(0, tangents[k]), 1e-9 * summary.first_norm[k]);
    EXPECT_NEAR(summary.last_norm[k], norm(2, carried[k]), 1e-9 * summary.last_norm[k]);
  }
  int iterations[2] = {0, 0};
  for (const Tangent& x : tangents) {
    const TransportSummary alone = Transport(path, {x}).summary;
    for (const int i : {0, 1}) {
      iterations[i] = std::max(iterations[i], alone.steps[i].krylov_iterations);
      EXPECT_LE(summary.steps[i].residual, 1e-12);
    }
  }
  for (const int i : {0, 1}) {
    EXPECT_NEAR(summary.steps[i].krylov_iterations, iterations[i], 1) << i;
    EXPECT_GT(iterations[i], 0);
    EXPECT_GT(summary.steps[i].seconds, 0);
  }
  EXPECT_GT(summary.total_seconds, summary.steps[0].seconds + summary.steps[1].seconds);
}

TEST(Transport, RefusalsNameTheFieldAndTheRemedy) {
  const Path path = UnevenPath();
  const Tangent x = Tangent::Constant(3, 28, 1);
  Tangent broken = x;
  broken(2, 27) = kNoNumber;
  EXPECT_TRUE(Refuses<MeshError>([&] { Transport(path, {x, broken}); }, {"tangent"}));
  EXPECT_TRUE(Refuses<MeshError>([&] { Transport(path, {x, Tangent::Zero(3, 27)}); }, {"tangent"}));
  EXPECT_TRUE(Refuses<MeshError>([&] { Transport(FirstShapes(path, 1), {x}); }, {"two shapes"}));
  TransportOptions options;
  options.memory_limit = 100;
  EXPECT_TRUE(Refuses<SolverError>([&] { Transport(path, {x}, options); },
                                   {"this transport", "fewer vertices"}));
  options.memory_limit = -1;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { Transport(path, {x}, options); }, {"memory_limit:"}));
}

}  // namespace
}  // namespace shapespace
