#include <shapespace/correspondence/detail/marker_check.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// A marker is doubtful if its distance from the predicted position is more than this factor times
// the median over all markers and at least this share of the square root of the area, and if its
// sum of differences is larger by this factor than at the predicted position. On six real pairs,
// with 20 to 55 markers, correct markers have up to 5 times the median (where proportions differ
// most), exchanged ones at least 14 times.
constexpr double kMuchFarther = 8, kMinOff = 0.15, kMuchWorse = 1.5;
// Differences are weighted by the inverse distance plus this constant, because proportions affect
// long distances more.
constexpr float kNear = 0.1F;
// Fewer other markers do not suffice: three distances determine a point of the plane only up to
// reflection.
constexpr int kMinOthers = 4;

struct Prediction {
  int expected = -1;
  double off = 0, ratio = 0;
};

Prediction Predict(int marker, const std::vector<bool>& is_out, const Eigen::MatrixXf& on_template,
                   const Eigen::MatrixXf& on_target, const std::vector<int>& template_vertices,
                   const std::vector<int>& target_vertices) {
  Eigen::VectorXf cost = Eigen::VectorXf::Zero(on_target.rows());
  int others = 0;
  for (int k = 0; k < on_template.cols(); ++k) {
    const float distance = on_template(template_vertices[marker], k);
    if (k == marker || is_out[k] || !std::isfinite(distance)) continue;
    ++others;
    cost += (on_target.col(k).array() - distance).abs().matrix() / (distance + kNear);
  }
  if (others < kMinOthers) return {};
  Prediction prediction;
  const float least = cost.minCoeff(&prediction.expected);
  prediction.off = on_target(prediction.expected, marker);
  const float own = cost(target_vertices[marker]);
  prediction.ratio = least > 0 ? own / least : std::numeric_limits<double>::infinity();
  return prediction;
}

// Whether marker `a` is predicted near `b`, and `b` near `a`.
bool AreSwapped(const CorrespondenceSummary::Doubt& a, const CorrespondenceSummary::Doubt& b,
                const Eigen::MatrixXf& on_target) {
  return on_target(a.expected, b.marker) < kMinOff && on_target(b.expected, a.marker) < kMinOff;
}

}  // namespace

std::vector<CorrespondenceSummary::Doubt> FindDoubtfulMarkers(
    const Eigen::MatrixXf& on_template, const Eigen::MatrixXf& on_target,
    const std::vector<int>& template_vertices, const std::vector<int>& target_vertices) {
  const int num_markers = static_cast<int>(template_vertices.size());
  std::vector<bool> is_out(num_markers, false);
  std::vector<CorrespondenceSummary::Doubt> doubtful;
  while (true) {
    std::vector<Prediction> predictions(num_markers);
    ParallelFor(num_markers, [&](int k) {
      if (is_out[k]) return;
      predictions[k] =
          Predict(k, is_out, on_template, on_target, template_vertices, target_vertices);
    });
    std::vector<double> offs;
    for (const Prediction& prediction : predictions) {
      if (prediction.expected >= 0) offs.push_back(prediction.off);
    }
    if (offs.empty()) break;
    const auto middle = offs.begin() + static_cast<std::ptrdiff_t>(offs.size() / 2);
    std::nth_element(offs.begin(), middle, offs.end());
    const double most_off = std::max(kMinOff, kMuchFarther * *middle);
    int worst = -1;
    for (int k = 0; k < num_markers; ++k) {
      const Prediction& prediction = predictions[k];
      if (!(prediction.off > most_off && prediction.ratio > kMuchWorse)) continue;
      if (worst < 0 || prediction.ratio > predictions[worst].ratio) worst = k;
    }
    if (worst < 0) break;
    is_out[worst] = true;
    doubtful.push_back({worst, predictions[worst].off, predictions[worst].expected, -1});
  }
  for (auto& a : doubtful) {
    for (const auto& b : doubtful) {
      if (a.marker != b.marker && AreSwapped(a, b, on_target)) a.swapped = b.marker;
    }
  }
  return doubtful;
}

}  // namespace shapespace::internal
