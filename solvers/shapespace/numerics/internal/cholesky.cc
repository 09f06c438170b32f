#include <shapespace/numerics/internal/cholesky.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>

#include <cholmod.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/clones.h>
#include <shapespace/base/parallel.h>
#include <shapespace/numerics/internal/one_thread.h>

namespace shapespace::internal {
namespace {

// Number of columns that are solved together with one pass over the factor: large enough to
// amortise reading it, and small enough to keep the rows of a supernode in the L1 cache.
constexpr int kChunk = 48;
// A branch of the elimination tree has at most this share of the total work. A factor has branches
// only if it has at least this many numbers; smaller ones do not justify several threads.
constexpr double kBranchShare = 1.0 / 16, kWorthBranches = 1e5;

// Vectors of 32 and 64 bytes without alignment beyond that of a number.
template <typename Scalar>
struct Vectors;
template <>
struct Vectors<double> {
  using Half = double __attribute__((vector_size(32), aligned(8), may_alias));
  using Full = double __attribute__((vector_size(64), aligned(8), may_alias));
};
template <>
struct Vectors<float> {
  using Half = float __attribute__((vector_size(32), aligned(4), may_alias));
  using Full = float __attribute__((vector_size(64), aligned(4), may_alias));
};

// The solves below keep a tile of kRows x kVectors vectors in registers while they read the
// factor's entries for it. `x` points at the tile's first column; its rows are `stride` apart.

// tile[r] -= sum over k < count of factor(r, k) * source(k).
template <typename Vector, int kRows, int kVectors, typename Factor, typename Source>
SHAPESPACE_INLINE void Accumulate(Vector (&tile)[kRows][kVectors], int count, const Factor& factor,
                                  const Source& source) {
  for (int k = 0; k < count; ++k) {
    const Vector* const from = reinterpret_cast<const Vector*>(source(k));
    for (int r = 0; r < kRows; ++r) {
      const auto f = factor(r, k);
      for (int c = 0; c < kVectors; ++c) tile[r][c] -= f * from[c];
    }
  }
}

template <typename Vector, int kRows, int kVectors, typename Target>
SHAPESPACE_INLINE void Load(Vector (&tile)[kRows][kVectors], const Target& target) {
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kVectors; ++c) tile[r][c] = reinterpret_cast<const Vector*>(target(r))[c];
  }
}

template <typename Vector, int kRows, int kVectors, typename Target>
SHAPESPACE_INLINE void Store(const Vector (&tile)[kRows][kVectors], const Target& target) {
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kVectors; ++c) reinterpret_cast<Vector*>(target(r))[c] = tile[r][c];
  }
}

// Calls panel(tile, i) for the rows [begin, end): tiles of four rows, then of one.
template <typename Vector, int kVectors, typename Panel>
SHAPESPACE_INLINE void ForTiles(int begin, int end, const Panel& panel) {
  int i = begin;
  for (; i + 4 <= end; i += 4) {
    Vector tile[4][kVectors];
    panel(tile, i);
  }
  for (; i < end; ++i) {
    Vector tile[1][kVectors];
    panel(tile, i);
  }
}

template <typename Vector, int kVectors, typename Scalar>
SHAPESPACE_INLINE void ForwardTile(const Supernode& node, const Scalar* block, const int* rows,
                                   Scalar* x, size_t stride) {
  Scalar* const own = x + node.begin * stride;
  const auto source = [&](int k) { return own + k * stride; };
  for (int i = 0; i < node.width; ++i) {
    Vector tile[1][kVectors];
    const auto target = [&](int) { return own + i * stride; };
    Load(tile, target);
    Accumulate(
        tile, i, [&](int, int k) { return block[i + static_cast<size_t>(k) * node.height]; },
        source);
    const Scalar inverse = 1 / block[i + static_cast<size_t>(i) * node.height];
    for (int c = 0; c < kVectors; ++c) tile[0][c] *= inverse;
    Store(tile, target);
  }
  const auto panel = [&](auto& tile, int i) {
    const auto target = [&](int r) { return x + rows[i + r] * stride; };
    Load(tile, target);
    Accumulate(
        tile, node.width,
        [&](int r, int k) { return block[i + r + static_cast<size_t>(k) * node.height]; }, source);
    Store(tile, target);
  };
  ForTiles<Vector, kVectors>(node.width, node.height, panel);
}

