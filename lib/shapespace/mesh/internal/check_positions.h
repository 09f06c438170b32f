#ifndef SHAPESPACE_MESH_INTERNAL_CHECK_POSITIONS_H_
#define SHAPESPACE_MESH_INTERNAL_CHECK_POSITIONS_H_

#include <vector>

#include <shapespace/mesh/check.h>

namespace shapespace::internal {

/// The findings of `CheckSoup` that depend on the vertices' positions: coordinates that are not
/// finite, edges without length, polygons without area. The soup's indices must be in range.
std::vector<Finding> CheckPositions(const Soup& soup);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_CHECK_POSITIONS_H_
