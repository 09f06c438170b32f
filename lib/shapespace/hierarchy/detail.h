#ifndef SHAPESPACE_HIERARCHY_DETAIL_H_
#define SHAPESPACE_HIERARCHY_DETAIL_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Where the vertices of a fine mesh sit on a coarser one: on the triangle (coarse vertices) that
/// comes nearest, with barycentric weights, non-negative and of sum 1. A vertex that both have sits
/// on itself.
struct Carriers {
  Eigen::Matrix3Xi vertices;  // 3 x fine
  Eigen::Matrix3Xd weights;
};

/// `kept[c]` is the fine vertex that coarse vertex c is; `near[v]` a coarse vertex in the
/// neighbourhood of fine vertex v. Distances are summed over `poses` of the fine mesh.
Carriers FindCarriers(const Connectivity& coarse, const std::vector<int>& kept,
                      const std::vector<int>& near, const std::vector<Shape>& poses);

/// The rotation of each coarse vertex's neighbourhood from `rest` to `moved`: best for the edges at
/// the vertex and the normal there.
std::vector<Eigen::Matrix3d> VertexRotations(const Connectivity& coarse, const Shape& rest,
                                             const Shape& moved);

/// The linear map of each coarse vertex's neighbourhood from `rest` to `moved`: best for the edges
/// at the vertex, which its rotation completes by the normal.
std::vector<Eigen::Matrix3d> VertexGradients(const Connectivity& coarse, const Shape& rest,
                                             const Shape& moved);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_HIERARCHY_DETAIL_H_
