#include <filesystem>

#include <ceres/autodiff_cost_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/cost/path_energy.h>
#include <shapespace/cost/path_energy_function.h>
#include <shapespace/cost/shape_features.h>
#include <shapespace/files/read.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/path/energy.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/own_features.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::NoisyBlend;

// Values and gradients, compared with the kernels, which are independent of Ceres.
TEST(PathEnergyBlocks, AreAQuarterOfTheEnergy) {
  MetricOptions all, paper = MetricOptions::Paper();
  all.strain = 0.5;
  all.volume = 0.3;
  paper.bending = 1e-4;
  for (const MetricOptions& options : {MetricOptions(), all, paper, testing::OwnBlend()}) {
    SCOPED_TRACE(DescribeMetric(options));
    const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
    const std::vector<Shape> ends = {bar.pose(0), bar.pose(80)};
    const auto metric = FreezeMetric(options, bar.connectivity, ends);
    std::vector<Shape> shapes = NoisyBlend(ends[0] / metric->unit, ends[1] / metric->unit, 3, 0.01);
    PathEnergy energy(metric, 3);
    energy.SetQuarticWeight(0.25);
    std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
    energy.Load(shapes, unknowns.data());
    const double expected = energy.Evaluate(unknowns.data(), gradient.data());
    std::vector<Shape> slopes = shapes;
    energy.Store(gradient.data(), &slopes);

    ceres::Problem problem;
    cost::AddPathEnergy(*metric, &shapes, &problem, nullptr, 0.25);
    ceres::Problem::EvaluateOptions evaluate;
    for (int i = 1; i <= 3; ++i) {
      for (int v = 0; v < shapes[i].cols(); ++v) {
        evaluate.parameter_blocks.push_back(shapes[i].col(v).data());
      }
    }
    double cost;
    std::vector<double> derivative;
    problem.Evaluate(evaluate, &cost, nullptr, &derivative, nullptr);
    EXPECT_NEAR(4 * cost, expected, 1e-12 * expected);
    size_t k = 0;
    double largest = 0;
    for (double slope : gradient) largest = std::max(largest, std::abs(slope));
    for (int i = 1; i <= 3; ++i) {
      for (double slope : slopes[i].reshaped()) {
        EXPECT_NEAR(4 * derivative[k++], slope, 1e-11 * largest);
      }
    }
  }
}

// Solves with and without, by both of Ceres' minimisers, end in the same bits. The volume is a
// feature that is not shared.
TEST(PathEnergyBlocks, SharedFeaturesChangeNoBit) {
  MetricOptions all;
  all.isometric = all.volume = 0.3;
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
  const std::vector<Shape> ends = {bar.pose(0), bar.pose(80)};
  for (const MetricOptions& metric_options : {all, MetricOptions::Paper(), testing::OwnBlend()}) {
    const auto metric = FreezeMetric(metric_options, bar.connectivity, ends);
    for (const ceres::MinimizerType minimizer : {ceres::TRUST_REGION, ceres::LINE_SEARCH}) {
      const auto solve = [&](bool shared) {
        std::vector<Shape> shapes =
            NoisyBlend(ends[0] / metric->unit, ends[1] / metric->unit, 3, 0.01);
        cost::ShapeFeatures features(metric, &shapes);
        ceres::Problem::Options problem_options;
        if (shared) problem_options.evaluation_callback = &features;
        ceres::Problem problem(problem_options);
        cost::AddPathEnergy(*metric, &shapes, &problem, nullptr, 1, shared ? &features : nullptr);
        cost::SetConstant(&shapes.front(), &problem);
        cost::SetConstant(&shapes.back(), &problem);
        ceres::Solver::Options options;
        options.minimizer_type = minimizer;
        options.max_num_iterations = 10;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
        EXPECT_LT(summary.final_cost, 0.9 * summary.initial_cost);
        return shapes;
      };
      EXPECT_EQ(solve(true), solve(false)) << DescribeMetric(metric_options);
    }
  }
}

TEST(PathEnergyBlocks, SharedFeaturesAreEvaluatedAtNewPointsOnly) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0)});
  std::vector<Shape> shapes = {bar.pose(0) / metric->unit, bar.pose(80) / metric->unit};
  cost::ShapeFeatures features(metric, &shapes);
  features.PrepareForEvaluation(true, true);
  const std::vector<double> before = features.Of(0, 1).values;
  shapes[1] *= 2;
  features.PrepareForEvaluation(true, false);
  EXPECT_EQ(features.Of(0, 1).values, before);
  features.PrepareForEvaluation(false, true);
  EXPECT_NE(features.Of(0, 1).values, before);
  const std::vector<double> derivatives = features.Of(0, 1).derivatives;
  features.PrepareForEvaluation(true, false);  // at the same point, for the first time with these
  EXPECT_NE(features.Of(0, 1).derivatives, derivatives);
}