template <typename Vector, int kVectors, typename Scalar>
SHAPESPACE_INLINE void BackwardTile(const Supernode& node, const Scalar* block, const int* rows,
                                    Scalar* x, size_t stride) {
  Scalar* const own = x + node.begin * stride;
  const auto panel = [&](auto& tile, int j) {
    const auto target = [&](int r) { return own + (j + r) * stride; };
    Load(tile, target);
    Accumulate(
        tile, node.height - node.width,
        [&](int r, int k) {
          return block[node.width + k + static_cast<size_t>(j + r) * node.height];
        },
        [&](int k) { return x + rows[node.width + k] * stride; });
    Store(tile, target);
  };
  ForTiles<Vector, kVectors>(0, node.width, panel);
  for (int i = node.width - 1; i >= 0; --i) {
    const Scalar* const column = block + static_cast<size_t>(i) * node.height;
    Vector tile[1][kVectors];
    const auto target = [&](int) { return own + i * stride; };
    Load(tile, target);
    Accumulate(
        tile, node.width - 1 - i, [&](int, int k) { return column[i + 1 + k]; },
        [&](int k) { return own + (i + 1 + k) * stride; });
    const Scalar inverse = 1 / column[i];
    for (int c = 0; c < kVectors; ++c) tile[0][c] *= inverse;
    Store(tile, target);
  }
}

// Solves `count` columns, a multiple of kColumns, with one supernode.
template <typename Scalar>
SHAPESPACE_INLINE void ForwardColumns(const Supernode& node, const Scalar* block, const int* rows,
                                      Scalar* x, size_t stride, int count) {
  using Half = typename Vectors<Scalar>::Half;
  using Full = typename Vectors<Scalar>::Full;
  constexpr int kFull = 64 / sizeof(Scalar);
  int c = 0;
  for (; c + 2 * kFull <= count; c += 2 * kFull) {
    ForwardTile<Full, 2>(node, block, rows, x + c, stride);
  }
  if (c + kFull <= count) ForwardTile<Full, 1>(node, block, rows, x + c, stride), c += kFull;
  if (c < count) ForwardTile<Half, 1>(node, block, rows, x + c, stride);
}

template <typename Scalar>
SHAPESPACE_INLINE void BackwardColumns(const Supernode& node, const Scalar* block, const int* rows,
                                       Scalar* x, size_t stride, int count) {
  using Half = typename Vectors<Scalar>::Half;
  using Full = typename Vectors<Scalar>::Full;
  constexpr int kFull = 64 / sizeof(Scalar);
  int c = 0;
  for (; c + 2 * kFull <= count; c += 2 * kFull) {
    BackwardTile<Full, 2>(node, block, rows, x + c, stride);
  }
  if (c + kFull <= count) BackwardTile<Full, 1>(node, block, rows, x + c, stride), c += kFull;
  if (c < count) BackwardTile<Half, 1>(node, block, rows, x + c, stride);
}

