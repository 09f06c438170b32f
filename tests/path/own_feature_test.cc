#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/path_file.h>

#include "support/features.h"
#include "support/message_of.h"
#include "support/own_features.h"
#include "support/paths.h"
#include "support/temporary_file.h"

namespace shapespace {
namespace {

struct KernelEnergy {
  double energy;
  std::vector<double> gradient;
};

KernelEnergy Evaluate(const MetricOptions& options, const ShapeFamily& bar, int inner) {
  const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(60)});
  const std::vector<Shape> shapes =
      testing::NoisyBlend(bar.pose(0) / metric->unit, bar.pose(60) / metric->unit, inner, 0.01);
  PathEnergy energy(metric, inner);
  std::vector<double> unknowns(energy.Size());
  energy.Load(shapes, unknowns.data());
  KernelEnergy result{0, std::vector<double>(energy.Size())};
  result.energy = energy.Evaluate(unknowns.data(), result.gradient.data());
  return result;
}

TEST(OwnFeature, NeedsTheMemoryOfTheLibrarysOwn) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const auto estimate = [&](const MetricOptions& options) {
    return PathEnergy::EstimateBytes(*FreezeMetric(options, bar.connectivity, {bar.pose(0)}), 7);
  };
  EXPECT_EQ(estimate(testing::OwnBlend()), estimate(testing::LibraryBlend()));
}

TEST(OwnFeature, HasTheEnergyOfTheLibrarysKernels) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  for (const int inner : {1, 3, 7}) {
    const KernelEnergy expected = Evaluate(testing::LibraryBlend(), bar, inner);
    const KernelEnergy own = Evaluate(testing::OwnBlend(), bar, inner);
    EXPECT_NEAR(own.energy, expected.energy, 1e-12 * expected.energy);
    // Rows of up to four shapes have no padding, others have undefined padding.
    const auto row = [inner](size_t i) { return inner <= 4 ? true : i % 8 < 7; };
    double largest = 0, apart = 0;
    for (size_t i = 0; i < own.gradient.size(); ++i) {
      if (!row(i)) continue;
      largest = std::max(largest, std::abs(expected.gradient[i]));
      apart = std::max(apart, std::abs(own.gradient[i] - expected.gradient[i]));
    }
    EXPECT_LT(apart, 1e-12 * largest);
  }
}

TEST(OwnFeature, HasTheBoundOfTheLibrarysFeature) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(60)};
  const auto library = FreezeMetric(testing::LibraryBlend(), bar.connectivity, poses);
  const auto own = FreezeMetric(testing::OwnBlend(), bar.connectivity, poses);
  const auto bound = [&](const Metric& metric) {
    return EnergyLowerBound(metric, poses[0] / metric.unit, poses[1] / metric.unit, 8);
  };
  EXPECT_NEAR(bound(*own), bound(*library), 1e-12 * bound(*library));
}

Path WithOwnFeatures() {
  const ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  MetricOptions options = testing::OwnBlend();
  options.stretching_stiffness.setLinSpaced(bar.connectivity->NumEdges(), 1, 2);
  options.bending_stiffness.setLinSpaced(bar.connectivity->NumEdges(), 1, 3);
  options.stiffness_on = StiffnessOn::kEdges;
  const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(60)});
  return MakePath(metric, {bar.pose(0), bar.pose(30), bar.pose(60)});
}

TEST(PathFile, KeepsOwnFeaturesAndStiffness) {
  const Path path = WithOwnFeatures();
  const std::string file = testing::TemporaryFile("own.path");
  WritePath(file, path);
  const Path read = ReadPath(file);
  std::remove(file.c_str());
  const auto& expected = testing::Get<testing::OwnStrain>(*path.metric);
  const auto& strain = testing::Get<testing::OwnStrain>(*read.metric);
  EXPECT_EQ(strain.stencils, expected.stencils);
  EXPECT_EQ(strain.weights, expected.weights);
  EXPECT_EQ(strain.original.epsilon_squared, expected.original.epsilon_squared);
  EXPECT_EQ(testing::Get<testing::OwnVolume>(*read.metric).original.reference,
            testing::Get<testing::OwnVolume>(*path.metric).original.reference);
  ASSERT_EQ(read.metric->options.features.size(), 2u);
  EXPECT_EQ(read.metric->options.features[1].name, "own volume");
  EXPECT_EQ(read.metric->options.features[1].coefficient, 0.2);
  EXPECT_EQ(read.metric->options.stretching_stiffness, path.metric->options.stretching_stiffness);
  EXPECT_EQ(read.metric->options.bending_stiffness, path.metric->options.bending_stiffness);
  EXPECT_EQ(read.metric->options.stiffness_on, StiffnessOn::kEdges);
}

struct Unheard : EdgeLength {
  static constexpr const char* kName = "unheard of";
};

// The file is read as by a program that does not know the feature.
TEST(PathFile, SaysWhichFeatureIsNotRegistered) {
  Path path = WithOwnFeatures();
  auto metric = std::make_shared<Metric>(*path.metric);
  Unheard feature;
  feature.stencils = metric->connectivity->Edges();
  feature.weights = Eigen::VectorXd::Ones(feature.stencils.cols());
  metric->features.push_back(MakeFeature(feature));
  path.metric = metric;
  const std::string file = testing::TemporaryFile("unheard.path");
  WritePath(file, path);
  const std::string message = testing::MessageOf<FileError>([&] { ReadPath(file); });
  std::remove(file.c_str());
  EXPECT_NE(message.find("unheard of"), std::string::npos) << message;
  EXPECT_NE(message.find("RegisterFeature"), std::string::npos) << message;
}

TEST(MakePath, PutsShapesBackWhereTheyAre) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  std::vector<Shape> placed;
  for (double angle : {0.0, 20.0, 60.0}) {
    placed.push_back(bar.pose(angle).colwise() + Eigen::Vector3d(1e3 * angle, 2, 3));
  }
  const auto metric = FreezeMetric({}, bar.connectivity, placed);
  const Path path = MakePath(metric, placed);
  EXPECT_EQ(path.parameters, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(path.poses, (std::vector<int>{0, 2}));
  for (int i = 0; i < 3; ++i) EXPECT_LT((path.Placed(i) - placed[i]).norm(), 1e-10);
  EXPECT_EQ(MakePath(metric, placed, {0, 1, 5}).parameters, (std::vector<double>{0, 1, 5}));
  EXPECT_THROW(MakePath(metric, {}), MeshError);
  EXPECT_THROW(MakePath(metric, placed, {0, 2, 1}), MeshError);
  EXPECT_THROW(MakePath(metric, {placed[0].leftCols(3)}), MeshError);
}

}  // namespace
}  // namespace shapespace
