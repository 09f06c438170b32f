#include <shapespace/mesh/rigid_motion.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/bar.h>

#include "support/paths.h"

namespace shapespace {
namespace {

TEST(FitRigidMotion, RecoversAMotionEvenByHalfATurn) {
  const Shape shape = testing::Noise(20, 1, 1);
  const Eigen::VectorXd weights = testing::Noise(20, 1, 2).row(0).cwiseAbs();
  for (double angle : {0.0, 1.0, 3.1, M_PI}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(2, -1, 1).normalized()).toRotationMatrix();
    const Shape moved = (turn * shape).colwise() + Eigen::Vector3d(4, 5, 6);
    const RigidMotion motion = FitRigidMotion(shape, moved, weights);
    EXPECT_TRUE(motion(shape).isApprox(moved, 1e-12));
    EXPECT_NEAR(motion.rotation.determinant(), 1, 1e-12);
  }
}

TEST(FitRigidMotion, NeverReflects) {
  const Shape shape = testing::Noise(20, 1, 1);
  Shape mirrored = shape;
  mirrored.row(0) *= -1;
  const RigidMotion motion = FitRigidMotion(shape, mirrored, Eigen::VectorXd::Ones(20));
  EXPECT_NEAR(motion.rotation.determinant(), 1, 1e-12);
}

TEST(FitRigidMotion, TakesTheLeastRotationOfALine) {
  Shape line = Shape::Zero(3, 3);
  line.row(0) << -1, 0, 1;
  const RigidMotion motion = FitRigidMotion(line, line, Eigen::VectorXd::Ones(3));
  EXPECT_TRUE(motion.rotation.isIdentity(1e-6));
}

double Travel(const std::vector<Shape>& shapes) {
  double sum = 0;
  for (size_t i = 0; i + 1 < shapes.size(); ++i) sum += (shapes[i + 1] - shapes[i]).squaredNorm();
  return sum;
}

TEST(RemoveRigidDrift, FindsTheBestMotionsAndKeepsTheShapes) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(bar.connectivity->NumVertices());
  std::vector<Shape> shapes;
  for (int i = 0; i <= 8; ++i) {
    Shape shape = bar.pose(10 * i);
    shape.colwise() -= Eigen::Vector3d(shape.rowwise().mean());
    shapes.push_back(shape);
  }
  RemoveRigidDrift(&shapes, weights);
  const double least = Travel(shapes);
  std::vector<Shape> drifted = shapes;
  for (int i = 1; i < 8; ++i) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.4 * i, Eigen::Vector3d(1, i, -1).normalized()).toRotationMatrix();
    drifted[i] = (turn * drifted[i]).colwise() + Eigen::Vector3d(i, 0, 1);
  }
  std::vector<Shape> mended = drifted;
  RemoveRigidDrift(&mended, weights);
  EXPECT_NEAR(Travel(mended), least, 1e-10 * least);
  for (int i = 0; i <= 8; ++i) {
    EXPECT_TRUE(mended[i].isApprox(shapes[i], 1e-6)) << i;
    EXPECT_NEAR((mended[i].col(3) - mended[i].col(20)).norm(),
                (drifted[i].col(3) - drifted[i].col(20)).norm(), 1e-12);
  }
  EXPECT_TRUE(mended.front() == drifted.front());
  EXPECT_TRUE(mended.back() == drifted.back());
}

TEST(InterpolateMotion, TurnsAtConstantSpeedAndTranslatesEvenly) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  const RigidMotion first;
  const RigidMotion last = {Eigen::AngleAxisd(2, axis).toRotationMatrix(), {4, 0, -2}};
  const RigidMotion quarter = InterpolateMotion(first, last, 0.25);
  EXPECT_TRUE(quarter.rotation.isApprox(Eigen::AngleAxisd(0.5, axis).toRotationMatrix(), 1e-12));
  EXPECT_TRUE(quarter.translation.isApprox(Eigen::Vector3d(1, 0, -0.5), 1e-12));
  EXPECT_TRUE(InterpolateMotion(first, last, 1).rotation.isApprox(last.rotation, 1e-12));
}

}  // namespace
}  // namespace shapespace
