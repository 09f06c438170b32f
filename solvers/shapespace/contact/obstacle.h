#ifndef SHAPESPACE_CONTACT_OBSTACLE_H_
#define SHAPESPACE_CONTACT_OBSTACLE_H_

#include <memory>
#include <optional>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A surface that does not move, which a body is not to touch: a wall, a floor, a piece of
/// furniture. It may be open and may consist of several parts.
struct Obstacle {
  std::shared_ptr<const Connectivity> connectivity;
  Shape shape;  ///< in the frame and the unit of the body's poses

  /// \throw MeshError if it has no triangle, or the shape is not finite or has another number of
  ///        vertices.
  void Validate() const;

  /// A body, followed by the obstacle: their triangles and segments, and a shape.
  std::shared_ptr<const Connectivity> Joined(const std::shared_ptr<const Connectivity>& body) const;
  Shape Joined(const Shape& body) const;
};

namespace internal {

/// \throw InvalidOptions naming the field, MeshError; for options with `avoid_contact`.
void CheckObstacle(const std::optional<Obstacle>& obstacle, bool avoid_contact);

/// The same obstacle in another frame: seen from `origin`, in so many times the user's unit.
inline Obstacle InFrame(Obstacle obstacle, const Eigen::Vector3d& origin, double unit) {
  obstacle.shape = (obstacle.shape.colwise() - origin) / unit;
  return obstacle;
}

}  // namespace internal
}  // namespace shapespace

#endif  // SHAPESPACE_CONTACT_OBSTACLE_H_
