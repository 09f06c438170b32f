#include <shapespace/numerics/internal/preconditioner.h>

#include <algorithm>
#include <cmath>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/numerics/internal/padded_width.h>

namespace shapespace::internal {
namespace {

// Without a position term translations have no cost; this share of one keeps the matrix definite.
constexpr double kMinLambda = 1e-6;

}  // namespace

Eigen::SparseMatrix<double> ScalarMetric(const Metric& metric, const std::vector<Shape>& poses,
                                         int quartic_segments) {
  std::vector<Eigen::Triplet<double>> triplets;
  // Elements of the lower triangle only.
  const auto add = [&](int i, int j, double value) {
    if (i >= j) triplets.emplace_back(i, j, value);
  };
  const bool quartic = quartic_segments > 0;
  for (const auto& feature : metric.features) {
    // A sum feature is a dense row, and is left to the quasi-Newton updates.
    if (feature->IsSum()) continue;
    const int corners = feature->VerticesPerElement(), num_rows = feature->NumScalarRows();
    const bool adds_quartic = quartic && feature->As<EdgeLength>() != nullptr;
    double x[3 * Feature::kMaxVertices];
    double rows[Feature::kMaxVertices * 3 * Feature::kMaxValues];
    double block[Feature::kMaxVertices * Feature::kMaxVertices];
    for (int e = 0; e < feature->NumElements(); ++e) {
      const int* const vertices = feature->Element(e);
      const double factor = 4 * feature->Weight(e) / static_cast<double>(poses.size());
      std::fill_n(block, corners * corners, 0.0);
      for (const Shape& pose : poses) {
        feature->GatherCoordinates(e, e + 1, pose, x);
        feature->ScalarRows(1, x, rows);
        for (const double* k = rows; k != rows + corners * num_rows; k += corners) {
          for (int i = 0; i < corners; ++i) {
            for (int l = 0; l < corners; ++l) block[corners * i + l] += factor * k[i] * k[l];
          }
        }
      }
      if (adds_quartic) {
        const int p = vertices[0], q = vertices[1];
        const Eigen::Vector3d turn =
            poses.back().col(q) - poses.back().col(p) - poses.front().col(q) + poses.front().col(p);
        const double share = 2 * feature->Weight(e) * turn.squaredNorm() /
                             (static_cast<double>(quartic_segments) * quartic_segments);
        for (int k = 0; k < 4; ++k) block[k] += k % 3 == 0 ? share : -share;
      }
      for (int i = 0; i < corners; ++i) {
        for (int l = 0; l < corners; ++l) add(vertices[i], vertices[l], block[corners * i + l]);
      }
    }
  }
  const int num_vertices = metric.connectivity->NumVertices();
  for (int v = 0; v < num_vertices; ++v) {
    double diagonal = 4 * kMinLambda * metric.vertex_area(v);
    if (metric.rigid.Active()) diagonal += 4 * metric.rigid.weights(v);
    add(v, v, diagonal);
  }
  Eigen::SparseMatrix<double> matrix(num_vertices, num_vertices);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
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
