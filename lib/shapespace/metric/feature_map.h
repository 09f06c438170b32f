#ifndef SHAPESPACE_METRIC_FEATURE_MAP_H_
#define SHAPESPACE_METRIC_FEATURE_MAP_H_

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace {

/// The derivative J of the feature map at a shape: a linear map from tangents (3 x m) to changes of
/// all features' values. On flat arrays, one small dense block an element; both products use all
/// threads, and their results do not depend on how many there are.
class FeatureDerivative {
 public:
  /// J X.
  Eigen::VectorXd Times(const Tangent& x) const;
  /// J^T y.
  Tangent TransposeTimes(const Eigen::VectorXd& y) const;

  /// J^T J, the matrix of the metric, 3m x 3m, unknown 3 v + axis; lower triangle only. What sum
  /// features add is of rank one and dense, and is left out.
  Eigen::SparseMatrix<double> MetricMatrix() const;
  /// The same into the numbers of `matrix`, which has this map's pattern already.
  void UpdateMetricMatrix(Eigen::SparseMatrix<double>* matrix) const;

 private:
  friend class FeatureMap;
  struct Layout;
  std::shared_ptr<const Layout> layout_;
  // Of each feature, of each element, of each of its vertices, of each value: three numbers.
  std::vector<std::vector<double>> blocks_;
};

/// The feature map Phi of a metric (docs/mathematics.md, section 1), weights included: the metric's
/// norm of a tangent X at P is |J(P) X|, the energy of a segment 2 |Phi(Q) - Phi(P)|^2. All of
/// shooting and transport is written in terms of it. Shapes are in the metric's unit.
class FeatureMap {
 public:
  /// \throw InvalidOptions if the metric has a rigid part, which is no feature.
  explicit FeatureMap(std::shared_ptr<const Metric> metric);

  const Metric& GetMetric() const { return *metric_; }

  /// Phi(P): feature after feature, element after element, each value times the root of the
  /// element's weight.
  Eigen::VectorXd Values(const Shape& shape) const;
  /// Where the values of metric.features[feature] begin in Phi.
  int FirstValue(size_t feature) const;
  /// J(P), differentiated automatically.
  FeatureDerivative Derivative(const Shape& shape) const;
  /// The second derivative of Phi at P along X twice.
  Eigen::VectorXd SecondDerivative(const Shape& shape, const Tangent& x) const;

 private:
  std::shared_ptr<const Metric> metric_;
  std::shared_ptr<const FeatureDerivative::Layout> layout_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_FEATURE_MAP_H_
