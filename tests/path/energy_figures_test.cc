#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/path/energy.h>

#include "support/message_of.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::NoisyBlend;
using testing::Refuses;

// Of more than a thousand triangles, edges and hinges, so that sums over them have several parts.
struct LongBar {
  ShapeFamily bar = MakeBar(6, 1, 1, 40, 8, 8);
  std::shared_ptr<const Metric> metric;
  std::vector<Shape> shapes;

  explicit LongBar(const MetricOptions& options, int inner = 2)
      : metric(FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(60)})),
        shapes(NoisyBlend(bar.pose(0) / metric->unit, bar.pose(60) / metric->unit, inner, 1e-3)) {}
};

MetricOptions MembraneAndVolume() {
  MetricOptions options = MetricOptions::Isometric();
  options.bending = 0;
  options.lambda = 0.01;
  options.volume = 3;
  return options;
}

TEST(ChordLengths, OfManyElementsAreTheRootsOfTheEnergiesOfSegments) {
  const LongBar body(MembraneAndVolume());
  ASSERT_GT(body.bar.connectivity->NumTriangles(), 2048);
  const std::vector<double> lengths = ChordLengths(*body.metric, body.shapes);
  const std::vector<double> squared = SquaredLengths(body.metric, body.shapes);
  ASSERT_EQ(lengths.size(), 3u);
  ASSERT_EQ(squared.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(lengths[i] * lengths[i], 2 * squared[i], 1e-10 * squared[i]) << i;
    EXPECT_NEAR(ChordLengths(*body.metric, {body.shapes[i], body.shapes[i + 1]})[0], lengths[i],
                1e-12 * lengths[i]);
  }
  EXPECT_TRUE(SquaredLengths(body.metric, {}).empty());
  EXPECT_TRUE(SquaredLengths(body.metric, {body.shapes[0]}).empty());
}

// Along straight lines in the space of values, a path of more segments costs that much less.
TEST(EnergyLowerBound, OfFlatFeaturesIsTheSquaredChordOverTheSegments) {
  const LongBar body(MembraneAndVolume());
  const Shape &first = body.shapes[0], &last = body.shapes[3];
  const double chord = ChordLengths(*body.metric, {first, last})[0];
  EXPECT_GT(chord, 0);
  for (const int segments : {1, 2, 5}) {
    EXPECT_NEAR(EnergyLowerBound(*body.metric, first, last, segments), chord * chord / segments,
                1e-12 * chord * chord);
  }
}

MetricOptions EveryFeature(Discretization discretization) {
  MetricOptions options;
  options.isometric = 0.4;
  options.strain = 0.7;
  options.volume = 0.3;
  options.rigid = 0.2;
  options.lambda = 0.05;
  options.discretization = discretization;
  return options;
}

// A path of which the last shape is unknown too has the energy of the path that ends there, and the
// derivative along any change of its shapes, the last included.
TEST(PathEnergy, OfAPathWithAFreeEndIsThatOfThePathThatEndsThere) {
  const ShapeFamily bar = MakeBar(3, 1, 1, 6, 2, 2);
  const auto metric = FreezeMetric(EveryFeature(Discretization::kMidpoint), bar.connectivity,
                                   {bar.pose(0), bar.pose(40)});
  for (const int inner : {3, 11}) {
    const auto shapes = [&](double along) {
      std::vector<Shape> moved =
          NoisyBlend(bar.pose(0) / metric->unit, bar.pose(40) / metric->unit, inner - 1, 1e-2);
      for (int i = 1; i <= inner; ++i) {
        moved[i] += along * testing::Noise(bar.connectivity->NumVertices(), 0.1, 100 + i);
      }
      return moved;
    };
    PathEnergy free(metric, inner, PathEnergy::End::kFree);
    PathEnergy fixed(metric, inner - 1);
    std::vector<double> x(free.Size()), more(free.Size()), gradient(free.Size()), ignored(x);
    std::vector<double> y(fixed.Size());
    fixed.Load(shapes(0), y.data());
    free.Load(shapes(0), x.data());
    const double energy = free.Evaluate(x.data(), gradient.data());
    EXPECT_NEAR(energy, fixed.Evaluate(y.data(), nullptr), 1e-12 * energy);
    double parts = 0;
    for (const double part : free.Parts(x.data())) parts += part;
    EXPECT_NEAR(parts, energy, 1e-12 * energy);
    const double h = 1e-5;
    free.Load(shapes(h), more.data());
    double slope = 0;
    for (size_t k = 0; k < x.size(); ++k) slope += gradient[k] * (more[k] - x[k]) / h;
    const double ahead = free.Evaluate(more.data(), ignored.data());
    free.Load(shapes(-h), more.data());
    const double behind = free.Evaluate(more.data(), ignored.data());
    EXPECT_NEAR((ahead - behind) / (2 * h), slope, 1e-5 * std::abs(slope)) << inner;
  }
}

TEST(PathEnergy, MessagesSayHowManyShapesItNeeds) {
  const ShapeFamily bar = MakeBar(3, 1, 1, 3, 1, 1);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0)});
  const Shape shape = bar.pose(0);
  PathEnergy fixed(metric, 2), free(metric, 2, PathEnergy::End::kFree);
  EXPECT_EQ(fixed.NumShapes(), 4);
  EXPECT_EQ(free.NumShapes(), 3);
  std::vector<double> x(fixed.Size());
  const auto message = [&](PathEnergy* energy, const std::vector<Shape>& shapes) {
    return MessageOf<MeshError>([&] { energy->Load(shapes, x.data()); });
  };
  EXPECT_TRUE(Names(message(&fixed, {shape, shape, shape}), {"2"}));
  EXPECT_TRUE(Names(message(&free, {shape, shape, shape, shape}), {"2"}));
  EXPECT_EQ(message(&free, {shape, shape, shape}), "nothing was thrown");
  EXPECT_TRUE(Names(message(&free, {shape, shape.leftCols(2), shape}), {"vertices"}));
  std::vector<Shape> stored(3);
  EXPECT_TRUE(Refuses<MeshError>([&] { fixed.Store(x.data(), &stored); }, {"2"}));
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { fixed.SetInner(0); }, {"inner:"}));
}

// For each segment, a gradient of both of its shapes.
TEST(PathEnergy, EstimateOfMemoryCountsTheSegmentsOfTheRigidMetric) {
  const ShapeFamily bar = MakeBar(3, 1, 1, 6, 2, 2);
  const auto metric = FreezeMetric(MetricOptions::Rigid(), bar.connectivity, {bar.pose(0)});
  const double of_segment = 2.0 * 3 * sizeof(double) * bar.connectivity->NumVertices();
  EXPECT_EQ(PathEnergy::EstimateBytes(*metric, 9) - PathEnergy::EstimateBytes(*metric, 4),
            5 * of_segment);
  EXPECT_GE(PathEnergy::EstimateBytes(*metric, 1), 2 * of_segment);
}

}  // namespace
}  // namespace shapespace
