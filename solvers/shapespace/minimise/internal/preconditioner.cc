#include <shapespace/minimise/internal/preconditioner.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/sparse/internal/padded_width.h>

namespace shapespace::internal {
namespace {

// Without a position term translations have no cost; this share of one keeps the matrix definite.
constexpr double kMinLambda = 1e-6;

// No element is stiffer than this multiple of typical ones, since the matrix is numerically
// indefinite where its entries differ by more than numbers can show. Triangles with a height of a
// ten-thousandth of others', and hinges of them, are below it.
constexpr double kStiffest = 1e9;

// The typical stiffness of a feature is the geometric mean over so many elements.
constexpr int kSampled = 1000;

// Elements whose blocks are computed at a time, on all threads, before they are added.
constexpr int kElementsAtATime = 1 << 14;

// The lower triangle of a matrix with a row for each vertex, as a sum of elements' blocks.
class LowerTriangle {
 public:
  // With memory for the blocks of all features of a metric, and for the diagonal. A sum feature is
  // a dense row, and is left to the quasi-Newton updates.
  explicit LowerTriangle(const Metric& metric) : begin_(metric.connectivity->NumVertices() + 1, 1) {
    begin_[0] = 0;
    for (const auto& feature : metric.features) {
      if (feature->IsSum()) continue;
      const int corners = feature->VerticesPerElement();
      for (int e = 0; e < feature->NumElements(); ++e) {
        const int* const vertices = feature->Element(e);
        for (int l = 0; l < corners; ++l) {
          for (int i = 0; i < corners; ++i) begin_[vertices[l] + 1] += vertices[i] >= vertices[l];
        }
      }
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    end_.assign(begin_.begin(), begin_.end() - 1);
    entries_ = std::unique_ptr<Entry[]>(new Entry[begin_.back()]);
  }

  void Add(int row, int column, double value) { entries_[end_[column]++] = {row, value}; }

  void Add(const Feature& feature, int element, const double* block) {
    const int corners = feature.VerticesPerElement();
    const int* const vertices = feature.Element(element);
    for (int i = 0; i < corners; ++i) {
      for (int l = 0; l < corners; ++l) {
        if (vertices[i] >= vertices[l]) Add(vertices[i], vertices[l], block[corners * i + l]);
      }
    }
  }

  // Entries of one place are added in the order in which they came.
  Eigen::SparseMatrix<double> Matrix() && {
    const int size = static_cast<int>(end_.size());
    ForIndices(size, [&](int column) {
      Entry* const first = &entries_[begin_[column]];
      std::stable_sort(first, &entries_[end_[column]],
                       [](const Entry& a, const Entry& b) { return a.row < b.row; });
      Entry* last = first;
      for (const Entry* entry = first + 1; entry < &entries_[end_[column]]; ++entry) {
        if (entry->row == last->row) {
          last->value += entry->value;
        } else {
          *++last = *entry;
        }
      }
      end_[column] = last + 1 - entries_.get();
    });
    Eigen::SparseMatrix<double> matrix(size, size);
    int* const outer = matrix.outerIndexPtr();
    for (int c = 0; c < size; ++c) outer[c + 1] = outer[c] + static_cast<int>(end_[c] - begin_[c]);
    matrix.resizeNonZeros(outer[size]);
    ForIndices(size, [&](int column) {
      int at = outer[column];
      for (size_t k = begin_[column]; k < end_[column]; ++k, ++at) {
        matrix.innerIndexPtr()[at] = entries_[k].row;
        matrix.valuePtr()[at] = entries_[k].value;
      }
    });
    return matrix;
  }

 private:
  struct Entry {
    int row;
    double value;
  };
  std::vector<size_t> begin_, end_;  // of the entries of each column
  std::unique_ptr<Entry[]> entries_;
};

// What elements [begin, end) add to the matrix: each a number for every two of its vertices, row by
// row: the mean of the poses' blocks, each divided by its trace, times the geometric mean of the
// traces. An element that collapses in one pose is as stiff as it is there only close to that pose.
void ElementBlocks(const Feature& feature, int begin, int end, const std::vector<Shape>& poses,
                   int quartic_segments, double stiffest, double* blocks) {
  const int corners = feature.VerticesPerElement(), num_rows = feature.NumScalarRows();
  const int size = corners * corners;
  const size_t count = end - begin;
  std::vector<double> x(feature.InputsPerElement() * count), rows(corners * num_rows * count);
  std::vector<double> logarithms(count), counts(count), own(size);
  std::fill_n(blocks, size * count, 0.0);
  for (const Shape& pose : poses) {
    feature.GatherCoordinates(begin, end, pose, x.data());
    feature.ScalarRows(end - begin, x.data(), rows.data());
    const double* k = rows.data();
    for (size_t e = 0; e < count; ++e) {
      std::fill(own.begin(), own.end(), 0.0);
      double trace = 0;
      for (int row = 0; row < num_rows; ++row, k += corners) {
        for (int i = 0; i < corners; ++i) {
          trace += k[i] * k[i];
          for (int l = 0; l < corners; ++l) own[corners * i + l] += k[i] * k[l];
        }
      }
      if (!(trace > 0)) continue;
      logarithms[e] += std::log(trace);
      ++counts[e];
      for (int i = 0; i < size; ++i) blocks[size * e + i] += own[i] / trace;
    }
  }
  for (size_t e = 0; e < count; ++e) {
    if (counts[e] == 0) continue;
    const double stiffness =
        4 * feature.Weight(begin + static_cast<int>(e)) * std::exp(logarithms[e] / counts[e]);
    const double factor = std::min(stiffness, stiffest) / counts[e];
    for (int i = 0; i < size; ++i) blocks[size * e + i] *= factor;
  }
  if (quartic_segments == 0 || feature.As<EdgeLength>() == nullptr) return;
  for (int e = begin; e < end; ++e, blocks += 4) {
    const int p = feature.Element(e)[0], q = feature.Element(e)[1];
    const Eigen::Vector3d turn =
        poses.back().col(q) - poses.back().col(p) - poses.front().col(q) + poses.front().col(p);
    const double share = 2 * feature.Weight(e) * turn.squaredNorm() /
                         (static_cast<double>(quartic_segments) * quartic_segments);
    for (int k = 0; k < 4; ++k) blocks[k] += k % 3 == 0 ? share : -share;
  }
}

double Trace(const double* block, int corners) {
  double trace = 0;
  for (int i = 0; i < corners; ++i) trace += block[(corners + 1) * i];
  return trace;
}

}  // namespace

double StiffestElement(const Metric& metric, const std::vector<Shape>& poses) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  double typical = 0;
  for (const auto& feature : metric.features) {
    if (feature->IsSum()) continue;
    const int corners = feature->VerticesPerElement(), count = feature->NumElements();
    std::vector<double> block(corners * corners);
    double sum = 0;
    int stiff = 0;
    for (int i = 0; i < std::min(count, kSampled); ++i) {
      const int e =
          static_cast<int>(static_cast<std::int64_t>(i) * count / std::min(count, kSampled));
      ElementBlocks(*feature, e, e + 1, poses, 0, kUnlimited, block.data());
      const double trace = Trace(block.data(), corners);
      if (!(trace > 0)) continue;
      sum += std::log(trace);
      ++stiff;
    }
    if (stiff > 0) typical = std::max(typical, std::exp(sum / stiff));
  }
  return typical > 0 ? kStiffest * typical : kUnlimited;
}

Eigen::SparseMatrix<double> ScalarMetric(const Metric& metric, const std::vector<Shape>& poses,
                                         int quartic_segments) {
  const int num_vertices = metric.connectivity->NumVertices();
  LowerTriangle sums(metric);
  std::vector<double> blocks;
  const double stiffest = StiffestElement(metric, poses);
  for (const auto& feature : metric.features) {
    if (feature->IsSum()) continue;
    const int size = feature->VerticesPerElement() * feature->VerticesPerElement();
    blocks.resize(static_cast<size_t>(kElementsAtATime) * size);
    for (int first = 0; first < feature->NumElements(); first += kElementsAtATime) {
      const int count = std::min(kElementsAtATime, feature->NumElements() - first);
      ForRanges(count, [&](int begin, int end) {
        ElementBlocks(*feature, first + begin, first + end, poses, quartic_segments, stiffest,
                      &blocks[static_cast<size_t>(begin) * size]);
      });
      for (int i = 0; i < count; ++i) {
        sums.Add(*feature, first + i, &blocks[static_cast<size_t>(i) * size]);
      }
    }
  }
  for (int v = 0; v < num_vertices; ++v) {
    double diagonal = 4 * kMinLambda * metric.vertex_area(v);
    if (metric.rigid.Active()) diagonal += 4 * metric.rigid.weights(v);
    sums.Add(v, v, diagonal);
  }
  return std::move(sums).Matrix();
}

ChangeOfVariables::ChangeOfVariables(const Cholesky& factor, const PathEnergy& energy)
    : factor_(factor),
      inner_(energy.Inner()),
      stride_(energy.Stride()),
      size_(3 * factor.Size() * energy.Inner()),
      width_(PaddedWidth<double>(3 * energy.Inner())),
      work_(static_cast<size_t>(factor.WorkRows()) * width_) {
  for (int vertex : factor.Permutation()) row_.push_back(energy.Row(vertex));
  // Cholesky factor of the second difference (2 on the diagonal, -1 beside it).
  double diagonal = std::sqrt(2.0);
  for (int t = 0; t < inner_; ++t) {
    diagonal_.push_back(1 / diagonal);
    below_.push_back(-1 / diagonal);
    diagonal = std::sqrt(2 - 1 / (diagonal * diagonal));
  }
}

void ChangeOfVariables::Apply(const double* y, const double* origin, double scale,
                              double* unknowns) {
  const int count = 3 * inner_;
  ForIndices(factor_.Size(), [&](int i) {
    double* const z = &work_[static_cast<size_t>(i) * width_];
    std::copy_n(y + static_cast<size_t>(i) * count, count, z);
    std::fill(z + count, z + width_, 0.0);
  });
  factor_.SolveUpper(work_.data(), width_);
  ForIndices(factor_.Size(), [&](int i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double* const z = &work_[static_cast<size_t>(i) * width_ + axis * inner_];
      const size_t offset = (3 * static_cast<size_t>(row_[i]) + axis) * stride_;
      double later = 0;
      for (int t = inner_ - 1; t >= 0; --t) {
        later = (z[t] - below_[t] * later) * diagonal_[t];
        unknowns[offset + t] = origin[offset + t] + scale * later;
      }
      std::fill(unknowns + offset + inner_, unknowns + offset + stride_, 0.0);
    }
  });
}

