#include <shapespace/sparse/detail/symbolic.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/quadruped.h>

namespace shapespace::internal {
namespace {

using Edges = std::vector<std::pair<int, int>>;

// The lower triangle of a matrix with dense blocks of `group` unknowns for the nodes and edges.
Eigen::SparseMatrix<double> MatrixOf(int nodes, const Edges& edges, int group) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int column) {
    for (int i = 0; i < group; ++i) {
      for (int k = 0; k < group; ++k) {
        const int r = group * row + i, c = group * column + k;
        if (r >= c) entries.emplace_back(r, c, 1.0);
      }
    }
  };
  for (int node = 0; node < nodes; ++node) add(node, node);
  for (const auto& [a, b] : edges) add(std::max(a, b), std::min(a, b));
  Eigen::SparseMatrix<double> matrix(group * nodes, group * nodes);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Edges Grid(int side) {
  Edges edges;
  for (int i = 0; i < side * side; ++i) {
    if (i % side + 1 < side) edges.emplace_back(i, i + 1);
    if (i + side < side * side) edges.emplace_back(i, i + side);
  }
  return edges;
}

Edges RandomForestAndCycles(int nodes, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> node(0, nodes - 1);
  std::set<std::pair<int, int>> edges;
  while (static_cast<int>(edges.size()) < count) {
    const int a = node(random), b = node(random);
    if (a != b) edges.emplace(std::min(a, b), std::max(a, b));
  }
  return {edges.begin(), edges.end()};
}

// The rows of each column of the factor, by elimination of one unknown after the other.
std::vector<std::set<int>> FactorByDefinition(const Eigen::SparseMatrix<double>& lower,
                                              const std::vector<int>& permutation) {
  const int size = static_cast<int>(permutation.size());
  std::vector<int> inverse(size);
  for (int i = 0; i < size; ++i) inverse[permutation[i]] = i;
  std::vector<std::set<int>> columns(size);
  for (int column = 0; column < size; ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it) {
      const int a = inverse[column], b = inverse[it.row()];
      columns[std::min(a, b)].insert(std::max(a, b));
    }
  }
  for (int i = 0; i < size; ++i) {
    for (auto j = std::next(columns[i].begin()); j != columns[i].end(); ++j) {
      columns[*j].insert(j, columns[i].end());
    }
  }
  return columns;
}

// Checks a factor against the definition, and returns its stored numbers in those that are needed.
double CheckFactor(const Eigen::SparseMatrix<double>& lower, int group) {
  const SymbolicFactor factor = AnalysePattern(lower, group);
  const int size = static_cast<int>(lower.cols());
  std::vector<int> sorted = factor.permutation;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(static_cast<int>(sorted.size()), size);
  for (int i = 0; i < size; ++i) EXPECT_EQ(sorted[i], i);

  const auto columns = FactorByDefinition(lower, factor.permutation);
  int next_column = 0;
  size_t next_row = 0, next_value = 0, needed = 0;
  for (const Supernode& node : factor.supernodes) {
    EXPECT_EQ(node.begin, next_column);
    EXPECT_EQ(node.rows, next_row);
    EXPECT_EQ(node.values, next_value);
    next_column += node.width;
    next_row += node.height;
    next_value += static_cast<size_t>(node.width) * node.height;
    const std::set<int> rows(&factor.rows[node.rows], &factor.rows[node.rows] + node.height);
    EXPECT_TRUE(std::is_sorted(&factor.rows[node.rows], &factor.rows[node.rows] + node.height));
    std::set<int> all;
    for (int i = node.begin; i < node.begin + node.width; ++i) {
      all.insert(i);
      all.insert(columns[i].begin(), columns[i].end());
      // The block of the supernode's own columns is stored as a square.
      needed += i - node.begin + columns[i].size();
    }
    EXPECT_EQ(rows, all) << "columns from " << node.begin;
  }
  EXPECT_EQ(next_column, size);
  EXPECT_EQ(next_row, factor.rows.size());
  EXPECT_EQ(next_value, factor.num_values);
  return static_cast<double>(factor.num_values) / static_cast<double>(needed);
}

TEST(SymbolicTest, RowsAreThoseOfEliminationOneByOne) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const int nodes = 5 + 10 * static_cast<int>(seed);
    for (int group : {1, 3}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", group " << group);
      // The first graphs have few edges, so that they have several components and single nodes.
      const Edges edges = RandomForestAndCycles(nodes, nodes * (1 + seed % 3) / 2, seed);
      CheckFactor(MatrixOf(nodes, edges, group), group);
    }
  }
}

TEST(SymbolicTest, WithoutEdgesTheFactorIsDiagonalButForSmallJoins) {
  EXPECT_EQ(AnalysePattern(MatrixOf(1, {}, 1), 1).num_values, 1u);
  EXPECT_EQ(AnalysePattern(MatrixOf(50, {}, 1), 1).num_values, 50u);
  EXPECT_EQ(AnalysePattern(MatrixOf(50, {}, 3), 3).num_values, 450u);
}

// George's nested dissection of a grid of n nodes leaves 31/4 n log2 n numbers (SIAM J. Numer.
// Anal. 10, 1973); the order of rows would leave n^(3/2).
TEST(SymbolicTest, FillOfGridsIsBelowThatOfNestedDissection) {
  for (int side : {30, 60, 120}) {
    const double n = side * side;
    const SymbolicFactor factor = AnalysePattern(MatrixOf(side * side, Grid(side), 1), 1);
    EXPECT_LT(static_cast<double>(factor.num_values), 31.0 / 4 * n * std::log2(n)) << side;
  }
}

TEST(SymbolicTest, GroupsAreEliminatedInTheOrderOfTheirGraph) {
  const SymbolicFactor nodes = AnalysePattern(MatrixOf(900, Grid(30), 1), 1);
  const SymbolicFactor groups = AnalysePattern(MatrixOf(900, Grid(30), 3), 3);
  for (int i = 0; i < 2700; ++i) {
    ASSERT_EQ(groups.permutation[i], 3 * nodes.permutation[i / 3] + i % 3);
  }
}

TEST(SymbolicTest, SmallSupernodesAreJoinedAtThePriceOfFewZeros) {
  const SkinnedBody body = MakeQuadruped(3000);
  const Eigen::Matrix2Xi& ends = body.connectivity->Edges();
  Edges edges;
  for (int e = 0; e < ends.cols(); ++e) edges.emplace_back(ends(0, e), ends(1, e));
  const int nodes = body.connectivity->NumVertices();
  const auto matrix = MatrixOf(nodes, edges, 1), of_groups = MatrixOf(nodes, edges, 3);
  EXPECT_LT(CheckFactor(matrix, 1), 1.5);
  EXPECT_LT(CheckFactor(of_groups, 3), 1.2);
  EXPECT_LT(AnalysePattern(matrix, 1).supernodes.size(), nodes / 8);
  EXPECT_LT(AnalysePattern(of_groups, 3).supernodes.size(), nodes / 3.5);
}

}  // namespace
}  // namespace shapespace::internal
