// The cost of one energy with its gradient, relative to the memory bandwidth of the machine, and
// the cost of its preconditioner. Only times of the same run can be compared: compare
// ns_per_edge_segment with that of other rows and with limit_ns, the time to move only the
// necessary bytes at the speed of a simple a[i] = b[i] + 3 c[i] on the same number of threads.
// Small problems that fit into the caches may be below it.

#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>

#include <shapespace/base/parallel.h>
#include <shapespace/minimise/internal/preconditioner.h>
#include <shapespace/path/energy.h>

#include "measure.h"
#include "quadruped.h"

namespace shapespace {
namespace {

constexpr double kDefaultBending = 1e-5;

struct Problem {
  std::shared_ptr<const Metric> metric;
  std::vector<Shape> shapes;

  Problem(int triangles, int inner, double bending, Discretization discretization) {
    const SkinnedBody& body = Quadruped(triangles);
    const std::vector<Shape> poses = {body.pose("sit"), body.pose("stretch")};
    MetricOptions options;
    options.bending = bending;
    options.discretization = discretization;
    metric = FreezeMetric(options, body.connectivity, poses);
    for (int i = 0; i < inner + 2; ++i) {
      const double t = static_cast<double>(i) / (inner + 1);
      shapes.push_back(body.between("sit", "stretch", t) / metric->unit);
    }
  }

