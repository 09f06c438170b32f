#include <shapespace/cost/euler_lagrange.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <shapespace/cost/detail/index_of.h>
#include <shapespace/cost/sum_cost.h>

namespace shapespace::cost {
namespace {

int CountSumFeatures(const Metric& metric) {
  return static_cast<int>(std::count_if(metric.features.begin(), metric.features.end(),
                                        [](const auto& feature) { return feature->IsSum(); }));
}

}  // namespace

EulerLagrange::EulerLagrange(const Metric& metric, const Shape& at, const Eigen::VectorXd& target,
                             double scale)
    : features_(metric.features),
      num_sums_(CountSumFeatures(metric)),
      rows_(at.cols()),
      neighbours_(at.cols()),
      magnitude_(Tangent::Zero(3, at.cols())) {
  const double* targets = target.data();
  for (const auto& feature : features_) targets = Add(feature, at, targets, scale);
}

double EulerLagrange::Rounding() const {
  return std::numeric_limits<double>::epsilon() * magnitude_.norm();
}

void EulerLagrange::AddTo(Shape* shape, std::vector<double>* sums, ceres::Problem* problem) const {
  sums->resize(NumSums());
  std::vector<double*> blocks;
  for (size_t v = 0; v < rows_.size(); ++v) {
    if (rows_[v].empty()) continue;
    blocks.clear();
    for (double& sum : *sums) blocks.push_back(&sum);
    for (int neighbour : neighbours_[v]) blocks.push_back(shape->col(neighbour).data());
    problem->AddResidualBlock(
        new EulerLagrangeRows(rows_[v], NumSums(), static_cast<int>(neighbours_[v].size())),
        nullptr, blocks);
  }
  AddSums(shape, sums, problem);
}

// Adds a row s = sum for every sum feature, and sets `sums` to the values at `shape`.
void EulerLagrange::AddSums(Shape* shape, std::vector<double>* sums,
                            ceres::Problem* problem) const {
  size_t i = 0;
  for (const auto& feature : features_) {
    if (!feature->IsSum()) continue;
    std::vector<double*> blocks;
    for (int v = 0; v < shape->cols(); ++v) blocks.push_back(shape->col(v).data());
    const double root = std::sqrt(feature->Weight(0));
    double& sum = (*sums)[i];
    sum = AddSum(*feature, blocks.data(), root, nullptr);
    blocks.push_back(&sum);
    const auto add = [feature, root](const double* const* at, double by, double** jacobians) {
      return AddSum(*feature, at, by * root, jacobians);
    };
    problem->AddResidualBlock(
        new SumCost(add, static_cast<int>(shape->cols()), sum_gradients_[i++]), nullptr, blocks);
  }
}

// Returns the beginning of the next feature's targets.
const double* EulerLagrange::Add(const std::shared_ptr<const Feature>& feature, const Shape& at,
                                 const double* targets, double scale) {
  const int num_vertices = feature->VerticesPerElement();
  const int num_values = feature->ValuesPerElement();
  const bool is_sum = feature->IsSum();
  Tangent sum_gradient = Tangent::Zero(3, is_sum ? at.cols() : 0);
  double sum_rounded = 0;
  double x[Feature::kMaxInputs], values[Feature::kMaxValues];
  double derivatives[3 * Feature::kMaxVertices * Feature::kMaxValues];
  const auto derivative = [&](int corner, int k) {
    return Eigen::Map<const Eigen::Vector3d>(derivatives + 3 * (num_values * corner + k));
  };
  for (int e = 0; e < feature->NumElements(); ++e) {
    const int* const vertices = feature->Element(e);
    feature->GatherCoordinates(e, e + 1, at, x);
    feature->Differentiate(1, x, values, derivatives);
    const double root = std::sqrt(feature->Weight(e));
    double rounded[Feature::kMaxValues];  // magnitudes of the terms of values
    for (int k = 0; k < num_values; ++k) {
      rounded[k] = is_sum ? 0 : std::abs(targets[k]);
      for (int corner = 0; corner < num_vertices; ++corner) {
        rounded[k] += root * derivative(corner, k).cwiseAbs().dot(
                                 Eigen::Map<const Eigen::Vector3d>(x + 3 * corner).cwiseAbs());
      }
    }
    sum_rounded += rounded[0];
    for (int corner = 0; corner < num_vertices; ++corner) {
      const int v = vertices[corner];
      if (is_sum) {
        sum_gradient.col(v) += scale * root * derivative(corner, 0);
        continue;
      }
      VertexElements& part = Part(feature, v);
      part.elements.push_back(e);
      for (int k = 0; k < num_vertices; ++k) {
        part.blocks.push_back(num_sums_ + static_cast<int>(IndexOf(vertices[k], &neighbours_[v])));
      }
      for (int k = 0; k < num_values; ++k) {
        const Eigen::Vector3d gradient = scale * root * derivative(corner, k);
        part.gradient.insert(part.gradient.end(), gradient.data(), gradient.data() + 3);
        part.targets.push_back(targets[k]);
        magnitude_.col(v) += rounded[k] * gradient.cwiseAbs();
      }
    }
    if (!is_sum) targets += num_values;
  }
  if (!is_sum) return targets;
  for (int v = 0; v < at.cols(); ++v) {
    VertexElements& part = Part(feature, v);
    part.blocks.push_back(static_cast<int>(sum_gradients_.size()));
    part.gradient.assign(sum_gradient.col(v).data(), sum_gradient.col(v).data() + 3);
    part.targets.push_back(*targets);
  }
  magnitude_ += (std::abs(*targets) + sum_rounded) * sum_gradient.cwiseAbs();
  sum_gradients_.push_back(sum_gradient.norm());
  return targets + 1;
}

// The terms of vertex v for the feature that is being added.
VertexElements& EulerLagrange::Part(const std::shared_ptr<const Feature>& feature, int v) {
  std::vector<VertexElements>& parts = rows_[v];
  if (parts.empty() || parts.back().feature != feature) parts.push_back({feature, {}, {}, {}, {}});
  return parts.back();
}

}  // namespace shapespace::cost
