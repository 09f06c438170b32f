#ifndef SHAPESPACE_FILES_POINT_CACHE_H_
#define SHAPESPACE_FILES_POINT_CACHE_H_

#include <string>
#include <vector>

#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Whether the file's extension is one of a point cache.
bool IsPointCache(const std::string& file);

/// Writes shapes as a point cache, from which animation programs move the vertices of a mesh that
/// they have: one shape a frame, positions as given, in single precision. The extension tells
/// the format:
/// - .pc2 (Blender, 3ds Max, Maya, Houdini): version 1, little-endian; the first frame is 0, and
///   there is one sample a frame.
/// - .mdd (Blender, LightWave, Maya, Houdini): big-endian; frame i has the time i / `fps` seconds.
///
/// The file is written completely or not at all.
/// \throw InvalidOptions if `fps` is not in 0.01 .. 1000; FileError if the extension is neither or
///        the file cannot be written; MeshError if there is no shape, if shapes have different
///        numbers of vertices, or if a coordinate is not finite or would change by more than a
///        ten-thousandth of its shape's diagonal.
void WritePointCache(const std::string& file, const std::vector<Shape>& shapes, double fps = 24);

/// What a point cache holds.
struct PointCache {
  std::vector<Shape> shapes;  ///< one a frame, of one number of vertices
  bool even = true;           ///< whether frames follow each other in equal times; .pc2 always
};

/// Reads a point cache; its extension tells the format, as above. It has no faces: `ReadPoses`
/// takes those of the mesh that is named before it.
/// \throw FileError naming file, frame and vertex: the extension is neither, the file is cut off or
///        of another kind, has no frames, or a coordinate is not finite.
PointCache ReadPointCache(const std::string& file);

}  // namespace shapespace

#endif  // SHAPESPACE_FILES_POINT_CACHE_H_
