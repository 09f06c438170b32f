#ifndef SHAPESPACE_MESH_SHAPE_H_
#define SHAPESPACE_MESH_SHAPE_H_

#include <Eigen/Core>

namespace shapespace {

/// A point of shape space: the positions of all m vertices, 3 x m, one vertex a column.
using Shape = Eigen::Matrix3Xd;

/// A tangent vector of shape space: one velocity a vertex. Same storage as a `Shape`.
using Tangent = Eigen::Matrix3Xd;

/// Coordinates may be as far from zero as this, in any unit, and a mesh no smaller than its
/// reciprocal: powers of lengths are then numbers too.
inline constexpr double kLargestCoordinate = 1e60;

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_SHAPE_H_
