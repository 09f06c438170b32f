#ifndef SHAPESPACE_OUTPUT_VTK_H_
#define SHAPESPACE_OUTPUT_VTK_H_

#include <string>

#include <shapespace/path/path.h>

namespace shapespace {

/// Writes a path for ParaView and VTK: one file of polygonal data (.vtp, XML with binary arrays)
/// per shape, numbered from 000 as by `WriteFrames`. Points are in the user's frame and unit, in
/// double precision; cells are the polygons, or the segments of a graph. Data of each point are
/// `deviation` (`EdgeDeviation`, from `reference`, 3 x m in the metric's unit; empty: the path's
/// first shape) and `energy` (`VertexEnergy`, unless the metric has a rigid part). The field
/// `TimeValue` is the shape's parameter. Each file is written completely or not at all.
/// \throw FileError if the pattern has no place for a number, or a file cannot be written;
///        MeshError as `Path::Validate`.
void WriteVtkSeries(const std::string& pattern, const Path& path, const Shape& reference = {});

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_VTK_H_
