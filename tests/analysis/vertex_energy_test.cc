#include <shapespace/analysis/vertex_energy.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/path/energy.h>

#include "support/motions.h"

namespace shapespace {
namespace {

// A tube that is bent, at uneven times.
Path BentTube(const MetricOptions& options) {
  const ShapeFamily tube = MakeBody("tube", 600);
  std::vector<Shape> shapes;
  for (const double angle : {0.0, 10.0, 40.0, 60.0}) shapes.push_back(tube.pose(angle));
  return MakePath(FreezeMetric(options, tube.connectivity, shapes), shapes, {0, 0.3, 0.6, 1});
}

// The density integrates to the squared speed, which another part of the library computes.
TEST(VertexEnergy, SumsToTheSquaredSpeed) {
  MetricOptions options;
  options.strain = 0.5;
  Path path = BentTube(options);
  const std::vector<Eigen::VectorXd> energies = VertexEnergy(path);
  ASSERT_EQ(energies.size(), 4u);
  std::vector<double> squared;
  for (int i = 0; i < 3; ++i) {
    PathEnergy energy(path.metric, 1);
    std::vector<double> unknowns(energy.Size());
    // The second segment has no length.
    energy.Load({path.shapes[i], path.shapes[i + 1], path.shapes[i + 1]}, unknowns.data());
    const double time = path.parameters[i + 1] - path.parameters[i];
    squared.push_back(energy.Evaluate(unknowns.data(), nullptr) / 2 / (time * time));
  }
  const Eigen::VectorXd& area = path.metric->vertex_area;
  EXPECT_NEAR(energies[0].dot(area), squared[0], 1e-9 * squared[0]);
  EXPECT_NEAR(energies[1].dot(area), (squared[0] + squared[1]) / 2, 1e-9 * squared[0]);
  EXPECT_NEAR(energies[3].dot(area), squared[2], 1e-9 * squared[2]);
  for (const Eigen::VectorXd& energy : energies) EXPECT_GE(energy.minCoeff(), 0);
}

TEST(VertexEnergy, IsWhereTheBodyBends) {
  const ShapeFamily bar = MakeBar(10, 1, 1, 40, 4, 4);
  Shape bent = bar.pose(0);
  // The part beyond the middle is turned about it.
  const double middle = (bent.row(0).minCoeff() + bent.row(0).maxCoeff()) / 2;
  const Eigen::Vector3d pivot(middle, bent.row(1).mean(), bent.row(2).mean());
  const Eigen::Matrix3d turn = testing::Rotation(20, Eigen::Vector3d::UnitZ());
  for (auto vertex : bent.colwise()) {
    if (vertex.x() > middle) vertex = pivot + turn * (vertex - pivot);
  }
  MetricOptions options;
  options.lambda = 0;
  const Path path =
      MakePath(FreezeMetric(options, bar.connectivity, {bar.pose(0), bent}), {bar.pose(0), bent});
  const Eigen::VectorXd energy = VertexEnergy(path)[1];
  const Shape straight = bar.pose(0);
  for (Eigen::Index v = 0; v < energy.size(); ++v) {
    const bool far = std::abs(straight(0, v) - middle) > 0.6;
    EXPECT_LT(energy[v], far ? 1e-20 : HUGE_VAL) << v;
  }
  EXPECT_GT(energy.maxCoeff(), 1e-6);
}

TEST(VertexEnergy, RigidMotionHasNone) {
  const ShapeFamily tube = MakeBody("tube", 600);
  const Shape shape = tube.pose(30);
  const Shape moved =
      (testing::Rotation(50, {1, 2, 3}) * shape).colwise() + Eigen::Vector3d(3, 1, 2);
  MetricOptions options;
  options.lambda = 0;
  const Path path =
      MakePath(FreezeMetric(options, tube.connectivity, {shape, moved}), {shape, moved});
  for (const Eigen::VectorXd& energy : VertexEnergy(path)) EXPECT_LT(energy.maxCoeff(), 1e-20);
}

TEST(VertexEnergy, VolumeIsDividedByArea) {
  const ShapeFamily bar = MakeBar(3, 1, 1, 6, 2, 2);
  const Shape larger = 1.1 * bar.pose(0);
  MetricOptions options;
  options.strain = options.bending = 0;
  options.lambda = 1e-15;  // a metric needs one part that is no sum
  options.volume = 1;
  const Path path = MakePath(FreezeMetric(options, bar.connectivity, {bar.pose(0), larger}),
                             {bar.pose(0), larger});
  const Eigen::VectorXd energy = VertexEnergy(path)[0];
  EXPECT_GT(energy.minCoeff(), 0);
  EXPECT_NEAR(energy.minCoeff(), energy.maxCoeff(), 1e-12 * energy.maxCoeff());
}

TEST(VertexEnergy, TheRigidMetricIsRefused) {
  EXPECT_THROW(VertexEnergy(BentTube(MetricOptions::Rigid())), InvalidOptions);
}

}  // namespace
}  // namespace shapespace
