#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <Eigen/Core>

namespace shapespace {
namespace {

// x y = 6 and x - y = 1.
struct Residual {
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = x[0] * x[1] - 6.;
    residual[1] = x[0] - x[1] - 1.;
    return true;
  }
};

// Ceres and shapespace instantiate the same templates of Eigen, of which the linker keeps one: what
// one of them allocates the other may free, so both have to allocate in the same way. Otherwise
// this ends in a double free.
TEST(EigenBesideCeresTest, EigensSparseSolverRunsInCeres) {
  double x[] = {2.5, 1.};
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual, 2, 2>(new Residual), nullptr,
                           x);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  ASSERT_EQ(summary.termination_type, ceres::CONVERGENCE) << summary.message;
  EXPECT_NEAR(x[0], 3., 1e-6);
  EXPECT_NEAR(x[1], 2., 1e-6);
}

}  // namespace
}  // namespace shapespace