void ChangeOfVariables::ApplyTranspose(const double* gradient, double scale, double* y) {
  const int count = 3 * inner_;
  ForIndices(factor_.Size(), [&](int i) {
    for (int axis = 0; axis < 3; ++axis) {
      double* const z = &work_[static_cast<size_t>(i) * width_ + axis * inner_];
      const double* const g = gradient + (3 * static_cast<size_t>(row_[i]) + axis) * stride_;
      double flow = 0;  // subdiagonal times the previous result
      for (int t = 0; t < inner_; ++t) {
        z[t] = (scale * g[t] - flow) * diagonal_[t];
        flow = below_[t] * z[t];
      }
    }
    double* const row = &work_[static_cast<size_t>(i) * width_];
    std::fill(row + count, row + width_, 0.0);
  });
  factor_.SolveLower(work_.data(), width_);
  ForIndices(factor_.Size(), [&](int i) {
    std::copy_n(&work_[static_cast<size_t>(i) * width_], count, y + static_cast<size_t>(i) * count);
  });
}

Preconditioner::Preconditioner(const CholeskyFactor<float>& factor, const PathEnergy& energy)
    : factor_(factor),
      inner_(energy.Inner()),
      stride_(energy.Stride()),
      width_(PaddedWidth<float>(3 * energy.Inner())),
      work_(static_cast<size_t>(factor.WorkRows()) * width_) {
  for (int vertex : factor.Permutation()) row_.push_back(energy.Row(vertex));
  // Pivots of the second difference (2 on the diagonal, -1 beside it): (t + 2) / (t + 1).
  for (int t = 0; t < inner_; ++t) diagonal_.push_back((t + 1.0) / (t + 2.0));
}

