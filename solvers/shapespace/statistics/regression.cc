#include <shapespace/statistics/regression.h>

#include <cmath>

#include <Eigen/QR>

#include <shapespace/base/error.h>
#include <shapespace/statistics/detail/permutations.h>
#include <shapespace/statistics/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

// A chance value counts as large as the true one if it is so but for rounding.
constexpr double kRoundingOfTests = 1e-9;

// Weighted least squares on fixed scalars, which keep their weights whatever data they are given.
class LinearFit {
 public:
  // The scalars have mean 0 and variance 1, so that the rank does not depend on their units.
  LinearFit(const Eigen::MatrixXd& design, const Eigen::VectorXd& weights)
      : design_(design), roots_(weights.cwiseSqrt()), solver_(roots_.asDiagonal() * design) {
    solver_.setThreshold(1e-10);
  }

  Eigen::MatrixXd Coefficients(const Eigen::MatrixXd& data) const {
    return solver_.solve(roots_.asDiagonal() * data);
  }
  Eigen::MatrixXd Residuals(const Eigen::MatrixXd& data) const {
    return data - design_ * Coefficients(data);
  }
  // The weighted sum of squares that the fit leaves.
  double Left(const Eigen::MatrixXd& data) const {
    return (roots_.asDiagonal() * Residuals(data)).squaredNorm();
  }
  bool HasFullRank() const { return solver_.rank() == design_.cols(); }

 private:
  const Eigen::MatrixXd design_;
  const Eigen::VectorXd roots_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver_;
};

// The rows in the order.
Eigen::MatrixXd Permuted(const Eigen::MatrixXd& rows, const std::vector<int>& order) {
  Eigen::MatrixXd permuted(rows.rows(), rows.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) permuted.row(i) = rows.row(order[i]);
  return permuted;
}

// How likely is it that scalars explain as much as they do of `data` if the poses' residuals of the
// fit of `others` are exchanged. Weights stay with the scalars: they say how much a pose counts and
// not how much it varies, so that residuals times their roots would not be exchangeable.
double PValue(const LinearFit& all, const LinearFit& others, const Eigen::MatrixXd& data,
              const PermutationOptions& options) {
  const auto ratio = [&](const Eigen::MatrixXd& values) {
    return all.Left(values) / others.Left(values);
  };
  const double truth = ratio(data);
  const Eigen::MatrixXd residuals = others.Residuals(data);
  const Eigen::MatrixXd fitted = data - residuals;
  internal::Permutations permutations(static_cast<int>(data.rows()), options.seed);
  int as_good = 1;
  for (int i = 0; i < options.permutations; ++i) {
    if (ratio(fitted + Permuted(residuals, permutations.Next())) <=
        truth * (1 + kRoundingOfTests)) {
      ++as_good;
    }
  }
  return static_cast<double>(as_good) / (options.permutations + 1);
}

Eigen::MatrixXd WithoutColumn(const Eigen::MatrixXd& matrix, Eigen::Index column) {
  Eigen::MatrixXd rest(matrix.rows(), matrix.cols() - 1);
  rest << matrix.leftCols(column), matrix.rightCols(matrix.cols() - 1 - column);
  return rest;
}

}  // namespace

void PermutationOptions::Validate() const {
  if (permutations < 1) throw InvalidOptions("permutations", "must be 1 or more");
}

Regression Regress(const PoseModes& modes, const std::vector<std::string>& scalars,
                   const Eigen::MatrixXd& values, const PermutationOptions& options) {
  options.Validate();
  modes.Validate();
  if (modes.NumModes() == 0) {
    throw InvalidOptions("modes", "there are none that scalars could explain");
  }
  const auto count = static_cast<Eigen::Index>(scalars.size());
  if (values.rows() != modes.NumPoses() || values.cols() != count || count == 0) {
    throw InvalidOptions("scalars", "must be one or more, with a value for each of the " +
                                        std::to_string(modes.NumPoses()) + " poses");
  }
  if (!values.allFinite()) throw InvalidOptions("scalars", "must be finite");
  if (modes.NumPoses() < count + 2) {
    throw InvalidOptions("scalars", "are too many for " + std::to_string(modes.NumPoses()) +
                                        " poses; at least two poses more are needed");
  }
  Regression result;
  result.scalars = scalars;
  result.least = values.colwise().minCoeff();
  result.most = values.colwise().maxCoeff();
  result.mean = values.transpose() * modes.weights;
  // Of mean 0 and variance 1: the first column is the intercept.
  const Eigen::MatrixXd centred = values.rowwise() - result.mean.transpose();
  const Eigen::VectorXd deviations =
      (centred.array().square().matrix().transpose() * modes.weights).cwiseSqrt();
  Eigen::MatrixXd design(values.rows(), count + 1);
  design.col(0).setOnes();
  for (Eigen::Index s = 0; s < count; ++s) {
    if (!(result.most(s) - result.least(s) > 1e-12 * values.col(s).cwiseAbs().maxCoeff())) {
      throw InvalidOptions("scalars", scalars[s] + " is the same for all poses");
    }
    design.col(s + 1) = centred.col(s) / deviations(s);
  }
  const LinearFit fit(design, modes.weights);
  if (!fit.HasFullRank()) {
    throw InvalidOptions("scalars", "follow from each other; leave one out");
  }
  // Coordinates in the unit of displacements, so that all modes' variances can be added.
  const Eigen::VectorXd scales = modes.variances.cwiseSqrt();
  const Eigen::MatrixXd data = modes.Coordinates() * scales.asDiagonal();
  const Eigen::MatrixXd coefficients = fit.Coefficients(data) * scales.cwiseInverse().asDiagonal();
  result.slopes =
      coefficients.bottomRows(count).transpose() * deviations.cwiseInverse().asDiagonal();
  result.intercept = coefficients.row(0).transpose() - result.slopes * result.mean;
  const LinearFit constant(design.leftCols(1), modes.weights);
  result.r_squared = 1 - fit.Left(data) / constant.Left(data);
  result.p_value = PValue(fit, constant, data, options);
  for (Eigen::Index s = 0; s < count; ++s) {
    const LinearFit others(WithoutColumn(design, s + 1), modes.weights);
    result.p_values.push_back(PValue(fit, others, data, options));
  }
  return result;
}

Eigen::VectorXd Regression::CoordinatesAt(const Eigen::VectorXd& values) const {
  if (values.size() != slopes.cols() || !values.allFinite()) {
    throw InvalidOptions("values", "must be " + std::to_string(slopes.cols()) +
                                       " finite numbers, one for each scalar");
  }
  return intercept + slopes * values;
}

std::string Regression::FullReport() const {
  std::string text = internal::Format("The scalars explain %.1f%% of the variance (p = %.4f).\n",
                                      100 * r_squared, p_value);
  for (size_t s = 0; s < scalars.size(); ++s) {
    text +=
        scalars[s] + internal::Format(" (%.6g to %.6g): p = %.4f", least(s), most(s), p_values[s]);
    text += "; per unit, in standard deviations of the modes:";
    for (Eigen::Index k = 0; k < slopes.rows(); ++k)
      text += internal::Format(" %.4g", slopes(k, s));
    text += '\n';
  }
  return text;
}

std::string Regression::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
