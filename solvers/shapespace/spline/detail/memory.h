#ifndef SHAPESPACE_SPLINE_DETAIL_MEMORY_H_
#define SHAPESPACE_SPLINE_DETAIL_MEMORY_H_

#include <shapespace/mesh/connectivity.h>

namespace shapespace::internal {

/// Bytes of the correction of a chain of geodesics to a spline; the chain itself is
/// `GeodesicBytes`.
inline double SplineBytes(const Connectivity& connectivity, int poses, int shapes) {
  constexpr double kIntegrator = 3000;  // matrix and factor, per vertex, and sides
  const double vertices = connectivity.NumVertices();
  const double quantities = 2.0 * connectivity.NumTriangles() + vertices;
  const double all_shapes = poses + (poses - 1.0) * shapes;
  // Of each quantity its way and velocities in every interval, and the system for its velocities.
  return 3 * sizeof(double) * (6.0 * poses * quantities + 2 * all_shapes * vertices) +
         kIntegrator * vertices;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPLINE_DETAIL_MEMORY_H_
