#ifndef SHAPESPACE_SOLVERS_OPTIMISE_CHOLESKY_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_CHOLESKY_H_

#include <memory>
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

/// A subtree of the elimination tree. Its columns take nothing from other branches; what they give
/// to rows outside, in the trunk, is gathered in rows of its own, to be added later.
struct Branch {
  std::vector<int> nodes;    ///< supernodes, in order
  std::vector<int> outside;  ///< rows
  int gathered = 0;          ///< where the rows of its own begin
};

/// Sparse Cholesky factor C C^T = Q S Q^T (Q a fill-reducing permutation), computed by CHOLMOD and
/// applied by kernels of ours, to many right-hand sides at once that lie side by side in memory.
/// Computed in double precision, kept and applied in `Scalar`: double or float.
template <typename Scalar>
class CholeskyFactor {
 public:
  /// `matrix` is symmetric positive definite; only its lower triangle is read.
  /// \throw SolverError if it is not positive definite, or memory runs out.
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
        work_rows_(other.work_rows_) {}

  CholeskyFactor(const CholeskyFactor&) = delete;
  CholeskyFactor(CholeskyFactor&&) noexcept = default;

  /// The factor of another matrix of the same pattern, in the same order of elimination and the
  /// same memory; in double precision only. \throw SolverError if it is not positive definite: then
  /// there is no factor until the next one.
  void Update(const Eigen::SparseMatrix<double>& matrix);

  int Size() const { return static_cast<int>(permutation_.size()); }
  /// Row i of the factor belongs to unknown Permutation()[i] of the matrix.
  const std::vector<int>& Permutation() const { return permutation_; }
  /// Numbers stored, those of dense blocks included.
  size_t NumNonzeros() const { return num_values_; }

  /// x <- C^{-1} x and x <- C^{-T} x; `x` is WorkRows() x `width`, row by row, rows `width` apart,
  /// a multiple of `kColumns`; rows from Size() on are scratch. Uses all threads: the branches of
  /// the elimination tree are independent, and so are chunks of columns.
  int WorkRows() const { return work_rows_; }
  void SolveLower(Scalar* x, int width) const;
  void SolveUpper(Scalar* x, int width) const;
  static constexpr int kColumns = 32 / sizeof(Scalar);

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

  // What CHOLMOD made; its numbers are used where they are, or rounded.
  struct Made;
  std::shared_ptr<Made> made_;
  std::vector<int> permutation_;
  std::vector<Supernode> supernodes_;
  std::vector<int> rows_;
  std::vector<Scalar> own_values_;
  const Scalar* values_ = nullptr;
  size_t num_values_ = 0;
  std::vector<Branch> branches_;
  std::vector<int> trunk_;        // supernodes in no branch
  std::vector<int> branch_rows_;  // rows_, those outside of a branch replaced by its own
  int work_rows_ = 0;
};

using Cholesky = CholeskyFactor<double>;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_CHOLESKY_H_
