#ifndef SHAPESPACE_HIERARCHY_INTERNAL_DETAIL_H_
#define SHAPESPACE_HIERARCHY_INTERNAL_DETAIL_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The position of a fine mesh's vertices relative to a coarser one: for each the nearest triangle
/// (coarse vertices), which carries it, with barycentric weights, non-negative and of sum 1. A
/// vertex of both meshes is carried by itself.
struct Carriers {
  Eigen::Matrix3Xi vertices;  // 3 x fine
  Eigen::Matrix3Xd weights;
};

/// `kept[c]` is the index of coarse vertex c in the fine mesh; `near[v]` is a coarse vertex in the
/// neighbourhood of fine vertex v. Distances are summed over `poses` of the fine mesh.
Carriers FindCarriers(const Connectivity& coarse, const std::vector<int>& kept,
                      const std::vector<int>& near, const std::vector<Shape>& poses);

/// The rotation of each coarse vertex's neighbourhood from `rest` to `moved`: the least squares fit
/// to the edges at the vertex and the normal there.
std::vector<Eigen::Matrix3d> VertexRotations(const Connectivity& coarse, const Shape& rest,
                                             const Shape& moved);

/// The linear map of each coarse vertex's neighbourhood from `rest` to `moved`: the least squares
/// fit to the edges at the vertex, completed by the rotation along the normal.
std::vector<Eigen::Matrix3d> VertexGradients(const Connectivity& coarse, const Shape& rest,
                                             const Shape& moved);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_HIERARCHY_INTERNAL_DETAIL_H_
