#ifndef SHAPESPACE_BODIES_BRICARD_H_
#define SHAPESPACE_BODIES_BRICARD_H_

#include <shapespace/bodies/body.h>

namespace shapespace {

/// A flexible octahedron: 6 vertices, 12 edges, 8 triangles (which cross each other, as in every
/// flexible octahedron), moving with all edges of constant length. It is of Bricard's second type,
/// with a plane of symmetry, y = 0: vertices 0, 1 mirror each other, and so do 2, 3; vertices 4, 5
/// lie in the plane. Opposite are 0 and 1, 2 and 3, 4 and 5. `pose(angle)` has the edge from 0 to 2
/// at that angle, in degrees, to the plane of symmetry, from -35 to 50. Its volume, counted with
/// signs, is zero throughout.
/// R. Bricard, "Mémoire sur la théorie de l'octaèdre articulé", 1897.
Body MakeBricard();

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_BRICARD_H_
