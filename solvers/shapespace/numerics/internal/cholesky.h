#ifndef SHAPESPACE_NUMERICS_INTERNAL_CHOLESKY_H_
#define SHAPESPACE_NUMERICS_INTERNAL_CHOLESKY_H_

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

namespace shapespace::internal {

/// Columns begin .. begin + width of a factor that share one sparsity pattern: a dense trapezoid,
/// stored by columns of length `height`, whose first `width` rows are the columns' own.
struct Supernode {
  int begin, width, height;
  size_t rows;    // index into the row list of its first row
  size_t values;  // index of its first number
};

/// A subtree of the elimination tree. Its columns do not depend on other branches. Its
/// contributions to rows outside, in the trunk, are accumulated in separate rows and added later.
struct Branch {
  std::vector<int> nodes;    ///< supernodes, in ascending order
  std::vector<int> outside;  ///< rows outside of the branch
  int gathered = 0;          ///< first of the separate rows
};

/// Sparse Cholesky factor C C^T = Q S Q^T (Q a fill-reducing permutation), computed by CHOLMOD and
/// applied by this library's kernels to many right-hand sides at once, which are adjacent in
/// memory. Computed in double precision, stored and applied in `Scalar`: double or float.
template <typename Scalar>
class CholeskyFactor {
 public:
  /// `matrix` is symmetric positive definite and in compressed form; only its lower triangle is
  /// read.
  /// \throw SolverError, saying which, if it is not positive definite, or memory runs out, or it is
  ///        too large for CHOLMOD.
  explicit CholeskyFactor(const Eigen::SparseMatrix<double>& matrix);

  /// The same factor, rounded.
  template <typename Other>
  explicit CholeskyFactor(const CholeskyFactor<Other>& other)
      : permutation_(other.permutation_),
        supernodes_(other.supernodes_),
        rows_(other.rows_),
        own_values_(other.values_, other.values_ + other.num_values_),
        values_(own_values_.data()),
        num_values_(other.num_values_),
        branches_(other.branches_),
        trunk_(other.trunk_),
        branch_rows_(other.branch_rows_),
        work_rows_(other.work_rows_),
        greatest_height_(other.greatest_height_) {}

  CholeskyFactor(const CholeskyFactor&) = delete;
  CholeskyFactor(CholeskyFactor&&) noexcept = default;

  /// Factors another matrix of the same pattern, with the same elimination order and the same
  /// memory; in double precision only.
  /// \throw SolverError if it is not positive definite; then the object must not be used until the
  ///        next update.
  void Update(const Eigen::SparseMatrix<double>& matrix);

  int Size() const { return static_cast<int>(permutation_.size()); }
  /// Row i of the factor belongs to unknown Permutation()[i] of the matrix.
  const std::vector<int>& Permutation() const { return permutation_; }
  /// Stored numbers, including those of dense blocks.
  size_t NumNonzeros() const { return num_values_; }

  /// x <- C^{-1} x and x <- C^{-T} x. `x` is WorkRows() x `width`, stored by rows; `width` is a
  /// multiple of `kColumns`; rows from Size() on are scratch memory. Uses all threads: branches of
  /// the elimination tree are independent, and so are chunks of columns.
  int WorkRows() const { return work_rows_; }
  void SolveLower(Scalar* x, int width) const;
  void SolveUpper(Scalar* x, int width) const;
  static constexpr int kColumns = 32 / sizeof(Scalar);
  /// The same for one vector of WorkRows() numbers.
  void SolveLower(Scalar* x) const;
  void SolveUpper(Scalar* x) const;

 private:
  template <typename Other>
  friend class CholeskyFactor;
  void GrowBranches();
  std::vector<int> AssignBranches(const std::vector<int>& node_of_row) const;
  template <typename IsOutside>
  void GatherOutsideRows(const IsOutside& is_outside, Branch* branch);
  // Calls task(i, begin, count) for every i in [0, tasks) and chunks of the columns.
  template <typename Task>
  void ForChunks(int tasks, int width, const Task& task) const;

  // The factor in CHOLMOD's form; its numbers are used in place, or rounded.
  struct Made;
  std::shared_ptr<Made> made_;
  std::vector<int> permutation_;
  std::vector<Supernode> supernodes_;
  std::vector<int> rows_;
  std::vector<Scalar> own_values_;
  const Scalar* values_ = nullptr;
  size_t num_values_ = 0;
  std::vector<Branch> branches_;
  std::vector<int> trunk_;        // supernodes that belong to no branch
  std::vector<int> branch_rows_;  // rows_, with separate rows outside of a branch
  int work_rows_ = 0;
  int greatest_height_ = 0;  // of a supernode
};

template <>
void CholeskyFactor<double>::Update(const Eigen::SparseMatrix<double>& matrix);

using Cholesky = CholeskyFactor<double>;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_NUMERICS_INTERNAL_CHOLESKY_H_
