// The cost of a step along a curve through a space of poses, relative to the time for its memory
// access.

#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include <shapespace/bodies/tube.h>
#include <shapespace/exploration/space.h>

namespace shapespace {
namespace {

// A triangle between three bends of a tube, without solving.
PoseSpace SpaceOfTubes(int triangles) {
  const ShapeFamily tube = MakeTube(triangles);
  const std::vector<Shape> poses = {tube.pose(0), tube.pose(40), tube.pose(80)};
  PoseSpace space;
  space.metric = FreezeMetric({}, tube.connectivity, poses);
  for (const Shape& pose : poses) space.nodes.emplace_back(pose / space.metric->unit);
  space.points.resize(2, 3);
  space.points << 0, 1, 0, 0, 0, 1;
  space.triangles.resize(3, 1);
  space.triangles << 0, 1, 2;
  return space;
}

void At(benchmark::State& state) {
  const PoseSpace space = SpaceOfTubes(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(space.At({0.3, 0.3}));
}

void CopyOfAShape(benchmark::State& state) {
  const PoseSpace space = SpaceOfTubes(static_cast<int>(state.range(0)));
  Shape shape = space.nodes[0];
  for (auto _ : state) {
    shape = space.nodes[1];
    benchmark::DoNotOptimize(shape);
  }
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("triangles")->Unit(benchmark::kMillisecond)->Arg(10000)->Arg(100000);
}
BENCHMARK(At)->Apply(Sizes);
BENCHMARK(CopyOfAShape)->Apply(Sizes);

}  // namespace
}  // namespace shapespace
