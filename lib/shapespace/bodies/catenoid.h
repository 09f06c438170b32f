#ifndef SHAPESPACE_BODIES_CATENOID_H_
#define SHAPESPACE_BODIES_CATENOID_H_

#include <shapespace/bodies/body.h>

namespace shapespace {

/// The deformation of a catenoid to a helicoid through their associated minimal surfaces, on a grid
/// of `around` x `along` cells of two triangles. The catenoid has waist radius 1 and axis z, from
/// -half_height to half_height, and is cut open along a meridian; the helicoid makes one turn. The
/// argument of `pose(angle)` is the angle of association in degrees: 0 for the catenoid, 90 for the
/// helicoid. The smooth deformation is isometric, and every tangent plane keeps its direction.
/// Edges are chords, whose lengths change by an amount proportional to the square of the cell size.
/// \throw InvalidOptions if half_height is not in (0, 20], a count is below 3 (around) or 1
///        (along), or there would be more than 20 million triangles.
ShapeFamily MakeCatenoid(double half_height, int around, int along);

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_CATENOID_H_
