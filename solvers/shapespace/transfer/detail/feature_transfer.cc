#include <shapespace/transfer/detail/feature_transfer.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

namespace shapespace::internal {

FeatureTransfer::FeatureTransfer(std::shared_ptr<const Metric> metric, const Shape& source,
                                 const Shape& target)
    : metric_(std::move(metric)),
      map_(metric_),
      source_(map_.Values(source)),
      target_(map_.Values(target)),
      gradients_(metric_->connectivity, source, target) {}

NearestShape FeatureTransfer::operator()(const Shape& deformed, double tolerance,
                                         int max_iterations,
                                         const std::function<void()>& check_cancelled) {
  const Shape placed = gradients_(deformed);
  const Eigen::VectorXd wanted = Wanted(deformed, placed);
  // The change of strains and angles only, because the weight of positions is arbitrary.
  Eigen::VectorXd change = wanted - target_;
  for (size_t i = 0; i < metric_->features.size(); ++i) {
    if (metric_->features[i]->As<PositionFeature>() != nullptr) {
      change.segment(map_.FirstValue(i), placed.size()).setZero();
    }
  }
  // If the source does not move, the change is due to rounding.
  const double rounding = 1e3 * std::numeric_limits<double>::epsilon() * target_.norm();
  const double least = std::max(tolerance * change.squaredNorm(), rounding * rounding);
  return FindNearestShape(map_, wanted, placed, {least, max_iterations}, check_cancelled, &solver_);
}

Eigen::VectorXd FeatureTransfer::Wanted(const Shape& deformed, const Shape& placed) const {
  const Eigen::VectorXd change = map_.Values(deformed);
  Eigen::VectorXd wanted = target_ + (change - source_);
  for (size_t i = 0; i < metric_->features.size(); ++i) {
    const int begin = map_.FirstValue(i);
    if (const auto* angles = metric_->features[i]->As<Dihedral>()) {
      // On the unit circle: multiplying complex numbers adds angles.
      for (int e = 0; e < angles->stencils.cols(); ++e) {
        const auto value = [&](const Eigen::VectorXd& values) {
          return std::complex<double>(values(begin + 2 * e), values(begin + 2 * e + 1));
        };
        const std::complex<double> turn = value(change) * std::conj(value(source_));
        if (std::abs(turn) == 0) continue;
        const std::complex<double> turned = value(target_) * (turn / std::abs(turn));
        wanted(begin + 2 * e) = turned.real();
        wanted(begin + 2 * e + 1) = turned.imag();
      }
    } else if (const auto* positions = metric_->features[i]->As<PositionFeature>()) {
      for (int v = 0; v < placed.cols(); ++v) {
        wanted.segment<3>(begin + 3 * v) = std::sqrt(positions->weights(v)) * placed.col(v);
      }
    }
  }
  return wanted;
}

}  // namespace shapespace::internal
