#ifndef SHAPESPACE_SPARSE_INTERNAL_SOLVE_H_
#define SHAPESPACE_SPARSE_INTERNAL_SOLVE_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/sparse/internal/padded_width.h>

namespace shapespace::internal {

/// Solves the factored system for each column of `right`.
inline Eigen::MatrixXd Solve(const Cholesky& factor, const Eigen::MatrixXd& right) {
  const auto columns = static_cast<int>(right.cols());
  const int width = PaddedWidth<double>(columns);
  const std::vector<int>& permutation = factor.Permutation();
  std::vector<double> rows(static_cast<size_t>(width) * factor.WorkRows(), 0.0);
  for (int i = 0; i < factor.Size(); ++i) {
    for (int k = 0; k < columns; ++k) {
      rows[static_cast<size_t>(width) * i + k] = right(permutation[i], k);
    }
  }
  factor.SolveLower(rows.data(), width);
  factor.SolveUpper(rows.data(), width);
  Eigen::MatrixXd solution(right.rows(), columns);
  for (int i = 0; i < factor.Size(); ++i) {
    for (int k = 0; k < columns; ++k) {
      solution(permutation[i], k) = rows[static_cast<size_t>(width) * i + k];
    }
  }
  return solution;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_INTERNAL_SOLVE_H_
