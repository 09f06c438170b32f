#ifndef SHAPESPACE_OUTPUT_FRAMES_H_
#define SHAPESPACE_OUTPUT_FRAMES_H_

#include <string>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// Whether the name has a place for a number, `%d`, `%3d` or `%03d`.
bool IsNumbered(const std::string& file);

/// The name of frame `number`: `pattern` with its one %d, %3d or %03d replaced.
/// \throw FileError if the pattern has no such place or more than one.
std::string FrameName(const std::string& pattern, int number);

/// Writes one mesh file per shape, numbered from 000, in the format of the pattern's extension
/// (`WriteMesh`). `soup` provides polygons, segments and appearance. `colours`, if given, are those
/// of each shape's vertices (vertex_colours.h) and replace the soup's colours, materials and
/// texture coordinates, behind which programs would hide them.
/// \throw FileError, MeshError, InvalidOptions (not as many colours as shapes).
void WriteFrames(const std::string& pattern, const std::vector<Shape>& shapes, const Soup& soup,
                 const std::vector<Eigen::MatrixXd>& colours = {});

/// `soup` with such colours.
Soup Coloured(Soup soup, const Eigen::MatrixXd& colours);

/// The content of frames besides positions: polygons, segments and appearance of a path or a body.
/// Its vertices are zero.
Soup FrameSoup(const Connectivity& connectivity, const Appearance& appearance = {});

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_FRAMES_H_
