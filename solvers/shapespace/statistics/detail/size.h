#ifndef SHAPESPACE_STATISTICS_DETAIL_SIZE_H_
#define SHAPESPACE_STATISTICS_DETAIL_SIZE_H_

#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The root of a shape's area; of a graph without triangles the length of its edges.
double Size(const Connectivity& connectivity, const Shape& shape);

/// Scales each shape about its own vertices' mean to the mean of their sizes.
void ScaleToMeanSize(const Connectivity& connectivity, std::vector<Shape>* shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_SIZE_H_
