#include <shapespace/metric/detail/collapse.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

#include <shapespace/metric/edge_length.h>
#include <shapespace/metric/triangle_strain.h>

namespace shapespace::internal {
namespace {

constexpr double kCollapseStrain = 3;

// Of an element with the corners `vertices` and the given numbers of a feature whose values are
// strains.
template <typename Strain>
double Kept(const MetricBasis& basis, double collapsed_squared,
            const std::array<int, Strain::kVertices>& vertices,
            const std::array<double, Strain::kNumbers>& numbers) {
  Strain strain;
  strain.epsilon_squared = collapsed_squared;
  using Values = Eigen::Matrix<double, Strain::kValues, 1>;
  Values value, before = Values::Zero(), low = before, high = before;
  double greatest = 0;
  for (size_t i = 0; i < basis.poses.size(); ++i) {
    double x[Strain::kInputs];
    for (int k = 0; k < Strain::kVertices; ++k) {
      Eigen::Map<Eigen::Vector3d>(x + 3 * k) = basis.poses[i].col(vertices[k]);
    }
    std::copy(numbers.begin(), numbers.end(), x + 3 * Strain::kVertices);
    strain(x, value.data());
    if (i == 0) {
      low = high = value;
    } else {
      greatest = std::max(greatest, (value - before).norm());
    }
    low = low.cwiseMin(value);
    high = high.cwiseMax(value);
    before = value;
  }
  const double change = basis.pairs == PosePairs::kAll ? (high - low).norm() : greatest;
  return 1 / (1 + std::pow(change / kCollapseStrain, 8));
}

}  // namespace

double KeptInCollapse(const MetricBasis& basis, double collapsed_squared,
                      const Eigen::Vector4d& rest, int a, int b, int c) {
  return Kept<TriangleStrain>(basis, collapsed_squared, {a, b, c},
                              {rest(0), rest(1), rest(2), rest(3)});
}

double KeptInCollapse(const MetricBasis& basis, double collapsed_squared, int a, int b) {
  return Kept<LogLength>(basis, collapsed_squared, {a, b}, {});
}

}  // namespace shapespace::internal
