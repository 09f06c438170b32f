#include <shapespace/numerics/internal/elimination.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

#include <cholmod.h>

#include <shapespace/base/error.h>

namespace shapespace::internal {
namespace {

// A branch of the elimination tree has at most this share of the total work. A factor has branches
// only if it has at least this many numbers; smaller ones do not justify several threads.
constexpr double kBranchShare = 1.0 / 16, kWorthBranches = 1e5;

// Indices have 64 bits, because a factor may have more than 2^31 numbers.
using Index = SuiteSparse_long;

// CHOLMOD's analysis of a matrix.
class Analysis {
 public:
  // With a given order of elimination, unless `order` is empty.
  Analysis(const Eigen::SparseMatrix<double>& matrix, std::vector<Index> order)
      : column_begin_(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.outerSize() + 1),
        rows_(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros()) {
    cholmod_l_start(&common_);
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.print = 0;
    common_.error_handler = nullptr;
    cholmod_sparse view = {};
    view.nrow = matrix.rows();
    view.ncol = matrix.cols();
    view.nzmax = rows_.size();
    view.p = column_begin_.data();
    view.i = rows_.data();
    view.stype = -1;
    view.itype = CHOLMOD_LONG;
    view.xtype = CHOLMOD_PATTERN;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    if (!order.empty()) {
      common_.nmethods = 1;
      common_.method[0].ordering = CHOLMOD_GIVEN;
    }
    {
      // METIS draws from rand(), which all threads share: two analyses at a time would change each
      // other's order of elimination.
      static std::mutex one_at_a_time;
      const std::lock_guard<std::mutex> lock(one_at_a_time);
      factor_ = order.empty() ? cholmod_l_analyze(&view, &common_)
                              : cholmod_l_analyze_p(&view, order.data(), nullptr, 0, &common_);
    }
    if (common_.status == CHOLMOD_OK) return;
    const std::string unknowns = "a matrix of " + std::to_string(matrix.rows()) + " unknowns";
    const int status = common_.status;
    Free();
    switch (status) {
      case CHOLMOD_OUT_OF_MEMORY:
        throw SolverError("memory ran out in factoring " + unknowns +
                          "; use a mesh of fewer vertices, or more memory");
      case CHOLMOD_TOO_LARGE:
        throw SolverError(unknowns +
                          " is too large to be factored by CHOLMOD; use a mesh of fewer vertices");
      default:
        throw SolverError("CHOLMOD could not factor " + unknowns + ": its status is " +
                          std::to_string(status));
    }
  }
  Analysis(const Analysis&) = delete;
  ~Analysis() { Free(); }

  const cholmod_factor& Factor() const { return *factor_; }

 private:
  void Free() {
    cholmod_l_free_factor(&factor_, &common_);
    cholmod_l_finish(&common_);
  }

  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  std::vector<Index> column_begin_, rows_;  // of the matrix
};

const Index* Indices(const void* begin) { return static_cast<const Index*>(begin); }

// The order of elimination of groups of unknowns, written out for the unknowns.
std::vector<Index> OrderOfGroups(const Eigen::SparseMatrix<double>& matrix, int group) {
  const Eigen::Index num_groups = matrix.cols() / group;
  Eigen::SparseMatrix<double> groups(num_groups, num_groups);
  groups.reserve(matrix.nonZeros() / (group * group) + num_groups);
  for (Eigen::Index column = 0; column < num_groups; ++column) {
    groups.startVec(column);
    Eigen::Index last = -1;
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, group * column); it; ++it) {
      const Eigen::Index row = it.row() / group;
      if (row < column || row == last) continue;
      groups.insertBackByOuterInner(column, row) = 0;
      last = row;
    }
  }
  groups.finalize();
  const Analysis analysis(groups, {});
  const Index* const order = Indices(analysis.Factor().Perm);
  std::vector<Index> result;
  for (Eigen::Index i = 0; i < num_groups; ++i) {
    for (int k = 0; k < group; ++k) result.push_back(group * order[i] + k);
  }
  return result;
}

}  // namespace

Elimination::Elimination(const Eigen::SparseMatrix<double>& matrix, int group) {
  const Analysis analysis(matrix, group > 1 ? OrderOfGroups(matrix, group) : std::vector<Index>());
  const cholmod_factor& factor = analysis.Factor();
  const auto integers = [](const void* begin, size_t count) {
    return std::vector<int>(Indices(begin), Indices(begin) + count);
  };
  permutation = integers(factor.Perm, factor.n);
  rows = integers(factor.s, factor.ssize);
  num_values = factor.xsize;
  const Index* const super = Indices(factor.super);
  const Index* const row_begin = Indices(factor.pi);
  const Index* const value_begin = Indices(factor.px);
  for (size_t s = 0; s < factor.nsuper; ++s) {
    supernodes.push_back({static_cast<int>(super[s]), static_cast<int>(super[s + 1] - super[s]),
                          static_cast<int>(row_begin[s + 1] - row_begin[s]),
                          static_cast<size_t>(row_begin[s]), static_cast<size_t>(value_begin[s])});
  }
  std::vector<int> node_of_row(factor.n);
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
  std::sort(outside.begin(), outside.end());
  outside.erase(std::unique(outside.begin(), outside.end()), outside.end());
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
