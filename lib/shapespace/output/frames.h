#ifndef SHAPESPACE_OUTPUT_FRAMES_H_
#define SHAPESPACE_OUTPUT_FRAMES_H_

#include <string>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// The name of frame `number`: `pattern` with its one %d, %3d or %03d replaced.
/// \throw FileError if the pattern has no such place or more than one.
std::string FrameName(const std::string& pattern, int number);

/// Writes one mesh file a shape, numbered from 000, in the format of the pattern's extension
/// (`WriteMesh`). `appearance` gives polygons, texture coordinates and materials.
/// \throw FileError, MeshError.
void WriteFrames(const std::string& pattern, const std::vector<Shape>& shapes,
                 const Soup& appearance);

/// The appearance of a mesh that came from no file: its polygons and segments and nothing else.
Soup PlainAppearance(const Connectivity& connectivity);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_FRAMES_H_
