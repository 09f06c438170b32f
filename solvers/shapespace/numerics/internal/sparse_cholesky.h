#ifndef SHAPESPACE_NUMERICS_INTERNAL_SPARSE_CHOLESKY_H_
#define SHAPESPACE_NUMERICS_INTERNAL_SPARSE_CHOLESKY_H_

#include <ceres/solver.h>

namespace shapespace::internal {

/// Has Ceres factor its normal equations as sparse matrices: by what Ceres prefers, which is
/// CHOLMOD where it was built with it, or by Eigen if this library is built without SuiteSparse.
inline void UseSparseCholesky(ceres::Solver::Options* options) {
  options->linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
#ifdef SHAPESPACE_WITHOUT_SUITESPARSE
  options->sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
#endif
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_NUMERICS_INTERNAL_SPARSE_CHOLESKY_H_
