#include <shapespace/sparse/detail/symbolic.h>

#include <algorithm>
#include <new>
#include <string>
#include <utility>

#include <Eigen/OrderingMethods>

#include <shapespace/base/error.h>

namespace shapespace::internal {
namespace {

// Which groups of unknowns meet in the matrix: both triangles, with the diagonal. The values mean
// nothing.
using Graph = Eigen::SparseMatrix<char>;

Graph GraphOf(const Eigen::SparseMatrix<double>& matrix, int group) {
  const Eigen::Index size = matrix.cols() / group;
  Graph lower(size, size);
  lower.reserve(matrix.nonZeros() / (group * group) + size);
  for (Eigen::Index column = 0; column < size; ++column) {
    lower.startVec(column);
    lower.insertBackByOuterInner(column, column) = 1;
    Eigen::Index last = column;
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, group * column); it; ++it) {
      const Eigen::Index row = it.row() / group;
      if (row <= last) continue;
      lower.insertBackByOuterInner(column, row) = 1;
      last = row;
    }
  }
  lower.finalize();
  return lower.selfadjointView<Eigen::Lower>();
}

std::vector<int> MinimumDegree(const Graph& graph) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph.selfadjointView<Eigen::Lower>(), order);
  return std::vector<int>(order.indices().data(), order.indices().data() + order.size());
}

std::vector<int> Inverse(const std::vector<int>& order) {
  std::vector<int> inverse(order.size());
  for (size_t i = 0; i < order.size(); ++i) inverse[order[i]] = static_cast<int>(i);
  return inverse;
}

// The elimination tree, in postorder: each node comes after its descendants, whose numbers are
// consecutive.
struct Tree {
  std::vector<int> order;   // node i is group order[i]
  std::vector<int> parent;  // -1 for a root
  std::vector<int> count;   // numbers in its column of the factor, with the diagonal
};

// Calls body(k, i) for the neighbours of all i that are eliminated before, ascending by i.
template <typename Body>
void ForEarlierNeighbours(const Graph& graph, const std::vector<int>& order, const Body& body) {
  const std::vector<int> inverse = Inverse(order);
  for (int i = 0; i < graph.cols(); ++i) {
    for (Graph::InnerIterator it(graph, order[i]); it; ++it) {
      if (inverse[it.row()] < i) body(inverse[it.row()], i);
    }
  }
}

std::vector<int> Postorder(const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<int> first_child(size, -1), sibling(size, -1), result, open;
  for (int i = size - 1; i >= 0; --i) {
    if (parent[i] < 0) continue;
    sibling[i] = first_child[parent[i]];
    first_child[parent[i]] = i;
  }
  for (int root = 0; root < size; ++root) {
    if (parent[root] >= 0) continue;
    open.push_back(root);
    while (!open.empty()) {
      const int child = first_child[open.back()];
      if (child >= 0) {
        first_child[open.back()] = sibling[child];
        open.push_back(child);
      } else {
        result.push_back(open.back());
        open.pop_back();
      }
    }
  }
  return result;
}

// Liu, "The role of elimination trees in sparse factorization", 1990, sections 4 and 5.
Tree EliminationTree(const Graph& graph, const std::vector<int>& order) {
  const int size = static_cast<int>(graph.cols());
  std::vector<int> parent(size, -1), ancestor(size, -1);
  ForEarlierNeighbours(graph, order, [&](int k, int i) {
    while (ancestor[k] >= 0 && ancestor[k] != i) k = std::exchange(ancestor[k], i);
    if (ancestor[k] >= 0) return;
    ancestor[k] = i;
    parent[k] = i;
  });

  Tree tree;
  const std::vector<int> post = Postorder(parent);
  std::vector<int> new_index(size);
  for (int i = 0; i < size; ++i) new_index[post[i]] = i;
  for (int old : post) {
    tree.order.push_back(order[old]);
    tree.parent.push_back(parent[old] < 0 ? -1 : new_index[parent[old]]);
  }

  // Row i of the factor is the part of the tree between the row's numbers in the matrix and i.
  tree.count.assign(size, 1);
  std::vector<int> seen_in_row(size, -1);
  ForEarlierNeighbours(graph, tree.order, [&](int k, int i) {
    for (; k != i && seen_in_row[k] != i; k = tree.parent[k]) {
      seen_in_row[k] = i;
      ++tree.count[k];
    }
  });
  return tree;
}

// The first nodes of supernodes, and behind them the number of nodes.
using FirstNodes = std::vector<int>;

std::vector<int> SupernodeOfNodes(const FirstNodes& first) {
  std::vector<int> supernode(first.back());
  for (size_t s = 0; s + 1 < first.size(); ++s) {
    std::fill(supernode.begin() + first[s], supernode.begin() + first[s + 1], static_cast<int>(s));
  }
  return supernode;
}

