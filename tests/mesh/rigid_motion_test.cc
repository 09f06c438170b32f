#include <shapespace/mesh/rigid_motion.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "support/paths.h"

namespace shapespace {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d Turn(double angle, const Vector3d& axis) {
  return AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

// Weighted sum of the squares of the columns.
double Squares(const Shape& difference, const Eigen::VectorXd& weights) {
  return difference.colwise().squaredNorm().dot(weights);
}

TEST(RigidMotionTest, CentroidsAreWeighted) {
  Shape shape(3, 3);
  shape << 1, 2, 4, -3, 0, 6, 5, 5, 7;
  EXPECT_LT((Centroid(shape, Vector3d(1, 2, 5)) - Vector3d(25, 27, 50) / 8).norm(), 1e-14);
  EXPECT_LT((Centroid(shape, Vector3d(0, 0, 3)) - Vector3d(4, 6, 7)).norm(), 1e-14);
}

TEST(RigidMotionTest, TheWeightsDecideWhereAFitIsClose) {
  const Shape from = testing::Noise(12, 1, 1);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(12);
  weights.tail(5).setZero();
  Shape to = (Turn(2, {1, -2, 3}) * from).colwise() + Vector3d(7, -8, 9);
  to.rightCols(5) += 2 * testing::Noise(5, 1, 2);
  const RigidMotion exact = FitRigidMotion(from, to, weights);
  EXPECT_LT((exact.rotation - Turn(2, {1, -2, 3})).norm(), 1e-9);
  EXPECT_LT((exact.translation - Vector3d(7, -8, 9)).norm(), 1e-9);
  // No motion nearby is closer.
  weights = testing::Noise(12, 1, 3).row(0).cwiseAbs().array() + 0.01;
  const RigidMotion best = FitRigidMotion(from, to, weights);
  const double least = Squares(best(from) - to, weights);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-3, 1e-3}) {
      const Vector3d unit = Vector3d::Unit(axis);
      const Shape shifted = best(from).colwise() + step * unit;
      EXPECT_GT(Squares(shifted - to, weights), least);
      const RigidMotion turned = {best.rotation * Turn(step, unit), best.translation};
      EXPECT_GT(Squares(turned(from) - to, weights), least);
    }
  }
}

TEST(RigidMotionTest, AMirrorImageIsTurnedAboutItsShortestAxis) {
  Shape from = testing::Noise(60, 1, 1);
  const Vector3d mean = from.rowwise().mean();
  from = Vector3d(3, 1, 0.1).asDiagonal() * (from.colwise() - mean);
  Shape to = from;
  to.row(2) *= -1;  // what lies flat is mirrored across its plane: best left as it is
  const RigidMotion motion = FitRigidMotion(from, to, Eigen::VectorXd::Ones(60));
  EXPECT_LT((motion.rotation - Matrix3d::Identity()).norm(), 0.05);
}

double Travel(const std::vector<Shape>& shapes, const Eigen::VectorXd& weights) {
  double sum = 0;
  for (size_t i = 0; i + 1 < shapes.size(); ++i) sum += Squares(shapes[i + 1] - shapes[i], weights);
  return sum;
}

TEST(RigidMotionTest, DriftIsRemovedAsTheWeightsSay) {
  constexpr int kVertices = 9, kLast = 5;
  const Eigen::VectorXd weights =
      testing::Noise(kVertices, 1, 5).row(0).cwiseAbs().array().square();
  std::vector<Shape> shapes;
  for (int i = 0; i <= kLast; ++i) {
    Shape shape = testing::Noise(kVertices, 1, 1) + 0.3 * testing::Noise(kVertices, 1, 10 + i);
    shape = Turn(0.2 * i, {1, 1, i - 3.0}) * shape;
    const Vector3d centre = Centroid(shape, weights);
    shape.colwise() -= centre;
    if (i > 0 && i < kLast) shape.colwise() += Vector3d(i, -4, 2);
    shapes.push_back(shape);
  }
  std::vector<Shape> best = shapes;
  RemoveRigidDrift(&best, weights);
  EXPECT_EQ(best.front(), shapes.front());
  EXPECT_EQ(best.back(), shapes.back());
  const double least = Travel(best, weights);
  for (int i = 1; i < kLast; ++i) {
    EXPECT_LT(Centroid(best[i], weights).norm(), 1e-12) << i;
    EXPECT_TRUE(FitRigidMotion(shapes[i], best[i], weights)(shapes[i]).isApprox(best[i], 1e-10));
    for (int axis = 0; axis < 3; ++axis) {
      for (const double step : {-1e-3, 1e-3}) {
        std::vector<Shape> other = best;
        other[i] = Turn(step, Vector3d::Unit(axis)) * best[i];
        EXPECT_GT(Travel(other, weights), least) << i;
        other[i] = best[i].colwise() + step * Vector3d::Unit(axis);
        EXPECT_GT(Travel(other, weights), least) << i;
      }
    }
  }
  // Two shapes have no inner ones; one inner shape is moved to the mean of the ends.
  std::vector<Shape> two = {shapes[1], shapes[2]};
  RemoveRigidDrift(&two, weights);
  EXPECT_EQ(two[0], shapes[1]);
  EXPECT_EQ(two[1], shapes[2]);
  std::vector<Shape> three = {shapes[0], shapes[2], shapes[kLast]};
  RemoveRigidDrift(&three, weights);
  const RigidMotion motion = FitRigidMotion(shapes[2], 0.5 * (shapes[0] + shapes[kLast]), weights);
  EXPECT_LT((three[1] - motion(shapes[2])).norm(), 1e-10);
}

TEST(RigidMotionTest, MotionsBetweenAndBeyondTwoThatAreNotTheIdentity) {
  const Vector3d axis(1, -2, 2);
  const RigidMotion first = {Turn(0.7, {3, 1, 1}), {1, 2, 3}};
  const RigidMotion last = {Turn(1.2, axis) * first.rotation, {5, -2, 4}};
  const auto expect = [&](double t, double angle, const Vector3d& translation) {
    const RigidMotion motion = InterpolateMotion(first, last, t);
    EXPECT_LT((motion.rotation - Turn(angle, axis) * first.rotation).norm(), 1e-13) << t;
    EXPECT_LT((motion.translation - translation).norm(), 1e-13) << t;
  };
  expect(0, 0, {1, 2, 3});
  expect(0.25, 0.3, {2, 1, 3.25});
  expect(1, 1.2, {5, -2, 4});
  expect(1.5, 1.8, {7, -4, 4.5});
  expect(-1, -1.2, {-3, 6, 2});
}

}  // namespace
}  // namespace shapespace
