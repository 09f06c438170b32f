#ifndef SHAPESPACE_SKINNING_DETAIL_MOVING_POINTS_H_
#define SHAPESPACE_SKINNING_DETAIL_MOVING_POINTS_H_

#include <functional>
#include <vector>

#include <Eigen/Core>

#include <shapespace/path/path.h>

namespace shapespace::internal {

/// The vertices of a path in all of its shapes, without twins (mesh/connectivity.h), in flat arrays
/// and in a frame in which figures do not depend on the user's: every shape has its centroid at the
/// origin, and the rest pose has root mean square radius 1.
struct MovingPoints {
  Eigen::MatrixXd moved;          ///< 3 s x n: a column per point, three rows per shape
  int rest = 0;                   ///< the shape that is the rest pose
  double size = 1;                ///< what was length 1 here is that long in the path's shapes
  Eigen::MatrixXd centroids;      ///< 3 x s: of each shape of the path, in its shapes' unit
  std::vector<int> vertices;      ///< the path's vertex of each point
  IndexLists neighbours;          ///< of each point, along edges
  std::vector<int> component_of;  ///< of each point: the part of the mesh that edges connect
  int num_components = 0;

  int NumPoints() const { return static_cast<int>(moved.cols()); }
  int NumShapes() const { return static_cast<int>(moved.rows() / 3); }
  auto Rest(int point) const { return moved.col(point).segment<3>(3 * rest); }
};

/// \throw MeshError if the rest pose has no extent.
MovingPoints MakeMovingPoints(const Path& path, int rest);

/// Root mean square distance, over points and shapes, from the squared distance of each point,
/// summed over shapes.
double RootMeanSquare(const MovingPoints& points, const Eigen::VectorXd& squared_errors);

/// Calls `body(begin, end)` for runs of consecutive points, so that those of a run share working
/// memory, on several threads (`ParallelFor`).
void ForRunsOfPoints(int num_points, const std::function<void(int begin, int end)>& body);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_MOVING_POINTS_H_
