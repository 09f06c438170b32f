#include <shapespace/metric/turning_angle.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/metric/metric_basis.h>

namespace shapespace {

Eigen::Matrix3Xi Turns(const Connectivity& connectivity) {
  if (connectivity.Segments().empty()) return {};
  std::vector<std::set<int>> neighbours(connectivity.NumVertices());
  for (const auto& [from, to] : connectivity.Segments()) {
    const int a = connectivity.Representative(from), b = connectivity.Representative(to);
    neighbours[a].insert(b);
    neighbours[b].insert(a);
  }
  std::vector<int> turns;
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    if (neighbours[v].size() != 2 || connectivity.TrianglesOfVertices()[v].size() > 0) continue;
    turns.insert(turns.end(), {*neighbours[v].begin(), v, *neighbours[v].rbegin()});
  }
  return Eigen::Map<Eigen::Matrix3Xi>(turns.data(), 3, turns.size() / 3);
}

TurningAngle TurningAngle::Freeze(const MetricBasis& basis) {
  // A curve is regarded as a strip, whose triangles make the cost of bending a surface three times
  // the integral of its squared curvature.
  constexpr double kOfHinges = 3;
  const Connectivity& connectivity = *basis.connectivity;
  TurningAngle feature;
  feature.stencils = Turns(connectivity);
  feature.weights.resize(feature.stencils.cols());
  feature.epsilon_squared = basis.CollapsedSquared();
  const double least = internal::SquaredShortest(basis.squared_length);
  for (Eigen::Index i = 0; i < feature.weights.size(); ++i) {
    const Eigen::Vector3i turn = feature.stencils.col(i);
    double length = 0, stiffness = 0;  // half the length of both segments; the mean of theirs
    for (const int e : connectivity.EdgesOfVertices()[turn(1)]) {
      const int end = connectivity.OtherEnd(e, turn(1));
      if (end != turn(0) && end != turn(2)) continue;  // a stiffener
      length += 0.5 * std::sqrt(std::max(basis.squared_length(e), least));
      stiffness += 0.5 * basis.edge_bending_stiffness(e);
    }
    feature.weights(i) = kOfHinges * stiffness * basis.vertex_area(turn(1)) / (length * length);
  }
  return feature;
}

}  // namespace shapespace
