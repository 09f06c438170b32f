#include <shapespace/sparse/detail/dense.h>

#include <cmath>
#include <cstddef>

// The interface of Fortran, which every BLAS has.
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b,
            const int* ldb);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* beta, double* c, const int* ldc);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
}

namespace shapespace::internal {
namespace {

constexpr double kOne = 1, kMinusOne = -1;

}  // namespace

bool FactorDense(int n, double* a, int lda) {
  int info = 0;
  dpotrf_("L", &n, a, &lda, &info);
  // Some libraries do not see what is not a number. It is then in the diagonal too, or an infinity.
  bool finite = info == 0;
  for (int j = 0; finite && j < n; ++j) finite = std::isfinite(a[j + static_cast<size_t>(j) * lda]);
  return finite;
}

void SolveDenseTransposed(int m, int n, const double* l, int ldl, double* b, int ldb) {
  dtrsm_("R", "L", "T", "N", &m, &n, &kOne, l, &ldl, b, &ldb);
}

void SubtractSquare(int n, int k, const double* a, int lda, double* c, int ldc) {
  dsyrk_("L", "N", &n, &k, &kMinusOne, a, &lda, &kOne, c, &ldc);
}

void SubtractProduct(int m, int n, int k, const double* a, int lda, const double* b, int ldb,
                     double* c, int ldc) {
  dgemm_("N", "T", &m, &n, &k, &kMinusOne, a, &lda, b, &ldb, &kOne, c, &ldc);
}

}  // namespace shapespace::internal
