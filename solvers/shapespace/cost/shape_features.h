#ifndef SHAPESPACE_COST_SHAPE_FEATURES_H_
#define SHAPESPACE_COST_SHAPE_FEATURES_H_

#include <memory>
#include <vector>

#include <ceres/evaluation_callback.h>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::cost {

/// The features of every shape of a path, evaluated once at each point at which Ceres evaluates a
/// problem. Without it, residual blocks evaluate each inner shape twice, once for each of its two
/// segments:
/// \code
///   cost::ShapeFeatures features(metric, &shapes);
///   ceres::Problem::Options options;
///   options.evaluation_callback = &features;
///   ceres::Problem problem(options);
///   cost::AddPathEnergy(*metric, &shapes, &problem, nullptr, 1, &features);
/// \endcode
/// Results are the same to the last bit. Features that are sums (volume), the trapezoid form and
/// the rigid metric are still evaluated by segment.
class ShapeFeatures final : public ceres::EvaluationCallback {
 public:
  /// Of `shapes`, in the metric's unit, which must outlive this object and keep its size.
  ShapeFeatures(std::shared_ptr<const Metric> metric, const std::vector<Shape>* shapes);

  /// Called by Ceres.
  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

  /// A feature's values without weights, by element, and their derivatives, by element, by vertex
  /// and by value, three numbers each.
  struct Values {
    std::vector<double> values, derivatives;
  };
  const Values& Of(int feature, int shape) const {
    return values_[feature * shapes_.size() + shape];
  }

 private:
  const std::shared_ptr<const Metric> metric_;
  const std::vector<Shape>& shapes_;
  std::vector<Values> values_;
  bool have_derivatives_ = false;
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_SHAPE_FEATURES_H_
