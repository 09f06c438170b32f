#include <shapespace/correspondence/detail/similarity.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include <shapespace/mesh/rigid_motion.h>

namespace shapespace::internal {
namespace {

Shape Centred(const Shape& points) { return points.colwise() - points.rowwise().mean(); }

}  // namespace

bool AreCollinear(const Shape& points) {
  constexpr double kFlat = 1e-2;
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(Centred(points));
  const auto& spread = svd.singularValues();
  return spread.size() < 2 || !(spread(1) > kFlat * spread(0));
}

SimilarityErrors CompareReflection(const Shape& from, const Shape& to) {
  const Shape a = Centred(from), b = Centred(to);
  // With the best rotation and scale the squared error is |b|^2 - trace^2 / |a|^2.
  const auto error = [&](double sign) {
    const Eigen::Matrix3d covariance = sign * a * b.transpose();
    const double trace = (ProcrustesRotation(covariance) * covariance).trace();
    return std::sqrt(std::max(0.0, 1 - trace * trace / (a.squaredNorm() * b.squaredNorm())));
  };
  return {error(1), error(-1)};
}

Shape MovedOnto(const Shape& from, const Shape& to, const Shape& shape) {
  return FitRigidMotion(from, to, Eigen::VectorXd::Ones(from.cols()))(shape);
}

}  // namespace shapespace::internal
