#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/geodesic/internal/residual_blocks.h>
#include <shapespace/minimise/detail/line_search.h>
#include <shapespace/minimise/internal/minimise.h>

#include "support/paths.h"

namespace shapespace::internal {
namespace {

// A bent bar between two poses, and the data with which an optimiser relaxes the path between them.
struct Problem {
  Problem(const ShapeFamily& body, int inner, const MetricOptions& options = {})
      : metric(FreezeMetric(options, body.connectivity, {body.pose(0), body.pose(70)})),
        shapes(testing::NoisyBlend(body.pose(0) / metric->unit, body.pose(70) / metric->unit, inner,
                                   2e-3)),
        energy(metric, inner),
        factor(ScalarMetric(*metric, {shapes.front(), shapes.back()}, 0)),
        single(factor),
        variables(factor, energy),
        preconditioner(single, energy),
        start(energy.Size()) {
    energy.Load(shapes, start.data());
  }

  MinimiseResult Ours(const MinimiseOptions& options, std::vector<double>* unknowns) {
    return MinimiseThreadedLbfgs(&energy, &preconditioner, options, unknowns);
  }

  std::shared_ptr<const Metric> metric;
  std::vector<Shape> shapes;
  PathEnergy energy;
  Cholesky factor;
  CholeskyFactor<float> single;
  ChangeOfVariables variables;
  Preconditioner preconditioner;
  std::vector<double> start;
};

MinimiseOptions Tolerance(double tolerance) {
  MinimiseOptions options;
  options.tolerance = tolerance;
  return options;
}

TEST(Minimise, AllThreeReachTheSameMinimum) {
  MetricOptions with_volume, stiff, paper = MetricOptions::Paper();
  with_volume.volume = 0.3;
  stiff.bending = 1e-3;
  paper.bending = 1e-4;
  for (const MetricOptions& metric :
       {MetricOptions(), MetricOptions::Isometric(), with_volume, stiff, paper}) {
    SCOPED_TRACE(DescribeMetric(metric));
    Problem problem(MakeBar(4, 1, 1, 6, 1, 1), 3, metric);
    // The minimum is flat: hundreds of iterations lead to 1e-13 and gain 3e-8.
    const MinimiseOptions options = Tolerance(1e-11);
    std::vector<double> ours = problem.start, ceres = problem.start;
    const MinimiseResult a = problem.Ours(options, &ours);
    const MinimiseResult b =
        MinimiseLbfgs(ObjectiveOf(&problem.energy), &problem.variables, options, &ceres);
    const MinimiseResult c = MinimiseTrustRegion(*problem.metric, 1, options, &problem.shapes);
    EXPECT_EQ(a.termination, Termination::kConverged);
    EXPECT_NEAR(a.energy, b.energy, 1e-7 * b.energy);
    EXPECT_NEAR(a.energy, c.energy, 1e-7 * c.energy);
    EXPECT_EQ(a.initial_energy, b.initial_energy);
    EXPECT_EQ(a.energy, problem.energy.Evaluate(ours.data(), nullptr));
  }
}

TEST(ThreadedLbfgs, ReachesTinyTolerancesWithAShortHistoryToo) {
  for (int rank : {1, 5, 20}) {
    Problem problem(MakeBar(6, 1, 1, 24, 4, 4), 7);
    MinimiseOptions options = Tolerance(1e-10);
    options.rank = rank;
    std::vector<double> unknowns = problem.start;
    const MinimiseResult result = problem.Ours(options, &unknowns);
    EXPECT_EQ(result.termination, Termination::kConverged);
    EXPECT_LT(result.remaining, 1e-8);
    EXPECT_NEAR(result.remaining,
                RemainingDecrease(ObjectiveOf(&problem.energy), &problem.variables, unknowns),
                1e-3 * result.remaining);
    // A new solve from the result gains almost nothing.
    const MinimiseResult again = problem.Ours(options, &unknowns);
    EXPECT_LE(again.energy, result.energy);
    EXPECT_NEAR(again.energy, result.energy, 1e-6 * result.energy);
  }
}

// A preconditioner with a wrong scale is equally good after the first step.
TEST(ThreadedLbfgs, FindsTheScaleOfThePreconditioner) {
  Problem problem(MakeBar(6, 1, 1, 24, 4, 4), 7);
  int evaluations = 0;
  for (double factor : {1.0, 0.02, 50.0}) {
    std::vector<double> unknowns = problem.start;
    const MinimiseResult result = MinimiseThreadedLbfgs(
        ObjectiveOf(&problem.energy),
        [&](const double* gradient, double unit, double* step) {
          problem.preconditioner.Apply(gradient, unit, step);
          for (size_t k = 0; k < problem.start.size(); ++k) step[k] *= factor;
        },
        Tolerance(1e-8), &unknowns);
    EXPECT_EQ(result.termination, Termination::kConverged);
    EXPECT_LT(result.evaluations, 1.2 * result.iterations + 8);
    if (factor == 1) evaluations = result.evaluations;
    EXPECT_LT(result.evaluations, 1.3 * evaluations + 8);
  }
}

// A solve that starts where little is left needs one iteration to see it: the next one promises
// less than the tolerance.
TEST(ThreadedLbfgs, EndsWhenTheNextIterationPromisesLittle) {
  Problem problem(MakeBar(6, 1, 1, 24, 4, 4), 7);
  std::vector<double> unknowns = problem.start;
  problem.Ours(Tolerance(1e-5), &unknowns);
  const MinimiseResult again = problem.Ours(Tolerance(1e-4), &unknowns);
  EXPECT_EQ(again.termination, Termination::kConverged);
  EXPECT_EQ(again.iterations, 1);
}

TEST(ThreadedLbfgs, DoesNothingAtAMinimum) {
  Problem problem(MakeBar(4, 1, 1, 6, 1, 1), 3);
  std::vector<double> unknowns = problem.start;
  const MinimiseResult result = problem.Ours(Tolerance(1e-13), &unknowns);
  const std::vector<double> minimum = unknowns;
  const MinimiseResult again = problem.Ours(Tolerance(1e-4), &unknowns);
  EXPECT_EQ(again.termination, Termination::kConverged);
  EXPECT_EQ(again.iterations, 0);
  EXPECT_EQ(again.evaluations, 1);
  EXPECT_EQ(again.energy, result.energy);
  EXPECT_TRUE(unknowns == minimum);
}

TEST(ThreadedLbfgs, AcceptsAnEnergyOfRounding) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 1, 1);
  Problem problem(bar, 3, MetricOptions::Isometric());
  const Shape shape = bar.pose(0) / problem.metric->unit;
  problem.energy.Load(std::vector<Shape>(5, shape), problem.start.data());
  std::vector<double> unknowns = problem.start;
  const MinimiseResult result = problem.Ours({}, &unknowns);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_LT(result.energy, 1e-30);
  EXPECT_TRUE(unknowns == problem.start);
}

