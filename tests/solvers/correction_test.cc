#include <shapespace/exponential/correction.h>

#include <cmath>
#include <limits>

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/cost/path_energy.h>
#include <shapespace/path/energy.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"
#include "support/path_of.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::Listener;
using testing::MessageOf;
using testing::Names;
using testing::PathOf;

// From the body's pose at `begin` on a straight line towards the one at `step`, to `reach` times
// the distance: an isometric motion without its curvature.
Path StraightOn(const ShapeFamily& body, double begin, double step, double reach, int segments) {
  const Shape first = body.pose(begin);
  const Tangent way = reach * (body.pose(step) - first);
  std::vector<Shape> shapes;
  for (int i = 0; i <= segments; ++i) shapes.push_back(first + i * way / segments);
  Path path = PathOf(body.connectivity, shapes);
  path.poses = {0};
  path.extrapolated = segments;
  path.provenance = "a test";
  return path;
}

// Both can flex with all edges of constant length; these paths stretch them by at least a third.
Path Strip(int segments = 8) { return StraightOn(MakeStrip(1, 0.9, 16), 0, 2.5, 8, segments); }
Path Bricard(int segments = 8) { return StraightOn(MakeBricard(), 0, 4, 8, segments); }

CorrectionOptions Options(double mu, double tolerance = 1e-10) {
  CorrectionOptions options;
  options.mu = mu;
  options.tolerance = tolerance;
  options.max_iterations = 10000;
  return options;
}

// With a tolerance of 1e-14, shapes are accurate to about its square root, and so are all figures
// that are not minimal there.
constexpr double kClose = 3e-6;

// Largest distance between corresponding vertices, over the body's size: both are in its unit.
double ShapeDifference(const Path& a, const Path& b) {
  double largest = 0;
  for (int i = 0; i < a.NumShapes(); ++i) {
    largest = std::max(largest, testing::Distance(a.shapes[i], b.shapes[i]));
  }
  return largest;
}

TEST(CorrectPath, KeepsAllButTheShapes) {
  const Path given = Strip();
  const auto [path, summary] = CorrectPath(given);
  EXPECT_TRUE(summary.converged);
  EXPECT_TRUE(path.shapes[0] == given.shapes[0]);
  EXPECT_EQ(path.NumShapes(), given.NumShapes());
  EXPECT_EQ(path.metric, given.metric);
  EXPECT_EQ(path.parameters, given.parameters);
  EXPECT_EQ(path.poses, given.poses);
  EXPECT_EQ(path.extrapolated, given.extrapolated);
  EXPECT_EQ(path.provenance, "a test; corrected");
  for (int i = 0; i < path.NumShapes(); ++i) {
    EXPECT_EQ(path.motions[i].rotation, given.motions[i].rotation);
    EXPECT_EQ(path.motions[i].translation, given.motions[i].translation);
  }
  EXPECT_EQ(summary.shapes, given.NumShapes() - 1);
  EXPECT_LT(summary.energy, 0.1 * summary.initial_energy);
  EXPECT_LT(summary.quality.first_rms, 0.3 * summary.initial_quality.first_rms);
}

// The smaller the weight of the distance, the more accurate the lengths, in the end proportionally,
// and the larger the displacement; the remaining motion is the body's own flex.
TEST(CorrectPath, LengthErrorsFallWithMu) {
  for (const Path& given : {Strip(), Bricard()}) {
    double error = MeasureQuality(given).first_max, energy = 0, distance = 0;
    for (double mu : {10.0, 1.0, 0.1, 0.01}) {
      SCOPED_TRACE(mu);
      const auto [path, summary] = CorrectPath(given, Options(mu));
      EXPECT_TRUE(summary.converged);
      EXPECT_EQ(summary.initial_quality.first_max, MeasureQuality(given).first_max);
      EXPECT_EQ(summary.quality.first_max, MeasureQuality(path).first_max);
      EXPECT_LT(summary.quality.first_max, error / (mu > 0.1 ? 2 : mu > 0.01 ? 6 : 8));
      EXPECT_GT(summary.quality.first_max, error / 10.5);
      EXPECT_LT(summary.energy, energy > 0 ? energy : summary.initial_energy);
      EXPECT_GT(summary.distance, distance);
      EXPECT_GT(summary.deformation_left, 0.6);
      EXPECT_TRUE(summary.warnings.empty());
      error = summary.quality.first_max;
      energy = summary.energy;
      distance = summary.distance;
    }
  }
}

