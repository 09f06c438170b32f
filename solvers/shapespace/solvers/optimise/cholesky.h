#ifndef SHAPESPACE_SOLVERS_OPTIMISE_CHOLESKY_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_CHOLESKY_H_

#include <vector>

#include <Eigen/SparseCore>

namespace shapespace::internal {

/// Columns begin .. begin + width of a factor that share one pattern: a dense trapezoid, column
/// after column, `height` apart, whose first `width` rows are the columns themselves.
struct Supernode {
  int begin, width, height;
  size_t rows;    // of its first row's index
  size_t values;  // of its first number
};

/// Sparse Cholesky factor C C^T = Q S Q^T (Q a fill-reducing permutation), computed by CHOLMOD and
/// applied by kernels of ours, to many right-hand sides at once that lie side by side in memory.
class Cholesky {
 public:
  /// `matrix` is symmetric positive definite; only its lower triangle is read.
  /// \throw SolverError if it is not positive definite.
  explicit Cholesky(const Eigen::SparseMatrix<double>& matrix);

  int Size() const { return static_cast<int>(permutation_.size()); }
  /// Row i of the factor belongs to unknown Permutation()[i] of the matrix.
  const std::vector<int>& Permutation() const { return permutation_; }
  /// Numbers stored, those of dense blocks included.
  size_t NumNonzeros() const { return values_.size(); }

  /// x <- C^{-1} x and x <- C^{-T} x; `x` is Size() x `width`, row by row, rows `width` apart, a
  /// multiple of `kColumns`. Uses all threads; every column's result is independent of the others.
  void SolveLower(double* x, int width) const;
  void SolveUpper(double* x, int width) const;
  static constexpr int kColumns = 4;

 private:
  template <typename SolveNodes>
  void ForChunks(int width, const SolveNodes& solve) const;

  std::vector<int> permutation_;
  std::vector<Supernode> supernodes_;
  std::vector<int> rows_;
  std::vector<double> values_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_CHOLESKY_H_
