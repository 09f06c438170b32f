#include <shapespace/exploration/embedding.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <Eigen/Eigenvalues>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/random.h>
#include <shapespace/summary/internal/check_options.h>

namespace shapespace {
namespace {

// Of an eigenvector, whose sign is arbitrary: the coordinate of the greatest absolute value becomes
// positive.
void PointToTheFarthest(Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> coordinates) {
  Eigen::Index farthest;
  coordinates.cwiseAbs().maxCoeff(&farthest);
  if (coordinates(farthest) < 0) coordinates *= -1;
}

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

// Majorisation finds a local minimum. It starts from the plane of the two principal directions, and
// from this number of random planes: of those of 4 to 12 points at equal distances, which have no
// principal directions, a third or more lead to the least stress.
constexpr int kRandomPlanes = 16;

// The result of a random plane is preferred if its stress is less by more than this share.
constexpr double kLessStress = 1e-6;

// Axes along which points extend by less than this share of the longest are rounding.
constexpr double kLeastExtent = 1e-6;

// Coordinates along the principal directions, a row for each, of points with these distances, as
// far as there are such points; at least two rows. Each axis points to the side on which the points
// extend farther, so that the order of the points does not matter.
Eigen::MatrixXd ClassicalScaling(const Eigen::MatrixXd& distances) {
  const Eigen::Index n = distances.rows();
  const Eigen::MatrixXd squares = distances.array().square();
  const Eigen::VectorXd mean = squares.rowwise().mean();
  const Eigen::MatrixXd products =
      -0.5 * ((squares.colwise() - mean).rowwise() - mean.transpose()).array() - 0.5 * mean.mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(products);
  const Eigen::VectorXd values = solver.eigenvalues().reverse();
  const auto axes = (values.array() > kLeastExtent * kLeastExtent * values(0)).count();
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(2, axes), n);
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    points.row(axis) =
        std::sqrt(values(axis)) * solver.eigenvectors().col(n - 1 - axis).transpose();
    PointToTheFarthest(points.row(axis));
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

// Aligns points with their principal axes.
Eigen::Matrix2Xd OnPrincipalAxes(Eigen::Matrix2Xd points) {
  points.colwise() -= points.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(points * points.transpose());
  points = axes.eigenvectors().rowwise().reverse().transpose() * points;
  for (int axis = 0; axis < 2; ++axis) PointToTheFarthest(points.row(axis));
  return points;
}

// Stress majorisation from given points.
Embedding Majorise(const Eigen::Matrix2Xd& start, const Eigen::MatrixXd& distances,
                   const EmbeddingOptions& options) {
  constexpr double kNoStress = 1e-14;  // at the level of rounding
  Embedding result;
  result.points = start;
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
  return result;
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
  const Eigen::MatrixXd points = ClassicalScaling(distances);
  Embedding result = Majorise(points.topRows(2), distances, options);
  std::mt19937_64 random(1);
  Eigen::MatrixXd plane(2, points.rows());
  for (int i = 0; i < kRandomPlanes && points.rows() > 2; ++i) {
    for (double& x : plane.reshaped()) x = 2 * internal::Uniform(&random) - 1;
    Embedding other = Majorise(plane * points, distances, options);
    if (other.stress < (1 - kLessStress) * result.stress) result = std::move(other);
  }
  result.points = OnPrincipalAxes(std::move(result.points));
  return result;
}

}  // namespace shapespace
