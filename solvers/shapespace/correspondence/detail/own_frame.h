#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_OWN_FRAME_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_OWN_FRAME_H_

#include <cmath>

#include <Eigen/Core>

#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// A body's own frame, in which its area is 1 and its centroid is at the origin.
struct OwnFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double unit = 1;

  OwnFrame(const Connectivity& connectivity, const Shape& shape) {
    // In two steps, to avoid cancellation far from the origin and overflow of squares.
    const Eigen::Vector3d low = shape.rowwise().minCoeff();
    const double extent = (shape.rowwise().maxCoeff() - low).maxCoeff();
    const Shape near = (shape.colwise() - low) / extent;
    double area = 0;
    for (const auto& triangle : connectivity.Triangles().colwise()) {
      area += TriangleArea(near, triangle);
    }
    centre = low + extent * (near * VertexAreas(connectivity, near));
    unit = extent * std::sqrt(area);
  }

  Shape In(const Shape& shape) const { return (shape.colwise() - centre) / unit; }
  Shape Out(const Shape& shape) const { return (unit * shape).colwise() + centre; }
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_OWN_FRAME_H_
