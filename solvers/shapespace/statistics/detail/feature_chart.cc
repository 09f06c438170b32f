#include <shapespace/statistics/detail/feature_chart.h>

#include <cmath>
#include <utility>

#include <shapespace/metric/dihedral.h>

namespace shapespace::internal {
namespace {

double Angle(const Eigen::VectorXd& values, int at) {
  return std::atan2(values(at + 1), values(at));
}

}  // namespace

FeatureChart::FeatureChart(const FeatureMap& map, Eigen::VectorXd centre)
    : centre_(std::move(centre)) {
  const auto& features = map.GetMetric().features;
  for (size_t i = 0; i < features.size(); ++i) {
    const auto* hinges = features[i]->As<Dihedral>();
    if (hinges == nullptr) continue;
    for (int e = 0; e < hinges->stencils.cols(); ++e) {
      const int at = map.FirstValue(i) + 2 * e;
      if (centre_.segment<2>(at).squaredNorm() > (1 - 1e-6) * hinges->weights(e)) {
        angles_.push_back(at);
      }
    }
  }
}

Eigen::VectorXd FeatureChart::Log(const Eigen::VectorXd& values) const {
  Eigen::VectorXd relative = values - centre_;
  for (const int at : angles_) {
    const double radius = centre_.segment<2>(at).norm();
    // A collapsed hinge has no angle.
    const bool known = !values.segment<2>(at).isZero(0);
    relative(at) = known ? radius * WrapAngle(Angle(values, at) - Angle(centre_, at)) : 0;
    relative(at + 1) = 0;
  }
  return relative;
}

Eigen::VectorXd FeatureChart::Exp(const Eigen::VectorXd& relative) const {
  Eigen::VectorXd values = centre_ + relative;
  for (const int at : angles_) {
    const double radius = centre_.segment<2>(at).norm();
    const double angle = Angle(centre_, at) + relative(at) / radius;
    values.segment<2>(at) << radius * std::cos(angle), radius * std::sin(angle);
  }
  return values;
}

Eigen::VectorXd FeatureChart::ChangeAt(const Eigen::VectorXd& values,
                                       const Eigen::VectorXd& relative) const {
  Eigen::VectorXd change = relative;
  for (const int at : angles_) {
    const double angle = Angle(values, at);
    change.segment<2>(at) << -std::sin(angle) * relative(at), std::cos(angle) * relative(at);
  }
  return change;
}

}  // namespace shapespace::internal
