#ifndef SHAPESPACE_OUTPUT_NORMALS_H_
#define SHAPESPACE_OUTPUT_NORMALS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Normals for smooth shading that leaves sharp edges sharp: a corner of a triangle averages, by
/// area, the triangles around its vertex that lie within a crease angle of its own.
class CornerNormals {
 public:
  explicit CornerNormals(const Connectivity& connectivity);

  /// Unit normals, 3 x 3F, column 3 f + k for corner k of triangle f; zero where only triangles
  /// without area meet.
  Eigen::Matrix3Xf operator()(const Shape& shape) const;

 private:
  const Eigen::Matrix3Xi& triangles_;
  std::vector<int> begin_, faces_;  // triangles around vertex v: faces_[begin_[v]] ...
};

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_NORMALS_H_
