#ifndef SHAPESPACE_MESH_INTERNAL_CHECK_STRUCTURE_H_
#define SHAPESPACE_MESH_INTERNAL_CHECK_STRUCTURE_H_

#include <vector>

#include <shapespace/mesh/check.h>

namespace shapespace::internal {

/// Checks the preconditions for using a soup's indices: there are vertices and elements, and all
/// indices are in range. All findings are fatal.
std::vector<Finding> CheckStructure(const Soup& soup);

/// The findings of `CheckSoup` but its notes, which take as long as all others.
std::vector<Finding> CheckMesh(const Soup& soup);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_CHECK_STRUCTURE_H_