// One right-hand side. Vectors extend along the columns of a block, four of which are taken
// together. `below` is scratch memory for the block's rows below its square.
template <typename Scalar>
SHAPESPACE_INLINE void ForwardOne(const Supernode& node, const Scalar* block, const int* rows,
                                  Scalar* x, Scalar* below) {
  const int width = node.width, height = node.height;
  const size_t stride = height;
  Scalar* const own = x + node.begin;
  std::fill_n(below, height - width, Scalar(0));
  for (int first = 0; first < width; first += 4) {
    const int last = std::min(first + 4, width);
    const Scalar* const columns = block + first * stride;
    for (int k = first; k < last; ++k) {
      const Scalar* const column = block + k * stride;
      own[k] /= column[k];
      for (int i = k + 1; i < last; ++i) own[i] -= column[i] * own[k];
    }
    if (last == first + 4) {
      const Scalar a = own[first], b = own[first + 1], c = own[first + 2], d = own[first + 3];
      const auto product = [&](int i) {
        return a * columns[i] + b * columns[i + stride] + c * columns[i + 2 * stride] +
               d * columns[i + 3 * stride];
      };
      for (int i = last; i < width; ++i) own[i] -= product(i);
      for (int i = width; i < height; ++i) below[i - width] += product(i);
    } else {
      for (int k = first; k < last; ++k) {
        const Scalar* const column = block + k * stride;
        for (int i = width; i < height; ++i) below[i - width] += own[k] * column[i];
      }
    }
  }
  for (int i = width; i < height; ++i) x[rows[i]] -= below[i - width];
}

// The sum of a[i] * x[i], in an order that suits vectors.
template <typename Scalar>
SHAPESPACE_INLINE Scalar DotOne(const Scalar* a, const Scalar* x, int count) {
  using Full = typename Vectors<Scalar>::Full;
  constexpr int kFull = 64 / sizeof(Scalar);
  Full sums[2] = {};
  int i = 0;
  for (; i + 2 * kFull <= count; i += 2 * kFull) {
    for (int k = 0; k < 2; ++k) {
      sums[k] += *reinterpret_cast<const Full*>(a + i + k * kFull) *
                 *reinterpret_cast<const Full*>(x + i + k * kFull);
    }
  }
  Scalar sum = 0;
  for (; i < count; ++i) sum += a[i] * x[i];
  sums[0] += sums[1];
  for (int k = 0; k < kFull; ++k) sum += sums[0][k];
  return sum;
}

template <typename Scalar>
SHAPESPACE_INLINE void BackwardOne(const Supernode& node, const Scalar* block, const int* rows,
                                   Scalar* x, Scalar* below) {
  const int width = node.width, height = node.height;
  Scalar* const own = x + node.begin;
  for (int i = width; i < height; ++i) below[i - width] = x[rows[i]];
  for (int k = width - 1; k >= 0; --k) {
    const Scalar* const column = block + k * static_cast<size_t>(height);
    const Scalar sum = DotOne(column + k + 1, own + k + 1, width - 1 - k) +
                       DotOne(column + width, below, height - width);
    own[k] = (own[k] - sum) / column[k];
  }
}

// Function multiversioning does not work for templates.
SHAPESPACE_CLONES
void ForwardNode(const Supernode& node, const double* block, const int* rows, double* x,
                 double* below) {
  ForwardOne(node, block, rows, x, below);
}

SHAPESPACE_CLONES
void ForwardNode(const Supernode& node, const float* block, const int* rows, float* x,
                 float* below) {
  ForwardOne(node, block, rows, x, below);
}

SHAPESPACE_CLONES
void BackwardNode(const Supernode& node, const double* block, const int* rows, double* x,
                  double* below) {
  BackwardOne(node, block, rows, x, below);
}

SHAPESPACE_CLONES
void BackwardNode(const Supernode& node, const float* block, const int* rows, float* x,
                  float* below) {
  BackwardOne(node, block, rows, x, below);
}

SHAPESPACE_CLONES
void ForwardNode(const Supernode& node, const double* block, const int* rows, double* x,
                 size_t stride, int count) {
  ForwardColumns(node, block, rows, x, stride, count);
}

SHAPESPACE_CLONES
void ForwardNode(const Supernode& node, const float* block, const int* rows, float* x,
                 size_t stride, int count) {
  ForwardColumns(node, block, rows, x, stride, count);
}

SHAPESPACE_CLONES
void BackwardNode(const Supernode& node, const double* block, const int* rows, double* x,
                  size_t stride, int count) {
  BackwardColumns(node, block, rows, x, stride, count);
}

SHAPESPACE_CLONES
void BackwardNode(const Supernode& node, const float* block, const int* rows, float* x,
                  size_t stride, int count) {
  BackwardColumns(node, block, rows, x, stride, count);
}