TEST(Minimise, EnoughEndsASolveThatHasGainedMostOfWhatThereIs) {
  for (const bool ours : {true, false}) {
    SCOPED_TRACE(ours ? "ours" : "Ceres");
    Problem problem(MakeBar(6, 1, 1, 24, 4, 4), 7);
    const auto solve = [&](double enough, std::vector<double>* unknowns) {
      MinimiseOptions options = Tolerance(1e-10);
      options.enough = enough;
      *unknowns = problem.start;
      return ours ? problem.Ours(options, unknowns)
                  : MinimiseLbfgs(ObjectiveOf(&problem.energy), &problem.variables, options,
                                  unknowns);
    };
    std::vector<double> unknowns;
    const MinimiseResult full = solve(0, &unknowns);
    const MinimiseResult some = solve(1e-2, &unknowns);
    EXPECT_EQ(some.termination, Termination::kConverged);
    EXPECT_LT(some.iterations, full.iterations);
    EXPECT_LT(some.initial_energy - full.energy, 1.1 * (some.initial_energy - some.energy));
    EXPECT_DOUBLE_EQ(some.energy, problem.energy.Evaluate(unknowns.data(), nullptr));
    EXPECT_NEAR(some.remaining,
                RemainingDecrease(ObjectiveOf(&problem.energy), &problem.variables, unknowns),
                1e-4 * some.remaining);
    EXPECT_GT(some.remaining, full.remaining);
  }
}

TEST(ThreadedLbfgs, KeepsItsLimitsAndCanBeCancelled) {
  Problem problem(MakeBar(4, 1, 1, 6, 1, 1), 3);
  MinimiseOptions options = Tolerance(1e-12);
  options.max_iterations = 4;
  std::vector<double> unknowns = problem.start;
  const MinimiseResult result = problem.Ours(options, &unknowns);
  EXPECT_EQ(result.termination, Termination::kMaxIterations);
  EXPECT_EQ(result.iterations, 4);
  for (int last : {0, 2}) {
    options.keep_going = [&](int iteration, double) { return iteration < last; };
    for (const bool ours : {true, false}) {
      unknowns = problem.start;
      const MinimiseResult stopped = ours ? problem.Ours(options, &unknowns)
                                          : MinimiseLbfgs(ObjectiveOf(&problem.energy),
                                                          &problem.variables, options, &unknowns);
      EXPECT_EQ(stopped.termination, Termination::kCancelled);
      EXPECT_EQ(stopped.iterations, last);
      EXPECT_EQ(stopped.energy<stopped.initial_energy, last> 0);
      EXPECT_NEAR(problem.energy.Evaluate(unknowns.data(), nullptr), stopped.energy,
                  1e-12 * stopped.energy);
    }
  }
}

