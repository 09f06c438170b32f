#include <shapespace/deformation/detail/free_end_preconditioner.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/minimise/internal/preconditioner.h>
#include <shapespace/sparse/internal/padded_width.h>

namespace shapespace::internal {
namespace {

// The factor of `scalar` + diag(`diagonal`), with the prescribed vertices decoupled.
std::shared_ptr<const CholeskyFactor<float>> FactorOf(const Eigen::SparseMatrix<double>& scalar,
                                                      const Eigen::VectorXd& diagonal,
                                                      const std::vector<char>& given) {
  Eigen::SparseMatrix<double> matrix = scalar;
  double* const values = matrix.valuePtr();
  for (int column = 0; column < matrix.cols(); ++column) {
    for (int k = matrix.outerIndexPtr()[column]; k < matrix.outerIndexPtr()[column + 1]; ++k) {
      const int row = matrix.innerIndexPtr()[k];
      if (row == column) {
        values[k] += diagonal(column);
      } else if (given[row] || given[column]) {
        values[k] = 0;
      }
    }
  }
  return std::make_shared<const CholeskyFactor<float>>(CholeskyFactor<double>(matrix));
}

std::vector<char> Marks(int size, const std::vector<int>& vertices) {
  std::vector<char> marks(size, 0);
  for (int v : vertices) marks[v] = 1;
  return marks;
}

// Per vertex, its row in the factor.
std::vector<int> Places(const CholeskyFactor<float>& factor) {
  std::vector<int> handle_positions(factor.Size());
  for (int i = 0; i < factor.Size(); ++i) handle_positions[factor.Permutation()[i]] = i;
  return handle_positions;
}

}  // namespace

FreeEndFactors::FreeEndFactors(std::shared_ptr<const Metric> metric, Shape rest,
                               PositionConstraints constraints)
    : metric_(std::move(metric)),
      rest_(std::move(rest)),
      constraints_(std::move(constraints)),
      scalar_(ScalarMetric(*metric_, {rest_}, 0)) {
  const int num_vertices = static_cast<int>(rest_.cols());
  given_ = Marks(num_vertices, constraints_.prescribed);
  between_ = FactorOf(scalar_, Eigen::VectorXd::Zero(num_vertices), given_);
  for (int v : constraints_.prescribed_last) given_[v] = 1;
  const bool same = constraints_.prescribed_last.empty() && constraints_.penalty.isZero(0);
  end_ = same ? between_ : FactorOf(scalar_, 2 * constraints_.penalty, given_);
}

void FreeEndFactors::SolveAndAdd(const std::vector<Eigen::MatrixXd>& rights,
                                 std::vector<Tangent>* shapes) const {
  const int size = end_->Size(), count = static_cast<int>(rights.size());
  const int width = PaddedWidth<float>(3 * count);
  const std::vector<int> handle_positions = Places(*end_);
  std::vector<float> work(static_cast<size_t>(end_->WorkRows()) * width, 0.0f);
  // Scale to numbers of the order of 1, which are safe in single precision.
  std::vector<double> units(count);
  for (int i = 0; i < count; ++i) {
    units[i] = rights[i].cwiseAbs().maxCoeff();
    if (units[i] == 0) units[i] = 1;
  }
  ForIndices(size, [&](int v) {
    if (given_[v]) return;
    float* const at = &work[static_cast<size_t>(handle_positions[v]) * width];
    for (int k = 0; k < 3 * count; ++k) {
      at[k] = static_cast<float>(rights[k / 3](v, k % 3) / units[k / 3]);
    }
  });
  end_->SolveLower(work.data(), width);
  end_->SolveUpper(work.data(), width);
  ForIndices(size, [&](int v) {
    if (given_[v]) return;
    const float* const at = &work[static_cast<size_t>(handle_positions[v]) * width];
    for (int k = 0; k < 3 * count; ++k) (*shapes)[k / 3](k % 3, v) += units[k / 3] * at[k];
  });
}

std::vector<Tangent> FreeEndFactors::Extend(const std::vector<Tangent>& ways) const {
  const int size = end_->Size();
  std::vector<Tangent> result(ways.size(), Tangent::Zero(3, size));
  std::vector<Eigen::MatrixXd> rights;
  for (size_t i = 0; i < ways.size(); ++i) {
    for (int v = 0; v < size; ++v) {
      if (given_[v]) result[i].col(v) = ways[i].col(v);
    }
    rights.push_back(-(scalar_.selfadjointView<Eigen::Lower>() * result[i].transpose()));
    rights.back() += 2 * constraints_.penalty.asDiagonal() * ways[i].transpose();
  }
  SolveAndAdd(rights, &result);
  return result;
}

void FreeEndFactors::Integrate(const std::vector<std::vector<Eigen::Matrix3d>>& gradients,
                               std::vector<Shape>* shapes) const {
  std::vector<Eigen::MatrixXd> rights(shapes->size(), Eigen::MatrixXd::Zero(rest_.cols(), 3));
  const double stiffest = StiffestElement(*metric_, {rest_});
  for (const auto& feature : metric_->features) {
    if (!feature->IsRigidInvariant() || feature->IsSum()) continue;
    const int corners = feature->VerticesPerElement(), num_rows = feature->NumScalarRows();
    const int num_elements = feature->NumElements();
    // Of all elements, one after the other.
    std::vector<double> x(static_cast<size_t>(feature->InputsPerElement()) * num_elements);
    Eigen::MatrixXd k(corners, num_rows * num_elements);
    feature->GatherCoordinates(0, num_elements, rest_, x.data());
    feature->ScalarRows(num_elements, x.data(), k.data());
    ParallelFor(static_cast<int>(shapes->size()), [&](int i) {
      Eigen::Matrix3Xd off_vertices(3, corners);
      Eigen::MatrixXd off(num_rows, 3);
      for (int e = 0; e < num_elements; ++e) {
        const int* const vertices = feature->Element(e);
        const auto own = k.middleCols(num_rows * e, num_rows);
        Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
        for (int c = 0; c < corners; ++c) gradient += gradients[i][vertices[c]] / corners;
        for (int c = 0; c < corners; ++c) {
          off_vertices.col(c) = gradient * rest_.col(vertices[c]) - (*shapes)[i].col(vertices[c]);
        }
        const double stiffness = 4 * feature->Weight(e) * own.squaredNorm();
        const double weight = 4 * feature->Weight(e) * std::min(1.0, stiffest / stiffness);
        off.noalias() = own.transpose().lazyProduct(off_vertices.transpose());
        for (int c = 0; c < corners; ++c) {
          rights[i].row(vertices[c]) += weight * own.row(c).lazyProduct(off);
        }
      }
    });
  }
  SolveAndAdd(rights, shapes);
}

FreeEndPreconditioner::FreeEndPreconditioner(const FreeEndFactors& factors,
                                             const PathEnergy& energy)
    : factors_(factors),
      energy_(energy),
      between_width_(PaddedWidth<float>(3 * energy.Inner())),
      end_width_(PaddedWidth<float>(3)),
      between_place_(Places(*factors.between_)),
      end_place_(Places(*factors.end_)),
      prescribed_(Marks(factors.end_->Size(), factors.constraints_.prescribed)),
      between_work_(static_cast<size_t>(factors.between_->WorkRows()) * between_width_),
      end_work_(static_cast<size_t>(factors.end_->WorkRows()) * end_width_) {}

void FreeEndPreconditioner::Apply(const double* gradient, double unit, double* result) {
  const int n = energy_.Inner(), stride = energy_.Stride(), size = factors_.end_->Size();
  const double scale = 1 / unit, root = 1 / std::sqrt(static_cast<double>(n));
  // The derivative with respect to a difference y_t is the sum of the gradient over all later
  // times. Its mean over t, in the orthonormal direction (1, ..., 1) / sqrt n, is for the factor
  // `end_`; the rest for `between_`.
  ForIndices(size, [&](int v) {
    const double* const g = gradient + 3 * static_cast<size_t>(energy_.Row(v)) * stride;
    float* const end = &end_work_[static_cast<size_t>(end_place_[v]) * end_width_];
    float* const between = &between_work_[static_cast<size_t>(between_place_[v]) * between_width_];
    std::fill(end, end + end_width_, 0.0f);
    std::fill(between, between + between_width_, 0.0f);
    if (prescribed_[v]) return;
    for (int axis = 0; axis < 3; ++axis) {
      double later = 0, sum = 0;
      for (int t = n - 1; t >= 0; --t) {
        later += scale * g[axis * stride + t];
        sum += later;
      }
      if (!factors_.given_[v]) end[axis] = static_cast<float>(sum * root);
      later = 0;
      for (int t = n - 1; t >= 0; --t) {
        later += scale * g[axis * stride + t];
        between[axis * n + t] = static_cast<float>(later - sum / n);
      }
    }
  });
  factors_.end_->SolveLower(end_work_.data(), end_width_);
  factors_.end_->SolveUpper(end_work_.data(), end_width_);
  if (n > 1) {
    factors_.between_->SolveLower(between_work_.data(), between_width_);
    factors_.between_->SolveUpper(between_work_.data(), between_width_);
  }
  ForIndices(size, [&](int v) {
    double* const out = result + 3 * static_cast<size_t>(energy_.Row(v)) * stride;
    const float* const end = &end_work_[static_cast<size_t>(end_place_[v]) * end_width_];
    const float* const between =
        &between_work_[static_cast<size_t>(between_place_[v]) * between_width_];
    std::fill(out, out + 3 * stride, 0.0);
    if (prescribed_[v]) return;
    for (int axis = 0; axis < 3; ++axis) {
      const double share = factors_.given_[v] ? 0 : end[axis] * root;
      double sum = 0;
      for (int t = 0; t < n; ++t) {
        sum += share + between[axis * n + t];
        out[axis * stride + t] = unit * sum;
      }
      if (factors_.given_[v]) out[axis * stride + n - 1] = 0;  // exactly, without rounding
    }
  });
}

}  // namespace shapespace::internal
