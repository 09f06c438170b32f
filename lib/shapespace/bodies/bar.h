#ifndef SHAPESPACE_BODIES_BAR_H_
#define SHAPESPACE_BODIES_BAR_H_

#include <shapespace/bodies/body.h>

namespace shapespace {

/// The closed surface of a box, centred at the origin with its length along x, width along y and
/// height along z, in nx x ny x nz cells. `pose(angle)` bends it about the y axis to a circular
/// arc, by the angle in degrees between its two ends, which rise to +z. The middle line keeps its
/// length. The smooth body is bent about its middle plane, so that its volume remains length *
/// width * height; the mesh's volume converges to that with the square of the cell length.
/// The range ends at a full circle, at 90 degrees a cell, or where the inner face is left with a
/// tenth of its length.
/// \throw InvalidOptions if a length is not positive and finite, a count is below 1, or there would
///        be more than 20 million triangles.
ShapeFamily MakeBar(double length, double width, double height, int nx, int ny, int nz);

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_BAR_H_
