// Complete solves. `evaluations` is the solve's time divided by that of one energy and gradient at
// the final size, measured in the same run, so it can be compared between machines. `peak_mb` is
// that of the process, and is meaningful only if it runs one case (--benchmark_filter), as `table`
// does. 0 threads means all cores.

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <shapespace/base/parallel.h>
#include <shapespace/files/read.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/path/energy.h>

#include "measure.h"
#include "quadruped.h"

namespace shapespace {
namespace {

double EvaluationSeconds(const Path& path) {
  PathEnergy energy(path.metric, path.NumShapes() - 2);
  std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
  energy.Load(path.shapes, unknowns.data());
  return MedianSeconds([&] { energy.Evaluate(unknowns.data(), gradient.data()); });
}

void Solve(benchmark::State& state, const std::shared_ptr<const Connectivity>& connectivity,
           const std::vector<Shape>& poses, const GeodesicOptions& options) {
  GeodesicResult result;
  double seconds = 0;
  ResetPeakMemory();
  for (auto _ : state) {
    const internal::Stopwatch stopwatch;
    result = Interpolate(connectivity, poses, options);
    seconds += stopwatch.Seconds() / state.max_iterations;
  }
  const GeodesicSummary& summary = result.summary;
  state.counters["seconds"] = seconds;
  state.counters["peak_mb"] = PeakMegabytes();
  state.counters["estimated_mb"] = summary.estimated_bytes / 1e6;
  state.counters["evaluations"] = seconds / EvaluationSeconds(result.path);
  state.counters["triangles"] = summary.triangles;
  state.counters["energy"] = summary.energy;
  state.counters["energy_over_bound"] = summary.Ratio();
  state.counters["edge_rms_percent"] = 100 * summary.quality.edge_rms;
  state.counters["roughness_degrees"] = summary.quality.roughness;
  state.counters["folds"] = summary.quality.folds;
  state.counters["converged"] = summary.termination == Termination::kConverged;
}

void SolveQuadruped(benchmark::State& state, const std::string& from, const std::string& to,
                    const GeodesicOptions& options) {
  const SkinnedBody& quadruped = Quadruped(static_cast<int>(state.range(0)));
  Solve(state, quadruped.connectivity, {quadruped.pose(from), quadruped.pose(to)}, options);
}

// Arguments: triangles, shapes, threads.
void Default(benchmark::State& state) {
  GeodesicOptions options;
  options.shapes = static_cast<int>(state.range(1));
  SetThreads(static_cast<int>(state.range(2)));
  SolveQuadruped(state, "sit", "stretch", options);
}

// Arguments: triangles, shapes, threads, decimal digits of the tolerance.
void Membrane(benchmark::State& state) {
  GeodesicOptions options;
  options.metric.bending = 0;
  options.shapes = static_cast<int>(state.range(1));
  SetThreads(static_cast<int>(state.range(2)));
  options.tolerance = std::pow(10, -static_cast<double>(state.range(3)));
  SolveQuadruped(state, "sit", "stretch", options);
}

// Arguments: triangles, shapes.
void ScheduleOf(benchmark::State& state, const std::string& from, const std::string& to,
                double bending, GeodesicSchedule schedule) {
  GeodesicOptions options;
  options.metric.bending = bending;
  options.shapes = static_cast<int>(state.range(1));
  options.schedule = schedule;
  SolveQuadruped(state, from, to, options);
}

// Arguments: shapes.
void Files(benchmark::State& state, const std::string& from, const std::string& to) {
  const std::filesystem::path folder = SHAPESPACE_DATA_DIR;
  if (!std::filesystem::exists(folder / from)) {
    state.SkipWithError("no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR");
    return;
  }
  const Poses poses = ReadPoses({(folder / from).string(), (folder / to).string()});
  GeodesicOptions options;
  options.shapes = static_cast<int>(state.range(0));
  Solve(state, poses.connectivity, poses.shapes, options);
}

void Milliseconds(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseRealTime()->Unit(benchmark::kMillisecond);
}

void DefaultSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"triangles", "shapes", "threads"})->Apply(Milliseconds);
  for (const int shapes : {3, 5, 7, 15, 31, 63, 127, 255}) benchmark->Args({4000, shapes, 0});
  for (const int triangles : {1000, 16000, 64000, 200000}) benchmark->Args({triangles, 15, 0});
  benchmark->Args({17000, 15, 0})
      ->Args({17000, 31, 0})
      ->Args({17000, 31, 1})
      ->Args({85000, 15, 0})
      ->Args({85000, 31, 0})
      ->Args({200000, 31, 0});
}
BENCHMARK(Default)->Apply(DefaultSizes);

// The last tolerance of a size gives the reference energy for the others.
BENCHMARK(Membrane)
    ->ArgNames({"triangles", "shapes", "threads", "digits"})
    ->ArgsProduct({{6000}, {31}, {0}, {4, 5, 7}})
    ->ArgsProduct({{26000}, {127}, {0}, {4, 5, 7}})
    ->ArgsProduct({{85000}, {31}, {0}, {4, 5, 7}})

    ->Apply(Milliseconds);

// Named Schedule/<pair of poses>/<schedule>.
const bool kSchedulesRegistered = [] {
  const std::pair<const char*, GeodesicSchedule> schedules[] = {
      {"automatic", GeodesicSchedule::kAutomatic},
      {"paper", GeodesicSchedule::kPaper},
      {"flat", GeodesicSchedule::kFlat}};
  const double bending = MetricOptions().bending;
  const struct {
    std::string name, from, to;
    double bending;
  } pairs[] = {{"stand-stride", "stand", "stride", bending},
               {"stand-rear", "stand", "rear", bending},
               {"sit-stretch", "sit", "stretch", bending},
               {"rear-sit", "rear", "sit", bending},
               {"sit-stretch-membrane", "sit", "stretch", 0}};
  for (const auto& pair : pairs) {
    for (const auto& [name, schedule] : schedules) {
      const auto solve = [pair, schedule = schedule](benchmark::State& state) {
        ScheduleOf(state, pair.from, pair.to, pair.bending, schedule);
      };
      benchmark::RegisterBenchmark(("Schedule/" + pair.name + "/" + name).c_str(), solve)
          ->ArgNames({"triangles", "shapes"})
          ->Args({16000, 15})
          ->Apply(Milliseconds);
    }
  }
  return true;
}();

BENCHMARK_CAPTURE(Files, finger, "finger/0.obj", "finger/1.obj")
    ->ArgName("shapes")
    ->Arg(5)
    ->Arg(15)
    ->Apply(Milliseconds);
BENCHMARK_CAPTURE(Files, horse, "horse/reference.obj", "horse/01.obj")
    ->ArgName("shapes")
    ->Arg(15)
    ->Arg(31)
    ->Apply(Milliseconds);
BENCHMARK_CAPTURE(Files, elephant, "elephant/reference.obj", "elephant/01.obj")
    ->ArgName("shapes")
    ->Arg(15)
    ->Arg(31)
    ->Apply(Milliseconds);

}  // namespace
}  // namespace shapespace
