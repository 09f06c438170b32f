#ifndef SHAPESPACE_SPARSE_DETAIL_DENSE_H_
#define SHAPESPACE_SPARSE_DETAIL_DENSE_H_

// The dense kernels of BLAS and LAPACK that a sparse factorisation needs. Matrices are stored by
// columns; the first number of column j of `a` is a + j * lda.

namespace shapespace::internal {

/// Lower triangle of `a` (n x n) <- its Cholesky factor. \return whether it is finite
/// and positive definite.
bool FactorDense(int n, double* a, int lda);

/// b <- b l^{-T}: `l` (n x n) is lower triangular, `b` is m x n.
void SolveDenseTransposed(int m, int n, const double* l, int ldl, double* b, int ldb);

/// Lower triangle of `c` (n x n) <- c - a a^T: `a` is n x k.
void SubtractSquare(int n, int k, const double* a, int lda, double* c, int ldc);

/// c <- c - a b^T: `a` is m x k, `b` is n x k, `c` is m x n.
void SubtractProduct(int m, int n, int k, const double* a, int lda, const double* b, int ldb,
                     double* c, int ldc);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_DETAIL_DENSE_H_
