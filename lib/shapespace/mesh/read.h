#ifndef SHAPESPACE_MESH_READ_H_
#define SHAPESPACE_MESH_READ_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// Reads an OBJ, PLY (text, or binary of either byte order) or OFF file, told by its extension.
/// Coordinates are doubles and everything stays in the file's order; nothing is repaired.
/// \throw FileError naming file, line and element: unreadable, empty or truncated file, a number
///        that is none, an index out of range, an unknown extension.
Soup ReadSoup(const std::string& file);

/// Changes the sign of the coordinate `axis`, 'x', 'y' or 'z', of a pose that is a mirror image of
/// the reference (`IsMirrored`, with the reference's polygons, which must be valid). True if it was
/// one. \throw InvalidOptions if there is no such axis.
bool MirrorBack(const Soup& reference, char axis, Soup* pose);

/// The connectivity of a mesh whose `poses`, of as many vertices, decide how its polygons are cut
/// (`Triangulate`). \throw MeshError as `Connectivity::Make` and `Triangulate`.
std::shared_ptr<const Connectivity> ConnectivityOf(
    const Soup& soup, const std::vector<Shape>& poses,
    const std::vector<std::pair<int, int>>& stiffeners = {});

/// Reads pairs of vertex numbers, counted from 1 as in OBJ, one pair a line; `#` begins a comment.
/// \return pairs counted from 0.
/// \throw FileError naming file and line.
std::vector<std::pair<int, int>> ReadStiffeners(const std::string& file, int num_vertices);

/// Poses of one mesh, ready for a solver.
struct Poses {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> shapes;          ///< one a file, in the files' units
  std::vector<std::string> names;     ///< the files
  Soup soup;                          ///< of the first file: polygons, appearance
  std::vector<std::string> warnings;  ///< what `CheckSoup` and `CheckCorrespondence` had to say
};

struct ReadOptions {
  bool allow_nonmanifold =
      false;               ///< take non-manifold or inconsistently wound meshes, with a warning
  std::string stiffeners;  ///< file of further edges; empty for none

  /// 'x', 'y' or 'z': poses that are mirror images of the first (closed meshes only: `IsMirrored`)
  /// have this coordinate's sign changed. 0: they are refused.
  char mirror = 0;
};

/// Reads one or more files as poses of the first one's connectivity.
/// \throw FileError, MeshError (fatal findings of `CheckSoup`), CorrespondenceError (fatal findings
///        of `CheckCorrespondence`, naming the first difference).
Poses ReadPoses(const std::vector<std::string>& files, const ReadOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_READ_H_
