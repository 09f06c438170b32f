// The cost of continuing a path: seconds per step of the variational integrator, the share of the
// factorisation, and the number of iterations of the linear solver.

#include <memory>

#include <benchmark/benchmark.h>

#include <shapespace/bodies/tube.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/path/align.h>

#include "measure.h"
#include "quadruped.h"

namespace shapespace {
namespace {

constexpr int kSteps = 4;

void Measure(const Path& path, benchmark::State* state) {
  ResetPeakMemory();
  ExponentialSummary summary;
  for (auto _ : *state) summary = Extrapolate(path, kSteps).summary;
  double newton = 0, krylov = 0, on_mesh = 0;
  for (const ExponentialSummary::Step& step : summary.steps) {
    newton += step.iterations;
    krylov += step.krylov_iterations;
    on_mesh += step.vertices == summary.vertices;
  }
  const double steps = static_cast<double>(summary.steps.size());
  state->counters["seconds_per_step"] = summary.total_seconds / steps;
  state->counters["factor_share"] = summary.factor_seconds / summary.total_seconds;
  state->counters["newton_per_step"] = newton / steps;
  state->counters["krylov_per_newton"] = newton > 0 ? krylov / newton : 0;
  state->counters["on_mesh"] = on_mesh / steps;
  state->counters["peak_mb"] = PeakMegabytes();
}

// A finger that continues to bend from 30 degrees, 4 degrees per step: all steps are solved on the
// mesh itself.
void Finger(benchmark::State& state) {
  const ShapeFamily tube = MakeTube(static_cast<int>(state.range(0)));
  const std::vector<Shape> poses = {tube.pose(26), tube.pose(30)};
  Path path;
  path.metric = FreezeMetric({}, tube.connectivity, poses);
  AlignedPoses aligned = AlignPoses(*path.metric, poses);
  path.shapes = std::move(aligned.shapes);
  path.motions = std::move(aligned.motions);
  path.parameters = {0, 1};
  path.poses = {0, 1};
  Measure(path, &state);
}

// An animal between two poses and beyond: some steps are solved on coarser meshes.
void Animal(benchmark::State& state) {
  const SkinnedBody& body = Quadruped(static_cast<int>(state.range(0)));
  GeodesicOptions options;
  options.tolerance = 1e-6;
  Measure(Interpolate(body.connectivity, {body.pose("stand"), body.pose("rear")}, options).path,
          &state);
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("triangles")->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);
  for (const int triangles : {2000, 15000, 85000}) benchmark->Arg(triangles);
}
BENCHMARK(Finger)->Apply(Sizes);
BENCHMARK(Animal)->Apply(Sizes);

}  // namespace
}  // namespace shapespace
