#ifndef SHAPESPACE_MESH_SHAPE_H_
#define SHAPESPACE_MESH_SHAPE_H_

#include <Eigen/Core>

namespace shapespace {

/// A point of shape space: the positions of all m vertices, 3 x m, one vertex per column.
using Shape = Eigen::Matrix3Xd;

/// A tangent vector of shape space: one velocity per vertex. Same storage as a `Shape`.
using Tangent = Eigen::Matrix3Xd;

/// Limit of coordinates' magnitudes, in any unit, and of the reciprocal of a mesh's size, so that
/// powers of lengths do not overflow or underflow.
inline constexpr double kLargestCoordinate = 1e60;

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_SHAPE_H_
