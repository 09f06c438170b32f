#ifndef SHAPESPACE_NUMERICS_INTERNAL_ROWS_H_
#define SHAPESPACE_NUMERICS_INTERNAL_ROWS_H_

#include <algorithm>

#include <shapespace/base/parallel.h>
#include <shapespace/numerics/internal/cholesky.h>

namespace shapespace::internal {

/// Rows per task of a thread.
inline constexpr int kRowsPerTask = 512;

/// Calls body(i) for every i in [0, num_rows), on all threads.
template <typename Body>
void ForRows(int num_rows, const Body& body) {
  ParallelFor((num_rows + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    const int end = std::min(num_rows, (task + 1) * kRowsPerTask);
    for (int i = task * kRowsPerTask; i < end; ++i) body(i);
  });
}

/// Numbers per row of `count` columns, padded for the factor's kernels.
template <typename Scalar>
int PaddedWidth(int count) {
  constexpr int kColumns = CholeskyFactor<Scalar>::kColumns;
  return (count + kColumns - 1) / kColumns * kColumns;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_NUMERICS_INTERNAL_ROWS_H_
