#ifndef SHAPESPACE_MESH_CHECK_H_
#define SHAPESPACE_MESH_CHECK_H_

#include <string>
#include <vector>

#include <shapespace/mesh/soup.h>

namespace shapespace {

enum class Severity {
  kNote,         ///< a fact: components, boundary loops, genus
  kWarning,      ///< usable, but look at it
  kNonManifold,  ///< refused unless the caller allows it; every metric works on graphs
  kFatal,        ///< not usable
};

/// One thing found, said once for all elements that share it: the first few are named.
struct Finding {
  Severity severity;
  std::string kind;     ///< a stable key, e.g. "non-manifold-edge"; docs/checks.md lists them all
  std::string message;  ///< file, line, element, count and remedy
};

/// Everything worth saying about one mesh. Findings come in order of falling severity.
std::vector<Finding> CheckSoup(const Soup& soup);

/// Whether `pose` is the same mesh as `reference` with other vertex positions: counts, the first
/// polygon that differs (and whether only the order differs), and groups of vertices whose edges
/// stretch together by orders of magnitude, which counts cannot show.
std::vector<Finding> CheckCorrespondence(const Soup& reference, const Soup& pose);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_CHECK_H_
