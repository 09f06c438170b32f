#include <shapespace/output/skinned_path.h>

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "output/skinned_body.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

TEST(SkinnedPathTest, AVertexIsTheMeanOfWhereItsBonesMoveIt) {
  const SkinnedPath path = SkinnedSphere(3, true);
  const Shape shape = path.Skinned(2);
  for (const int v : {0, 5, 77}) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < path.weights.rows(); ++k) {
      const int b = path.bones(k, v);
      mean += path.weights(k, v) * (path.motions[2 * path.NumJoints() + b].Matrix(path.joints[b]) *
                                    path.rest.col(v).homogeneous());
    }
    EXPECT_LT((shape.col(v) - mean).norm(), 1e-12);
  }
}

TEST(SkinnedPathTest, ABoneIsScaledAlongItsOwnAxesAboutItsPivot) {
  Joint joint;
  joint.pivot << 1, 2, 3;
  joint.axes = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 2) / 3);
  JointMotion motion;
  motion.scale << 2, 1, 0.5;
  motion.place << -1, 0, 4;
  const Eigen::Matrix<double, 3, 4> matrix = motion.Matrix(joint);
  EXPECT_LT((matrix * joint.pivot.homogeneous() - motion.place).norm(), 1e-12);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d along = joint.axes.col(k);
    EXPECT_LT((matrix.leftCols<3>() * along - motion.scale(k) * along).norm(), 1e-12);
  }
}

TEST(SkinnedPathTest, RefusesWhatDoesNotFitTogether) {
  const std::vector<std::function<void(SkinnedPath*)>> spoil = {
      [](SkinnedPath* path) { path->joints.clear(); },
      [](SkinnedPath* path) { path->joints[2].parent = 3; },
      [](SkinnedPath* path) { path->joints[0].parent = 0; },
      [](SkinnedPath* path) { path->joints[1].pivot(0) = std::nan(""); },
      [](SkinnedPath* path) { path->motions.pop_back(); },
      [](SkinnedPath* path) { path->motions[3].place(1) = std::nan(""); },
      [](SkinnedPath* path) { path->motions[3].scale(1) = HUGE_VAL; },
      [](SkinnedPath* path) { path->parameters[1] = path->parameters[0]; },
      [](SkinnedPath* path) { path->parameters.clear(); },
      [](SkinnedPath* path) { path->rest.conservativeResize(3, 5); },
      [](SkinnedPath* path) { path->rest(0, 0) = std::nan(""); },
      [](SkinnedPath* path) { path->bones(0, 0) = 7; },
      [](SkinnedPath* path) { path->bones(0, 0) = -1; },
      [](SkinnedPath* path) { path->weights(0, 0) += 0.01; },
      [](SkinnedPath* path) { path->bones(1, 0) = path->bones(0, 0); },
      [](SkinnedPath* path) { path->weights.col(2) << -1, 1, 1; },
      [](SkinnedPath* path) { path->weights(0, 0) = std::nan(""); },
      [](SkinnedPath* path) { path->weights.conservativeResize(2, path->rest.cols()); },
      [](SkinnedPath* path) { path->connectivity = nullptr; }};
  EXPECT_NO_THROW(SkinnedSphere(3, true).Validate());
  for (size_t i = 0; i < spoil.size(); ++i) {
    SkinnedPath path = SkinnedSphere(3, true);
    spoil[i](&path);
    EXPECT_THROW(path.Validate(), MeshError) << i;
  }
}

}  // namespace
}  // namespace shapespace
