#ifndef SHAPESPACE_MATCHING_INTERNAL_CHECK_BODY_H_
#define SHAPESPACE_MATCHING_INTERNAL_CHECK_BODY_H_

#include <string>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Whether any triangle has an area.
bool HasArea(const Connectivity& connectivity, const Shape& shape);

/// `name` is "template" or "target".
/// \throw MeshError unless the body has triangles, a finite shape with the connectivity's number of
///        vertices, and an area.
void CheckBody(const std::string& name, const Connectivity& connectivity, const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_INTERNAL_CHECK_BODY_H_
