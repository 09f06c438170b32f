// The deviation of a path's increments from another's, against its definition.

#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/tube.h>
#include <shapespace/contact/detail/increments.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {
namespace {

// The values of all features of a shape, times the square roots of their weights.
Eigen::VectorXd Values(const Metric& metric, const Shape& shape) {
  std::vector<double> all;
  for (const auto& feature : metric.features) {
    const int elements = feature->NumElements(), values = feature->ValuesPerElement();
    std::vector<double> x(feature->InputsPerElement() * elements), value(values * elements);
    feature->GatherCoordinates(0, elements, shape, x.data());
    feature->Evaluate(elements, x.data(), value.data());
    for (size_t k = 0; k < value.size(); ++k) {
      all.push_back(std::sqrt(feature->Weight(static_cast<int>(k) / values)) * value[k]);
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), all.size());
}

// A tube between two bends, with inner shapes that are disturbed.
struct Case {
  explicit Case(int seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-0.02, 0.02);
    for (int k = 0; k < 5; ++k) {
      Shape shape = tube.pose(10 * k);
      if (k > 0 && k < 4) shape = shape.unaryExpr([&](double x) { return x + uniform(random); });
      shapes.push_back(std::move(shape));
    }
    metric = FreezeMetric({}, tube.connectivity, {tube.pose(0), tube.pose(40)}, 1);
    for (Shape& shape : shapes) shape /= metric->unit;
  }
  const ShapeFamily tube = MakeTube(200);
  std::shared_ptr<const Metric> metric;
  std::vector<Shape> shapes;
};

TEST(Increments, WithTheEnergyAreTheSquaredDeviationFromTheGuide) {
  const Case path(1), guide(2);
  const Metric& metric = *path.metric;
  PathEnergy energy(path.metric, 3);
  std::vector<double> x(energy.Size());
  energy.Load(path.shapes, x.data());
  Increments increments(path.metric, energy, guide.shapes);
  const double value = energy.Evaluate(x.data(), nullptr) + increments.Evaluate(x.data(), nullptr);
  double expected = 0;
  for (int k = 0; k < 4; ++k) {
    const auto step = [&](const std::vector<Shape>& shapes) -> Eigen::VectorXd {
      return Values(metric, shapes[k + 1]) - Values(metric, shapes[k]);
    };
    expected += 2 * (step(path.shapes) - step(guide.shapes)).squaredNorm();
  }
  EXPECT_NEAR(value, expected, 1e-9 * energy.Evaluate(x.data(), nullptr));
}

TEST(Increments, HaveTheDerivativesOfTheirValue) {
  const Case path(3), guide(4);
  PathEnergy energy(path.metric, 3);
  std::vector<double> x(energy.Size()), gradient(energy.Size()), direction(energy.Size());
  std::vector<Shape> change = guide.shapes;
  for (int k = 0; k < 5; ++k) change[k] -= path.shapes[k];
  energy.Load(change, direction.data());
  energy.Load(path.shapes, x.data());
  Increments increments(path.metric, energy, guide.shapes);
  const auto at = [&](double t) {
    std::vector<Shape> moved = path.shapes;
    for (int k = 1; k < 4; ++k) moved[k] += t * change[k];
    std::vector<double> y(energy.Size());
    energy.Load(moved, y.data());
    return increments.Evaluate(y.data(), nullptr);
  };
  increments.Evaluate(x.data(), gradient.data());
  double slope = 0;
  for (size_t i = 0; i < x.size(); ++i) slope += gradient[i] * direction[i];
  const double step = 1e-5;
  EXPECT_NEAR(slope, (at(step) - at(-step)) / (2 * step), 1e-6 * std::abs(slope));
}

}  // namespace
}  // namespace shapespace::internal
