#include <shapespace/solvers/cost/euler_lagrange.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

#include <ceres/dynamic_autodiff_cost_function.h>

#include <shapespace/solvers/cost/index_of.h>

namespace shapespace::cost {
namespace {

int CountSumFeatures(const Metric& metric) {
  return static_cast<int>(
      std::count_if(metric.features.begin(), metric.features.end(), [](const AnyFeature& any) {
        return std::visit([](const auto& feature) { return feature.kSum; }, any);
      }));
}

}  // namespace

EulerLagrange::EulerLagrange(const Metric& metric, const Shape& at, const Eigen::VectorXd& target,
                             double scale)
    : metric_(metric),
      num_sums_(CountSumFeatures(metric)),
      rows_(at.cols()),
      neighbours_(at.cols()),
      magnitude_(Tangent::Zero(3, at.cols())) {
  const double* targets = target.data();
  for (const AnyFeature& any : metric.features) {
    std::visit([&](const auto& feature) { targets = Add(any, feature, at, targets, scale); }, any);
  }
}

double EulerLagrange::Rounding() const {
  return std::numeric_limits<double>::epsilon() * magnitude_.norm();
}

// Ceres' default of four derivatives per pass was the fastest of 3 to 64, although a row with
// bending has about sixty unknowns: Jets of that size do not fit into registers.
void EulerLagrange::AddTo(Shape* shape, std::vector<double>* sums, ceres::Problem* problem) const {
  sums->resize(NumSums());
  std::vector<double*> blocks;
  for (size_t v = 0; v < rows_.size(); ++v) {
    if (rows_[v].parts.empty()) continue;
    auto* const cost =
        new ceres::DynamicAutoDiffCostFunction<EulerLagrangeRows>(new EulerLagrangeRows(rows_[v]));
    blocks.clear();
    for (double& sum : *sums) {
      cost->AddParameterBlock(1);
      blocks.push_back(&sum);
    }
    for (int neighbour : neighbours_[v]) {
      cost->AddParameterBlock(3);
      blocks.push_back(shape->col(neighbour).data());
    }
    cost->SetNumResiduals(3);
    problem->AddResidualBlock(cost, nullptr, blocks);
  }
  AddSums(shape, sums, problem);
}

// Adds a row s = sum for every sum feature, and sets `sums` to the values at `shape`.
void EulerLagrange::AddSums(Shape* shape, std::vector<double>* sums,
                            ceres::Problem* problem) const {
  size_t i = 0;
  for (const AnyFeature& any : metric_.features) {
    std::visit(
        [&](const auto& feature) {
          using Feature = std::decay_t<decltype(feature)>;
          if constexpr (Feature::kSum) {
            using Cost = SumCost<SumElements<Feature>>;
            const int num_vertices = static_cast<int>(shape->cols());
            auto* const cost = new Cost({feature}, num_vertices, sum_gradients_[i]);
            std::vector<double*> blocks;
            for (int v = 0; v < num_vertices; ++v) blocks.push_back(shape->col(v).data());
            double& sum = (*sums)[i++];
            blocks.push_back(&sum);
            sum = cost->Sum(blocks.data());
            problem->AddResidualBlock(cost, nullptr, blocks);
          }
        },
        any);
  }
}

// Returns the beginning of the next feature's targets.
template <typename Feature>
const double* EulerLagrange::Add(const AnyFeature& any, const Feature& feature, const Shape& at,
                                 const double* targets, double scale) {
  constexpr int kVertices = Feature::kVertices, kValues = Feature::kValues;
  using Jet = ceres::Jet<double, 3 * kVertices>;
  Tangent sum_gradient = Tangent::Zero(3, Feature::kSum ? at.cols() : 0);
  double sum_rounded = 0;
  for (int e = 0; e < feature.stencils.cols(); ++e) {
    double x[3 * kVertices];
    Gather(feature, e, at, x);
    Jet jet[3 * kVertices], value[kValues];
    for (int k = 0; k < 3 * kVertices; ++k) jet[k] = Jet(x[k], k);
    feature(jet, value);
    const double root = std::sqrt(feature.weights(Feature::kSum ? 0 : e));
    double rounded[kValues];  // magnitudes of the terms of values
    for (int k = 0; k < kValues; ++k) {
      rounded[k] = Feature::kSum ? 0 : std::abs(targets[k]);
      for (int i = 0; i < 3 * kVertices; ++i) rounded[k] += root * std::abs(value[k].v[i] * x[i]);
    }
    sum_rounded += rounded[0];
    for (int corner = 0; corner < kVertices; ++corner) {
      const int v = feature.stencils(corner, e);
      if constexpr (Feature::kSum) {
        sum_gradient.col(v) += scale * root * value[0].v.template segment<3>(3 * corner);
      } else {
        VertexElements& part = Part(any, v);
        part.elements.push_back(e);
        for (int k = 0; k < kVertices; ++k) {
          const int neighbour = IndexOf(feature.stencils(k, e), &neighbours_[v]);
          part.blocks.push_back(num_sums_ + neighbour);
        }
        for (int k = 0; k < kValues; ++k) {
          const Eigen::Vector3d gradient =
              scale * root * value[k].v.template segment<3>(3 * corner);
          part.gradient.insert(part.gradient.end(), gradient.data(), gradient.data() + 3);
          part.targets.push_back(targets[k]);
          magnitude_.col(v) += rounded[k] * gradient.cwiseAbs();
        }
      }
    }
    if (!Feature::kSum) targets += kValues;
  }
  if constexpr (Feature::kSum) {
    for (int v = 0; v < at.cols(); ++v) {
      VertexElements& part = Part(any, v);
      part.blocks.push_back(static_cast<int>(sum_gradients_.size()));
      part.gradient.assign(sum_gradient.col(v).data(), sum_gradient.col(v).data() + 3);
      part.targets.push_back(*targets);
    }
    magnitude_ += (std::abs(*targets) + sum_rounded) * sum_gradient.cwiseAbs();
    sum_gradients_.push_back(sum_gradient.norm());
    ++targets;
  }
  return targets;
}

// The terms of vertex v for the feature that is being added.
VertexElements& EulerLagrange::Part(const AnyFeature& any, int v) {
  std::vector<VertexElements>& parts = rows_[v].parts;
  if (parts.empty() || parts.back().feature != &any) parts.push_back({&any, {}, {}, {}, {}});
  return parts.back();
}

}  // namespace shapespace::cost
