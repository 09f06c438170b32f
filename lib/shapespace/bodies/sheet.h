#ifndef SHAPESPACE_BODIES_SHEET_H_
#define SHAPESPACE_BODIES_SHEET_H_

#include <shapespace/bodies/body.h>

namespace shapespace {

/// A flat rectangle in the xy plane, centred at the origin, length along x, in nx x ny cells of two
/// triangles. `pose(angle)` rolls it onto a cylinder about the y axis, its ends rising to +z, by
/// the angle in degrees between its two ends. The range ends at 360, where these meet, or at 90
/// degrees a cell. The smooth surface is isometric.
/// The edges are chords: one along x is shorter than at rest by a part of (angle / nx)^2 / 24
/// (angle in radians), others by less, those along y not at all.
/// \throw InvalidOptions if a length is not positive and finite, a count is below 1, or there would
///        be more than 20 million triangles.
ShapeFamily MakeSheet(double length, double width, int nx, int ny);

/// A zigzag strip of equal isosceles triangles, whose motion is exactly isometric. At rest it lies
/// in the xy plane along x; its vertices alternate between the sides y = width / 2 and y = -width /
/// 2, and those of one side are `side` apart. `pose(angle)` folds every hinge by the same angle in
/// degrees (0: flat) towards +z. All vertices then lie on two circles: the strip is a part of an
/// antiprism's side. The range ends where the strip closes to a ring or, in narrow strips of few
/// triangles, shortly before the hinges are closed.
/// \throw InvalidOptions if a length is not positive and finite, side is above 10000 widths, or
///        there are fewer than 2 triangles or more than 20 million.
ShapeFamily MakeStrip(double side, double width, int triangles);

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_SHEET_H_