TEST(CorrectPath, FindsExactlyIsometricPathsWhereLengthsAreAllThatCounts) {
  for (const Path& given : {Strip(), Bricard()}) {
    const CorrectionSummary summary = CorrectPath(given, Options(0)).summary;
    EXPECT_TRUE(summary.converged);
    EXPECT_LT(summary.quality.first_max, 1e-8);
    EXPECT_GT(summary.deformation_left, 0.5);
  }
}

// Corrected paths of fine and coarse resolution in time end in nearly the same shape:
// discretisation errors are of first order in the length of a segment, because the distance is
// summed over all shapes but the first.
TEST(CorrectPath, MuMeansTheSameForAnyNumberOfShapes) {
  std::vector<Shape> ends;
  for (int segments : {8, 16, 32}) {
    ends.push_back(CorrectPath(Bricard(segments), Options(1)).path.shapes.back());
  }
  const double coarse = (ends[1] - ends[0]).norm(), fine = (ends[2] - ends[1]).norm();
  EXPECT_NEAR(coarse / fine, 2, 0.3);
  EXPECT_LT(fine, 0.02);
}

// A rigid motion of a shape changes no length: its centroid and orientation are determined by the
// distance term alone, which is Procrustes' own criterion.
TEST(CorrectPath, LeavesShapesAlignedWithTheGivenOnes) {
  const Path given = Strip();
  const Path path = CorrectPath(given, Options(1, 1e-14)).path;
  const Eigen::VectorXd& area = given.metric->vertex_area;
  for (int i = 1; i < path.NumShapes(); ++i) {
    EXPECT_LT(Centroid(path.shapes[i] - given.shapes[i], area).norm(), kClose);
    const RigidMotion motion = FitRigidMotion(path.shapes[i], given.shapes[i], area);
    EXPECT_LT(Eigen::AngleAxisd(motion.rotation).angle(), kClose);
  }
}

TEST(CorrectPath, LeavesAnIsometricPathAlone) {
  const ShapeFamily body = MakeBricard();
  std::vector<Shape> shapes;
  for (int i = 0; i <= 8; ++i) shapes.push_back(body.pose(4 * i));
  const Path given = PathOf(body.connectivity, shapes);
  const auto [path, summary] = CorrectPath(given);
  EXPECT_TRUE(summary.converged);
  EXPECT_LT(ShapeDifference(path, given), 1e-12);
  EXPECT_NEAR(summary.deformation_left, 1, 1e-10);
}

TEST(CorrectPath, LeavesAPathThatOnlyTurnsAlone) {
  const Shape shape = MakeBar(4, 1, 1, 4, 1, 1).pose(20);
  const Eigen::Matrix3d turn = testing::Rotation(1e-3, {1, 2, 3});
  const Path given =
      PathOf(MakeBar(4, 1, 1, 4, 1, 1).connectivity, {shape, turn * shape, turn * turn * shape});
  for (const CorrectionMode mode : {CorrectionMode::kProximal, CorrectionMode::kPaper}) {
    CorrectionOptions options;
    options.mode = mode;
    const auto [path, summary] = CorrectPath(given, options);
    EXPECT_TRUE(summary.converged);
    EXPECT_LT(ShapeDifference(path, given), 1e-12);
    EXPECT_EQ(summary.deformation_left, 1);
    EXPECT_TRUE(summary.warnings.empty());
  }
}

TEST(CorrectPath, ThePapersEnergyCollapsesAndSaysSo) {
  for (const Path& given :
       {Strip(), Bricard(), StraightOn(MakeBar(6, 1, 1, 6, 2, 2), 0, 10, 8, 8)}) {
    CorrectionOptions options = Options(1, 1e-4);
    options.mode = CorrectionMode::kPaper;
    const auto [path, summary] = CorrectPath(given, options);
    EXPECT_TRUE(summary.converged);
    EXPECT_TRUE(path.shapes[0] == given.shapes[0]);
    EXPECT_LT(summary.quality.first_max, 1e-4);
    EXPECT_LT(summary.deformation_left, 0.02);
    // A translate: not even rotated.
    const Shape& first = path.shapes.front();
    const Shape& last = path.shapes.back();
    const Shape moved = last.colwise() - Centroid(last - first, given.metric->vertex_area);
    EXPECT_LT((moved - first).norm(), 0.1 * (given.shapes.back() - first).norm());

    // If stopped early, the result looks better, but has the warning too.
    for (double tolerance : {1e-4, 1e-3}) {
      options.tolerance = tolerance;
      const std::vector<std::string> warnings = CorrectPath(given, options).summary.warnings;
      ASSERT_EQ(warnings.size(), 1u);
      EXPECT_TRUE(Names(warnings[0], {"first shape"}));
      EXPECT_NE(warnings[0].find("kProximal"), std::string::npos);
    }
  }
}