  double EdgeSegments() const {
    return static_cast<double>(metric->connectivity->NumEdges()) *
           static_cast<double>(shapes.size() - 1);
  }
  Eigen::SparseMatrix<double> Scalar() const {
    return internal::ScalarMetric(*metric, {shapes.front(), shapes.back()}, 0);
  }
};

// Bytes per second, counted as in the STREAM benchmark: two arrays read, one written.
double Triad() {
  constexpr int kChunks = 64, kChunk = 1 << 18;
  std::vector<double> a(kChunks * kChunk, 1), b(a.size(), 2), c(a.size(), 3);
  const double seconds = MedianSeconds([&] {
    ParallelFor(kChunks, [&](int chunk) {
      const size_t begin = static_cast<size_t>(chunk) * kChunk;
      for (size_t i = begin; i < begin + kChunk; ++i) a[i] = b[i] + 3 * c[i];
    });
    benchmark::DoNotOptimize(a.data());
    benchmark::ClobberMemory();
  });
  return 3 * sizeof(double) * static_cast<double>(a.size()) / seconds;
}

void Evaluate(benchmark::State& state, double bending, Discretization discretization) {
  const int inner = static_cast<int>(state.range(1));
  SetThreads(static_cast<int>(state.range(2)));
  const Problem problem(static_cast<int>(state.range(0)), inner, bending, discretization);
  PathEnergy energy(problem.metric, inner);
  std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
  energy.Load(problem.shapes, unknowns.data());
  double seconds = 0;
  for (auto _ : state) {
    const internal::Stopwatch stopwatch;
    benchmark::DoNotOptimize(energy.Evaluate(unknowns.data(), gradient.data()));
    seconds += stopwatch.Seconds() / static_cast<double>(state.max_iterations);
  }
  const double triad = Triad();
  // Reading the unknowns once, writing the gradient once.
  const double least = 2 * sizeof(double) * static_cast<double>(energy.Size()) / triad;
  state.counters["ns_per_edge_segment"] = 1e9 * seconds / problem.EdgeSegments();
  state.counters["limit_ns"] = 1e9 * least / problem.EdgeSegments();
  state.counters["share_of_triad"] = least / seconds;
  state.counters["triad_gb_per_s"] = 1e-9 * triad;
}

void Membrane(benchmark::State& state) { Evaluate(state, 0, Discretization::kMidpoint); }
void Paper(benchmark::State& state) { Evaluate(state, 0, Discretization::kTrapezoid); }
void Default(benchmark::State& state) {
  Evaluate(state, kDefaultBending, Discretization::kMidpoint);
}

// Once per mesh, for any number of shapes.
void Factorise(benchmark::State& state, double bending) {
  const Problem problem(static_cast<int>(state.range(0)), 1, bending, Discretization::kMidpoint);
  size_t nonzeros = 0;
  for (auto _ : state) {
    nonzeros = internal::Cholesky(problem.Scalar()).NumNonzeros();
  }
  state.counters["factor_nonzeros"] = static_cast<double>(nonzeros);
}

void FactoriseMembrane(benchmark::State& state) { Factorise(state, 0); }
void FactoriseDefault(benchmark::State& state) { Factorise(state, kDefaultBending); }

// The preconditioner's cost per iteration, relative to one evaluation of the energy.
template <typename Apply>
void CompareWithEnergy(const Apply& apply, PathEnergy* energy, std::vector<double>* unknowns,
                       benchmark::State* state) {
  std::vector<double> gradient(energy->Size());
  const double evaluation =
      MedianSeconds([&] { energy->Evaluate(unknowns->data(), gradient.data()); });
  double seconds = 0;
  for (auto _ : *state) {
    const internal::Stopwatch stopwatch;
    apply(gradient.data());
    seconds += stopwatch.Seconds() / static_cast<double>(state->max_iterations);
  }
  state->counters["evaluations"] = seconds / evaluation;
}

// As used by Ceres: both directions, in double precision.
void ChangeVariables(benchmark::State& state) {
  const int inner = static_cast<int>(state.range(1));
  SetThreads(static_cast<int>(state.range(2)));
  const Problem problem(static_cast<int>(state.range(0)), inner, kDefaultBending,
                        Discretization::kMidpoint);
  const internal::Cholesky factor(problem.Scalar());
  PathEnergy energy(problem.metric, inner);
  internal::ChangeOfVariables variables(factor, energy);
  std::vector<double> unknowns(energy.Size()), step(energy.Size()), y(variables.Size());
  energy.Load(problem.shapes, unknowns.data());
  const auto apply = [&](const double* gradient) {
    variables.ApplyTranspose(gradient, 1, y.data());
    variables.Apply(y.data(), unknowns.data(), 1, step.data());
  };
  CompareWithEnergy(apply, &energy, &unknowns, &state);
}

// As used by this library's L-BFGS: from a gradient to a step, in single precision.
void Precondition(benchmark::State& state) {
  const int inner = static_cast<int>(state.range(1));
  SetThreads(static_cast<int>(state.range(2)));
  const Problem problem(static_cast<int>(state.range(0)), inner, kDefaultBending,
                        Discretization::kMidpoint);
  const internal::CholeskyFactor<float> factor(problem.Scalar());
  PathEnergy energy(problem.metric, inner);
  internal::Preconditioner preconditioner(factor, energy);
  std::vector<double> unknowns(energy.Size()), step(energy.Size());
  energy.Load(problem.shapes, unknowns.data());
  const auto apply = [&](const double* gradient) {
    preconditioner.Apply(gradient, 1, step.data());
  };
  CompareWithEnergy(apply, &energy, &unknowns, &state);
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"triangles", "shapes", "threads"})
      ->ArgsProduct({{4000, 26000, 85000}, {15, 31, 127}, {1, 2}})
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}
void FewSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"triangles", "shapes", "threads"})
      ->ArgsProduct({{26000}, {127}, {1, 2}})
      ->ArgsProduct({{85000}, {31}, {1, 2}})
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}
void Meshes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("triangles")->UseRealTime()->Unit(benchmark::kMillisecond);
  for (const int triangles : {1000, 4000, 16000, 64000, 200000}) benchmark->Arg(triangles);
}

BENCHMARK(Membrane)->Apply(Sizes);
BENCHMARK(Default)->Apply(Sizes);
BENCHMARK(Paper)->Apply(FewSizes);
BENCHMARK(FactoriseMembrane)->Apply(Meshes);
BENCHMARK(FactoriseDefault)->Apply(Meshes);
BENCHMARK(ChangeVariables)->Apply(FewSizes);
BENCHMARK(Precondition)->Apply(FewSizes);

}  // namespace
}  // namespace shapespace
