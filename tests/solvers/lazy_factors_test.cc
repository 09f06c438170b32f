#include <shapespace/geodesic/detail/lazy_factors.h>

#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/parallel.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/minimise/internal/preconditioner.h>

#include "support/threads.h"

namespace shapespace::internal {
namespace {

Eigen::SparseMatrix<double> MatrixOfABar() {
  const ShapeFamily bar = MakeBar(6, 1, 1, 24, 4, 4);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(40)};
  return ScalarMetric(*FreezeMetric({}, bar.connectivity, poses), poses, 0);
}

// C^-1 of a vector, which shows every digit of the factor.
template <typename Scalar>
std::vector<Scalar> Solved(const CholeskyFactor<Scalar>& factor) {
  std::vector<Scalar> x(factor.WorkRows());
  for (int i = 0; i < factor.Size(); ++i) x[i] = static_cast<Scalar>(1 + i % 7);
  factor.SolveLower(x.data());
  x.resize(factor.Size());
  return x;
}

TEST(LazyFactors, DoNotDependOnTheOrderInWhichTheyAreAskedFor) {
  const Eigen::SparseMatrix<double> matrix = MatrixOfABar();
  LazyFactors double_first([&] { return matrix; }), single_first([&] { return matrix; });
  EXPECT_EQ(double_first.NumNonzeros(), 0u);
  const std::vector<double> x = Solved(double_first.Get<double>());
  const std::vector<float> y = Solved(single_first.Get<float>());
  EXPECT_EQ(x, Solved(single_first.Get<double>()));
  EXPECT_EQ(y, Solved(double_first.Get<float>()));
  EXPECT_EQ(x, Solved(Cholesky(matrix)));
  EXPECT_EQ(double_first.NumNonzeros(), Cholesky(matrix).NumNonzeros());
}

TEST(LazyFactors, HaveAsManyNumbersInEitherPrecision) {
  LazyFactors factors(MatrixOfABar);
  factors.Get<float>();
  EXPECT_EQ(factors.NumNonzeros(), Cholesky(MatrixOfABar()).NumNonzeros());
}

TEST(LazyFactors, AreComputedOnceForAllThreads) {
  const Eigen::SparseMatrix<double> matrix = MatrixOfABar();
  for (const int times : testing::OnThreads([&] {
         int times = 0;
         LazyFactors factors([&] {
           ++times;
           return matrix;
         });
         std::vector<const void*> single(8), both(8);
         ParallelTasks(8, 8, [&](int i) {
           both[i] = &factors.Get<double>();
           single[i] = &factors.Get<float>();
         });
         EXPECT_EQ(single, std::vector<const void*>(8, single[0]));
         EXPECT_EQ(both, std::vector<const void*>(8, both[0]));
         return times;
       })) {
    EXPECT_EQ(times, 1);
  }
}

}  // namespace
}  // namespace shapespace::internal
