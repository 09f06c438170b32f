#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_NEAREST_CORNERS_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_NEAREST_CORNERS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/correspondence/surface_map.h>
#include <shapespace/mesh/connectivity.h>

namespace shapespace::internal {

/// Of each point on a mesh the corner of its triangle that has the greatest weight.
inline std::vector<int> NearestCorners(const SurfacePoints& points,
                                       const Connectivity& connectivity) {
  std::vector<int> corners(points.NumVertices());
  for (int i = 0; i < points.NumVertices(); ++i) {
    Eigen::Index nearest = 0;
    points.barycentric.col(i).maxCoeff(&nearest);
    corners[i] = connectivity.Triangles()(nearest, points.triangle(i));
  }
  return corners;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_NEAREST_CORNERS_H_
