#ifndef SHAPESPACE_TESTS_SUPPORT_RENUMBERED_H_
#define SHAPESPACE_TESTS_SUPPORT_RENUMBERED_H_

#include <memory>
#include <utility>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::testing {

/// The same body with its vertices in another order: vertex v becomes vertex order[v].
inline std::pair<std::shared_ptr<const Connectivity>, Shape> Renumbered(
    const Connectivity& connectivity, const Shape& shape, const std::vector<int>& order) {
  Shape renumbered(3, shape.cols());
  renumbered(Eigen::all, order) = shape;
  const Eigen::Matrix3Xi triangles =
      connectivity.Triangles().unaryExpr([&](int v) { return order[v]; });
  return {Connectivity::FromTriangles(connectivity.NumVertices(), triangles), renumbered};
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_RENUMBERED_H_
