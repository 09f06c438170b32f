#ifndef SHAPESPACE_MATCHING_DETAIL_FARTHEST_POINTS_H_
#define SHAPESPACE_MATCHING_DETAIL_FARTHEST_POINTS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/matching/detail/surface_graph.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Vertices that are spread evenly along a surface, each as far as possible from those before it.
struct EvenSamples {
  std::vector<int> vertices;
  Eigen::MatrixXf distances;  ///< n x samples: of every vertex from each of them
};

/// So many are enough for what is found from distances: extremities, and whether maps differ.
inline constexpr int kEvenSamples = 200;

/// `count` of the first `among` vertices, or as many as there are distinct places. The first is far
/// from the vertex that is nearest to the centroid, for which `areas` are the weights. The surface
/// must be connected.
EvenSamples SampleEvenly(const SurfaceGraph& graph, const Shape& shape,
                         const Eigen::VectorXd& areas, int count, int among);

/// The same for columns of a matrix, with the distances between them, beginning with column
/// `first`. Of equal columns only one is taken.
std::vector<int> FarthestColumns(const Eigen::MatrixXf& points, int first, int count);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_FARTHEST_POINTS_H_
