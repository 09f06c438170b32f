#include <shapespace/matching/detail/landmarks.h>

#include <cmath>
#include <utility>

#include <shapespace/matching/detail/turns.h>

namespace shapespace::internal {
namespace {

// Weight of all turns together, relative to the distances; 1 and 2 were no better.
constexpr float kTurnWeight = 0.5F;
// Times of heat kernels, in units of the area.
constexpr int kHeatTimes = 8;
constexpr double kFirstTime = 0.01;

// Logarithms of the heat kernel signature, vertices x times, of the body enlarged by `scale`.
Eigen::MatrixXd LogHeat(const Spectrum& spectrum, const std::vector<int>& vertices,
                        double last_time, double scale) {
  Eigen::MatrixXd heat(vertices.size(), kHeatTimes);
  for (int t = 0; t < kHeatTimes; ++t) {
    const double time = kFirstTime * std::pow(last_time / kFirstTime, t / (kHeatTimes - 1.0));
    const Eigen::VectorXd decay = (-time / (scale * scale) * spectrum.values.array()).exp();
    for (size_t i = 0; i < vertices.size(); ++i) {
      heat(i, t) = std::log(spectrum.functions.row(vertices[i]).cwiseAbs2().dot(decay)) -
                   2 * std::log(scale);
    }
  }
  return heat;
}

}  // namespace

Landmarks::Landmarks(const MatchingBody& body, std::vector<int> vertices)
    : vertices_(std::move(vertices)) {
  const auto count = static_cast<int>(vertices_.size());
  const Eigen::MatrixXf all = body.graph.FromEach(vertices_);
  between_.resize(count, count);
  for (int i = 0; i < count; ++i) between_.row(i) = all.row(vertices_[i]);
  distances_.resize(body.spread.size(), count);
  for (size_t i = 0; i < body.spread.size(); ++i) distances_.row(i) = all.row(body.spread[i]);
  const std::vector<std::pair<int, int>> pairs = AllPairs(count);
  turns_ = body.Smooth(GradientTurns(*body.surface.connectivity, body.laplacian.areas, all, pairs),
                       body.spread);
  pair_.resize(count, count);
  for (size_t p = 0; p < pairs.size(); ++p) {
    pair_(pairs[p].first, pairs[p].second) = static_cast<int>(p);
  }
}

Eigen::MatrixXd Landmarks::Between(int count, size_t extremities) const {
  const Eigen::Index behind = between_.cols() - static_cast<Eigen::Index>(extremities);
  Eigen::MatrixXd distances(count, count + behind);
  distances << between_.topLeftCorner(count, count).cast<double>(),
      between_.topRightCorner(count, behind).cast<double>();
  return distances;
}

Eigen::MatrixXf Landmarks::Describe(const std::vector<int>& chosen) const {
  const auto count = static_cast<int>(chosen.size());
  const std::vector<std::pair<int, int>> pairs = AllPairs(count);
  Eigen::MatrixXf descriptors(count + pairs.size(), distances_.rows());
  for (int i = 0; i < count; ++i) {
    float sum = 0;
    for (const int other : chosen) sum += between_(chosen[i], other);
    descriptors.row(i) =
        distances_.col(chosen[i]).transpose() * (static_cast<float>(count - 1) / sum);
  }
  const float weight = kTurnWeight / std::sqrt(static_cast<float>(count - 1));
  for (size_t p = 0; p < pairs.size(); ++p) {
    const int i = chosen[pairs[p].first], j = chosen[pairs[p].second];
    const float sign = i < j ? 1 : -1;
    descriptors.row(count + p) =
        sign * weight * turns_.col(i < j ? pair_(i, j) : pair_(j, i)).transpose();
  }
  return descriptors;
}

Eigen::MatrixXd HeatDifference(const Spectrum& first, const std::vector<int>& first_vertices,
                               const Spectrum& second, const std::vector<int>& second_vertices,
                               double last_time, double scale) {
  const Eigen::MatrixXd a = LogHeat(first, first_vertices, last_time, 1),
                        b = LogHeat(second, second_vertices, last_time, scale);
  Eigen::MatrixXd difference(a.rows(), b.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < b.rows(); ++j) {
      difference(i, j) = (a.row(i) - b.row(j)).cwiseAbs().mean();
    }
  }
  return difference;
}

}  // namespace shapespace::internal
