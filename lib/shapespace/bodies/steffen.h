#ifndef SHAPESPACE_BODIES_STEFFEN_H_
#define SHAPESPACE_BODIES_STEFFEN_H_

#include <shapespace/bodies/body.h>

namespace shapespace {

/// Steffen's flexible polyhedron: 9 vertices, 21 edges, 14 triangles, closed, wound outwards and
/// free of self-intersections, moving with all edges of constant length, and so with constant
/// volume. Edge 0-1 is 17 long; 0-2, 0-3, 1-2, 1-3 and the four from 8 to 4, 5, 6, 7 are 12; 4-6
/// and 5-7 are 11; 0-4, 0-6, 1-5, 1-7, 2-8, 3-8 are 10; 2-5, 2-6, 3-4, 3-7 are 5.
/// Vertices 0 to 3 stay in place. `pose(angle)` turns vertex 8 about the line from 2 to 3 by the
/// angle in degrees, from -12.5 to 12.5; at 0 a half turn about the z axis maps the body to itself.
/// Beyond 12.8 degrees faces cross.
/// K. Steffen, "A symmetric flexible Connelly sphere with only nine vertices", IHES, 1978; the edge
/// lengths are also in P. R. Cromwell, "Polyhedra", 1997, chapter 6.
ShapeFamily MakeSteffen();

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_STEFFEN_H_
