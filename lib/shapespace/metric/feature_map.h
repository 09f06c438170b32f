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
/// all features' values. Stored in flat arrays, one small dense block per element; both products
/// use all threads, and their results do not depend on the number of threads.
class FeatureDerivative {
 public:
  /// J X.
  Eigen::VectorXd Times(const Tangent& x) const;
  /// J^T y.
  Tangent TransposeTimes(const Eigen::VectorXd& y) const;

  /// J^T J, the matrix of the metric, 3m x 3m, unknown 3 v + axis; lower triangle only. The
  /// contributions of sum features, which are dense and of rank one, are omitted.
  Eigen::SparseMatrix<double> MetricMatrix() const;
  /// The same, stored in `matrix`, which already has this map's sparsity pattern.
  void UpdateMetricMatrix(Eigen::SparseMatrix<double>* matrix) const;
  /// The rows of J that belong to sum features, one each: J^T J is `MetricMatrix` plus the sum of
  /// their squares r r^T.
  std::vector<Tangent> SumRows() const;

 private:
  friend class FeatureMap;
  struct Layout;
  std::shared_ptr<const Layout> layout_;
  // By feature, by element, by vertex, by value: three numbers each.
  std::vector<std::vector<double>> blocks_;
};

/// The feature map Phi of a metric (docs/mathematics.md, section 1), including weights: the
/// metric's norm of a tangent X at P is |J(P) X|, the energy of a segment 2 |Phi(Q) - Phi(P)|^2.
/// Shooting and transport are formulated in terms of it. Shapes are in the metric's unit.
class FeatureMap {
 public:
  /// \throw InvalidOptions if the metric has a rigid part, which is not a feature.
  explicit FeatureMap(std::shared_ptr<const Metric> metric);

  const Metric& GetMetric() const { return *metric_; }

  /// Phi(P): by feature, by element; each value times the square root of the element's weight.
  Eigen::VectorXd Values(const Shape& shape) const;
  /// Index in Phi of the first value of metric.features[feature].
  int FirstValue(size_t feature) const;
  /// J(P), by Feature::Evaluate: the derivatives that features have of their own, or else automatic
  /// ones.
  FeatureDerivative Derivative(const Shape& shape) const;
  /// The second derivative of Phi at P along X twice.
  Eigen::VectorXd SecondDerivative(const Shape& shape, const Tangent& x) const;

 private:
  std::shared_ptr<const Metric> metric_;
  std::shared_ptr<const FeatureDerivative::Layout> layout_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_FEATURE_MAP_H_
