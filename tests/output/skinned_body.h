#ifndef SHAPESPACE_TESTS_OUTPUT_SKINNED_BODY_H_
#define SHAPESPACE_TESTS_OUTPUT_SKINNED_BODY_H_

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/output/skinned_path.h>

#include "output/bodies.h"

namespace shapespace {

/// A sphere at `place` with seven bones in a tree with two branches, all of which move and turn.
/// `weights_per_vertex` of them, up to seven, move each vertex.
inline SkinnedPath SkinnedSphere(int shapes, bool scale, int weights_per_vertex = 3,
                                 const Eigen::Vector3d& place = Eigen::Vector3d::Zero()) {
  const SimpleBody sphere = Sphere(1, 16, 24);
  SkinnedPath path;
  path.connectivity = sphere.connectivity;
  path.rest = sphere.shape.colwise() + place;
  path.provenance = "made by a test";
  const std::vector<int> parents = {-1, 0, 1, 0, 3, 3, 2};
  const int bones = static_cast<int>(parents.size());
  for (int b = 0; b < bones; ++b) {
    Joint joint;
    joint.name = "bone " + std::to_string(b);
    joint.parent = parents[b];
    joint.pivot = place + Eigen::Vector3d(0.1 * b, 0.2 * b - 0.6, 0);
    if (scale) joint.axes = Eigen::AngleAxisd(0.5 * b, Eigen::Vector3d(1, 1, 2).normalized());
    path.joints.push_back(joint);
  }
  for (int i = 0; i < shapes; ++i) {
    path.parameters.push_back(shapes > 1 ? i / (shapes - 1.0) : 0);
    for (int b = 0; b < bones; ++b) {
      JointMotion motion;
      // Turns by more than half a revolution in all, so that quaternions change their sign.
      motion.rotation =
          Eigen::AngleAxisd((0.5 + 0.4 * b) * i, Eigen::Vector3d(b, 1, 2 - b).normalized());
      motion.place = path.joints[b].pivot + Eigen::Vector3d(0.2 * i, 0.05 * b * i, 0);
      if (scale) motion.scale << 1 + 0.05 * i * b, 1, 1 - 0.05 * i;
      path.motions.push_back(motion);
    }
  }
  const Eigen::Index vertices = path.rest.cols();
  path.bones = Eigen::MatrixXi::Zero(weights_per_vertex, vertices);
  path.weights = Eigen::MatrixXd::Zero(weights_per_vertex, vertices);
  for (Eigen::Index v = 0; v < vertices; ++v) {
    for (int k = 0; k < weights_per_vertex; ++k) {
      path.bones(k, v) = static_cast<int>((v + k) % bones);
      path.weights(k, v) = 1 + std::sin(v + 2.0 * k);
    }
    path.weights.col(v) /= path.weights.col(v).sum();
  }
  return path;
}

}  // namespace shapespace

#endif  // SHAPESPACE_TESTS_OUTPUT_SKINNED_BODY_H_
