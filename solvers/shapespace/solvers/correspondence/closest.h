#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_CLOSEST_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_CLOSEST_H_

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/surface.h>
#include <shapespace/solvers/correspondence/marker_distances.h>
#include <shapespace/solvers/correspondence/shell_fit.h>

// Private.

namespace shapespace::internal {

/// Where an open surface ends.
struct Border {
  /// Of each triangle, whether the side opposite to corner k is no other triangle's.
  std::vector<std::array<bool, 3>> sides;
  std::vector<bool> vertices;  ///< whether each vertex is an end of such a side
};
Border BorderOf(const Connectivity& connectivity);

/// The target of a fit: its surface, and what closest points on it are judged by.
class Target {
 public:
  /// `distances` is kept by reference.
  Target(std::shared_ptr<const Connectivity> connectivity, const Shape& shape,
         const MarkerDistances& distances);

  const Surface& GetSurface() const { return surface_; }
  const Connectivity& GetConnectivity() const { return *connectivity_; }
  const Shape& GetShape() const { return surface_.GetShape(); }
  const Shape& GetVertexNormals() const { return normals_; }
  const Eigen::VectorXd& VertexAreas() const { return areas_; }  ///< of sum 1
  const MarkerDistances& Distances() const { return distances_; }

  /// The normal at a point, interpolated.
  Eigen::Vector3d NormalAt(const Foot& foot) const;
  /// The point nearest to `point`, which belongs to a vertex of the template, where the normal is
  /// within 70 degrees of `normal` and which the vertex may match.
  Foot Nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, int template_vertex,
               double within = std::numeric_limits<double>::infinity()) const;
  /// Whether a point lies on the border of an open target: what is nearest to it may belong into
  /// the hole.
  bool IsOnBorder(const Foot& foot) const;

 private:
  const std::shared_ptr<const Connectivity> connectivity_;
  const Surface surface_;
  const Shape normals_;
  const Eigen::VectorXd areas_;
  const Border border_;
  const MarkerDistances& distances_;
};

/// A third of the triangles around each vertex, of sum 1.
Eigen::VectorXd VertexAreas(const Connectivity& connectivity, const Shape& shape);

/// The part of the template that a level of the hierarchy has.
struct Level {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<int> vertices;  ///< of each vertex, its number in the template
  Border border;
};

/// The point of the fitted template to which a vertex of the target belongs, if one is near.
Foot NearestOnTemplate(const Surface& fitted, const Level& level, const Target& target,
                       int target_vertex);

/// What pulls `shape`, a level's, onto the target: its vertices to their nearest points there, and
/// every `stride`-th vertex of the target at the point nearest to it. Only what is nearer than
/// a twentieth of the root of the area pulls. `distance` is the root mean
/// square of the former.
std::vector<Pull> FindPulls(const Level& level, const Shape& shape, const Eigen::VectorXd& areas,
                            const Target& target, int stride, double weight, double* distance);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_CLOSEST_H_
