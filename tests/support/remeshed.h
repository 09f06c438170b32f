#ifndef SHAPESPACE_TESTS_SUPPORT_REMESHED_H_
#define SHAPESPACE_TESTS_SUPPORT_REMESHED_H_

#include <string>
#include <vector>

#include <shapespace/bodies/quadruped.h>
#include <shapespace/correspondence/correspondence.h>

namespace shapespace::testing {

/// Markers far from each other on `shape`. Those of the target are the vertices of `on_target`
/// nearest to the `places` of the same vertices.
inline std::vector<CorrespondenceMarker> SpreadMarkers(const Shape& shape, const Shape& places,
                                                       const Shape& on_target, int count) {
  std::vector<CorrespondenceMarker> markers;
  Eigen::RowVectorXd distance = (shape.colwise() - shape.rowwise().mean()).colwise().squaredNorm();
  for (int k = 0; k < count; ++k) {
    Eigen::Index from = 0, to = 0;
    distance.maxCoeff(&from);
    distance = distance.cwiseMin(
        Eigen::RowVectorXd((shape.colwise() - shape.col(from)).colwise().squaredNorm()));
    if (k == 0) distance = (shape.colwise() - shape.col(from)).colwise().squaredNorm();
    (on_target.colwise() - places.col(from)).colwise().squaredNorm().minCoeff(&to);
    markers.push_back({static_cast<int>(from), static_cast<int>(to)});
  }
  return markers;
}

/// One animal as two meshes of different, unrelated connectivity: the template stands, the target
/// is in a pose.
struct Remeshed {
  SkinnedBody first, second;
  Shape rest, other_rest;  ///< both standing: near points correspond
  Shape target;
  std::vector<CorrespondenceMarker> markers;

  explicit Remeshed(const std::string& pose = "stand", int first_triangles = 2400,
                    int second_triangles = 3300, int num_markers = 16,
                    const QuadrupedForm& form = {})
      : first(MakeQuadruped(first_triangles)),
        second(MakeQuadruped(second_triangles)),
        rest(first.pose("stand")),
        other_rest(second.pose("stand")),
        target(MakeQuadruped(second_triangles, form).pose(pose)) {
    markers = SpreadMarkers(rest, rest, other_rest, num_markers);
  }

  CorrespondenceResult Fit(const CorrespondenceOptions& options = {}) const {
    return Correspond(first.connectivity, rest, second.connectivity, target, markers, options);
  }

  /// Per vertex of the template, the distance between its image and the correct point.
  Eigen::VectorXd Errors(const SurfaceMap& map) const {
    const Shape landed = PullBack(map.to_target, second.connectivity->Triangles(), other_rest);
    return (landed - rest).colwise().norm();
  }

  /// The mean edge of the coarser mesh.
  double Edge() const {
    double sum = 0;
    for (const auto& edge : first.connectivity->Edges().colwise()) {
      sum += (rest.col(edge(0)) - rest.col(edge(1))).norm();
    }
    return sum / first.connectivity->NumEdges();
  }
};

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_REMESHED_H_
