// What one energy with its gradient costs, beside what the machine's memory can do. Times of one
// run compare with each other only: read ns_per_edge_segment against those of other rows, and
// share_of_triad, the bytes a sweep must move at least at the speed of a plain a[i] = b[i] + 3
// c[i].

#include <chrono>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include <shapespace/base/parallel.h>
#include <shapespace/bodies/body.h>
#include <shapespace/path/energy.h>
#include <shapespace/solvers/optimise/preconditioner.h>

namespace shapespace {
namespace {

struct Problem {
  Metric metric;
  std::vector<Shape> shapes;

  Problem(int triangles, int inner, double bending, Discretization discretization) {
    const Body body = MakeBody("quadruped", triangles);
    const std::vector<Shape> poses = {body.pose(body.begin), body.pose(body.end)};
    MetricOptions options;
    options.bending = bending;
    options.discretization = discretization;
    metric = FreezeMetric(options, body.connectivity, poses);
    for (int i = 0; i < inner + 2; ++i) {
      const double t = static_cast<double>(i) / (inner + 1);
      shapes.push_back(body.pose((1 - t) * body.begin + t * body.end) / metric.unit);
    }
  }
};

// Bytes a second of one thread, measured once.
double Triad() {
  static const double speed = [] {
    constexpr size_t kSize = 1 << 24;
    std::vector<double> a(kSize, 1), b(kSize, 2), c(kSize, 3);
    double best = 0;
    for (int round = 0; round < 5; ++round) {
      const auto begin = std::chrono::steady_clock::now();
      for (size_t i = 0; i < kSize; ++i) a[i] = b[i] + 3 * c[i];
      benchmark::DoNotOptimize(a.data());
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      best = std::max(best, 3 * sizeof(double) * kSize / time.count());
    }
    return best;
  }();
  return speed;
}

void Evaluate(benchmark::State& state, double bending, Discretization discretization) {
  const int inner = static_cast<int>(state.range(1));
  SetThreads(static_cast<int>(state.range(2)));
  const Problem problem(static_cast<int>(state.range(0)), inner, bending, discretization);
  PathEnergy energy(problem.metric, inner);
  std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
  energy.Load(problem.shapes, unknowns.data());
  const auto begin = std::chrono::steady_clock::now();
  for (auto _ : state) {
    benchmark::DoNotOptimize(energy.Evaluate(unknowns.data(), gradient.data()));
  }
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  const double seconds = time.count() / static_cast<double>(state.iterations());
  const double edge_segments =
      static_cast<double>(problem.metric.connectivity->NumEdges()) * (inner + 1);
  state.counters["ns_per_edge_segment"] = 1e9 * seconds / edge_segments;
  // The unknowns read once, the gradient written once.
  state.counters["share_of_triad"] = 2 * sizeof(double) * energy.Size() / seconds / Triad();
}

void Membrane(benchmark::State& state) { Evaluate(state, 0, Discretization::kMidpoint); }
void Paper(benchmark::State& state) { Evaluate(state, 0, Discretization::kTrapezoid); }
void Default(benchmark::State& state) { Evaluate(state, 1e-5, Discretization::kMidpoint); }

void Preconditioner(benchmark::State& state) {
  const int inner = static_cast<int>(state.range(1));
  SetThreads(static_cast<int>(state.range(2)));
  const Problem problem(static_cast<int>(state.range(0)), inner, 1e-5, Discretization::kMidpoint);
  const internal::Cholesky factor(
      internal::ScalarMetric(problem.metric, {problem.shapes.front(), problem.shapes.back()}, 0));
  PathEnergy energy(problem.metric, inner);
  internal::ChangeOfVariables variables(factor, energy);
  std::vector<double> gradient(energy.Size()), y(variables.Size());
  energy.Load(problem.shapes, gradient.data());
  for (auto _ : state) {
    variables.ApplyTranspose(gradient.data(), 1, y.data());
    variables.Apply(y.data(), gradient.data(), 0, gradient.data());
  }
  state.counters["factor_nonzeros"] = static_cast<double>(factor.NumNonzeros());
}

const std::vector<std::vector<int64_t>> kSizes = {{4000, 26000, 85000}, {15, 31, 127}, {1, 2}};

BENCHMARK(Membrane)
    ->ArgNames({"triangles", "shapes", "threads"})
    ->ArgsProduct(kSizes)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Paper)
    ->ArgNames({"triangles", "shapes", "threads"})
    ->Args({26000, 127, 1})
    ->Args({26000, 127, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Default)
    ->ArgNames({"triangles", "shapes", "threads"})
    ->ArgsProduct(kSizes)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Preconditioner)
    ->ArgNames({"triangles", "shapes", "threads"})
    ->Args({26000, 127, 2})
    ->Args({85000, 15, 2})
    ->Args({85000, 31, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace shapespace
