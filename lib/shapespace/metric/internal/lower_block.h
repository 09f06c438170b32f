#ifndef SHAPESPACE_METRIC_INTERNAL_LOWER_BLOCK_H_
#define SHAPESPACE_METRIC_INTERNAL_LOWER_BLOCK_H_

#include <algorithm>

#include <Eigen/SparseCore>

namespace shapespace::internal {

/// Calls add(a, b, entry) for the entries (a, b) of the 3 x 3 block of vertices p >= q in a
/// symmetric matrix of which the lower triangle is stored.
template <typename Add>
void ForLowerBlock(int p, int q, Eigen::SparseMatrix<double>* matrix, const Add& add) {
  const int* const rows = matrix->innerIndexPtr();
  const int* const begins = matrix->outerIndexPtr();
  for (int b = 0; b < 3; ++b) {
    const int column = 3 * q + b;
    const int first = p == q ? column : 3 * p;
    double* entry =
        matrix->valuePtr() +
        (std::lower_bound(rows + begins[column], rows + begins[column + 1], first) - rows);
    for (int a = first - 3 * p; a < 3; ++a, ++entry) add(a, b, entry);
  }
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_METRIC_INTERNAL_LOWER_BLOCK_H_