// Throws unless CHOLMOD did what it was asked to do with `matrix`. `factor` may be null.
void Check(const cholmod_common& common, const cholmod_sparse& matrix,
           const cholmod_factor* factor) {
  const std::string unknowns = "a matrix of " + std::to_string(matrix.nrow) + " unknowns";
  switch (common.status) {
    case CHOLMOD_OK:
      return;
    case CHOLMOD_NOT_POSDEF:
      throw SolverError(
          "the preconditioner's matrix is not positive definite: is a weight of the metric zero or "
          "a coordinate enormous?");
    case CHOLMOD_OUT_OF_MEMORY: {
      const double bytes = factor == nullptr ? 0 : 8.0 * static_cast<double>(factor->xsize);
      const std::string needs =
          bytes > 0 ? ", which needs " + std::to_string(std::lround(bytes / 1e6)) + " MB" : "";
      throw SolverError("memory ran out in factoring " + unknowns + needs +
                        "; use a mesh of fewer vertices, or more memory");
    }
    case CHOLMOD_TOO_LARGE:
      throw SolverError(unknowns +
                        " is too large to be factored by CHOLMOD; use a mesh of fewer vertices");
    default:
      throw SolverError("CHOLMOD could not factor " + unknowns + ": its status is " +
                        std::to_string(common.status));
  }
}

}  // namespace

// Indices have 64 bits, because a factor may have more than 2^31 numbers.
template <typename Scalar>
struct CholeskyFactor<Scalar>::Made {
  using Index = SuiteSparse_long;

  cholmod_common common;
  cholmod_factor* factor = nullptr;
  std::vector<Index> column_begin, rows;  // of the matrix

  explicit Made(const Eigen::SparseMatrix<double>& matrix)
      : column_begin(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.outerSize() + 1),
        rows(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros()) {
    cholmod_l_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.print = 0;
    common.error_handler = nullptr;
    cholmod_sparse view = View(matrix);
    factor = cholmod_l_analyze(&view, &common);
    try {
      Check(common, view, factor);
      Factorize(matrix);
    } catch (...) {
      Free();
      throw;
    }
  }
  Made(const Made&) = delete;
  ~Made() { Free(); }

  // The numbers may be others than before; their places must be the same.
  void Factorize(const Eigen::SparseMatrix<double>& matrix) {
    const OneThread one_thread;
    cholmod_sparse view = View(matrix);
    cholmod_l_factorize(&view, factor, &common);
    Check(common, view, factor);
  }

 private:
  cholmod_sparse View(const Eigen::SparseMatrix<double>& matrix) {
    cholmod_sparse view = {};
    view.nrow = matrix.rows();
    view.ncol = matrix.cols();
    view.nzmax = rows.size();
    view.p = column_begin.data();
    view.i = rows.data();
    view.x = const_cast<double*>(matrix.valuePtr());
    view.stype = -1;
    view.itype = CHOLMOD_LONG;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    return view;
  }

  void Free() {
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
  }
};

template <typename Scalar>
CholeskyFactor<Scalar>::CholeskyFactor(const Eigen::SparseMatrix<double>& matrix)
    : made_(std::make_shared<Made>(matrix)) {
  using Index = typename Made::Index;
  const cholmod_factor& factor = *made_->factor;
  const auto integers = [](const void* begin, size_t count) {
    const Index* const from = static_cast<const Index*>(begin);
    return std::vector<int>(from, from + count);
  };
  permutation_ = integers(factor.Perm, factor.n);
  const std::vector<int> super = integers(factor.super, factor.nsuper + 1);
  const Index* const row_begin = static_cast<Index*>(factor.pi);
  const Index* const value_begin = static_cast<Index*>(factor.px);
  const double* const values = static_cast<double*>(factor.x);
  rows_ = integers(factor.s, factor.ssize);
  num_values_ = factor.xsize;
  for (size_t s = 0; s < factor.nsuper; ++s) {
    supernodes_.push_back({super[s], super[s + 1] - super[s],
                           static_cast<int>(row_begin[s + 1] - row_begin[s]),
                           static_cast<size_t>(row_begin[s]), static_cast<size_t>(value_begin[s])});
  }
  if constexpr (std::is_same_v<Scalar, double>) {
    values_ = values;
  } else {
    own_values_.assign(values, values + num_values_);
    values_ = own_values_.data();
    made_.reset();
  }
  GrowBranches();
}

