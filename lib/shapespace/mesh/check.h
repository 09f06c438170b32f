#ifndef SHAPESPACE_MESH_CHECK_H_
#define SHAPESPACE_MESH_CHECK_H_

#include <string>
#include <vector>

#include <shapespace/mesh/soup.h>

namespace shapespace {

enum class Severity {
  kNote,         ///< a fact: components, boundary loops, genus
  kWarning,      ///< usable, but should be checked
  kNonManifold,  ///< refused unless the caller permits it; every metric works on graphs
  kMirrored,     ///< a pose that is refused unless the caller permits it or has it mirrored back
  kDoubtful,     ///< a pose that is refused unless the caller says that it is right: in other
                 ///< units, or with its vertices in another order
  kFatal,        ///< not usable
};

/// One result of a check, for all elements concerned; the first few of them are named.
struct Finding {
  Severity severity;
  std::string kind;     ///< a stable key, e.g. "non-manifold-edge"; docs/checks.md lists them all
  std::string message;  ///< file, line, element, count and remedy
  /// The field of `ReadOptions` that accepts or mends this; empty if there is none.
  std::string option = {};
  /// The polygons of the two meshes connect other vertices, and not only because they are cut along
  /// other diagonals: what `DifferentMeshes` is thrown for.
  bool different_meshes = false;
};

/// All findings about one mesh, in order of descending severity. Components, borders and genus are
/// those of the surface whose seams (mesh/seams.h) are joined, unless `open_seams`.
std::vector<Finding> CheckSoup(const Soup& soup, bool open_seams = false);

/// Whether `pose` is the same mesh as `reference` with other vertex positions. Compares counts,
/// finds the first polygon that differs (and whether only the order differs), and finds groups of
/// vertices whose edges have stretched by orders of magnitude, which shows wrong orders of vertices
/// that counts do not show.
std::vector<Finding> CheckSameMesh(const Soup& reference, const Soup& pose);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_CHECK_H_
