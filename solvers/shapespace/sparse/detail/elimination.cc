#include <shapespace/sparse/detail/elimination.h>

#include <algorithm>

#include <shapespace/base/internal/sort_unique.h>

namespace shapespace::internal {
namespace {

// A branch of the elimination tree has at most this share of the total work. A factor has branches
// only if it has at least this many numbers; smaller ones do not justify several threads.
constexpr double kBranchShare = 1.0 / 16, kWorthBranches = 1e5;

}  // namespace

Elimination::Elimination(const Eigen::SparseMatrix<double>& matrix, int group)
    : SymbolicFactor(AnalysePattern(matrix, group)) {
  std::vector<int> node_of_row(Size());
  for (size_t s = 0; s < supernodes.size(); ++s) {
    std::fill_n(node_of_row.begin() + supernodes[s].begin, supernodes[s].width,
                static_cast<int>(s));
  }
  ListEntries(matrix, node_of_row);
  GrowBranches(node_of_row);
}

void Elimination::ListEntries(const Eigen::SparseMatrix<double>& matrix,
                              const std::vector<int>& node_of_row) {
  const int size = Size(), num_nodes = static_cast<int>(supernodes.size());
  std::vector<int> inverse(size);
  for (int i = 0; i < size; ++i) inverse[permutation[i]] = i;
  const int* const outer = matrix.outerIndexPtr();
  const int* const inner = matrix.innerIndexPtr();
  const auto for_entries = [&](const auto& body) {
    for (int column = 0; column < size; ++column) {
      for (int i = outer[column]; i < outer[column + 1]; ++i) {
        if (inner[i] < column) continue;
        const int a = inverse[column], b = inverse[inner[i]];
        body(i, std::min(a, b), std::max(a, b));
      }
    }
  };
  entry_begin.assign(num_nodes + 1, 0);
  for_entries([&](int, int column, int) { ++entry_begin[node_of_row[column] + 1]; });
  for (int s = 0; s < num_nodes; ++s) entry_begin[s + 1] += entry_begin[s];
  entry_index.resize(entry_begin.back());
  entry_place.resize(entry_begin.back());
  std::vector<size_t> next(entry_begin.begin(), entry_begin.end() - 1);
  for_entries([&](int i, int column, int row) {
    const int s = node_of_row[column];
    const Supernode& node = supernodes[s];
    const int* const first = &rows[node.rows];
    const int at =
        node_of_row[row] == s
            ? row - node.begin
            : static_cast<int>(std::lower_bound(first + node.width, first + node.height, row) -
                               first);
    const size_t e = next[s]++;
    entry_index[e] = i;
    entry_place[e] = (column - node.begin) * node.height + at;
  });
}

void Elimination::GrowBranches(const std::vector<int>& node_of_row) {
  const int num_nodes = static_cast<int>(supernodes.size());
  // The parent of a supernode contains the first row below it.
  for (const Supernode& node : supernodes) {
    parent.push_back(node.height > node.width ? node_of_row[rows[node.rows + node.width]] : -1);
    greatest_height = std::max(greatest_height, node.height);
  }
  const std::vector<int> branch_of = AssignBranches();
  branches.resize(*std::max_element(branch_of.begin(), branch_of.end()) + 1);
  for (int s = 0; s < num_nodes; ++s) {
    (branch_of[s] < 0 ? trunk : branches[branch_of[s]].nodes).push_back(s);
  }
  work_rows = Size();
  branch_rows = rows;
  for (size_t b = 0; b < branches.size(); ++b) {
    GatherOutsideRows([&](int row) { return branch_of[node_of_row[row]] != static_cast<int>(b); },
                      &branches[b]);
  }
}

// Per supernode, the index of its branch, or -1 in the trunk.
std::vector<int> Elimination::AssignBranches() const {
  const int num_nodes = static_cast<int>(supernodes.size());
  std::vector<int> branch_of(num_nodes, -1), open;
  std::vector<std::vector<int>> children(num_nodes);
  std::vector<double> work(num_nodes, 0);  // of the subtree
  double total = 0;
  for (int s = 0; s < num_nodes; ++s) {
    const double own = static_cast<double>(supernodes[s].width) * supernodes[s].height;
    work[s] += own;
    total += own;
    if (parent[s] < 0) {
      open.push_back(s);
      continue;
    }
    children[parent[s]].push_back(s);
    work[parent[s]] += work[s];
  }
  if (total <= kWorthBranches) return branch_of;
  // Split subtrees until none is so large that other threads would wait for it.
  int num_branches = 0;
  while (!open.empty()) {
    const int s = open.back();
    open.pop_back();
    if (work[s] > kBranchShare * total) {
      open.insert(open.end(), children[s].begin(), children[s].end());
    } else {
      branch_of[s] = num_branches++;
    }
  }
  for (int s = num_nodes - 1; s >= 0; --s) {
    if (branch_of[s] < 0 && parent[s] >= 0) branch_of[s] = branch_of[parent[s]];
  }
  return branch_of;
}

// Assigns separate rows to a branch for its contributions to rows outside.
template <typename IsOutside>
void Elimination::GatherOutsideRows(const IsOutside& is_outside, Branch* branch) {
  const auto for_rows_below = [&](const auto& body) {
    for (int s : branch->nodes) {
      const Supernode& node = supernodes[s];
      for (int k = node.width; k < node.height; ++k) body(branch_rows[node.rows + k]);
    }
  };
  std::vector<int>& outside = branch->outside;
  for_rows_below([&](int row) {
    if (is_outside(row)) outside.push_back(row);
  });
  SortUnique(&outside);
  branch->gathered = work_rows;
  work_rows += static_cast<int>(outside.size());
  for_rows_below([&](int& row) {
    const auto found = std::lower_bound(outside.begin(), outside.end(), row);
    if (found != outside.end() && *found == row) {
      row = branch->gathered + static_cast<int>(found - outside.begin());
    }
  });
}

}  // namespace shapespace::internal
