#ifndef SHAPESPACE_MATCHING_DETAIL_LAPLACIAN_H_
#define SHAPESPACE_MATCHING_DETAIL_LAPLACIAN_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The Laplacian of a surface by linear finite elements: f^T `stiffness` f is the integral of
/// |grad f|^2 (the weights of edges are half the sum of the cotangents of the opposite angles), and
/// f^T diag(`areas`) f that of f^2.
struct Laplacian {
  Eigen::SparseMatrix<double> stiffness;  ///< symmetric, positive semidefinite, rows add up to 0
  Eigen::VectorXd areas;  ///< a third of the triangles' at each vertex; positive on every vertex
};

/// Every vertex must be a corner of a triangle; edges need not be manifold. Triangles without area
/// would have no cotangents: where there are any, all edges are taken to be longer by the least
/// number with which every triangle has an area (N. Sharp and K. Crane, "A Laplacian for
/// nonmanifold triangle meshes", SGP 2020, section 4.5). Cotangents are not clipped, which would
/// make the matrix indefinite.
Laplacian MakeLaplacian(const Connectivity& connectivity, const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_LAPLACIAN_H_
