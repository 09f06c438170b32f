#ifndef SHAPESPACE_ANALYSIS_INTERSECTIONS_H_
#define SHAPESPACE_ANALYSIS_INTERSECTIONS_H_

#include <cstdint>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// The number of pairs of triangles that share no vertex and pass through each other: where a body
/// passes through itself. They must meet along a line of some length, and both must reach beyond
/// it; what only touches, such as doubled vertices along a seam, or lies on each other in one
/// plane, is no intersection. What counts as touching, and as no length, is a billionth of the
/// shape's extent. Quadrilaterals count as their two triangles. 0 for a graph.
/// Exact up to that, in doubles; pairs are found by Embree's hierarchy of boxes. Time grows with
/// the triangles and with those that are close to each other.
/// \throw MeshError if the shape has another number of vertices or is not finite; Error if Embree
///        cannot start or runs out of memory.
std::int64_t CountIntersections(const Connectivity& connectivity, const Shape& shape);

/// The same of each shape.
std::vector<std::int64_t> CountIntersections(const Connectivity& connectivity,
                                             const std::vector<Shape>& shapes);

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_INTERSECTIONS_H_
