#ifndef SHAPESPACE_ANALYSIS_INTERSECTIONS_H_
#define SHAPESPACE_ANALYSIS_INTERSECTIONS_H_

#include <cstdint>
#include <utility>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// The pairs of intersecting triangles that share no vertex, each with the smaller index first, in
/// ascending order. Their intersection must have a length, and both triangles must extend to both
/// sides of it: triangles that only touch, such as doubled vertices along a seam, or that overlap
/// within one plane, do not count. The tolerance for touching and for lengths is a billionth of the
/// shape's extent. Quadrilaterals count as their two triangles. None for a graph. Apart from the
/// tolerance the result is exact, in double precision; pairs are found by Embree's bounding volume
/// hierarchy. Time grows with the number of triangles and of pairs that are close to each other.
/// \throw MeshError if the shape has another number of vertices or is not finite; Error if Embree
///        cannot start or runs out of memory.
std::vector<std::pair<int, int>> FindIntersections(const Connectivity& connectivity,
                                                   const Shape& shape);

/// Their number.
std::int64_t CountIntersections(const Connectivity& connectivity, const Shape& shape);

/// Their number, or `most` (not negative) if there are that many or more, which takes less time
/// than to count all.
std::int64_t CountIntersections(const Connectivity& connectivity, const Shape& shape,
                                std::int64_t most);

/// Their numbers for each shape.
std::vector<std::int64_t> CountIntersections(const Connectivity& connectivity,
                                             const std::vector<Shape>& shapes);

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_INTERSECTIONS_H_