template <>
void CholeskyFactor<double>::Update(const Eigen::SparseMatrix<double>& matrix) {
  made_->Factorize(matrix);
  values_ = static_cast<double*>(made_->factor->x);
}

template <typename Scalar>
void CholeskyFactor<Scalar>::GrowBranches() {
  const int num_nodes = static_cast<int>(supernodes_.size());
  std::vector<int> node_of_row(permutation_.size());
  for (int s = 0; s < num_nodes; ++s) {
    std::fill_n(node_of_row.begin() + supernodes_[s].begin, supernodes_[s].width, s);
  }
  const std::vector<int> branch_of = AssignBranches(node_of_row);
  branches_.resize(*std::max_element(branch_of.begin(), branch_of.end()) + 1);
  for (int s = 0; s < num_nodes; ++s) {
    (branch_of[s] < 0 ? trunk_ : branches_[branch_of[s]].nodes).push_back(s);
  }
  for (const Supernode& node : supernodes_) {
    greatest_height_ = std::max(greatest_height_, node.height);
  }
  work_rows_ = Size();
  branch_rows_ = rows_;
  for (size_t b = 0; b < branches_.size(); ++b) {
    GatherOutsideRows([&](int row) { return branch_of[node_of_row[row]] != static_cast<int>(b); },
                      &branches_[b]);
  }
}

