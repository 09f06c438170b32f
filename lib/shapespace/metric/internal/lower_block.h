#ifndef SHAPESPACE_METRIC_INTERNAL_LOWER_BLOCK_H_
#define SHAPESPACE_METRIC_INTERNAL_LOWER_BLOCK_H_

#include <algorithm>

#include <Eigen/SparseCore>

namespace shapespace::internal {

/// Calls add(a, b, entry) for the entries (a, b) of the 3 x 3 block of vertices p >= q in a
/// symmetric matrix that consists of such blocks and of which the lower triangle is stored.
template <typename Add>
void ForLowerBlock(int p, int q, Eigen::SparseMatrix<double>* matrix, const Add& add) {
  const int* const rows = matrix->innerIndexPtr();
  const int* const begins = matrix->outerIndexPtr() + 3 * q;
  // The block's place in the first column; the next two columns begin one and two rows later.
  const int place =
      p == q ? 0
             : static_cast<int>(std::lower_bound(rows + begins[0], rows + begins[1], 3 * p) -
                                (rows + begins[0]));
  for (int b = 0; b < 3; ++b) {
    double* entry = matrix->valuePtr() + begins[b] + (p == q ? 0 : place - b);
    for (int a = p == q ? b : 0; a < 3; ++a, ++entry) add(a, b, entry);
  }
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_METRIC_INTERNAL_LOWER_BLOCK_H_