TEST(PathEnergyBlocks, OfTheRigidMetricAreItsEnergyOnceTheMotionsAreSolvedFor) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
  const std::vector<Shape> ends = {bar.pose(0), bar.pose(80)};
  const auto metric = FreezeMetric(MetricOptions::Rigid(), bar.connectivity, ends);
  std::vector<Shape> shapes = NoisyBlend(ends[0] / metric->unit, ends[1] / metric->unit, 2, 0.01);
  PathEnergy energy(metric, 2);
  std::vector<double> unknowns(energy.Size());
  energy.Load(shapes, unknowns.data());
  ceres::Problem problem;
  cost::RigidMotions motions;
  cost::AddPathEnergy(*metric, &shapes, &problem, &motions);
  for (Shape& shape : shapes) cost::SetConstant(&shape, &problem);
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 0;
  options.max_num_iterations = 20;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_NEAR(4 * summary.final_cost, energy.Evaluate(unknowns.data(), nullptr),
              1e-9 * summary.final_cost);
}

// Ceres' L-BFGS on the function and its trust region on residual blocks find the same path.
TEST(PathEnergyFunction, LeadsToTheMinimumOfTheResidualBlocks) {
  for (const MetricOptions& options : {MetricOptions(), MetricOptions::Paper()}) {
    SCOPED_TRACE(DescribeMetric(options));
    const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
    const std::vector<Shape> ends = {bar.pose(0), bar.pose(60)};
    const auto metric = FreezeMetric(options, bar.connectivity, ends);
    std::vector<Shape> shapes = NoisyBlend(ends[0] / metric->unit, ends[1] / metric->unit, 3, 0.01);

    auto* const function = new cost::PathEnergyFunction(metric, shapes);
    const ceres::GradientProblem problem(function);
    std::vector<double> y(problem.NumParameters(), 0.0);
    const std::vector<Shape> start = function->PathAt(y.data());
    for (size_t i = 0; i < shapes.size(); ++i) EXPECT_LT((start[i] - shapes[i]).norm(), 1e-14);
    ceres::GradientProblemSolver::Options gradient_options;
    gradient_options.max_num_iterations = 2000;
    gradient_options.function_tolerance = 1e-12;
    gradient_options.gradient_tolerance = gradient_options.parameter_tolerance = 0;
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(gradient_options, problem, y.data(), &summary);
    const double energy = summary.final_cost * function->InitialEnergy();
    const std::vector<Shape> found = function->PathAt(y.data());
    EXPECT_EQ(found.front(), shapes.front());
    EXPECT_EQ(found.back(), shapes.back());

    ceres::Problem blocks;
    cost::AddPathEnergy(*metric, &shapes, &blocks);
    cost::SetConstant(&shapes.front(), &blocks);
    cost::SetConstant(&shapes.back(), &blocks);
    ceres::Solver::Options solver_options;
    solver_options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver_options.logging_type = ceres::SILENT;
    solver_options.function_tolerance = 1e-12;
    solver_options.gradient_tolerance = solver_options.parameter_tolerance = 0;
    solver_options.max_num_iterations = 500;
    ceres::Solver::Summary expected;
    ceres::Solve(solver_options, &blocks, &expected);
    EXPECT_NEAR(energy, 2 * 4 * expected.final_cost, 1e-5 * energy);
    EXPECT_LT(energy, 0.9 * function->InitialEnergy());
  }
}

TEST(PathEnergyFunction, RefusesPathsWithoutUnknownsOrEnergy) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(60)});
  const Shape shape = bar.pose(0) / metric->unit, other = bar.pose(60) / metric->unit;
  EXPECT_THROW(cost::PathEnergyFunction(metric, {shape, other}), MeshError);
  EXPECT_THROW(cost::PathEnergyFunction(metric, {shape, shape.array() / 0, other}), SolverError);
  EXPECT_THROW(cost::PathEnergyFunction(metric, {shape, Shape::Zero(3, 2), other}), MeshError);
}

