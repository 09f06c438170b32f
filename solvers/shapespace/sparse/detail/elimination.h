#ifndef SHAPESPACE_SPARSE_DETAIL_ELIMINATION_H_
#define SHAPESPACE_SPARSE_DETAIL_ELIMINATION_H_

#include <cstddef>
#include <vector>

#include <Eigen/SparseCore>

#include <shapespace/sparse/detail/symbolic.h>

namespace shapespace::internal {

/// A subtree of the elimination tree. Its columns do not depend on other branches. Its
/// contributions to rows outside, in the trunk, are accumulated in separate rows and added later.
struct Branch {
  std::vector<int> nodes;    ///< supernodes, in ascending order
  std::vector<int> outside;  ///< rows outside of the branch
  int gathered = 0;          ///< first of the separate rows
};

/// The order in which a sparse symmetric matrix is eliminated, and where the numbers of its factor
/// are: all of a factorisation that depends only on the pattern.
struct Elimination : SymbolicFactor {
  /// `matrix` is in compressed form, and only its lower triangle is read. Unknowns are in groups of
  /// `group` consecutive ones with equal patterns, such as the coordinates of one vertex; the order
  /// of elimination is found for the groups, in less time.
  /// \throw SolverError if memory runs out.
  Elimination(const Eigen::SparseMatrix<double>& matrix, int group);

  int Size() const { return static_cast<int>(permutation.size()); }

  std::vector<int> parent;  ///< of each supernode in the elimination tree, which has a larger
                            ///< index; -1 for a root
  std::vector<Branch> branches;
  std::vector<int> trunk;        ///< supernodes that belong to no branch, in ascending order
  std::vector<int> branch_rows;  ///< rows, with separate rows outside of a branch
  int work_rows = 0;             ///< size, and the separate rows of all branches
  int greatest_height = 0;       ///< of a supernode

  /// The numbers of the matrix that a supernode starts from: number entry_index[e] of the matrix
  /// belongs to place entry_place[e] of the supernode's block, for entry_begin[s] <= e <
  /// entry_begin[s + 1].
  std::vector<size_t> entry_begin;
  std::vector<int> entry_index, entry_place;

 private:
  void ListEntries(const Eigen::SparseMatrix<double>& matrix, const std::vector<int>& node_of_row);
  void GrowBranches(const std::vector<int>& node_of_row);
  std::vector<int> AssignBranches() const;
  template <typename IsOutside>
  void GatherOutsideRows(const IsOutside& is_outside, Branch* branch);
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_DETAIL_ELIMINATION_H_
