// Whole solves between two poses of the quadruped, which sits and stretches. Read `evaluations`:
// the solve's time over that of one energy and gradient at the final size, measured in the same
// run; it holds on any machine.

#include <chrono>

#include <benchmark/benchmark.h>

#include <shapespace/bodies/quadruped.h>
#include <shapespace/path/energy.h>
#include <shapespace/solvers/geodesic.h>

namespace shapespace {
namespace {

using Clock = std::chrono::steady_clock;

double Seconds(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void Solve(benchmark::State& state, double bending) {
  const SkinnedBody quadruped = MakeQuadruped(static_cast<int>(state.range(0)));
  const std::vector<Shape> poses = {quadruped.pose("sit"), quadruped.pose("stretch")};
  GeodesicOptions options;
  options.shapes = static_cast<int>(state.range(1));
  options.metric.bending = bending;
  GeodesicResult result;
  const auto begin = Clock::now();
  for (auto _ : state) {
    result = Interpolate(quadruped.connectivity, poses, options);
  }
  const double seconds = Seconds(begin) / static_cast<double>(state.iterations());

  PathEnergy energy(*result.path.metric, options.shapes);
  std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
  energy.Load(result.path.shapes, unknowns.data());
  constexpr int kRepeats = 10;
  energy.Evaluate(unknowns.data(), gradient.data());
  const auto evaluate = Clock::now();
  for (int i = 0; i < kRepeats; ++i) energy.Evaluate(unknowns.data(), gradient.data());
  state.counters["evaluations"] = seconds / (Seconds(evaluate) / kRepeats);
  state.counters["energy_over_bound"] = result.summary.Ratio();
}

void Default(benchmark::State& state) { Solve(state, 1e-5); }
void Membrane(benchmark::State& state) { Solve(state, 0); }

BENCHMARK(Default)
    ->ArgNames({"triangles", "shapes"})
    ->Args({4000, 5})
    ->Args({17000, 15})
    ->Args({17000, 31})
    ->Args({85000, 15})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Membrane)
    ->ArgNames({"triangles", "shapes"})
    ->Args({6000, 31})
    ->Args({26000, 127})
    ->Args({85000, 31})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace shapespace