// A user's spring as additional residual: the stiffer it is, the nearer its vertex is to the
// target.
TEST(PathEnergyBlocks, TakeResidualsOfTheUser) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
  GeodesicOptions options;
  options.shapes = 3;
  options.tolerance = 1e-10;
  Path path = Interpolate(bar.connectivity, {bar.pose(0), bar.pose(60)}, options).path;
  const Eigen::Vector3d target = path.shapes[2].col(5) + Eigen::Vector3d(0, 0.2, 0);
  struct Spring {
    Eigen::Vector3d target;
    double stiffness;
    bool operator()(const ceres::Jet<double, 3>* p, ceres::Jet<double, 3>* r) const {
      for (int k = 0; k < 3; ++k) r[k] = stiffness * (p[k] - target(k));
      return true;
    }
    bool operator()(const double* p, double* r) const {
      for (int k = 0; k < 3; ++k) r[k] = stiffness * (p[k] - target(k));
      return true;
    }
  };
  double before = (path.shapes[2].col(5) - target).norm();
  double cost_before = 0;
  for (double stiffness : {1e-3, 1e-1, 1e2}) {
    std::vector<Shape> shapes = path.shapes;
    ceres::Problem problem;
    cost::AddPathEnergy(*path.metric, &shapes, &problem);
    cost::SetConstant(&shapes.front(), &problem);
    cost::SetConstant(&shapes.back(), &problem);
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Spring, 3, 3>(new Spring{target, stiffness}), nullptr,
        shapes[2].col(5).data());
    ceres::Solver::Options solve;
    solve.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solve.function_tolerance = 1e-12;
    solve.gradient_tolerance = solve.parameter_tolerance = 0;
    solve.max_num_iterations = 200;
    solve.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solve, &problem, &summary);
    const double off = (shapes[2].col(5) - target).norm();
    EXPECT_LT(off, before) << stiffness;
    EXPECT_GT(summary.final_cost, cost_before) << stiffness;
    before = off;
    cost_before = summary.final_cost;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(PathEnergyBlocks, RefuseWhatTheyCannotTake) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 40, 15, 15);
  std::vector<Shape> shapes = {bar.pose(0), bar.pose(0)};
  ASSERT_GT(shapes[0].cols(), cost::kMaxDenseVertices);
  MetricOptions volume;
  volume.volume = 1;
  const auto message = [&](const MetricOptions& options) {
    const auto metric = FreezeMetric(options, bar.connectivity, shapes);
    return MessageOf<InvalidOptions>([&] {
      ceres::Problem problem;
      cost::AddPathEnergy(*metric, &shapes, &problem);
    });
  };
  EXPECT_EQ(message(volume).rfind("volume:", 0), 0u);
  EXPECT_EQ(message(MetricOptions::Rigid()).rfind("motions:", 0), 0u);
  const auto metric = FreezeMetric({}, bar.connectivity, shapes);
  ceres::Problem problem;
  std::vector<Shape> one = {shapes[0]}, other = {shapes[0], shapes[1].leftCols(3)};
  EXPECT_THROW(cost::AddPathEnergy(*metric, &one, &problem), MeshError);
  EXPECT_THROW(cost::AddPathEnergy(*metric, &other, &problem), MeshError);
  EXPECT_EQ(problem.NumParameterBlocks(), 0);
}

// Without a cost of position nothing determines a vertex that no polygon uses.
TEST(PathEnergyBlocks, KnowEveryVertex) {
  Shape shape(3, 4);
  shape << 0, 1, 0, 5, 0, 0, 1, 5, 0, 0, 0, 5;
  std::vector<Shape> shapes = {shape, shape};
  MetricOptions options;
  options.lambda = 0;
  const auto metric = FreezeMetric(options, Connectivity::Make(4, {0, 3}, {0, 1, 2}, {}), shapes);
  ceres::Problem problem;
  cost::AddPathEnergy(*metric, &shapes, &problem);
  for (Shape& each : shapes) cost::SetConstant(&each, &problem);
  EXPECT_EQ(problem.NumParameterBlocks(), 8);
}

TEST(RealPosesBySolvers, CeresAndOursReachTheSameEnergy) {
  const std::filesystem::path folder = SHAPESPACE_DATA_DIR;
  const std::string first = (folder / "horse_lowpoly/base.obj").string();
  if (folder.empty() || !std::filesystem::exists(first)) {
    GTEST_SKIP() << "no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR";
  }
  const Poses poses = ReadPoses({first, (folder / "horse_lowpoly/m03.obj").string()});
  std::vector<double> energies;
  for (GeodesicSolver solver :
       {GeodesicSolver::kLbfgs, GeodesicSolver::kThreadedLbfgs, GeodesicSolver::kTrustRegion}) {
    GeodesicOptions options;
    options.solver = solver;
    options.shapes = 7;
    options.tolerance = 1e-8;
    options.max_iterations = 2000;
    const GeodesicSummary summary = Interpolate(poses, options).summary;
    EXPECT_EQ(summary.termination, Termination::kConverged);
    energies.push_back(summary.energy);
  }
  for (double energy : energies) EXPECT_NEAR(energy, energies[0], 1e-4 * energies[0]);
}

}  // namespace
}  // namespace shapespace
