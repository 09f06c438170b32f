// The cost of a hierarchy: decimating two poses simultaneously, and lifting one shape from the
// level below to the mesh itself. Items are triangles: items_per_second would be constant for
// linear complexity.

#include <vector>

#include <benchmark/benchmark.h>

#include <shapespace/hierarchy/hierarchy.h>

#include "quadruped.h"

namespace shapespace {
namespace {

struct Problem {
  const SkinnedBody& body;
  std::vector<Shape> poses;

  explicit Problem(const benchmark::State& state)
      : body(Quadruped(static_cast<int>(state.range(0)))),
        poses{body.pose("sit"), body.pose("stretch")} {}
};

void CountTriangles(const Problem& problem, benchmark::State* state) {
  const int triangles = problem.body.connectivity->NumTriangles();
  state->counters["triangles"] = triangles;
  state->SetItemsProcessed(triangles * state->iterations());
}

void Decimate(benchmark::State& state) {
  const Problem problem(state);
  int levels = 0;
  for (auto _ : state) {
    levels = Hierarchy(problem.body.connectivity, problem.poses).NumLevels();
  }
  CountTriangles(problem, &state);
  state.counters["levels"] = levels;
}

void Lift(benchmark::State& state) {
  const Problem problem(state);
  const Hierarchy hierarchy(problem.body.connectivity, problem.poses);
  const int level = hierarchy.NumLevels() - 2;
  const Shape half = 0.5 * (problem.poses[0] + problem.poses[1]);
  const Shape coarse = hierarchy.Restrict(half, level);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        hierarchy.Lift(coarse, level, problem.poses[0], problem.poses[1], 0.5));
  }
  CountTriangles(problem, &state);
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("triangles")->UseRealTime()->Unit(benchmark::kMillisecond);
  for (const int triangles : {1000, 4000, 16000, 64000, 200000}) benchmark->Arg(triangles);
}
BENCHMARK(Decimate)->Apply(Sizes);
BENCHMARK(Lift)->Apply(Sizes);

}  // namespace
}  // namespace shapespace
