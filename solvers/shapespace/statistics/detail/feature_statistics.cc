#include <shapespace/statistics/detail/feature_statistics.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/metric/dihedral.h>

namespace shapespace::internal {
namespace {

// Calls visit(first value, number of elements) for each dihedral feature.
template <typename Visit>
void ForDihedrals(const FeatureMap& map, const Visit& visit) {
  const auto& features = map.GetMetric().features;
  for (size_t i = 0; i < features.size(); ++i) {
    if (const auto* hinges = features[i]->As<Dihedral>()) visit(map.FirstValue(i), *hinges);
  }
}

// 2 K^2 (1 - |sum_i w_i exp(i theta_i / K)|), the least over all ways to unwrap the angles: each is
// given by the point at which the circle is cut. Changes `given`.
double LeastOnCircle(const Eigen::VectorXd& weights, int segments, std::vector<double>* given,
                     std::vector<int>* scratch) {
  std::vector<double>& angles = *given;
  std::vector<int>& order = *scratch;
  order.resize(angles.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return angles[a] < angles[b]; });
  const auto term = [&](int i) { return weights(i) * std::polar(1.0, angles[i] / segments); };
  std::complex<double> sum = 0;
  for (const int i : order) sum += term(i);
  double longest = std::abs(sum);
  for (const int i : order) {
    sum -= term(i);
    angles[i] += 2 * M_PI;
    sum += term(i);
    longest = std::max(longest, std::abs(sum));
  }
  return std::max(0.0, 2.0 * segments * segments * (weights.sum() - longest));
}

}  // namespace

FeatureStatistics::FeatureStatistics(const FeatureMap& map, const std::vector<Shape>& poses,
                                     const Eigen::VectorXd& weights)
    : map_(map), weights_(weights) {
  for (size_t i = 0; i < poses.size(); ++i) {
    const Eigen::VectorXd values = map.Values(poses[i]);
    if (i == 0) values_.resize(values.size(), poses.size());
    values_.col(i) = values;
  }
  mean_ = values_ * weights_;
  ForDihedrals(map_, [&](int begin, const Dihedral& hinges) {
    ForRanges(static_cast<int>(hinges.stencils.cols()), [&](int first, int last) {
      std::vector<double> angles;
      for (int e = first; e < last; ++e) {
        auto mean = mean_.segment<2>(begin + 2 * e);
        if (!GetAngles(begin + 2 * e, &angles) || mean.isZero(0)) continue;
        // The angles are unwrapped around the direction of the mean point, and then around their
        // mean, until that stays: their variance on the circle falls each time.
        double angle = std::atan2(mean(1), mean(0));
        for (double turned = 1; std::abs(turned) > 1e-14;) {
          turned = 0;
          for (size_t i = 0; i < angles.size(); ++i) {
            turned += weights_(i) * WrapAngle(angles[i] - angle);
          }
          angle += turned;
        }
        mean = std::sqrt(hinges.weights(e)) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      }
    });
  });
}

bool FeatureStatistics::GetAngles(Eigen::Index at, std::vector<double>* angles) const {
  angles->clear();
  for (Eigen::Index i = 0; i < values_.cols(); ++i) {
    const auto value = values_.col(i).segment<2>(at);
    if (value.isZero(0)) return false;
    angles->push_back(std::atan2(value(1), value(0)));
  }
  return true;
}

double FeatureStatistics::Variance() const {
  return (values_.colwise() - mean_).colwise().squaredNorm() * weights_;
}

double FeatureStatistics::LowerBound(int segments) const {
  // The variance about the arithmetic mean is the least value of anything that is not an angle.
  const Eigen::VectorXd means = values_ * weights_;
  Eigen::VectorXd least = (values_.colwise() - means).array().square().matrix() * weights_;
  ForDihedrals(map_, [&](int begin, const Dihedral& hinges) {
    ForRanges(static_cast<int>(hinges.stencils.cols()), [&](int first, int last) {
      std::vector<double> angles;
      std::vector<int> order;
      for (int e = first; e < last; ++e) {
        const Eigen::Index at = begin + 2 * e;
        // Points inside the circle, of collapsed triangles, may move straight.
        const double inside =
            values_.middleRows<2>(at).colwise().squaredNorm().minCoeff() / hinges.weights(e);
        if (!GetAngles(at, &angles) || inside < 1 - 1e-6) continue;
        least(at) = hinges.weights(e) * LeastOnCircle(weights_, segments, &angles, &order);
        least(at + 1) = 0;
      }
    });
  });
  return least.sum();
}

int FeatureStatistics::AmbiguousHinges() const {
  int count = 0;
  std::vector<double> angles;
  ForDihedrals(map_, [&](int begin, const Dihedral& hinges) {
    for (Eigen::Index e = 0; e < hinges.stencils.cols(); ++e) {
      if (!GetAngles(begin + 2 * e, &angles)) continue;
      std::sort(angles.begin(), angles.end());
      double gap = angles.front() + 2 * M_PI - angles.back();
      for (size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
      if (gap < M_PI) ++count;
    }
  });
  return count;
}

}  // namespace shapespace::internal
