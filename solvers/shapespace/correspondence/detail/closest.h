#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_CLOSEST_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_CLOSEST_H_

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/correspondence/detail/marker_distances.h>
#include <shapespace/correspondence/detail/shell_fit.h>
#include <shapespace/correspondence/surface_map.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/surface.h>

namespace shapespace::internal {

/// The border of an open surface.
struct Border {
  /// Per triangle: whether the side opposite to corner k belongs to no other triangle.
  std::vector<std::array<bool, 3>> sides;
  std::vector<bool> vertices;  ///< whether each vertex is an end of such a side
};
Border BorderOf(const Connectivity& connectivity);

/// The target of a fit: its surface, and the data by which closest points on it are selected.
class Target {
 public:
  /// `distances` is kept by reference.
  Target(std::shared_ptr<const Connectivity> connectivity, const Shape& shape,
         const MarkerDistances& distances);

  const MeshSurface& GetSurface() const { return surface_; }
  const Connectivity& GetConnectivity() const { return *connectivity_; }
  const Shape& GetShape() const { return surface_.GetShape(); }
  const Shape& GetVertexNormals() const { return normals_; }
  const Eigen::VectorXd& VertexAreas() const { return areas_; }  ///< of sum 1
  const MarkerDistances& Distances() const { return distances_; }

  /// The normal at a point, interpolated.
  Eigen::Vector3d NormalAt(const ClosestPoint& closest) const;
  /// The nearest point to `point` at which the normal is within 70 degrees of `normal`, and which
  /// according to the distances from the markers may correspond to `template_vertex`.
  ClosestPoint Nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                       int template_vertex,
                       double within = std::numeric_limits<double>::infinity()) const;
  /// Whether a point lies on the border of an open target. A template vertex with such a nearest
  /// point may belong to the missing part of the target.
  bool IsOnBorder(const ClosestPoint& closest) const;

 private:
  const std::shared_ptr<const Connectivity> connectivity_;
  const MeshSurface surface_;
  const Shape normals_;
  const Eigen::VectorXd areas_;
  const Border border_;
  const MarkerDistances& distances_;
};

/// Where points are on their meshes, without their positions.
SurfacePoints PointsOf(const std::vector<ClosestPoint>& closest);

/// A third of the area of the triangles around each vertex, scaled to sum 1.
Eigen::VectorXd VertexAreas(const Connectivity& connectivity, const Shape& shape);

/// The template on one level of the hierarchy.
struct Level {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<int> vertices;  ///< per vertex, its number in the template
  Border border;
};

/// The point of the fitted template that corresponds to a vertex of the target, if one is near.
ClosestPoint NearestOnTemplate(const MeshSurface& fitted, const Level& level, const Target& target,
                               int target_vertex);

/// Vertices of the target whose nearest points on a template are sought.
struct TargetSamples {
  std::vector<int> vertices;
  double area;  ///< of all samples, of which these may be a part
};

/// At least `count` vertices of the target, if it has so many, and fewer than twice as many.
TargetSamples SampleTarget(const Target& target, int count);

/// The closest-point terms between `shape`, which is of a level, and the target: from each of its
/// vertices to the nearest point of the target, and from samples of the target to the nearest point
/// of `shape`. Only points nearer than a twentieth of the square root of the area count. `distance`
/// becomes the root mean square distance of the former.
std::vector<PointToPlaneTerm> FindTerms(const Level& level, const Shape& shape,
                                        const Eigen::VectorXd& areas, const Target& target,
                                        const TargetSamples& samples, double weight,
                                        double* distance);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_CLOSEST_H_
