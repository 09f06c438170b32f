#include <shapespace/output/detail/ray_scene.h>

#include <utility>

#include <shapespace/base/error.h>

// Where there is no Embree no pictures are drawn, and whoever asks for one is told so.

namespace shapespace::internal {

Eigen::Matrix2Xi SegmentsOfGraph(const Connectivity&) { return {}; }

RayTracer::RayTracer(const Connectivity& connectivity, float tube_radius)
    : connectivity_(connectivity), tube_radius_(tube_radius) {
  throw Error("pictures cannot be drawn here: this program was built without Embree. Write a .glb");
}

RayScene::RayScene(const RayTracer& tracer, const Shape&, Eigen::VectorXf values)
    : tracer_(tracer), values_(std::move(values)) {}

bool RayScene::Trace(const Eigen::Vector3f&, const Eigen::Vector3f&, Hit*) const { return false; }

bool RayScene::Blocked(const Eigen::Vector3f&, const Eigen::Vector3f&, float) const {
  return false;
}

}  // namespace shapespace::internal
