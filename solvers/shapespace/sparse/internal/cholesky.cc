#include <shapespace/sparse/internal/cholesky.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <string>
#include <type_traits>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/clones.h>
#include <shapespace/base/parallel.h>
#include <shapespace/sparse/detail/multifrontal.h>

namespace shapespace::internal {
namespace {

// Number of columns that are solved together with one pass over the factor: large enough to
// amortise reading it, and small enough to keep the rows of a supernode in the L1 cache.
constexpr int kChunk = 48;

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

// The vector at an address. In templates, clang drops the attributes above, and would take the
// vector to be aligned.
#if defined(__clang__)
template <typename Vector>
struct __attribute__((packed, may_alias)) Packed {
  Vector vector;
};
template <typename Vector>
using InMemory = std::conditional_t<std::is_const_v<Vector>,
                                    const Packed<std::remove_const_t<Vector>>, Packed<Vector>>;
#define SHAPESPACE_VECTOR_AT(Vector, address) (reinterpret_cast<InMemory<Vector>*>(address)->vector)
#else
#define SHAPESPACE_VECTOR_AT(Vector, address) (*reinterpret_cast<Vector*>(address))
#endif

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
      for (int c = 0; c < kVectors; ++c)
        tile[r][c] -= f * SHAPESPACE_VECTOR_AT(const Vector, from + c);
    }
  }
}

template <typename Vector, int kRows, int kVectors, typename Target>
SHAPESPACE_INLINE void Load(Vector (&tile)[kRows][kVectors], const Target& target) {
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kVectors; ++c) {
      tile[r][c] =
          SHAPESPACE_VECTOR_AT(const Vector, reinterpret_cast<const Vector*>(target(r)) + c);
    }
  }
}

template <typename Vector, int kRows, int kVectors, typename Target>
SHAPESPACE_INLINE void Store(const Vector (&tile)[kRows][kVectors], const Target& target) {
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kVectors; ++c) {
      SHAPESPACE_VECTOR_AT(Vector, reinterpret_cast<Vector*>(target(r)) + c) = tile[r][c];
    }
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
      sums[k] += SHAPESPACE_VECTOR_AT(const Full, a + i + k * kFull) *
                 SHAPESPACE_VECTOR_AT(const Full, x + i + k * kFull);
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

}  // namespace

template <typename Scalar>
CholeskyFactor<Scalar>::CholeskyFactor(const Eigen::SparseMatrix<double>& matrix, int group)
    : elimination_(std::make_shared<const Elimination>(matrix, group)) {
  Update(matrix);
}

template <typename Scalar>
void CholeskyFactor<Scalar>::Update(const Eigen::SparseMatrix<double>& matrix) {
  const size_t count = elimination_->num_values;
  bool definite;
  try {
    if (!values_) values_.reset(new Scalar[count]);
    definite = FactorMultifrontal(*elimination_, matrix, values_.get());
  } catch (const std::bad_alloc&) {
    throw SolverError("memory ran out in factoring a matrix of " + std::to_string(matrix.rows()) +
                      " unknowns, which needs " +
                      std::to_string(std::lround(sizeof(Scalar) * count / 1e6)) +
                      " MB; use a mesh of fewer vertices, or more memory");
  }
  if (!definite) {
    throw SolverError(
        "the preconditioner's matrix is not positive definite: a weight of the metric is zero, a "
        "coordinate is enormous, or weights, stiffness or sizes of triangles differ too much for "
        "its precision");
  }
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
  const Elimination& elimination = *elimination_;
  const int num_branches = static_cast<int>(elimination.branches.size());
  ForChunks(num_branches, width, [&](int b, int begin, int count) {
    const Branch& branch = elimination.branches[b];
    for (size_t row = 0; row < branch.outside.size(); ++row) {
      std::fill_n(x + (branch.gathered + row) * width + begin, count, Scalar(0));
    }
    for (int s : branch.nodes) {
      const Supernode& node = elimination.supernodes[s];
      ForwardNode(node, &values_[node.values], &elimination.branch_rows[node.rows], x + begin,
                  width, count);
    }
  });
  ForChunks(1, width, [&](int, int begin, int count) {
    for (const Branch& branch : elimination.branches) {
      const Scalar* from = x + static_cast<size_t>(branch.gathered) * width + begin;
      for (int row : branch.outside) {
        Scalar* const to = x + static_cast<size_t>(row) * width + begin;
        for (int c = 0; c < count; ++c) to[c] += from[c];
        from += width;
      }
    }
    for (int s : elimination.trunk) {
      const Supernode& node = elimination.supernodes[s];
      ForwardNode(node, &values_[node.values], &elimination.rows[node.rows], x + begin, width,
                  count);
    }
  });
}

template <typename Scalar>
void CholeskyFactor<Scalar>::SolveUpper(Scalar* x, int width) const {
  const Elimination& elimination = *elimination_;
  const auto solve = [&](const std::vector<int>& nodes, int begin, int count) {
    for (auto s = nodes.rbegin(); s != nodes.rend(); ++s) {
      const Supernode& node = elimination.supernodes[*s];
      BackwardNode(node, &values_[node.values], &elimination.rows[node.rows], x + begin, width,
                   count);
    }
  };
  ForChunks(1, width, [&](int, int begin, int count) { solve(elimination.trunk, begin, count); });
  ForChunks(static_cast<int>(elimination.branches.size()), width, [&](int b, int begin, int count) {
    solve(elimination.branches[b].nodes, begin, count);
  });
}

template <typename Scalar>
void CholeskyFactor<Scalar>::SolveLower(Scalar* x) const {
  const Elimination& elimination = *elimination_;
  ParallelFor(static_cast<int>(elimination.branches.size()), [&](int b) {
    const Branch& branch = elimination.branches[b];
    std::vector<Scalar> below(elimination.greatest_height);
    std::fill_n(x + branch.gathered, branch.outside.size(), Scalar(0));
    for (int s : branch.nodes) {
      const Supernode& node = elimination.supernodes[s];
      ForwardNode(node, &values_[node.values], &elimination.branch_rows[node.rows], x,
                  below.data());
    }
  });
  for (const Branch& branch : elimination.branches) {
    const Scalar* from = x + branch.gathered;
    for (int row : branch.outside) x[row] += *from++;
  }
  std::vector<Scalar> below(elimination.greatest_height);
  for (int s : elimination.trunk) {
    const Supernode& node = elimination.supernodes[s];
    ForwardNode(node, &values_[node.values], &elimination.rows[node.rows], x, below.data());
  }
}

template <typename Scalar>
void CholeskyFactor<Scalar>::SolveUpper(Scalar* x) const {
  const Elimination& elimination = *elimination_;
  const auto solve = [&](const std::vector<int>& nodes) {
    std::vector<Scalar> below(elimination.greatest_height);
    for (auto s = nodes.rbegin(); s != nodes.rend(); ++s) {
      const Supernode& node = elimination.supernodes[*s];
      BackwardNode(node, &values_[node.values], &elimination.rows[node.rows], x, below.data());
    }
  };
  solve(elimination.trunk);
  ParallelFor(static_cast<int>(elimination.branches.size()),
              [&](int b) { solve(elimination.branches[b].nodes); });
}

template class CholeskyFactor<double>;
template class CholeskyFactor<float>;

}  // namespace shapespace::internal
