#ifndef SHAPESPACE_SPARSE_DETAIL_SYMBOLIC_H_
#define SHAPESPACE_SPARSE_DETAIL_SYMBOLIC_H_

#include <cstddef>
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

/// The pattern of the Cholesky factor of a sparse symmetric matrix.
struct SymbolicFactor {
  std::vector<int> permutation;  ///< row i of the factor belongs to unknown permutation[i]
  std::vector<Supernode> supernodes;
  std::vector<int> rows;  ///< of all supernodes, ascending in each
  size_t num_values = 0;  ///< stored numbers, including those of dense blocks
};

/// Finds an order of elimination with little fill, and the supernodes of the factor. `matrix` is in
/// compressed form with sorted rows, and only the pattern of its lower triangle is read. Unknowns
/// are in groups of `group` consecutive ones with equal patterns, such as the coordinates of one
/// vertex, and all is found for the groups.
///
/// The order is that of approximate minimum degree (Amestoy, Davis, Duff 1996) in Eigen; the
/// elimination tree and the pattern follow Liu, "The role of elimination trees in sparse
/// factorization", 1990. Small supernodes are joined with their parents at the price of some zeros
/// (Ashcraft, Grimes 1989). On meshes from 1 K to 1 M triangles the factor has within 4 % the
/// numbers that CHOLMOD's has (docs/performance.md).
///
/// \throw SolverError if memory runs out.
SymbolicFactor AnalysePattern(const Eigen::SparseMatrix<double>& matrix, int group);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_DETAIL_SYMBOLIC_H_