// The first step leads away from a barrier: it is very short, and says nothing about the rest.
TEST(ThreadedLbfgs, GoesOnAfterAStepThatWasCut) {
  const auto energy = [](const double* x, double* gradient) {
    gradient[0] = 1 - 1e-12 / (x[0] * x[0]);
    gradient[1] = x[1] - 1;
    return x[0] + 1e-12 / x[0] + (x[1] - 1) * (x[1] - 1) / 2;
  };
  MinimiseOptions options = Tolerance(1e-6);
  options.longest_step = [](const double*, const float* direction) {
    return std::min(1., 1e-6 / std::abs(direction[0]));
  };
  const auto as_it_is = [](const double* gradient, double, double* step) {
    std::copy_n(gradient, 2, step);
  };
  std::vector<double> unknowns = {1e-7, 0};
  const MinimiseResult result = MinimiseThreadedLbfgs(energy, as_it_is, options, &unknowns);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_NEAR(unknowns[1], 1, 1e-2);
}

// A preconditioner without an effect, and an energy that after the first step is never lower again,
// as if by rounding: whether the solve has converged is told by the preconditioned gradient.
TEST(ThreadedLbfgs, WithoutDecreaseHasConvergedWhereTheGradientIsSmallEnough) {
  constexpr double kCurvature = 7e-4;
  const auto as_it_is = [](const double* gradient, double, double* step) { *step = *gradient; };
  for (const auto& [tolerance, expected] :
       {std::make_pair(7e-5, Termination::kConverged), {1e-5, Termination::kStalled}}) {
    bool stepped = false;
    const auto energy = [&](const double* x, double* gradient) {
      *gradient = kCurvature * *x;
      const double value = 1 + kCurvature * *x * *x / 2;
      return stepped ? value + 1 : value;
    };
    MinimiseOptions options = Tolerance(tolerance);
    options.keep_going = [&](int iteration, double) {
      stepped = iteration > 0;
      return true;
    };
    std::vector<double> unknowns = {1};
    const MinimiseResult result = MinimiseThreadedLbfgs(energy, as_it_is, options, &unknowns);
    EXPECT_EQ(result.termination, expected);
    EXPECT_NEAR(result.remaining, std::pow(kCurvature * unknowns[0], 2) / 2, 1e-11);
    EXPECT_NEAR(unknowns[0], 0.3, 1e-6);
  }
}

TEST(ThreadedLbfgs, RefusesAStartThatIsNotFinite) {
  Problem problem(MakeBar(4, 1, 1, 6, 1, 1), 3);
  problem.start[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(problem.Ours({}, &problem.start), SolverError);
}

struct Curve {
  const char* name;
  double (*value)(double);
  double (*slope)(double);
};

TEST(SearchLine, FindsAStepThatSatisfiesTheWolfeConditions) {
  const Curve curves[] = {
      {"parabola, far", [](double t) { return std::pow(t / 500 - 1, 2); },
       [](double t) { return 2 * (t / 500 - 1) / 500; }},
      {"parabola, near", [](double t) { return std::pow(500 * t - 1, 2); },
       [](double t) { return 1000 * (500 * t - 1); }},
      {"quartic wall", [](double t) { return -t + std::pow(t, 4) * 1e6; },
       [](double t) { return -1 + 4e6 * std::pow(t, 3); }},
      {"defined below 1/2 only", [](double t) { return -t - 0.1 * std::log(0.5 - t); },
       [](double t) { return -1 + 0.1 / (0.5 - t); }},
      {"waves", [](double t) { return std::cos(9 * t + 0.1) + 0.1 * t; },
       [](double t) { return -9 * std::sin(9 * t + 0.1) + 0.1; }},
  };
  for (const Curve& curve : curves) {
    SCOPED_TRACE(curve.name);
    int evaluations = 0;
    double last = 0;
    const auto evaluate = [&](double step) {
      ++evaluations;
      last = step;
      return LinePoint{step, curve.value(step), curve.slope(step)};
    };
    const LinePoint start = {0, curve.value(0), curve.slope(0)};
    const LinePoint end = SearchLine(start, evaluate);
    EXPECT_EQ(end.step, last);
    EXPECT_GT(end.step, 0);
    EXPECT_LE(end.value, start.value + 1e-4 * end.step * start.slope);
    EXPECT_LE(std::abs(end.slope), 0.9 * std::abs(start.slope));
    EXPECT_LE(evaluations, 10);
  }
}

// A parabola plus a number so large that differences of its values are rounding errors, which
// increase here.
TEST(SearchLine, SlopesDecideWhereValuesDifferByRoundingOnly) {
  const auto evaluate = [](double step) {
    return LinePoint{step, step > 0 ? 1e6 * (1 + 1e-15) : 1e6, 2e-12 * (step - 0.9)};
  };
  EXPECT_EQ(SearchLine(evaluate(0), evaluate).step, 1);
}

TEST(SearchLine, StaysWhereNothingIsLower) {
  const LinePoint start = {0, 1, -1};  // an incorrect slope
  const LinePoint end = SearchLine(start, [](double step) { return LinePoint{step, 1 + step, 1}; });
  EXPECT_EQ(end.step, 0);
  EXPECT_EQ(end.value, 1);
}

}  // namespace
}  // namespace shapespace::internal
