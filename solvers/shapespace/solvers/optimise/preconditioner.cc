#include <shapespace/solvers/optimise/preconditioner.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// Without a position term translations cost nothing; this share of it keeps the matrix definite.
constexpr double kLeastLambda = 1e-6;

}  // namespace

Eigen::SparseMatrix<double> ScalarMetric(const Metric& metric, const std::vector<Shape>& poses,
                                         int quartic_segments) {
  std::vector<Eigen::Triplet<double>> triplets;
  // Elements of the lower triangle only.
  const auto add = [&](int i, int j, double value) {
    if (i >= j) triplets.emplace_back(i, j, value);
  };
  for (const AnyFeature& any : metric.features) {
    std::visit(
        [&](const auto& feature) {
          using Feature = std::decay_t<decltype(feature)>;
          // A sum over all elements is a dense row: left to the quasi-Newton updates.
          if constexpr (!Feature::kSum) {
            constexpr int kVertices = Feature::kVertices;
            for (int e = 0; e < feature.stencils.cols(); ++e) {
              Eigen::Matrix<double, kVertices, kVertices> block;
              block.setZero();
              Eigen::Vector3d x[kVertices];
              Eigen::Matrix<double, kVertices, 1> k;
              for (const Shape& pose : poses) {
                for (int i = 0; i < kVertices; ++i) x[i] = pose.col(feature.stencils(i, e));
                feature.Stencil(x, k.data());
                block += 4 * feature.weights(e) / poses.size() * k * k.transpose();
              }
              if constexpr (Feature::kTrapezoid) {
                if (quartic_segments > 0) {
                  const int p = feature.stencils(0, e), q = feature.stencils(1, e);
                  const Eigen::Vector3d turn = poses.back().col(q) - poses.back().col(p) -
                                               poses.front().col(q) + poses.front().col(p);
                  const double share = 2 * feature.weights(e) * turn.squaredNorm() /
                                       (static_cast<double>(quartic_segments) * quartic_segments);
                  block += share * Eigen::Matrix2d{{1, -1}, {-1, 1}};
                }
              }
              for (int i = 0; i < kVertices; ++i) {
                for (int j = 0; j < kVertices; ++j) {
                  add(feature.stencils(i, e), feature.stencils(j, e), block(i, j));
                }
              }
            }
          }
        },
        any);
  }
  const int num_vertices = metric.connectivity->NumVertices();
  for (int v = 0; v < num_vertices; ++v) {
    double diagonal = 4 * kLeastLambda * metric.vertex_area(v);
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
      width_((3 * energy.Inner() + Cholesky::kColumns - 1) / Cholesky::kColumns *
             Cholesky::kColumns),
      work_(static_cast<size_t>(factor.Size()) * width_) {
  for (int vertex : factor.Permutation()) row_.push_back(energy.Row(vertex));
  // Cholesky factor of the second difference (2 on the diagonal, -1 beside it).
  double diagonal = std::sqrt(2.0);
  for (int t = 0; t < inner_; ++t) {
    diagonal_.push_back(1 / diagonal);
    below_.push_back(-1 / diagonal);
    diagonal = std::sqrt(2 - 1 / (diagonal * diagonal));
  }
}

template <typename Body>
void ChangeOfVariables::ForRows(const Body& body) const {
  constexpr int kRowsPerTask = 512;
  const int num_rows = factor_.Size();
  ParallelFor((num_rows + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    const int end = std::min(num_rows, (task + 1) * kRowsPerTask);
    for (int i = task * kRowsPerTask; i < end; ++i) body(i);
  });
}

void ChangeOfVariables::Apply(const double* y, const double* origin, double scale,
                              double* unknowns) {
  const int count = 3 * inner_;
  ForRows([&](int i) {
    double* const z = &work_[static_cast<size_t>(i) * width_];
    std::copy_n(y + static_cast<size_t>(i) * count, count, z);
    std::fill(z + count, z + width_, 0.0);
  });
  factor_.SolveUpper(work_.data(), width_);
  ForRows([&](int i) {
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
  ForRows([&](int i) {
    for (int axis = 0; axis < 3; ++axis) {
      double* const z = &work_[static_cast<size_t>(i) * width_ + axis * inner_];
      const double* const g = gradient + (3 * static_cast<size_t>(row_[i]) + axis) * stride_;
      double flow = 0;  // subdiagonal times the result one time earlier
      for (int t = 0; t < inner_; ++t) {
        z[t] = (scale * g[t] - flow) * diagonal_[t];
        flow = below_[t] * z[t];
      }
    }
    double* const row = &work_[static_cast<size_t>(i) * width_];
    std::fill(row + count, row + width_, 0.0);
  });
  factor_.SolveLower(work_.data(), width_);
  ForRows([&](int i) {
    std::copy_n(&work_[static_cast<size_t>(i) * width_], count, y + static_cast<size_t>(i) * count);
  });
}

}  // namespace shapespace::internal
