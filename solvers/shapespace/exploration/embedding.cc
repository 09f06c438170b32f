#include <shapespace/exploration/embedding.h>

#include <cmath>

#include <Eigen/Eigenvalues>

#include <shapespace/base/error.h>
#include <shapespace/numerics/internal/check_options.h>

namespace shapespace {
namespace {

void CheckDistances(const Eigen::MatrixXd& distances) {
  const bool fits = distances.rows() == distances.cols() && distances.rows() > 0 &&
                    distances.allFinite() && distances.minCoeff() >= 0 &&
                    distances.diagonal().isZero(0) && distances == distances.transpose();
  if (!fits) {
    throw InvalidOptions("distances",
                         "must be a square matrix, symmetric, finite, not negative and zero on its "
                         "diagonal");
  }
}

// Coordinates along the two principal directions of the points with these distances.
Eigen::Matrix2Xd ClassicalScaling(const Eigen::MatrixXd& distances) {
  const Eigen::Index n = distances.rows();
  const Eigen::MatrixXd squares = distances.array().square();
  const Eigen::VectorXd mean = squares.rowwise().mean();
  const Eigen::MatrixXd products =
      -0.5 * ((squares.colwise() - mean).rowwise() - mean.transpose()).array() - 0.5 * mean.mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(products);
  Eigen::Matrix2Xd points = Eigen::Matrix2Xd::Zero(2, n);
  for (Eigen::Index axis = 0; axis < std::min<Eigen::Index>(2, n); ++axis) {
    const double value = solver.eigenvalues()(n - 1 - axis);
    if (value > 0) {
      points.row(axis) = std::sqrt(value) * solver.eigenvectors().col(n - 1 - axis).transpose();
    }
  }
  return points;
}

double Stress(const Eigen::Matrix2Xd& points, const Eigen::MatrixXd& distances) {
  double off = 0, all = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double d = (points.col(i) - points.col(j)).norm() - distances(i, j);
      off += d * d;
      all += distances(i, j) * distances(i, j);
    }
  }
  return all > 0 ? std::sqrt(off / all) : 0;
}

// The minimum of the quadratic that majorises the stress at `points` (the Guttman transform).
Eigen::Matrix2Xd GuttmanTransform(const Eigen::Matrix2Xd& points,
                                  const Eigen::MatrixXd& distances) {
  const Eigen::Index n = points.cols();
  Eigen::Matrix2Xd result = Eigen::Matrix2Xd::Zero(2, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Vector2d difference = points.col(i) - points.col(j);
      const double length = difference.norm();
      if (length > 0) result.col(i) += distances(i, j) / length * difference;
    }
  }
  return result / static_cast<double>(n);
}

// Aligns points with their principal axes. Each axis points to the side on which the points extend
// farther, so that the result does not depend on an eigensolver's choice of signs.
Eigen::Matrix2Xd OnPrincipalAxes(Eigen::Matrix2Xd points) {
  points.colwise() -= points.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(points * points.transpose());
  points = axes.eigenvectors().rowwise().reverse().transpose() * points;
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Index farthest;
    points.row(axis).cwiseAbs().maxCoeff(&farthest);
    if (points(axis, farthest) < 0) points.row(axis) *= -1;
  }
  return points;
}

}  // namespace

void EmbeddingOptions::Validate() const {
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
}

Embedding Embed(const Eigen::MatrixXd& distances, const EmbeddingOptions& options) {
  options.Validate();
  CheckDistances(distances);
  // In units of the greatest distance, to avoid overflow and underflow of squares.
  const double unit = distances.maxCoeff();
  if (unit > 0 && unit != 1) {
    Embedding scaled = Embed(distances / unit, options);
    scaled.points *= unit;
    return scaled;
  }
  constexpr double kNoStress = 1e-14;  // at the level of rounding
  Embedding result;
  result.points = ClassicalScaling(distances);
  result.stress = Stress(result.points, distances);
  result.stresses = {result.stress};
  result.converged = result.stress <= kNoStress;
  for (int i = 0; i < options.max_iterations && !result.converged; ++i) {
    const Eigen::Matrix2Xd next = GuttmanTransform(result.points, distances);
    const double stress = Stress(next, distances);
    result.converged = !(stress < (1 - options.tolerance) * result.stress) || stress <= kNoStress;
    result.points = next;
    result.stress = stress;
    result.stresses.push_back(stress);
  }
  result.points = OnPrincipalAxes(std::move(result.points));
  return result;
}

}  // namespace shapespace
