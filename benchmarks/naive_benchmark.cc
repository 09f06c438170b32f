// A simple implementation for comparison: Ceres' L-BFGS on automatically differentiated residual
// blocks, one for each element and segment, at full resolution, from the linear blend of the poses.
// Measures the time until the energy is within one percent of the minimum, and the time of
// Interpolate.

#include <cmath>
#include <limits>
#include <vector>

#include <benchmark/benchmark.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <shapespace/cost/path_energy.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/path/energy.h>

#include "measure.h"
#include "quadruped.h"

namespace shapespace {
namespace {

constexpr double kNear = 1.01;
constexpr double kLimitSeconds = 60;

// Stops when the energy is at most `goal`, or the time is over.
class Watch final : public ceres::IterationCallback {
 public:
  explicit Watch(double goal) : goal_(goal) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    energy_ = 4 * iteration.cost;  // segment_cost.h
    seconds_ = stopwatch_.Seconds();
    if (energy_ <= goal_) return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    return seconds_ > kLimitSeconds ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }
  double Energy() const { return energy_; }
  double Seconds() const { return seconds_; }

 private:
  const double goal_;
  const internal::Stopwatch stopwatch_;
  double energy_ = 0, seconds_ = 0;
};

void MinimiseNaively(const Metric& metric, std::vector<Shape> shapes, Watch* watch) {
  ceres::Problem problem;
  cost::AddPathEnergy(metric, &shapes, &problem);
  for (Shape* end : {&shapes.front(), &shapes.back()}) {
    for (int v = 0; v < end->cols(); ++v) problem.SetParameterBlockConstant(end->col(v).data());
  }
  ceres::Solver::Options options;
  options.minimizer_type = ceres::LINE_SEARCH;
  options.max_num_iterations = std::numeric_limits<int>::max();
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 0;
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(watch);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

// Time for the largest tolerance that is within one percent.
double OurSeconds(const SkinnedBody& body, const std::vector<Shape>& poses, GeodesicOptions options,
                  double goal) {
  for (options.tolerance = 1e-2; options.tolerance > 1e-6; options.tolerance /= 10) {
    const auto solve = [&] { return Interpolate(body.connectivity, poses, options); };
    if (solve().summary.energy <= goal) return MedianSeconds(solve);
  }
  return std::numeric_limits<double>::infinity();
}

void Compare(benchmark::State& state, double bending) {
  const SkinnedBody& body = Quadruped(static_cast<int>(state.range(0)));
  const std::vector<Shape> poses = {body.pose("sit"), body.pose("stretch")};
  GeodesicOptions options;
  options.shapes = static_cast<int>(state.range(1));
  options.metric.bending = bending;
  options.tolerance = 1e-9;
  options.max_iterations = 10000;
  const GeodesicResult best = Interpolate(body.connectivity, poses, options);
  const double goal = kNear * best.summary.energy;
  const double ours = OurSeconds(body, poses, options, goal);

  const int segments = options.shapes + 1;
  std::vector<Shape> blend;
  for (int i = 0; i <= segments; ++i) {
    const double t = static_cast<double>(i) / segments;
    blend.push_back((1 - t) * best.path.shapes.front() + t * best.path.shapes.back());
  }
  double naive = 0, energy = 0;
  for (auto _ : state) {
    Watch watch(goal / ScaledEnergy(1, segments));
    MinimiseNaively(*best.path.metric, blend, &watch);
    naive = watch.Seconds();
    energy = ScaledEnergy(watch.Energy(), segments);
  }
  state.counters["vertices"] = body.connectivity->NumVertices();
  state.counters["naive_seconds"] = naive;
  state.counters["naive_above_percent"] = 100 * (energy / best.summary.energy - 1);
  state.counters["naive_arrived"] = energy <= goal;
  state.counters["our_seconds"] = ours;
  state.counters["times_faster"] = naive / ours;
}

void Membrane(benchmark::State& state) { Compare(state, 0); }
void Default(benchmark::State& state) { Compare(state, 1e-5); }

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"triangles", "shapes"})
      ->Args({1000, 15})
      ->Iterations(1)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}
BENCHMARK(Membrane)->Apply(Sizes);
BENCHMARK(Default)->Apply(Sizes);

}  // namespace
}  // namespace shapespace