// Fundamental supernodes: each of their nodes but the first has the node before it as its only
// child, and the pattern of that less one number.
FirstNodes FundamentalSupernodes(const Tree& tree) {
  const int size = static_cast<int>(tree.parent.size());
  std::vector<int> children(size, 0);
  FirstNodes first;
  for (int parent : tree.parent) {
    if (parent >= 0) ++children[parent];
  }
  for (int i = 0; i < size; ++i) {
    const bool continues = i > 0 && tree.parent[i - 1] == i && children[i] == 1 &&
                           tree.count[i - 1] == tree.count[i] + 1;
    if (!continues) first.push_back(i);
  }
  first.push_back(size);
  return first;
}

// Joins supernodes with the parent that follows directly, while the zeros that this stores are few.
// The limits are the defaults of CHOLMOD, in columns of unknowns.
FirstNodes JoinSupernodes(const Tree& tree, const FirstNodes& first, int group) {
  const int num_nodes = static_cast<int>(first.size()) - 1;
  const std::vector<int> supernode = SupernodeOfNodes(first);
  std::vector<double> width(num_nodes), height(num_nodes), zeros(num_nodes, 0);
  for (int s = 0; s < num_nodes; ++s) {
    width[s] = group * (first[s + 1] - first[s]);
    height[s] = group * tree.count[first[s]];
  }
  std::vector<int> joined_to(num_nodes, -1);
  for (int s = num_nodes - 2; s >= 0; --s) {
    int parent = tree.parent[first[s + 1] - 1];
    if (parent < 0) continue;
    parent = supernode[parent];
    while (joined_to[parent] >= 0) parent = joined_to[parent];
    if (parent != s + 1) continue;
    const double columns = width[s] + width[parent];
    const double more = width[s] * (height[parent] + width[s] - height[s]);
    const double all = zeros[parent] + more;
    const double numbers = columns * (columns + 1) / 2 + columns * (height[parent] - width[parent]);
    const double share = all / numbers;
    if (columns <= 4 || more == 0 || (columns <= 16 && share < 0.8) ||
        (columns <= 48 && share < 0.1) || share < 0.05) {
      joined_to[parent] = s;
      zeros[s] = all;
      height[s] = width[s] + height[parent];
      width[s] = columns;
    }
  }
  FirstNodes result;
  for (int s = 0; s < num_nodes; ++s) {
    if (joined_to[s] < 0) result.push_back(first[s]);
  }
  result.push_back(first.back());
  return result;
}

// The pattern of the factor. The rows of a supernode are those of the matrix and of its children.
SymbolicFactor ListRows(const Graph& graph, const Tree& tree, const FirstNodes& first, int group) {
  const int num_nodes = static_cast<int>(first.size()) - 1;
  const std::vector<int> inverse = Inverse(tree.order), supernode = SupernodeOfNodes(first);
  std::vector<int> seen_in(first.back(), -1);
  SymbolicFactor result;
  for (int node : tree.order) {
    for (int k = 0; k < group; ++k) result.permutation.push_back(group * node + k);
  }
  std::vector<std::vector<int>> children(num_nodes), below(num_nodes);
  for (int s = 0; s < num_nodes; ++s) {
    std::vector<int>& rows = below[s];
    const auto add = [&](int row) {
      if (row < first[s + 1] || seen_in[row] == s) return;
      seen_in[row] = s;
      rows.push_back(row);
    };
    for (int i = first[s]; i < first[s + 1]; ++i) {
      for (Graph::InnerIterator it(graph, tree.order[i]); it; ++it) add(inverse[it.row()]);
    }
    for (int child : children[s]) std::for_each(below[child].begin(), below[child].end(), add);
    std::sort(rows.begin(), rows.end());
    if (!rows.empty()) children[supernode[rows.front()]].push_back(s);

    const int width = first[s + 1] - first[s], height = width + static_cast<int>(rows.size());
    result.supernodes.push_back(
        {group * first[s], group * width, group * height, result.rows.size(), result.num_values});
    result.num_values += static_cast<size_t>(group * width) * (group * height);
    const auto append = [&](int row) {
      for (int k = 0; k < group; ++k) result.rows.push_back(group * row + k);
    };
    for (int i = first[s]; i < first[s + 1]; ++i) append(i);
    std::for_each(rows.begin(), rows.end(), append);
  }
  return result;
}

}  // namespace

SymbolicFactor AnalysePattern(const Eigen::SparseMatrix<double>& matrix, int group) try {
  const Graph graph = GraphOf(matrix, group);
  const Tree tree = EliminationTree(graph, MinimumDegree(graph));
  return ListRows(graph, tree, JoinSupernodes(tree, FundamentalSupernodes(tree), group), group);
} catch (const std::bad_alloc&) {
  throw SolverError("memory ran out in factoring a matrix of " + std::to_string(matrix.rows()) +
                    " unknowns; use a mesh of fewer vertices, or more memory");
}

}  // namespace shapespace::internal
