#include <shapespace/correspondence/detail/shell_fit.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/metric/internal/lower_block.h>
#include <shapespace/sparse/internal/solve.h>

namespace shapespace::internal {
namespace {

// Penalty on the motion of vertices in an iteration; keeps the system definite.
constexpr double kMotion = 1e-6;
constexpr int kHalvings = 8;
// No vertex moves farther in a step, as a share of the root of the area. A triangle that hangs by
// one vertex or two has nothing to hold it but its strain, whose logarithm lets it leave, farther
// with each step, and the steps of all others are shortened for it.
constexpr double kFarthestStep = 0.3;

MetricOptions ShellMetric(double bending) {
  MetricOptions options = MetricOptions::Strain();
  options.lambda = kMotion;
  options.bending = bending;
  return options;
}

Eigen::Vector3d Offset(const PointToPlaneTerm& term, const Shape& shape) {
  Eigen::Vector3d offset = -term.point;
  for (int k = 0; k < 3; ++k) offset += term.barycentric(k) * shape.col(term.vertices(k));
  return offset;
}

}  // namespace

ShellFit::ShellFit(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
                   const std::vector<int>& held, double bending, double proportions)
    : metric_(FreezeMetric(ShellMetric(bending), connectivity, {rest})),
      map_(metric_),
      stretch_(connectivity, rest / metric_->unit, proportions),
      is_held_(rest.cols(), false),
      wanted_(map_.Values(rest / metric_->unit)) {
  for (const int v : held) is_held_[v] = true;
}

void ShellFit::SetWanted(const Shape& shape) {
  for (size_t i = 0; i < metric_->features.size(); ++i) {
    const int begin = map_.FirstValue(i);
    if (const auto* positions = metric_->features[i]->As<PositionFeature>()) {
      for (int v = 0; v < shape.cols(); ++v) {
        wanted_.segment<3>(begin + 3 * v) = std::sqrt(positions->weights(v)) * shape.col(v);
      }
    } else if (const auto* strains = metric_->features[i]->As<TriangleStrain>()) {
      const auto triangles = stretch_.StretchedTriangles(shape);
      for (int f = 0; f < triangles.cols(); ++f) {
        double x[TriangleStrain::kInputs];
        std::copy_n(triangles.col(f).data(), 9, x);
        std::copy_n(strains->numbers.col(f).data(), TriangleStrain::kNumbers, x + 9);
        Eigen::Vector3d strain;
        (*strains)(x, strain.data());
        wanted_.segment<3>(begin + 3 * f) = std::sqrt(strains->weights(f)) * strain;
      }
    }
  }
}

std::vector<PointToPlaneTerm> ShellFit::InOwnUnit(std::vector<PointToPlaneTerm> terms) const {
  for (PointToPlaneTerm& term : terms) term.point /= metric_->unit;
  return terms;
}

double ShellFit::TermEnergy(const std::vector<PointToPlaneTerm>& terms, const Shape& shape) const {
  double energy = 0;
  for (const PointToPlaneTerm& term : terms) {
    const Eigen::Vector3d offset = Offset(term, shape);
    const double across = term.normal.dot(offset);
    energy += term.weight * (across * across + term.along * offset.squaredNorm());
  }
  return energy;
}

void ShellFit::AddTerms(const std::vector<PointToPlaneTerm>& terms, const Shape& shape,
                        Tangent* gradient) {
  for (const PointToPlaneTerm& term : terms) {
    const Eigen::Matrix3d stiffness = term.weight * (term.normal * term.normal.transpose() +
                                                     term.along * Eigen::Matrix3d::Identity());
    const Eigen::Vector3d force = stiffness * Offset(term, shape);
    for (int i = 0; i < 3; ++i) {
      if (term.barycentric(i) == 0) continue;
      gradient->col(term.vertices(i)) += term.barycentric(i) * force;
      for (int j = 0; j < 3; ++j) {
        const int p = term.vertices(i), q = term.vertices(j);
        if (p < q || term.barycentric(j) == 0) continue;
        const double factor = term.barycentric(i) * term.barycentric(j);
        ForLowerBlock(p, q, &matrix_,
                      [&](int a, int b, double* entry) { *entry += factor * stiffness(a, b); });
      }
    }
  }
}

double ShellFit::Energy(const std::vector<PointToPlaneTerm>& terms, const Shape& user_shape) {
  const Shape shape = user_shape / metric_->unit;
  SetWanted(shape);
  return (map_.Values(shape) - wanted_).squaredNorm() + TermEnergy(InOwnUnit(terms), shape);
}

double ShellFit::Step(const std::vector<PointToPlaneTerm>& user_terms, Shape* user_shape) {
  const double unit = metric_->unit;
  const Shape shape = *user_shape / unit;
  const std::vector<PointToPlaneTerm> terms = InOwnUnit(user_terms);

  SetWanted(shape);
  const Eigen::VectorXd off = map_.Values(shape) - wanted_;
  const double energy = off.squaredNorm() + TermEnergy(terms, shape);
  const FeatureDerivative derivative = map_.Derivative(shape);
  if (matrix_.rows() == 0) {
    matrix_ = derivative.MetricMatrix();
  } else {
    derivative.UpdateMetricMatrix(&matrix_);
  }
  Tangent gradient = derivative.TransposeTimes(off);
  AddTerms(terms, shape, &gradient);
  for (int column = 0; column < matrix_.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix_, column); entry; ++entry) {
      const auto row = static_cast<int>(entry.row());
      if (is_held_[row / 3] || is_held_[column / 3]) entry.valueRef() = row == column ? 1 : 0;
    }
  }
  for (int v = 0; v < shape.cols(); ++v) {
    if (is_held_[v]) gradient.col(v).setZero();
  }
  if (factor_ == nullptr) {
    factor_ = std::make_unique<Cholesky>(matrix_);
  } else {
    factor_->Update(matrix_);
  }
  const Eigen::VectorXd solution = Solve(*factor_, gradient.reshaped());
  Shape step = solution.reshaped(3, shape.cols());
  const double motion = std::sqrt(metric_->vertex_area.dot(step.colwise().squaredNorm()));
  for (auto own : step.colwise()) own *= std::min(1.0, kFarthestStep / own.norm());

  double factor = 1;
  for (int halving = 0; halving <= kHalvings; ++halving, factor *= 0.5) {
    const Shape trial = shape - factor * step;
    if ((map_.Values(trial) - wanted_).squaredNorm() + TermEnergy(terms, trial) < energy) {
      *user_shape = unit * trial;
      for (int v = 0; v < shape.cols(); ++v) {
        if (is_held_[v]) user_shape->col(v) = unit * shape.col(v);
      }
      metric_->connectivity->CopyToTwins(user_shape);
      break;
    }
  }
  return motion;
}

}  // namespace shapespace::internal
