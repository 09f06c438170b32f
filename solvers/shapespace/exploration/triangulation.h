#ifndef SHAPESPACE_EXPLORATION_TRIANGULATION_H_
#define SHAPESPACE_EXPLORATION_TRIANGULATION_H_

#include <vector>

#include <Eigen/Core>

namespace shapespace {

/// A triangulation of points of the plane, or their order on a line.
struct Triangulation {
  Eigen::Matrix3Xi triangles;  ///< counterclockwise; empty if all points lie on a line
  Eigen::Matrix2Xi segments;   ///< in that case: from each point to the next on the line
  std::vector<int> left_out;   ///< points that coincide with an earlier one
};

/// Points whose spread across a line is less than this share of that along it are treated as
/// collinear. This is the accuracy with which lengths of geodesics determine the position of a
/// shape between two others (docs/mathematics.md, section 13).
inline constexpr double kFlatSpread = 1e-2;

/// The Delaunay triangulation of points of the plane, by Qhull.
/// \throw InvalidOptions if a point is not finite, or if fewer than two differ; SolverError if
///        Qhull fails.
Triangulation DelaunayTriangulation(const Eigen::Matrix2Xd& points);

}  // namespace shapespace

#endif  // SHAPESPACE_EXPLORATION_TRIANGULATION_H_
