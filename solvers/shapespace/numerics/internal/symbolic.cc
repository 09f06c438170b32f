#include <shapespace/numerics/internal/symbolic.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <string>
#include <utility>

#include <Eigen/OrderingMethods>

#include <shapespace/base/error.h>

namespace shapespace::internal {
namespace {

// The neighbours of every group of unknowns in the matrix, without itself, in ascending order.
struct Graph {
  std::vector<int> begin, neighbours;

  int Size() const { return static_cast<int>(begin.size()) - 1; }
  template <typename Body>
  void ForNeighbours(int node, const Body& body) const {
    for (int i = begin[node]; i < begin[node + 1]; ++i) body(neighbours[i]);
  }
};

Graph GraphOf(const Eigen::SparseMatrix<double>& matrix, int group) {
  const int size = static_cast<int>(matrix.cols() / group);
  const auto for_edges = [&](const auto& body) {
    for (int column = 0; column < size; ++column) {
      int last = column;
      for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, group * column); it; ++it) {
        const int row = static_cast<int>(it.row() / group);
        if (row <= last) continue;
        body(column, row);
        last = row;
      }
    }
  };
  Graph graph;
  graph.begin.assign(size + 1, 0);
  for_edges([&](int a, int b) { ++graph.begin[a + 1], ++graph.begin[b + 1]; });
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  graph.neighbours.resize(graph.begin.back());
  std::vector<int> next(graph.begin.begin(), graph.begin.end() - 1);
  for_edges([&](int a, int b) {
    graph.neighbours[next[a]++] = b;
    graph.neighbours[next[b]++] = a;
  });
  return graph;
}

std::vector<int> MinimumDegree(const Graph& graph) {
  Eigen::SparseMatrix<double> lower(graph.Size(), graph.Size());
  lower.reserve(graph.neighbours.size() / 2 + graph.Size());
  for (int node = 0; node < graph.Size(); ++node) {
    lower.startVec(node);
    lower.insertBackByOuterInner(node, node) = 1;
    graph.ForNeighbours(node, [&](int i) {
      if (i > node) lower.insertBackByOuterInner(node, i) = 1;
    });
  }
  lower.finalize();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(lower.selfadjointView<Eigen::Lower>(), order);
  return std::vector<int>(order.indices().data(), order.indices().data() + graph.Size());
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
  std::vector<int> inverse(order.size());
  for (size_t i = 0; i < order.size(); ++i) inverse[order[i]] = static_cast<int>(i);
  for (int i = 0; i < graph.Size(); ++i) {
    graph.ForNeighbours(order[i], [&](int neighbour) {
      if (inverse[neighbour] < i) body(inverse[neighbour], i);
    });
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
  const int size = graph.Size();
  std::vector<int> parent(size, -1), ancestor(size, -1);
  ForEarlierNeighbours(graph, order, [&](int k, int i) {
    while (ancestor[k] >= 0 && ancestor[k] != i) k = std::exchange(ancestor[k], i);
    if (ancestor[k] >= 0) return;
    ancestor[k] = i;
    parent[k] = i;
  });

  Tree tree;
  const std::vector<int> post = Postorder(parent);
  std::vector<int> place(size);
  for (int i = 0; i < size; ++i) place[post[i]] = i;
  for (int old : post) {
    tree.order.push_back(order[old]);
    tree.parent.push_back(parent[old] < 0 ? -1 : place[parent[old]]);
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

// The first nodes of the fundamental supernodes: each other node has the node before it as its only
// child, and the pattern of that less one number.
std::vector<int> FundamentalSupernodes(const Tree& tree) {
  const int size = static_cast<int>(tree.parent.size());
  std::vector<int> children(size, 0), first;
  for (int parent : tree.parent) {
    if (parent >= 0) ++children[parent];
  }
  for (int i = 0; i < size; ++i) {
    const bool continues = i > 0 && tree.parent[i - 1] == i && children[i] == 1 &&
                           tree.count[i - 1] == tree.count[i] + 1;
    if (!continues) first.push_back(i);
  }
  return first;
}

// Joins supernodes with the parent that follows directly, while the zeros that this stores are few.
// The limits are the defaults of CHOLMOD, in columns of unknowns.
std::vector<int> JoinSupernodes(const Tree& tree, const std::vector<int>& first, int group) {
  const int size = static_cast<int>(tree.parent.size()), num_nodes = static_cast<int>(first.size());
  std::vector<int> node_of(size);
  std::vector<double> width(num_nodes), height(num_nodes), zeros(num_nodes, 0);
  for (int s = 0; s < num_nodes; ++s) {
    const int end = s + 1 < num_nodes ? first[s + 1] : size;
    std::fill(node_of.begin() + first[s], node_of.begin() + end, s);
    width[s] = group * (end - first[s]);
    height[s] = group * tree.count[first[s]];
  }
  std::vector<int> joined_to(num_nodes, -1);
  for (int s = num_nodes - 2; s >= 0; --s) {
    int parent = tree.parent[first[s + 1] - 1];
    if (parent < 0) continue;
    parent = node_of[parent];
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
  std::vector<int> result;
  for (int s = 0; s < num_nodes; ++s) {
    if (joined_to[s] < 0) result.push_back(first[s]);
  }
  return result;
}

// The pattern of the factor. The rows of a supernode are those of the matrix and of its children.
SymbolicFactor ListRows(const Graph& graph, const Tree& tree, const std::vector<int>& first,
                        int group) {
  const int size = graph.Size(), num_nodes = static_cast<int>(first.size());
  const auto end_of = [&](int s) { return s + 1 < num_nodes ? first[s + 1] : size; };
  std::vector<int> inverse(size), node_of(size), seen_in_node(size, -1);
  for (int i = 0; i < size; ++i) inverse[tree.order[i]] = i;
  for (int s = 0; s < num_nodes; ++s) {
    std::fill(node_of.begin() + first[s], node_of.begin() + end_of(s), s);
  }
  SymbolicFactor result;
  for (int node : tree.order) {
    for (int k = 0; k < group; ++k) result.permutation.push_back(group * node + k);
  }
  std::vector<std::vector<int>> children(num_nodes), below(num_nodes);
  for (int s = 0; s < num_nodes; ++s) {
    std::vector<int>& rows = below[s];
    const auto add = [&](int row) {
      if (row < end_of(s) || seen_in_node[row] == s) return;
      seen_in_node[row] = s;
      rows.push_back(row);
    };
    for (int i = first[s]; i < end_of(s); ++i) {
      graph.ForNeighbours(tree.order[i], [&](int neighbour) { add(inverse[neighbour]); });
    }
    for (int child : children[s]) std::for_each(below[child].begin(), below[child].end(), add);
    std::sort(rows.begin(), rows.end());
    if (!rows.empty()) children[node_of[rows.front()]].push_back(s);

    const int width = end_of(s) - first[s], height = width + static_cast<int>(rows.size());
    result.supernodes.push_back(
        {group * first[s], group * width, group * height, result.rows.size(), result.num_values});
    result.num_values += static_cast<size_t>(group * width) * (group * height);
    const auto append = [&](int row) {
      for (int k = 0; k < group; ++k) result.rows.push_back(group * row + k);
    };
    for (int i = first[s]; i < end_of(s); ++i) append(i);
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
