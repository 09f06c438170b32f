#ifndef SHAPESPACE_OUTPUT_NORMALS_H_
#define SHAPESPACE_OUTPUT_NORMALS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Normals for smooth shading with sharp edges: the normal at a corner of a triangle is the
/// area-weighted mean over those triangles around the vertex whose normals are within a crease
/// angle of the triangle's own.
class CornerNormals {
 public:
  explicit CornerNormals(const Connectivity& connectivity);

  /// Unit normals, 3 x 3F, column 3 f + k for corner k of triangle f; zero if all triangles there
  /// have no area.
  Eigen::Matrix3Xf operator()(const Shape& shape) const;

 private:
  const Eigen::Matrix3Xi& triangles_;
  std::vector<int> begin_, faces_;  // triangles around vertex v: faces_[begin_[v]] ...
};

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_NORMALS_H_
