#ifndef SHAPESPACE_TESTS_SOLVERS_SKINNING_BODIES_H_
#define SHAPESPACE_TESTS_SOLVERS_SKINNING_BODIES_H_

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>

namespace shapespace::testing {

/// A body whose bones and weights are known, and its motion.
struct BonedBody {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> shapes;  ///< the first is the rest pose
  Eigen::MatrixXd weights;    ///< bones x vertices
  Eigen::Matrix3Xd joints;    ///< in the rest pose: of each bone but the first, with the one before

  Path MakePath() const {
    return shapespace::MakePath(FreezeMetric(MetricOptions(), connectivity, shapes), shapes);
  }
};

/// A closed strip of quads around the x axis: `rings` rings of `around` vertices, one apart.
inline Shape TubeShape(int rings, int around) {
  Shape shape(3, rings * around);
  for (int r = 0; r < rings; ++r) {
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * M_PI * k / around;
      shape.col(r * around + k) << r, 2 * std::cos(angle), 1.5 * std::sin(angle);
    }
  }
  return shape;
}

inline std::shared_ptr<const Connectivity> TubeConnectivity(int rings, int around) {
  std::vector<int> begin = {0}, corners;
  for (int r = 0; r + 1 < rings; ++r) {
    for (int k = 0; k < around; ++k) {
      const int next = (k + 1) % around;
      corners.insert(corners.end(), {r * around + k, r * around + next, (r + 1) * around + next,
                                     (r + 1) * around + k});
      begin.push_back(static_cast<int>(corners.size()));
    }
  }
  return Connectivity::Make(rings * around, begin, corners);
}

/// A tube with bones of length 10 in a row. Joints turn about random axes, by up to half a radian
/// more in each shape; near a joint, weights change linearly over a length of 4.
inline BonedBody Snake(int bones, int shapes, unsigned seed = 1) {
  constexpr int kAround = 12, kLength = 10;
  constexpr double kBlend = 4;
  const int rings = bones * kLength + 1;
  BonedBody body;
  body.connectivity = TubeConnectivity(rings, kAround);
  const Shape rest = TubeShape(rings, kAround);
  body.weights = Eigen::MatrixXd::Zero(bones, rest.cols());
  body.joints = Eigen::Matrix3Xd::Zero(3, bones);
  for (int b = 1; b < bones; ++b) body.joints(0, b) = b * kLength;
  for (Eigen::Index v = 0; v < rest.cols(); ++v) {
    // How far the vertex belongs to the bones from b on.
    double reached = 1;
    for (int b = 0; b < bones; ++b) {
      const double begin = (b + 1) * kLength - kBlend / 2;
      const double next = b + 1 < bones ? std::clamp((rest(0, v) - begin) / kBlend, 0.0, 1.0) : 0.0;
      body.weights(b, v) = reached - next;
      reached = next;
    }
  }
  std::mt19937 random(seed);
  // Not uniform_real_distribution, which differs between libraries.
  const auto uniform = [&] { return random() / 2147483648.0 - 1; };
  body.shapes = {rest};
  for (int i = 1; i < shapes; ++i) {
    Shape shape = Shape::Zero(3, rest.cols());
    Eigen::Affine3d motion = Eigen::Affine3d::Identity();
    for (int b = 0; b < bones; ++b) {
      const Eigen::Vector3d axis(uniform(), uniform(), uniform());
      motion.translate(body.joints.col(b))
          .rotate(Eigen::AngleAxisd(0.5 + 0.5 * std::abs(uniform()), axis.normalized()))
          .translate(-body.joints.col(b));
      shape += (motion.matrix().topRows<3>() * rest.colwise().homogeneous()) *
               body.weights.row(b).asDiagonal();
    }
    body.shapes.push_back(shape);
  }
  return body;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SOLVERS_SKINNING_BODIES_H_