TEST(CorrectPath, CommutesWithRotationAndScale) {
  const ShapeFamily body = MakeBricard();
  ShapeFamily moved = body;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (double scale : {1e-4, 1.0, 1e4}) {
    moved.pose = [&](double angle) -> Shape { return scale * turn * body.pose(angle); };
    const Path given = StraightOn(body, 0, 4, 8, 8), other = StraightOn(moved, 0, 4, 8, 8);
    const CorrectionResult a = CorrectPath(given, Options(1, 1e-14));
    const CorrectionResult b = CorrectPath(other, Options(1, 1e-14));
    EXPECT_NEAR(a.summary.energy, b.summary.energy, kClose * a.summary.energy);
    for (int i = 0; i < given.NumShapes(); ++i) {
      const Shape expected = scale * turn * a.path.Placed(i);
      EXPECT_LT((b.path.Placed(i) - expected).norm(), kClose * expected.norm());
    }
  }
}

// sqrt(w) (P - P^given) of one vertex.
struct ProximityCost {
  double root_weight;
  Eigen::Vector3d given;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int k = 0; k < 3; ++k) residual[k] = root_weight * (x[k] - given(k));
    return true;
  }
};

// The same sum from automatically differentiated residual blocks, minimised by another optimiser.
// Ceres' cost is a quarter of it.
double SolveFromResidualBlocks(const Path& given, double mu, std::vector<Shape>* shapes) {
  MetricOptions options = MetricOptions::Isometric();
  options.lambda = options.bending = 0;
  const auto metric = FreezeMetric(options, given.metric->connectivity, {given.shapes.front()}, 1);
  const int segments = given.NumShapes() - 1;
  ceres::Problem problem;
  cost::AddPathEnergy(*metric, shapes, &problem);
  for (int i = 0; i < segments; ++i) {
    Shape& to = (*shapes)[i + 1];
    for (int v = 0; v < to.cols(); ++v) {
      const double weight = mu / (segments * segments) * given.metric->vertex_area(v);
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ProximityCost, 3, 3>(
              new ProximityCost{std::sqrt(weight), given.shapes[i + 1].col(v)}),
          nullptr, to.col(v).data());
    }
  }
  for (int v = 0; v < shapes->front().cols(); ++v) {
    problem.SetParameterBlockConstant(shapes->front().col(v).data());
  }
  ceres::Solver::Options solve;
  solve.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solve.max_num_iterations = 500;
  solve.function_tolerance = 1e-15;
  solve.gradient_tolerance = solve.parameter_tolerance = 0;
  solve.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solve, &problem, &summary);
  return 4 * summary.final_cost;
}

TEST(CorrectPath, AgreesWithResidualBlocks) {
  for (const Path& given :
       {Strip(4), Bricard(5), StraightOn(MakeBar(4, 1, 1, 4, 1, 1), 0, 10, 8, 3)}) {
    for (double mu : {3.0, 0.3}) {
      const auto [path, summary] = CorrectPath(given, Options(mu, 1e-14));
      std::vector<Shape> shapes = given.shapes;
      const int segments = summary.shapes;
      const double expected = SolveFromResidualBlocks(given, mu, &shapes);
      // Its scaled value, from the summary's own figures.
      const double reached = summary.energy + mu * summary.distance * summary.distance *
                                                  given.metric->vertex_area.sum();
      EXPECT_NEAR(reached, ScaledEnergy(expected, segments), 1e-9 * reached);
      for (int i = 0; i <= segments; ++i) {
        EXPECT_LT((path.shapes[i] - shapes[i]).cwiseAbs().maxCoeff(), 1e-5);
      }
    }
  }
}