void Preconditioner::Apply(const double* gradient, double unit, double* result) {
  const double scale = 1 / unit;
  // Both factors of T at once, because they commute with those of S.
  ForIndices(factor_.Size(), [&](int i) {
    const double* const g = gradient + 3 * static_cast<size_t>(row_[i]) * stride_;
    float* const z = &work_[static_cast<size_t>(i) * width_];
    double forward[3] = {0, 0, 0};
    for (int t = 0; t < inner_; ++t) {
      for (int axis = 0; axis < 3; ++axis) {
        forward[axis] = (scale * g[axis * stride_ + t] + forward[axis]) * diagonal_[t];
        z[axis * inner_ + t] = static_cast<float>(forward[axis]);
      }
    }
    double later[3] = {0, 0, 0};
    for (int t = inner_ - 1; t >= 0; --t) {
      for (int axis = 0; axis < 3; ++axis) {
        later[axis] = z[axis * inner_ + t] + later[axis] * diagonal_[t];
        z[axis * inner_ + t] = static_cast<float>(later[axis]);
      }
    }
    std::fill(z + 3 * inner_, z + width_, 0.0f);
  });
  factor_.SolveLower(work_.data(), width_);
  factor_.SolveUpper(work_.data(), width_);
  ForIndices(factor_.Size(), [&](int i) {
    const float* const z = &work_[static_cast<size_t>(i) * width_];
    double* const out = result + 3 * static_cast<size_t>(row_[i]) * stride_;
    for (int axis = 0; axis < 3; ++axis) {
      double* const row = out + axis * stride_;
      for (int t = 0; t < inner_; ++t) row[t] = unit * z[axis * inner_ + t];
      std::fill(row + inner_, row + stride_, 0.0);
    }
  });
}

}  // namespace shapespace::internal
