#ifndef SHAPESPACE_TESTS_SUPPORT_THIN_TRIANGLES_H_
#define SHAPESPACE_TESTS_SUPPORT_THIN_TRIANGLES_H_

#include <array>
#include <memory>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::testing {

/// A mesh and poses of it.
struct PosedMesh {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
};

/// The same surface, some of whose triangles have one more vertex inside, at the barycentric
/// coordinates `place` of the triangle in all poses: near the middle of a side this makes a cap,
/// near a corner needles. One triangle in `every`, from the first on.
inline PosedMesh WithInnerVertices(const PosedMesh& mesh, const Eigen::Vector3d& place, int every) {
  const Eigen::Matrix3Xi& triangles = mesh.connectivity->Triangles();
  int vertex = mesh.connectivity->NumVertices();
  std::vector<Eigen::Vector3i> result, parents;
  for (int f = 0; f < triangles.cols(); ++f) {
    const Eigen::Vector3i t = triangles.col(f);
    if (f % every != 0) {
      result.push_back(t);
      continue;
    }
    for (int k = 0; k < 3; ++k) result.emplace_back(t(k), t((k + 1) % 3), vertex);
    parents.push_back(t);
    ++vertex;
  }
  PosedMesh with;
  Eigen::Matrix3Xi matrix(3, result.size());
  for (size_t f = 0; f < result.size(); ++f) matrix.col(f) = result[f];
  with.connectivity = Connectivity::FromTriangles(vertex, matrix);
  for (const Shape& pose : mesh.poses) {
    Shape shape(3, vertex);
    shape.leftCols(pose.cols()) = pose;
    for (size_t i = 0; i < parents.size(); ++i) {
      shape.col(pose.cols() + i) = pose(Eigen::all, parents[i]) * place;
    }
    with.poses.push_back(shape);
  }
  return with;
}

/// `place` of a cap over the first side of a triangle, `height` of the triangle's height above it.
inline Eigen::Vector3d CapPlace(double height) {
  return {0.5 * (1 - height), 0.5 * (1 - height), height};
}

/// `place` beside the first corner, so that a side of this length, relative to the triangle's
/// sides, is the short one of two needles.
inline Eigen::Vector3d NeedlePlace(double length) {
  return {1 - length, 0.5 * length, 0.5 * length};
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_THIN_TRIANGLES_H_