// Per supernode, the index of its branch, or -1 in the trunk.
template <typename Scalar>
std::vector<int> CholeskyFactor<Scalar>::AssignBranches(const std::vector<int>& node_of_row) const {
  const int num_nodes = static_cast<int>(supernodes_.size());
  // The parent of a supernode contains the first row below it, and has a larger index.
  std::vector<int> parent(num_nodes, -1), branch_of(num_nodes, -1), open;
  std::vector<std::vector<int>> children(num_nodes);
  std::vector<double> work(num_nodes, 0);  // of the subtree
  double total = 0;
  for (int s = 0; s < num_nodes; ++s) {
    const Supernode& node = supernodes_[s];
    const double own = static_cast<double>(node.width) * node.height;
    work[s] += own;
    total += own;
    if (node.height == node.width) {  // a root
      open.push_back(s);
      continue;
    }
    parent[s] = node_of_row[rows_[node.rows + node.width]];
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
template <typename Scalar>
template <typename IsOutside>
void CholeskyFactor<Scalar>::GatherOutsideRows(const IsOutside& is_outside, Branch* branch) {
  const auto for_rows_below = [&](const auto& body) {
    for (int s : branch->nodes) {
      const Supernode& node = supernodes_[s];
      for (int k = node.width; k < node.height; ++k) body(branch_rows_[node.rows + k]);
    }
  };
  std::vector<int>& outside = branch->outside;
  for_rows_below([&](int row) {
    if (is_outside(row)) outside.push_back(row);
  });
  std::sort(outside.begin(), outside.end());
  outside.erase(std::unique(outside.begin(), outside.end()), outside.end());
  branch->gathered = work_rows_;
  work_rows_ += static_cast<int>(outside.size());
  for_rows_below([&](int& row) {
    const auto found = std::lower_bound(outside.begin(), outside.end(), row);
    if (found != outside.end() && *found == row) {
      row = branch->gathered + static_cast<int>(found - outside.begin());
    }
  });
}

template <typename Scalar>
template <typename Task>
void CholeskyFactor<Scalar>::ForChunks(int tasks, int width, const Task& task) const {
  // A single task is split into at least two chunks, if there are enough columns, to use several
  // threads.
  const int groups = width / kColumns;
  const int chunks = std::max(tasks == 1 ? std::min(2, groups) : 1, (width + kChunk - 1) / kChunk);
  ParallelFor(tasks * chunks, [&](int i) {
    const int chunk = i % chunks, begin = groups * chunk / chunks * kColumns;
    task(i / chunks, begin, groups * (chunk + 1) / chunks * kColumns - begin);
  });
}

template <typename Scalar>
void CholeskyFactor<Scalar>::SolveLower(Scalar* x, int width) const {
  const int num_branches = static_cast<int>(branches_.size());
  ForChunks(num_branches, width, [&](int b, int begin, int count) {
    const Branch& branch = branches_[b];
    for (size_t row = 0; row < branch.outside.size(); ++row) {
      std::fill_n(x + (branch.gathered + row) * width + begin, count, Scalar(0));
    }
    for (int s : branch.nodes) {
      const Supernode& node = supernodes_[s];
      ForwardNode(node, &values_[node.values], &branch_rows_[node.rows], x + begin, width, count);
    }
  });
  ForChunks(1, width, [&](int, int begin, int count) {
    for (const Branch& branch : branches_) {
      const Scalar* from = x + static_cast<size_t>(branch.gathered) * width + begin;
      for (int row : branch.outside) {
        Scalar* const to = x + static_cast<size_t>(row) * width + begin;
        for (int c = 0; c < count; ++c) to[c] += from[c];
        from += width;
      }
    }
    for (int s : trunk_) {
      const Supernode& node = supernodes_[s];
      ForwardNode(node, &values_[node.values], &rows_[node.rows], x + begin, width, count);
    }
  });
}

template <typename Scalar>
void CholeskyFactor<Scalar>::SolveUpper(Scalar* x, int width) const {
  const auto solve = [&](const std::vector<int>& nodes, int begin, int count) {
    for (auto s = nodes.rbegin(); s != nodes.rend(); ++s) {
      const Supernode& node = supernodes_[*s];
      BackwardNode(node, &values_[node.values], &rows_[node.rows], x + begin, width, count);
    }
  };
  ForChunks(1, width, [&](int, int begin, int count) { solve(trunk_, begin, count); });
  ForChunks(static_cast<int>(branches_.size()), width,
            [&](int b, int begin, int count) { solve(branches_[b].nodes, begin, count); });
}

template <typename Scalar>
void CholeskyFactor<Scalar>::SolveLower(Scalar* x) const {
  ParallelFor(static_cast<int>(branches_.size()), [&](int b) {
    const Branch& branch = branches_[b];
    std::vector<Scalar> below(greatest_height_);
    std::fill_n(x + branch.gathered, branch.outside.size(), Scalar(0));
    for (int s : branch.nodes) {
      const Supernode& node = supernodes_[s];
      ForwardNode(node, &values_[node.values], &branch_rows_[node.rows], x, below.data());
    }
  });
  for (const Branch& branch : branches_) {
    const Scalar* from = x + branch.gathered;
    for (int row : branch.outside) x[row] += *from++;
  }
  std::vector<Scalar> below(greatest_height_);
  for (int s : trunk_) {
    const Supernode& node = supernodes_[s];
    ForwardNode(node, &values_[node.values], &rows_[node.rows], x, below.data());
  }
}

template <typename Scalar>
void CholeskyFactor<Scalar>::SolveUpper(Scalar* x) const {
  const auto solve = [&](const std::vector<int>& nodes) {
    std::vector<Scalar> below(greatest_height_);
    for (auto s = nodes.rbegin(); s != nodes.rend(); ++s) {
      const Supernode& node = supernodes_[*s];
      BackwardNode(node, &values_[node.values], &rows_[node.rows], x, below.data());
    }
  };
  solve(trunk_);
  ParallelFor(static_cast<int>(branches_.size()), [&](int b) { solve(branches_[b].nodes); });
}

template class CholeskyFactor<double>;
template class CholeskyFactor<float>;

}  // namespace shapespace::internal
