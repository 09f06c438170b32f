#include <shapespace/matching/detail/compare_bodies.h>

#include <algorithm>
#include <cmath>

#include <shapespace/mesh/surface.h>

namespace shapespace::internal {
namespace {

// Pairs from which distances are compared, to all others.
constexpr size_t kDistancesFrom = 80;
// In units of the area: heat has spread over a tenth of its root.
constexpr double kHeatTime = 0.003;

double Isometry(const MatchingBody& on_template, const MatchingBody& on_target,
                const VertexPairs& pairs) {
  const size_t stride = std::max<size_t>(1, pairs.size() / kDistancesFrom);
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
      sum += RelativeChange<double>(before(from, i), after(to, i));
    }
  }
  return sum / static_cast<double>(before.cols() * pairs.size());
}

// The smoothed mean curvature in units of its own deviation, cut off smoothly at 1.
Eigen::VectorXd SaturatedCurvature(const MatchingBody& body) {
  const Eigen::MatrixXd& functions = body.spectrum.functions;
  const Eigen::VectorXd curvature = functions * (functions.transpose() * MeanCurvature(body));
  const Eigen::VectorXd& areas = body.laplacian.areas;
  const Eigen::ArrayXd off = curvature.array() - areas.dot(curvature) / areas.sum();
  const double deviation = std::sqrt(areas.dot(off.square().matrix()) / areas.sum());
  if (!(deviation > 0)) return Eigen::VectorXd::Zero(off.size());
  return (off / deviation).tanh();
}

Eigen::VectorXd HeatSignature(const Spectrum& spectrum) {
  const Eigen::VectorXd decay = (-kHeatTime * spectrum.values.array()).exp();
  return (spectrum.functions.cwiseAbs2() * decay).array().log();
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
  figures.isometry = Isometry(on_template, on_target, pairs);
  figures.curvature =
      MeanDifference(SaturatedCurvature(on_template), SaturatedCurvature(on_target), pairs);
  figures.heat =
      MeanDifference(HeatSignature(on_template.spectrum), HeatSignature(on_target.spectrum), pairs);
  return figures;
}

}  // namespace shapespace::internal
