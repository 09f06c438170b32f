#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/analysis/intersections.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/output/picture.h>
#include <shapespace/path/energy.h>

#include "output/bodies.h"
#include "support/path_of.h"
#include "support/paths.h"
#include "support/stiffened.h"
#include "support/threads.h"

namespace shapespace {
namespace {

TEST(QuadrupedTest, IsTheSameForAnyNumberOfThreads) {
  const auto results = testing::OnThreads([] {
    const SkinnedBody body = MakeQuadruped(3000);
    return std::make_pair(body.connectivity, body.pose("sit"));
  });
  for (const auto& [connectivity, sits] : results) {
    EXPECT_TRUE(connectivity->Triangles() == results[0].first->Triangles());
    EXPECT_TRUE(sits == results[0].second);
  }
}

TEST(CountIntersections, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily tube = MakeTube(1500);
  Shape flat = tube.pose(0);
  flat.row(2) *= flat.row(0).array().sin().matrix().asDiagonal();  // turns inside out now and then
  const std::int64_t count = CountIntersections(*tube.connectivity, flat);
  ASSERT_GT(count, 20);
  const std::vector<Shape> shapes(5, flat);
  for (const std::vector<std::int64_t>& counts :
       testing::OnThreads([&] { return CountIntersections(*tube.connectivity, shapes); })) {
    EXPECT_EQ(counts, std::vector<std::int64_t>(5, count));
  }
}

TEST(Hierarchy, IsTheSameForAnyNumberOfThreads) {
  const SkinnedBody body = MakeQuadruped(6000);
  const std::vector<Shape> poses = {body.pose("stand"), body.pose("sit")};
  const auto results = testing::OnThreads([&] {
    const Hierarchy hierarchy(body.connectivity, poses);
    const int last = hierarchy.NumLevels() - 2;
    const Shape coarse =
        0.5 * (hierarchy.Restrict(poses[0], last) + hierarchy.Restrict(poses[1], last));
    return std::make_pair(hierarchy.Lift(coarse, last, poses[0], poses[1], 0.5),
                          hierarchy.Vertices(0));
  });
  for (const auto& [lifted, vertices] : results) {
    EXPECT_TRUE(lifted == results[0].first);
    EXPECT_EQ(vertices, results[0].second);
  }
}

TEST(FeatureMap, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 60, 4, 4);
  ASSERT_GT(bar.connectivity->NumVertices(), 512);  // several tasks a feature
  MetricOptions options;
  options.volume = 0.3;
  const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(60)});
  const FeatureMap map(metric);
  const int num_vertices = bar.connectivity->NumVertices();
  const Shape shape = bar.pose(30) / metric->unit + testing::Noise(num_vertices, 0.01, 1);
  const Tangent x = testing::Noise(num_vertices, 1, 10);
  struct Results {
    Eigen::VectorXd values, jx, second, gx;
    Tangent jty;
  };
  const auto results = testing::OnThreads([&] {
    const FeatureDerivative derivative = map.Derivative(shape);
    Results results;
    results.values = map.Values(shape);
    results.jx = derivative.Times(x);
    results.second = map.SecondDerivative(shape, x);
    results.jty = derivative.TransposeTimes(results.jx);
    results.gx = derivative.MetricMatrix().selfadjointView<Eigen::Lower>() * x.reshaped();
    return results;
  });
  for (const Results& result : results) {
    EXPECT_TRUE(result.values == results[0].values);
    EXPECT_TRUE(result.jx == results[0].jx);
    EXPECT_TRUE(result.second == results[0].second);
    EXPECT_TRUE(result.jty == results[0].jty);
    EXPECT_TRUE(result.gx == results[0].gx);
  }
}

TEST(PathEnergy, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily bar = testing::Stiffened(MakeBar(6, 1, 1, 120, 20, 20));
  MetricOptions options;
  options.volume = 0.3;
  options.strain = 0.1;
  const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(60)});
  const std::vector<Shape> shapes =
      testing::NoisyBlend(bar.pose(0) / metric->unit, bar.pose(60) / metric->unit, 3, 1e-3);
  const auto results = testing::OnThreads([&] {
    PathEnergy energy(metric, 3);
    std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
    energy.Load(shapes, unknowns.data());
    const double value = energy.Evaluate(unknowns.data(), gradient.data());
    return std::make_pair(value, gradient);
  });
  for (const auto& [value, gradient] : results) {
    EXPECT_EQ(value, results[0].first);
    EXPECT_TRUE(gradient == results[0].second);
  }
}

TEST(FindRigidParts, IsTheSameForAnyNumberOfThreads) {
  const ShapeFamily tube = MakeTube(3000);
  const Path path =
      testing::PathOf(tube.connectivity, {tube.pose(0), tube.pose(30), tube.pose(60)});
  const auto results = testing::OnThreads([&] { return FindRigidParts(path); });
  ASSERT_GE(results[0].parts.size(), 2u);
  for (const RigidParts& result : results) {
    EXPECT_TRUE(result.of_triangle == results[0].of_triangle);
    ASSERT_EQ(result.parts.size(), results[0].parts.size());
    EXPECT_EQ(result.parts[1].residual, results[0].parts[1].residual);
  }
}

TEST(RenderFilmStripTest, IsTheSameForAnyNumberOfThreads) {
  const SimpleBody sphere = Sphere(1);
  FilmStripOptions options;
  options.frame_width = 96;
  options.values.assign(3, sphere.shape.row(0).transpose().cwiseAbs());
  Shape squashed = sphere.shape;
  squashed.row(1) *= 0.4;
  const std::vector<Shape> shapes = {sphere.shape, squashed, sphere.shape};
  const auto images =
      testing::OnThreads([&] { return RenderFilmStrip(*sphere.connectivity, shapes, options); });
  for (const RgbImage& image : images) EXPECT_EQ(image.pixels, images[0].pixels);
}

}  // namespace
}  // namespace shapespace