// The gradient at a free end is that of a sum with no segment after it, for every feature; for the
// last shape it is compared with differences of the energy.
TEST(PathEnergy, AFreeEndFollowsItsGradient) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  MetricOptions everything, paper = MetricOptions::Paper();
  everything.volume = 0.3;
  everything.rigid = 0.1;
  everything.strain = 0.5;
  for (const MetricOptions& options : {everything, paper}) {
    const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(80)});
    for (int inner : {1, 3, 8}) {
      std::vector<Shape> shapes =
          testing::NoisyBlend(bar.pose(0) / metric->unit, bar.pose(80) / metric->unit, inner, 1e-2);
      shapes.pop_back();
      PathEnergy energy(metric, inner, PathEnergy::End::kFree);
      ASSERT_EQ(energy.NumShapes(), inner + 1);
      std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
      energy.Load(shapes, unknowns.data());
      const double value = energy.Evaluate(unknowns.data(), gradient.data());
      // If the path rests at its end, the energy does not change.
      PathEnergy fixed(metric, inner);
      std::vector<double> same(fixed.Size());
      std::vector<Shape> longer = shapes;
      longer.push_back(shapes.back());
      fixed.Load(longer, same.data());
      EXPECT_NEAR(value, fixed.Evaluate(same.data(), nullptr), 1e-12 * value);

      constexpr double kStep = 1e-5;
      const Tangent way = testing::Noise(static_cast<int>(shapes[0].cols()), 1, 7);
      double values[2], slope = 0;
      for (int side : {0, 1}) {
        std::vector<Shape> moved = shapes;
        moved.back() += (side == 0 ? -kStep : kStep) * way;
        std::vector<double> there(energy.Size());
        energy.Load(moved, there.data());
        values[side] = energy.Evaluate(there.data(), nullptr);
      }
      std::vector<Shape> derivative = shapes;
      energy.Store(gradient.data(), &derivative);
      slope = derivative.back().cwiseProduct(way).sum();
      EXPECT_NEAR((values[1] - values[0]) / (2 * kStep), slope, 1e-5 * std::abs(slope));
    }
  }
}

TEST(CorrectPath, RefusesWhatCannotBeCorrected) {
  const Path given = Bricard();
  Path one = given;
  one.shapes.resize(1);
  EXPECT_THROW(CorrectPath(one), MeshError);
  for (int i : {0, 3}) {
    Path broken = given;
    broken.shapes[i](1, 2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(CorrectPath(broken), Error);
  }
  const auto message = [&](void (*change)(CorrectionOptions*)) {
    CorrectionOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { CorrectPath(given, options); });
  };
  EXPECT_EQ(message([](CorrectionOptions* o) { o->mu = -1; }).find("mu:"), 0u);
  EXPECT_EQ(message([](CorrectionOptions* o) { o->mu = NAN; }).find("mu:"), 0u);
  EXPECT_EQ(message([](CorrectionOptions* o) { o->tolerance = 0; }).find("tolerance:"), 0u);
  EXPECT_EQ(message([](CorrectionOptions* o) { o->max_iterations = 0; }).find("max_iterations:"),
            0u);
}

TEST(CorrectPath, ReturnsTheBestSoFarWhenCancelled) {
  Listener at_once(1);
  EXPECT_THROW(CorrectPath(Strip(), {}, &at_once), Cancelled);
  Listener later(5);
  const auto [path, summary] = CorrectPath(Strip(), {}, &later);
  EXPECT_FALSE(summary.converged);
  ASSERT_FALSE(summary.warnings.empty());
  EXPECT_NE(summary.warnings[0].find("cancelled"), std::string::npos);
  EXPECT_LT(summary.energy, summary.initial_energy);
  EXPECT_LT(summary.quality.first_rms, summary.initial_quality.first_rms);
}

TEST(CorrectionSummary, SaysThatIterationsRanOut) {
  CorrectionOptions options;
  options.max_iterations = 2;
  const CorrectionSummary summary = CorrectPath(Strip(), options).summary;
  EXPECT_FALSE(summary.converged);
  EXPECT_EQ(summary.iterations, 2);
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_NE(summary.warnings[0].find("max_iterations"), std::string::npos);
  const auto json = nlohmann::json::parse(summary.ToJson());
  EXPECT_EQ(json["converged"], false);
  EXPECT_EQ(json["termination"], "max_iterations");
  EXPECT_EQ(json["mode"], "proximal");
  EXPECT_EQ(json["mu"], 1);
  EXPECT_EQ(json["quality"]["first_max"], summary.quality.first_max);
  EXPECT_EQ(json["initial_quality"]["first_rms"], summary.initial_quality.first_rms);
}

}  // namespace
}  // namespace shapespace
