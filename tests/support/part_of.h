#ifndef SHAPESPACE_TESTS_SUPPORT_PART_OF_H_
#define SHAPESPACE_TESTS_SUPPORT_PART_OF_H_

#include <memory>
#include <utility>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/internal/submesh.h>
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
  internal::Submesh part = internal::MakeSubmesh(body, keep);
  const Shape own = shape(Eigen::all, part.vertices);
  return {std::move(part.connectivity), own, std::move(part.vertices)};
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_PART_OF_H_
