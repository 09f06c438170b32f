#ifndef SHAPESPACE_FILES_READ_H_
#define SHAPESPACE_FILES_READ_H_

#include <iosfwd>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <shapespace/mesh/check.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// Reads a mesh file, according to its extension: OBJ, PLY (text, or binary of either byte order),
/// OFF, STL (text or binary), glTF 2.0 (.glb, .gltf), or VTK: legacy (.vtk, text or binary,
/// polygonal data or the surface cells of an unstructured grid) or XML polygonal data (.vtp, also
/// compressed by zlib). Coordinates are doubles and all elements remain in the file's order;
/// nothing is repaired. STL and glTF store a vertex once for each of its triangles, normals or
/// texture coordinates: vertices with exactly equal coordinates, in glTF in all poses, become one,
/// in the order of their first occurrence.
///
/// A glTF file must have one mesh. It is transformed as its node says, and read as the first of
/// several poses if it has morph targets (`ReadSoups`); `Soup::dropped` tells that there are more.
/// The buffers of a .gltf must lie in its folder or below it, links followed, unless
/// `allow_outside_files`, for files that are trusted.
/// \throw FileError naming file, line and element: unreadable, empty or truncated file, an invalid
///        number, an index out of range, an unknown extension, a buffer outside of the folder.
Soup ReadSoup(const std::string& file, bool allow_outside_files = false);

/// All poses of a file: of glTF the mesh and then each morph target, fully applied and with its
/// name as `Soup::name`; of the other formats one. They have the same polygons.
std::vector<Soup> ReadSoups(const std::string& file, bool allow_outside_files = false);

enum class MeshFormat { kObj, kPly, kOff, kStl, kGltf, kVtk, kVtp };

/// `ReadSoup` for a stream, from its current position to its end; binary formats need a binary
/// stream. `name` is used in messages and as the soup's `file`. Material libraries of an OBJ, and
/// buffers of a .gltf, are searched in the folder of that name and below it.
/// \throw FileError as above, and if the stream fails or is empty.
Soup ReadSoup(std::istream& stream, const std::string& name, MeshFormat format);

/// Changes the sign of the coordinate `axis`, 'x', 'y' or 'z', of a pose that is a mirror image of
/// the reference (`IsMirrored`, with the reference's polygons, which must be valid). Returns
/// whether it was one.
/// \throw InvalidOptions if there is no such axis.
bool MirrorBack(const Soup& reference, char axis, Soup* pose);

/// The connectivity of a mesh, whose polygons are triangulated according to their shape in `poses`
/// (`Triangulate`), which have the same number of vertices. `representatives` are those of vertices
/// at seams (`FindSeams`).
/// \throw MeshError as `Connectivity::Make` and `Triangulate`.
std::shared_ptr<const Connectivity> ConnectivityOf(
    const Soup& soup, const std::vector<Shape>& poses,
    const std::vector<std::pair<int, int>>& stiffeners = {},
    const std::vector<int>& representatives = {});

/// Reads pairs of vertex numbers, counted from 1 as in OBJ, one pair per line; `#` begins a
/// comment.
/// \return pairs counted from 0.
/// \throw FileError naming file and line.
std::vector<std::pair<int, int>> ReadStiffeners(const std::string& file, int num_vertices);

/// Poses of one mesh, ready for a solver.
struct Poses {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> shapes;          ///< one per soup, in its unit
  std::vector<std::string> names;     ///< of each: `Soup::name` or, without, `Soup::file`
  Soup soup;                          ///< the first: polygons, appearance
  std::vector<std::string> warnings;  ///< from `CheckSoup` and `CheckSameMesh`
  std::vector<std::string> notes;     ///< what was done with the mesh that is right as a rule
};

/// Options for meshes that are used as poses.
struct ReadOptions {
  bool allow_nonmanifold = false;    ///< accept non-manifold or inconsistent meshes, with a warning
  std::string stiffeners;            ///< file of additional edges; empty for none
  bool allow_outside_files = false;  ///< read buffers of a .gltf from outside of its folder too

  /// Leave components loose, such as eyes and clothes, although they stay near others in all poses.
  /// By default they are tied to these (`TieComponents`), and a note says how many.
  bool loose_components = false;

  /// 'x', 'y' or 'z': change the sign of this coordinate in poses that are mirror images of the
  /// first (`IsMirrored`). 0: they are refused, unless `allow_mirrored`.
  char mirror = 0;
  /// Take poses that look like mirror images of the first as they are, with a warning: a dome that
  /// is pushed through, a body that is turned inside out.
  bool allow_mirrored = false;
  /// Take poses as they are, with a warning, whose units or order of vertices seem to be others
  /// than those of the first: `Severity::kDoubtful`.
  bool allow_mismatch = false;

  /// Leave seams open, where borders of the surface lie on each other in all poses: for lips that
  /// never part. By default their vertices are one point of the surface (`FindSeams`), and a note
  /// says how many; shapes have the vertices of the file all the same.
  bool open_seams = false;
};

/// Whether the options refuse a mesh or a pose with this finding.
bool IsRefused(const Finding& finding, const ReadOptions& options);

/// Reads one or more files, with all poses that they have, as poses of the first one's
/// connectivity. The frames of a point cache (`ReadPointCache`) are poses of the mesh in the file
/// that is named before it, which lends its faces and is no pose itself.
/// \throw FileError, MeshError (fatal findings of `CheckSoup`), MismatchError (those of
///        `CheckSameMesh`, naming the first difference; DifferentMeshes if their faces differ).
Poses ReadPoses(const std::vector<std::string>& files, const ReadOptions& options = {});

/// The same for soups from other sources: `ReadSoup` makes them from streams, `MakeSoup`
/// (mesh/arrays.h) from matrices, `FromOpenMesh` (mesh/openmesh.h) from OpenMesh's meshes. They are
/// checked in the same way; messages name them by `Soup::file`.
/// \throw MeshError also if there is none.
Poses MakePoses(std::vector<Soup> soups, const ReadOptions& options = {});

/// Adds stiffeners to the connectivity of poses that tie components to others near which they stay
/// in all poses (`FindTies`), and says how many in the notes. Components that stiffeners connect
/// already are not tied once more.
void TieComponents(Poses* poses);

}  // namespace shapespace

#endif  // SHAPESPACE_FILES_READ_H_
