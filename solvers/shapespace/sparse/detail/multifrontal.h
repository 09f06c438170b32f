#ifndef SHAPESPACE_SPARSE_DETAIL_MULTIFRONTAL_H_
#define SHAPESPACE_SPARSE_DETAIL_MULTIFRONTAL_H_

#include <Eigen/SparseCore>

#include <shapespace/sparse/detail/elimination.h>

namespace shapespace::internal {

/// Computes the numbers of a sparse Cholesky factor into `values` (elimination.num_values of them)
/// by the multifrontal method (Duff and Reid 1983; Liu, "The Multifrontal Method for Sparse Matrix
/// Solution", SIAM Review 1992): a supernode's columns, and what they subtract from the columns
/// above, are a dense matrix, the front, to which its children in the elimination tree have added.
/// Branches of the tree are factored side by side, and large fronts of the trunk by tiles. Computed
/// in double precision and rounded to `Scalar`. The result is identical for any number of threads.
/// \return whether the matrix is positive definite. \throw std::bad_alloc.
template <typename Scalar>
bool FactorMultifrontal(const Elimination& elimination, const Eigen::SparseMatrix<double>& matrix,
                        Scalar* values);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_DETAIL_MULTIFRONTAL_H_
