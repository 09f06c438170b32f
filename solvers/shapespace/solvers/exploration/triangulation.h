#ifndef SHAPESPACE_SOLVERS_EXPLORATION_TRIANGULATION_H_
#define SHAPESPACE_SOLVERS_EXPLORATION_TRIANGULATION_H_

#include <vector>

#include <Eigen/Core>

namespace shapespace {

/// What lies between points of the plane.
struct Triangulation {
  Eigen::Matrix3Xi triangles;  ///< counterclockwise; none where all points lie on a line
  Eigen::Matrix2Xi segments;   ///< then: from each point to the next on the line
  std::vector<int> left_out;   ///< points that coincide with one before them
};

/// Points that spread across a line by less than this share of how far they reach along it count as
/// lying on it: that is how precisely lengths of geodesics tell where a shape between two others is
/// (docs/mathematics.md, section 13).
inline constexpr double kFlatSpread = 1e-2;

/// The Delaunay triangulation of points of the plane, by Qhull.
/// \throw InvalidOptions if a point is not finite, or if fewer than two differ; SolverError if
///        Qhull fails.
Triangulation Triangulate(const Eigen::Matrix2Xd& points);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_EXPLORATION_TRIANGULATION_H_
