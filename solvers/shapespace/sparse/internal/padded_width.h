#ifndef SHAPESPACE_SPARSE_INTERNAL_PADDED_WIDTH_H_
#define SHAPESPACE_SPARSE_INTERNAL_PADDED_WIDTH_H_

#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// Numbers per row of `count` columns, padded for the factor's kernels.
template <typename Scalar>
int PaddedWidth(int count) {
  constexpr int kColumns = CholeskyFactor<Scalar>::kColumns;
  return (count + kColumns - 1) / kColumns * kColumns;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_INTERNAL_PADDED_WIDTH_H_
