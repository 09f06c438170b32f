#ifndef SHAPESPACE_BODIES_BRICARD_H_
#define SHAPESPACE_BODIES_BRICARD_H_

#include <shapespace/bodies/body.h>

namespace shapespace {

/// A flexible octahedron: 6 vertices, 12 edges, 8 triangles (which intersect, as in every flexible
/// octahedron), moving with all edges of constant length. It is of Bricard's second type, with the
/// plane of symmetry y = 0: vertices 0, 1 are mirror images of each other, and so are 2, 3;
/// vertices 4, 5 lie in the plane. Opposite vertices are 0 and 1, 2 and 3, 4 and 5. In
/// `pose(angle)` the edge from 0 to 2 has this angle, in degrees from -35 to 50, to the plane of
/// symmetry. Its signed volume is always zero.
/// R. Bricard, "Mémoire sur la théorie de l'octaèdre articulé", 1897.
ShapeFamily MakeBricard();

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_BRICARD_H_
