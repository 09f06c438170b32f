#include <shapespace/sparse/internal/one_thread.h>

#include <dlfcn.h>

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/paths.h"

namespace shapespace::internal {
namespace {

const auto threads = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
const auto set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));

// Shapes and tangents from every solver that factorises matrices.
std::vector<Shape> SolveWithEverything() {
  const ShapeFamily bar = MakeBar(6, 1, 1, 24, 6, 6);
  const std::vector<Shape> poses = {bar.pose(bar.begin), bar.pose(40)};
  GeodesicOptions options;
  options.shapes = 3;
  options.coarsest = 1000;
  options.tolerance = 1e-3;
  const Path path = Interpolate(bar.connectivity, poses, options).path;
  options.solver = GeodesicSolver::kTrustRegion;
  std::vector<Shape> results = Interpolate(bar.connectivity, poses, options).path.shapes;
  results.insert(results.end(), path.shapes.begin(), path.shapes.end());
  for (StepSolver solver : {StepSolver::kNewtonKrylov, StepSolver::kCeres}) {
    ExponentialOptions going_on;
    going_on.solver = solver;
    results.push_back(Extrapolate(path, 1, going_on).path.shapes.back());
  }
  const Tangent tangent = testing::Noise(bar.connectivity->NumVertices(), 0.01, 1);
  results.push_back(Transport(path, {tangent}).tangents.front());
  return results;
}

TEST(OneThread, ResultsHaveTheSameBitsForAnyThreadsOfBlas) {
  if (threads == nullptr || set == nullptr) GTEST_SKIP() << "this program has another BLAS";
  const int original = threads();
  set(1);
  const std::vector<Shape> one = SolveWithEverything();
  set(2);
  EXPECT_EQ(SolveWithEverything(), one);
  set(original);
}

TEST(OneThread, GivesBlasItsThreadsBackWhenTheLastOneGoes) {
  if (threads == nullptr || set == nullptr) GTEST_SKIP() << "this program has another BLAS";
  const int original = threads();
  set(2);
  const int before = threads();  // 1 on a machine with one core
  {
    std::optional<OneThread> first;
    first.emplace();
    const OneThread second;
    EXPECT_EQ(threads(), 1);
    first.reset();
    EXPECT_EQ(threads(), 1);
  }
  EXPECT_EQ(threads(), before);
  set(original);
}

}  // namespace
}  // namespace shapespace::internal
