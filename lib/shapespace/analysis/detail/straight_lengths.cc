#include <shapespace/analysis/detail/straight_lengths.h>

#include <array>
#include <utility>
#include <vector>

namespace shapespace::internal {
namespace {

// The struct of a feature of the metric; null if it has none.
template <typename Struct>
const Struct* Find(const Metric& metric) {
  for (const auto& feature : metric.features) {
    if (const auto* found = feature->As<Struct>()) return found;
  }
  return nullptr;
}

// The values of all elements, one column each.
template <typename Struct>
Eigen::MatrixXd ValuesOf(const Struct& feature, const Shape& shape) {
  Eigen::MatrixXd values(Struct::kValues, feature.stencils.cols());
  for (int i = 0; i < values.cols(); ++i) {
    double x[Struct::kInputs];
    GatherCoordinates(feature, i, shape, x);
    feature(x, values.col(i).data());
  }
  return values;
}

}  // namespace

Eigen::VectorXd SquaredLengths(const Connectivity& connectivity, const Shape& shape) {
  const Eigen::Matrix2Xi& edges = connectivity.Edges();
  Eigen::VectorXd squared(edges.cols());
  for (int e = 0; e < edges.cols(); ++e) {
    squared(e) = (shape.col(edges(1, e)) - shape.col(edges(0, e))).squaredNorm();
  }
  return squared;
}

StraightLengths::StraightLengths(std::shared_ptr<const Metric> metric, const Shape& m,
                                 const Shape& n)
    : metric_(std::move(metric)) {
  const auto* const strain = Find<TriangleStrain>(*metric_);
  const auto* const log_length = Find<LogLength>(*metric_);
  const MetricOptions& options = metric_->options;
  if (options.strain > 0) strain_share_ = options.strain / (options.strain + options.isometric);
  for (const auto& [shape, values] : {std::pair(&m, &m_), std::pair(&n, &n_)}) {
    if (strain_share_ < 1) values->squared_lengths = SquaredLengths(*metric_->connectivity, *shape);
    if (strain != nullptr) values->strains = ValuesOf(*strain, *shape);
    if (log_length != nullptr) values->log_lengths = ValuesOf(*log_length, *shape).transpose();
  }
}

Eigen::VectorXd StraightLengths::SquaredAt(double t) const {
  Eigen::VectorXd squared = Eigen::VectorXd::Zero(metric_->connectivity->NumEdges());
  if (strain_share_ < 1) {
    squared += (1 - strain_share_) * ((1 - t) * m_.squared_lengths + t * n_.squared_lengths);
  }
  if (strain_share_ > 0) squared += strain_share_ * ByStrainAt(t);
  return squared;
}

Eigen::VectorXd StraightLengths::ByStrainAt(double t) const {
  const Connectivity& connectivity = *metric_->connectivity;
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  std::vector<std::array<double, 3>> sides(triangles.cols());
  if (const auto* const strain = Find<TriangleStrain>(*metric_)) {
    for (int f = 0; f < triangles.cols(); ++f) {
      const Eigen::Vector3d values = (1 - t) * m_.strains.col(f) + t * n_.strains.col(f);
      sides[f] = strain->SquaredSides(values.data(), strain->numbers.col(f).data());
    }
  }
  Eigen::VectorXd squared = Eigen::VectorXd::Zero(connectivity.NumEdges());
  for (int e = 0; e < connectivity.NumTriangleEdges(); ++e) {
    const IndexLists::Row around = connectivity.TrianglesOfEdges()[e];
    const int a = connectivity.Edges()(0, e), b = connectivity.Edges()(1, e);
    for (const int f : around) {
      // The corner opposite to the edge, which in a triangle with a vertex twice is one of its
      // ends.
      const auto is_opposite = [&](int corner) {
        const int next = triangles((corner + 1) % 3, f), last = triangles((corner + 2) % 3, f);
        return (next == a && last == b) || (next == b && last == a);
      };
      const int opposite = is_opposite(0) ? 0 : is_opposite(1) ? 1 : 2;
      squared(e) += sides[f][opposite] / around.size();
    }
  }
  if (const auto* const log_length = Find<LogLength>(*metric_)) {
    const Eigen::VectorXd values = (1 - t) * m_.log_lengths + t * n_.log_lengths;
    squared.tail(values.size()) = (2 * values).array().exp() - log_length->epsilon_squared;
  }
  return squared;
}

}  // namespace shapespace::internal
