#ifndef SHAPESPACE_OUTPUT_DETAIL_RAY_SCENE_H_
#define SHAPESPACE_OUTPUT_DETAIL_RAY_SCENE_H_

#include <memory>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace shapespace::internal {

/// The edges of a graph that are drawn: its segments, in the order of its edges. Stiffeners are
/// edges of the metric alone.
Eigen::Matrix2Xi SegmentsOfGraph(const Connectivity& connectivity);

/// The data that all scenes of one picture share.
class RayTracer {
 public:
  /// `connectivity` must outlive the tracer and its scenes. Tubes and balls of graphs get
  /// `tube_radius`. \throw Error if Embree cannot start.
  RayTracer(const Connectivity& connectivity, float tube_radius);

 private:
  friend class RayScene;
  const Connectivity& connectivity_;
  const Eigen::Matrix2Xi tubes_;  // of a graph: edges
  const float tube_radius_;
  std::shared_ptr<RTCDeviceTy> device_;
};

/// One shape, prepared for ray tracing. Safe to use from several threads.
class RayScene {
 public:
  struct Hit {
    float distance;
    Eigen::Vector3f face_normal;  ///< unit, of the flat triangle, towards the ray's origin
    Eigen::Vector3f normal;       ///< unit, for shading, towards the ray's origin
    bool back;                    ///< the triangle was hit from behind
    float value;                  ///< interpolated from the vertices; 0 without values
    int vertex;                   ///< the nearest vertex of the triangle or edge
  };

  /// `shape` is finite and lies in the unit ball; `values` has one number a vertex or is empty.
  /// \throw Error if Embree runs out of memory.
  RayScene(const RayTracer& tracer, const Shape& shape, Eigen::VectorXf values);

  /// Finds the first hit along the ray; false if there is none.
  bool Trace(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, Hit* hit) const;

  /// Whether the ray hits anything at less than `distance`.
  bool Blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
               float distance) const;

 private:
  void AddTriangles(const Shape& shape);
  void AddTubes(const Shape& shape);

  const RayTracer& tracer_;
  Eigen::VectorXf values_;
  Eigen::Matrix3Xf corner_normals_;
  Eigen::VectorXi loose_vertices_;  // of a graph: those without an edge, drawn as balls
  std::shared_ptr<RTCSceneTy> scene_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_RAY_SCENE_H_
