#include <shapespace/sparse/detail/multifrontal.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include <shapespace/base/parallel.h>
#include <shapespace/sparse/detail/dense.h>
#include <shapespace/sparse/internal/one_thread.h>

namespace shapespace::internal {
namespace {

// Rows and columns of a tile of a front: large enough for BLAS to be efficient, and small enough
// that the large fronts have work for several threads.
constexpr int kTile = 192;

// Calls body(i) for every i < count, on several threads.
template <typename Body>
void ForTiles(int count, const Body& body) {
  if (count == 1) {  // as most fronts have; needs no function object on the heap
    body(0);
  } else {
    ParallelFor(count, body);
  }
}

int Tiles(int count) { return (count + kTile - 1) / kTile; }

// Computed in double precision, because in single precision the matrices of large meshes are not
// definite, and rounded to `Stored`.
template <typename Stored>
class Multifrontal {
 public:
  Multifrontal(const Elimination& elimination, const Eigen::SparseMatrix<double>& matrix,
               Stored* values)
      : elimination_(elimination),
        matrix_(matrix.valuePtr()),
        values_(values),
        update_matrices_(elimination.supernodes.size()),
        children_(elimination.supernodes.size()) {
    const int num_nodes = static_cast<int>(update_matrices_.size());
    for (int s = 0; s < num_nodes; ++s) {
      if (elimination.parent[s] >= 0) children_[elimination.parent[s]].push_back(s);
    }
  }

  bool Run() {
    ParallelFor(static_cast<int>(elimination_.branches.size()), [&](int b) {
      Scratch scratch;
      for (int s : elimination_.branches[b].nodes) Factor(s, &scratch);
    });
    Scratch scratch;
    for (int s : elimination_.trunk) Factor(s, &scratch);
    return definite_;
  }

 private:
  struct Scratch {
    std::vector<int> entry_index;
    std::vector<double> block;
  };

  void Factor(int s, Scratch* scratch) {
    if (!definite_) return;
    const Supernode& node = elimination_.supernodes[s];
    const size_t size = static_cast<size_t>(node.width) * node.height;
    const int below = node.height - node.width;
    scratch->block.assign(size, 0);
    double* const block = scratch->block.data();
    for (size_t e = elimination_.entry_begin[s]; e < elimination_.entry_begin[s + 1]; ++e) {
      block[elimination_.entry_place[e]] += matrix_[elimination_.entry_index[e]];
    }
    double* update = nullptr;
    if (below > 0) {
      update_matrices_[s].reset(new double[static_cast<size_t>(below) * below]);
      update = update_matrices_[s].get();
      ForTiles(Tiles(below), [&](int tile) {
        const int end = std::min(below, (tile + 1) * kTile);
        for (int j = tile * kTile; j < end; ++j) {
          std::fill(update + static_cast<size_t>(j) * below + j,
                    update + static_cast<size_t>(j + 1) * below, 0.0);
        }
      });
    }
    for (int child : children_[s]) {
      ExtendAdd(child, node, block, update, &scratch->entry_index);
      update_matrices_[child].reset();
    }
    if (!FactorBlock(node, block)) {
      definite_ = false;
      return;
    }
    std::copy_n(block, size, values_ + node.values);
    const int tiles = Tiles(below);
    const double* const lower = block + node.width;
    ForTiles(tiles * (tiles + 1) / 2, [&](int i) {
      int column = 0;
      for (; i >= tiles - column; ++column) i -= tiles - column;
      const int row = column + i;
      const int to_row = row * kTile, to_column = column * kTile;
      const int num_rows = std::min(kTile, below - to_row);
      double* const target = update + static_cast<size_t>(to_column) * below + to_row;
      if (row == column) {
        SubtractSquare(num_rows, node.width, lower + to_row, node.height, target, below);
      } else {
        SubtractProduct(num_rows, std::min(kTile, below - to_column), node.width, lower + to_row,
                        node.height, lower + to_column, node.height, target, below);
      }
    });
  }

  // Adds what `child` leaves to the front of its parent `node`.
  void ExtendAdd(int child, const Supernode& node, double* block, double* update,
                 std::vector<int>* entry_index) const {
    const Supernode& from = elimination_.supernodes[child];
    const int count = from.height - from.width, below = node.height - node.width;
    const int* const rows = &elimination_.rows[from.rows + from.width];
    const int* const front = &elimination_.rows[node.rows];
    entry_index->resize(count);  // of the child's rows in the front; both are ascending
    for (int i = 0, at = 0; i < count; ++i) {
      while (front[at] != rows[i]) ++at;
      (*entry_index)[i] = at;
    }
    const int* const index = entry_index->data();
    const double* const source = update_matrices_[child].get();
    ForTiles(Tiles(count), [&](int tile) {
      const int end = std::min(count, (tile + 1) * kTile);
      for (int j = tile * kTile; j < end; ++j) {
        const int column = index[j];
        double* const target =
            column < node.width
                ? block + static_cast<size_t>(column) * node.height
                : update + static_cast<size_t>(column - node.width) * below - node.width;
        const double* const source_column = source + static_cast<size_t>(j) * count;
        for (int i = j; i < count; ++i) target[index[i]] += source_column[i];
      }
    });
  }

  // Factors the columns of a supernode.
  static bool FactorBlock(const Supernode& node, double* block) {
    const int height = node.height;
    for (int begin = 0; begin < node.width; begin += kTile) {
      const int width = std::min(kTile, node.width - begin), end = begin + width;
      double* const columns = block + static_cast<size_t>(begin) * height;
      if (!FactorDense(width, columns + begin, height)) return false;
      ForTiles(Tiles(height - end), [&](int tile) {
        const int row = end + tile * kTile;
        SolveDenseTransposed(std::min(kTile, height - row), width, columns + begin, height,
                             columns + row, height);
      });
      const int right = Tiles(node.width - end), down = Tiles(height - end);
      ForTiles(right * down, [&](int i) {
        const int column = end + i % right * kTile, row = end + i / right * kTile;
        if (row < column) return;
        double* const target = block + static_cast<size_t>(column) * height + row;
        SubtractProduct(std::min(kTile, height - row), std::min(kTile, node.width - column), width,
                        columns + row, height, columns + column, height, target, height);
      });
    }
    return true;
  }

  const Elimination& elimination_;
  const double* const matrix_;
  Stored* const values_;
  // Of every supernode whose parent has not been factored yet: what it adds to the parent's front,
  // the lower triangle of a square matrix.
  std::vector<std::unique_ptr<double[]>> update_matrices_;
  std::vector<std::vector<int>> children_;
  std::atomic<bool> definite_ = true;
};

}  // namespace

template <typename Scalar>
bool FactorMultifrontal(const Elimination& elimination, const Eigen::SparseMatrix<double>& matrix,
                        Scalar* values) {
  const OneThread one_thread;
  return Multifrontal<Scalar>(elimination, matrix, values).Run();
}

template bool FactorMultifrontal(const Elimination&, const Eigen::SparseMatrix<double>&, double*);
template bool FactorMultifrontal(const Elimination&, const Eigen::SparseMatrix<double>&, float*);

}  // namespace shapespace::internal
