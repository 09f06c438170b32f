#include <shapespace/statistics/detail/procrustes.h>

namespace shapespace::internal {
namespace {

constexpr int kMaxRounds = 100;
constexpr double kTurned = 1e-12;  // squared, of all rotations of a round

Shape Mean(const std::vector<Shape>& shapes, const Eigen::VectorXd& weights) {
  Shape mean = Shape::Zero(3, shapes[0].cols());
  for (size_t i = 0; i < shapes.size(); ++i) mean += weights(i) * shapes[i];
  return mean;
}

}  // namespace

AlignedPoses AlignToMean(const Metric& metric, const std::vector<Shape>& poses,
                         const Eigen::VectorXd& weights) {
  AlignedPoses aligned = AlignPoses(metric, poses);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Shape mean = Mean(aligned.shapes, weights);
    double turned = 0;
    for (size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Matrix3d turn =
          FitRigidMotion(aligned.shapes[i], mean, metric.vertex_area).rotation;
      aligned.shapes[i] = turn * aligned.shapes[i];
      aligned.motions[i].rotation *= turn.transpose();
      turned += (turn - Eigen::Matrix3d::Identity()).squaredNorm();
    }
    if (turned < kTurned) break;
  }
  return aligned;
}

RigidMotion MeanMotion(const AlignedPoses& poses, const Eigen::VectorXd& weights) {
  RigidMotion mean;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < poses.motions.size(); ++i) {
    sum += weights(i) * poses.motions[i].rotation;
    mean.translation += weights(i) * poses.motions[i].translation;
  }
  mean.rotation = ProcrustesRotation(sum.transpose());
  return mean;
}

}  // namespace shapespace::internal
