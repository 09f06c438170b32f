#include <shapespace/metric/internal/lower_block.h>

#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace shapespace::internal {
namespace {

// Each entry of each block is found where it stands, and those of the diagonal's blocks that are
// stored; vertices 0 and 2 of four share no element.
TEST(ForLowerBlock, CallsWithTheEntriesOfTheBlock) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(12, 12);
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < 12; ++column) {
    for (int row = column; row < 12; ++row) {
      if (row / 3 == 2 && column / 3 == 0) continue;
      dense(row, column) = 100 * row + column + 1;
      entries.emplace_back(row, column, dense(row, column));
    }
  }
  Eigen::SparseMatrix<double> matrix(12, 12);
  matrix.setFromTriplets(entries.begin(), entries.end());
  for (int q = 0; q < 4; ++q) {
    for (int p = q; p < 4; ++p) {
      if (p == 2 && q == 0) continue;
      Eigen::Matrix3d found = Eigen::Matrix3d::Zero();
      ForLowerBlock(p, q, &matrix, [&](int a, int b, double* entry) { found(a, b) += *entry; });
      EXPECT_EQ(found, (dense.block<3, 3>(3 * p, 3 * q))) << p << ", " << q;
    }
  }
}

}  // namespace
}  // namespace shapespace::internal
