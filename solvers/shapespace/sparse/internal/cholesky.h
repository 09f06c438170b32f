#ifndef SHAPESPACE_SPARSE_INTERNAL_CHOLESKY_H_
#define SHAPESPACE_SPARSE_INTERNAL_CHOLESKY_H_

#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include <shapespace/sparse/detail/elimination.h>

namespace shapespace::internal {

/// Sparse Cholesky factor C C^T = Q S Q^T (Q a fill-reducing permutation), applied by this
/// library's kernels to many right-hand sides at once, which are adjacent in memory. Computed in
/// double precision, stored and applied in `Scalar`: double or float.
template <typename Scalar>
class CholeskyFactor {
 public:
  /// `matrix` is symmetric positive definite and in compressed form; only its lower triangle is
  /// read. `group` as in Elimination.
  /// \throw SolverError, saying which, if it is not positive definite, or memory runs out.
  explicit CholeskyFactor(const Eigen::SparseMatrix<double>& matrix, int group = 1);

  /// The same factor, rounded.
  template <typename Other>
  explicit CholeskyFactor(const CholeskyFactor<Other>& other)
      : elimination_(other.elimination_), values_(new Scalar[other.NumNonzeros()]) {
    std::copy_n(other.values_.get(), other.NumNonzeros(), values_.get());
  }

  /// Factors another matrix of the same pattern as that of `like`, with its elimination order.
  template <typename Other>
  CholeskyFactor(const CholeskyFactor<Other>& like, const Eigen::SparseMatrix<double>& matrix)
      : elimination_(like.elimination_) {
    Update(matrix);
  }

  CholeskyFactor(const CholeskyFactor&) = delete;
  CholeskyFactor(CholeskyFactor&&) noexcept = default;

  /// Factors another matrix of the same pattern, with the same elimination order and the same
  /// memory.
  /// \throw SolverError if it is not positive definite, or memory runs out; then the object must
  ///        not be used until the next update.
  void Update(const Eigen::SparseMatrix<double>& matrix);

  int Size() const { return elimination_->Size(); }
  /// Row i of the factor belongs to unknown Permutation()[i] of the matrix.
  const std::vector<int>& Permutation() const { return elimination_->permutation; }
  /// Stored numbers, including those of dense blocks.
  size_t NumNonzeros() const { return elimination_->num_values; }

  /// x <- C^{-1} x and x <- C^{-T} x. `x` is WorkRows() x `width`, stored by rows; `width` is a
  /// multiple of `kColumns`; rows from Size() on are scratch memory. Uses all threads: branches of
  /// the elimination tree are independent, and so are chunks of columns.
  int WorkRows() const { return elimination_->work_rows; }
  void SolveLower(Scalar* x, int width) const;
  void SolveUpper(Scalar* x, int width) const;
  static constexpr int kColumns = 32 / sizeof(Scalar);
  /// The same for one vector of WorkRows() numbers.
  void SolveLower(Scalar* x) const;
  void SolveUpper(Scalar* x) const;

 private:
  template <typename Other>
  friend class CholeskyFactor;
  // Calls task(i, begin, count) for every i in [0, tasks) and chunks of the columns.
  template <typename Task>
  void ForChunks(int tasks, int width, const Task& task) const;

  std::shared_ptr<const Elimination> elimination_;
  std::unique_ptr<Scalar[]> values_;
};

using Cholesky = CholeskyFactor<double>;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_INTERNAL_CHOLESKY_H_
