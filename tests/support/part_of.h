#ifndef SHAPESPACE_TESTS_SUPPORT_PART_OF_H_
#define SHAPESPACE_TESTS_SUPPORT_PART_OF_H_

#include <memory>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::testing {

/// Some triangles of a body as a mesh of their own.
struct Part {
  std::shared_ptr<const Connectivity> connectivity;
  Shape shape;
  std::vector<int> vertices;  ///< per vertex, its number in the body of which it is a part
};

/// The triangles of a body in `shape` whose numbers are kept.
template <typename Keep>
Part PartOf(const Connectivity& body, const Shape& shape, const Keep& keep) {
  std::vector<int> index(shape.cols(), -1), triangles;
  for (int f = 0; f < body.NumTriangles(); ++f) {
    if (!keep(f)) continue;
    triangles.push_back(f);
    for (const int v : body.Triangles().col(f)) index[v] = 0;
  }
  Part part;
  for (int v = 0; v < shape.cols(); ++v) {
    if (index[v] < 0) continue;
    index[v] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(v);
  }
  const Eigen::Matrix3Xi chosen = body.Triangles()(Eigen::all, triangles);
  part.connectivity = Connectivity::FromTriangles(
      static_cast<int>(part.vertices.size()), chosen.unaryExpr([&](int v) { return index[v]; }));
  part.shape = shape(Eigen::all, part.vertices);
  return part;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_PART_OF_H_
