#include <shapespace/matching/detail/compare_bodies.h>

#include <algorithm>
#include <cmath>

#include <shapespace/matching/detail/part_maps.h>
#include <shapespace/mesh/surface.h>

namespace shapespace::internal {
namespace {

// Pairs from which distances are compared, to all others; of parts, which are fitted several times
// as often, fewer.
constexpr size_t kDistancesFrom = 80, kDistancesFromPart = 40;
// In units of the area: heat has spread over a tenth of its root.
constexpr double kHeatTime = 0.003;

// Distances on the target are multiplied by `scale`.
double Isometry(const MatchingBody& on_template, const MatchingBody& on_target,
                const VertexPairs& pairs, double scale, size_t num_from) {
  const size_t stride = std::max<size_t>(1, pairs.size() / num_from);
  std::vector<int> first, second;
  for (size_t i = 0; i < pairs.size(); i += stride) {
    first.push_back(pairs[i].first);
    second.push_back(pairs[i].second);
  }
  const Eigen::MatrixXf before = on_template.graph.FromEach(first),
                        after = on_target.graph.FromEach(second);
  double sum = 0;
  for (Eigen::Index i = 0; i < before.cols(); ++i) {
    for (const auto& [from, to] : pairs) {
      sum += RelativeChange<double>(before(from, i), scale * after(to, i));
    }
  }
  return sum / static_cast<double>(before.cols() * pairs.size());
}

// The smoothed mean curvature in units of its own deviation, cut off smoothly at 1. `weights` are
// those of vertices in the mean and the deviation.
Eigen::VectorXd SaturatedCurvature(const MatchingBody& body, const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd& functions = body.spectrum.functions;
  const Eigen::VectorXd curvature = functions * (functions.transpose() * MeanCurvature(body));
  const Eigen::ArrayXd off = curvature.array() - weights.dot(curvature) / weights.sum();
  const double deviation = std::sqrt(weights.dot(off.square().matrix()) / weights.sum());
  if (!(deviation > 0)) return Eigen::VectorXd::Zero(off.size());
  return (off / deviation).tanh();
}

// Of the body enlarged by `scale`.
Eigen::VectorXd HeatSignature(const Spectrum& spectrum, double scale) {
  const Eigen::VectorXd decay = (-kHeatTime / (scale * scale) * spectrum.values.array()).exp();
  return (spectrum.functions.cwiseAbs2() * decay).array().log() - 2 * std::log(scale);
}

// The same pairs in another order, in which the first of them are anywhere on the body.
VertexPairs Spread(const VertexPairs& pairs) {
  constexpr size_t kStride = 37;
  VertexPairs spread;
  for (size_t first = 0; first < std::min(kStride, pairs.size()); ++first) {
    for (size_t i = first; i < pairs.size(); i += kStride) spread.push_back(pairs[i]);
  }
  return spread;
}

double MeanDifference(const Eigen::VectorXd& on_template, const Eigen::VectorXd& on_target,
                      const VertexPairs& pairs) {
  double sum = 0;
  for (const auto& [from, to] : pairs) sum += std::abs(on_template(from) - on_target(to));
  return sum / static_cast<double>(pairs.size());
}

}  // namespace

Eigen::VectorXd MeanCurvature(const MatchingBody& body) {
  const Eigen::MatrixXd laplacian = 0.5 * body.laplacian.stiffness * body.surface.shape.transpose();
  const Shape normals = VertexNormals(*body.surface.connectivity, body.surface.shape);
  return (laplacian.transpose().cwiseProduct(normals)).colwise().sum();
}

MapFigures CompareBodies(const MatchingBody& on_template, const MatchingBody& on_target,
                         const VertexPairs& pairs) {
  MapFigures figures;
  if (pairs.empty()) return figures;
  figures.isometry = Isometry(on_template, on_target, pairs, 1, kDistancesFrom);
  figures.curvature =
      MeanDifference(SaturatedCurvature(on_template, on_template.laplacian.areas),
                     SaturatedCurvature(on_target, on_target.laplacian.areas), pairs);
  figures.heat = MeanDifference(HeatSignature(on_template.spectrum, 1),
                                HeatSignature(on_target.spectrum, 1), pairs);
  return figures;
}

MapFigures ComparePart(const MatchingBody& on_template, const MatchingBody& on_target,
                       const VertexPairs& pairs) {
  MapFigures figures;
  VertexPairs inner;
  Eigen::VectorXd on_both = Eigen::VectorXd::Zero(on_template.surface.NumVertices()),
                  of_both = Eigen::VectorXd::Zero(on_target.surface.NumVertices());
  for (const auto& [from, to] : pairs) {
    if (!on_target.IsInner(to)) continue;
    inner.emplace_back(from, to);
    on_both(from) += on_target.laplacian.areas(to);
    of_both(to) += on_target.laplacian.areas(to);
  }
  if (inner.empty()) return figures;
  const double scale = RelativeScale(on_template, on_target, Spread(pairs));
  figures.isometry = Isometry(on_template, on_target, pairs, scale, kDistancesFromPart);
  figures.curvature = MeanDifference(SaturatedCurvature(on_template, on_both),
                                     SaturatedCurvature(on_target, of_both), inner);
  figures.heat = MeanDifference(HeatSignature(on_template.spectrum, 1),
                                HeatSignature(on_target.spectrum, scale), inner);
  return figures;
}

}  // namespace shapespace::internal
