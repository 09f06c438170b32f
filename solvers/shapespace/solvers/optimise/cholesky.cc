#include <shapespace/solvers/optimise/cholesky.h>

#include <algorithm>
#include <memory>

#include <cholmod.h>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/path/energy_kernels.h>

namespace shapespace::internal {
namespace {

// A chunk of columns goes through the whole factor at once; wide enough to fill registers, narrow
// enough to keep the rows of a supernode in the nearest cache.
constexpr int kChunk = 48;

// target -= sum of four rows, each times a number.
SHAPESPACE_CLONES
void Subtract4(double* __restrict target, const double* a, const double* b, const double* c,
               const double* d, double wa, double wb, double wc, double wd, int width) {
  for (int i = 0; i < width; ++i) {
    target[i] -= wa * a[i] + wb * b[i] + wc * c[i] + wd * d[i];
  }
}

SHAPESPACE_CLONES
void Subtract1(double* __restrict target, const double* a, double wa, int width) {
  for (int i = 0; i < width; ++i) target[i] -= wa * a[i];
}

}  // namespace

Cholesky::Cholesky(const Eigen::SparseMatrix<double>& matrix) {
  struct Common : cholmod_common {
    Common() { cholmod_start(this); }
    ~Common() { cholmod_finish(this); }
  } common;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.final_ll = 1;
  common.print = 0;
  common.error_handler = nullptr;

  cholmod_sparse view = {};
  view.nrow = matrix.rows();
  view.ncol = matrix.cols();
  view.nzmax = matrix.nonZeros();
  view.p = const_cast<int*>(matrix.outerIndexPtr());
  view.i = const_cast<int*>(matrix.innerIndexPtr());
  view.x = const_cast<double*>(matrix.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = matrix.isCompressed() ? 1 : 0;
  view.nz = const_cast<int*>(matrix.innerNonZeroPtr());
  const auto free_factor = [&](cholmod_factor* factor) { cholmod_free_factor(&factor, &common); };
  const std::unique_ptr<cholmod_factor, decltype(free_factor)> factor(
      cholmod_analyze(&view, &common), free_factor);
  if (factor == nullptr || cholmod_factorize(&view, factor.get(), &common) == 0 ||
      common.status != CHOLMOD_OK) {
    throw SolverError(
        "the preconditioner's matrix is not positive definite: is a weight of the metric zero or a "
        "coordinate enormous?");
  }

  permutation_.assign(static_cast<int*>(factor->Perm), static_cast<int*>(factor->Perm) + factor->n);
  const int* const super = static_cast<int*>(factor->super);
  const int* const row_begin = static_cast<int*>(factor->pi);
  const int* const value_begin = static_cast<int*>(factor->px);
  rows_.assign(static_cast<int*>(factor->s), static_cast<int*>(factor->s) + factor->ssize);
  values_.assign(static_cast<double*>(factor->x), static_cast<double*>(factor->x) + factor->xsize);
  for (size_t s = 0; s < factor->nsuper; ++s) {
    supernodes_.push_back({super[s], super[s + 1] - super[s], row_begin[s + 1] - row_begin[s],
                           static_cast<size_t>(row_begin[s]), static_cast<size_t>(value_begin[s])});
  }
}

void Cholesky::SolveLower(double* x, int width) const {
  const int chunks = std::max({1, std::min(2, width / 8), (width + kChunk - 1) / kChunk});
  ParallelFor(chunks, [&](int chunk) {
    const int begin = width * chunk / chunks, count = width * (chunk + 1) / chunks - begin;
    const auto row = [&](int r) { return x + static_cast<size_t>(r) * width + begin; };
    for (const Supernode& node : supernodes_) {
      const double* const block = values_.data() + node.values;
      const int* const rows = rows_.data() + node.rows;
      for (int j = 0; j < node.width; ++j) {
        const double* const column = block + static_cast<size_t>(j) * node.height;
        double* const source = row(node.begin + j);
        const double inverse = 1 / column[j];
        for (int i = 0; i < count; ++i) source[i] *= inverse;
        for (int i = j + 1; i < node.width; ++i)
          Subtract1(row(node.begin + i), source, column[i], count);
      }
      for (int i = node.width; i < node.height; ++i) {
        double* const target = row(rows[i]);
        int j = 0;
        for (; j + 4 <= node.width; j += 4) {
          const double* const w = block + static_cast<size_t>(j) * node.height + i;
          Subtract4(target, row(node.begin + j), row(node.begin + j + 1), row(node.begin + j + 2),
                    row(node.begin + j + 3), w[0], w[node.height], w[2 * node.height],
                    w[3 * node.height], count);
        }
        for (; j < node.width; ++j) {
          Subtract1(target, row(node.begin + j), block[static_cast<size_t>(j) * node.height + i],
                    count);
        }
      }
    }
  });
}

void Cholesky::SolveUpper(double* x, int width) const {
  const int chunks = std::max({1, std::min(2, width / 8), (width + kChunk - 1) / kChunk});
  ParallelFor(chunks, [&](int chunk) {
    const int begin = width * chunk / chunks, count = width * (chunk + 1) / chunks - begin;
    const auto row = [&](int r) { return x + static_cast<size_t>(r) * width + begin; };
    for (auto node = supernodes_.rbegin(); node != supernodes_.rend(); ++node) {
      const double* const block = values_.data() + node->values;
      const int* const rows = rows_.data() + node->rows;
      for (int j = node->width - 1; j >= 0; --j) {
        const double* const column = block + static_cast<size_t>(j) * node->height;
        double* const target = row(node->begin + j);
        const auto source = [&](int i) { return row(i < node->width ? node->begin + i : rows[i]); };
        int i = j + 1;
        for (; i + 4 <= node->height; i += 4) {
          Subtract4(target, source(i), source(i + 1), source(i + 2), source(i + 3), column[i],
                    column[i + 1], column[i + 2], column[i + 3], count);
        }
        for (; i < node->height; ++i) Subtract1(target, source(i), column[i], count);
        const double inverse = 1 / column[j];
        for (int k = 0; k < count; ++k) target[k] *= inverse;
      }
    }
  });
}

}  // namespace shapespace::internal
