#include <shapespace/path/energy.h>

#include <cmath>
#include <numeric>

#include <ceres/jet.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/mesh/triangulate.h>
#include <shapespace/metric/trapezoid.h>

#include "support/blends.h"
#include "support/features.h"
#include "support/paths.h"
#include "support/stiffened.h"

namespace shapespace {
namespace {

using testing::NoisyBlend;

struct Evaluated {
  double energy;
  std::vector<Shape> gradient;  // of the inner shapes
};

// The energy by its definition, from the functors and their automatic derivatives: without kernels
// or reordering, element by element and segment by segment.
Evaluated FromDefinition(const Metric& metric, const std::vector<Shape>& shapes, double quartic) {
  Evaluated result{0, std::vector<Shape>(shapes.size(), Shape::Zero(3, shapes[0].cols()))};
  const bool trapezoid = metric.options.discretization == Discretization::kTrapezoid;
  for (const auto& any : metric.features) {
    testing::WithStruct(*any, [&](const auto& feature) {
      using Feature = std::decay_t<decltype(feature)>;
      constexpr int kSize = 3 * Feature::kVertices, kValues = Feature::kValues,
                    kInputs = Feature::kInputs;
      using Jet = ceres::Jet<double, 2 * kSize>;
      for (size_t i = 0; i + 1 < shapes.size(); ++i) {
        const auto spread = [&](int e, const Jet& value) {
          result.energy += value.a;
          for (int k = 0; k < 2 * kSize; ++k) {
            const int v = feature.stencils(k % kSize / 3, e);
            result.gradient[i + k / kSize](k % 3, v) += value.v(k);
          }
        };
        const auto evaluate = [&](int e, Jet* change, Jet* from, Jet* to) {
          double x[2][kInputs];
          GatherCoordinates(feature, e, shapes[i], x[0]);
          GatherCoordinates(feature, e, shapes[i + 1], x[1]);
          for (int k = 0; k < kInputs; ++k) {
            from[k] = k < kSize ? Jet(x[0][k], k) : Jet(x[0][k]);
            to[k] = k < kSize ? Jet(x[1][k], kSize + k) : Jet(x[1][k]);
          }
          Jet a[kValues], b[kValues];
          feature(from, a);
          feature(to, b);
          for (int k = 0; k < kValues; ++k) change[k] = b[k] - a[k];
        };
        Jet change[kValues], from[kInputs], to[kInputs];
        if constexpr (Feature::kSum) {
          double total = 0;
          for (int e = 0; e < feature.stencils.cols(); ++e) {
            evaluate(e, change, from, to);
            total += change[0].a;
          }
          const double w = feature.weights(0);
          result.energy += 2 * w * total * total;
          for (int e = 0; e < feature.stencils.cols(); ++e) {
            evaluate(e, change, from, to);
            spread(e, 4 * w * total * (change[0] - Jet(change[0].a)));
          }
        } else {
          for (int e = 0; e < feature.stencils.cols(); ++e) {
            evaluate(e, change, from, to);
            const double w = feature.weights(e);
            Jet sum = Jet(0.0);
            constexpr bool kIsEdge = std::is_same_v<Feature, EdgeLength>;
            if (kIsEdge && trapezoid) {
              Jet ends[2];
              if constexpr (kIsEdge) TrapezoidResiduals(from, to, ends);
              const Jet a = 0.5 * (ends[0] + ends[1]), b = 0.5 * (ends[1] - ends[0]);
              sum = 2.0 * (a * a + quartic * b * b);
            } else {
              for (const Jet& c : change) sum += 2.0 * c * c;
            }
            spread(e, w * sum);
          }
        }
      }
    });
  }
  result.gradient.erase(result.gradient.begin());
  result.gradient.pop_back();
  return result;
}

// The same through PathEnergy.
Evaluated FromPathEnergy(const std::shared_ptr<const Metric>& metric,
                         const std::vector<Shape>& shapes, double quartic) {
  const int inner = static_cast<int>(shapes.size()) - 2;
  PathEnergy energy(metric, inner);
  energy.SetQuarticWeight(quartic);
  std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
  energy.Load(shapes, unknowns.data());
  Evaluated result;
  result.energy = energy.Evaluate(unknowns.data(), gradient.data());
  std::vector<Shape> stored = shapes;
  energy.Store(gradient.data(), &stored);
  result.gradient.assign(stored.begin() + 1, stored.end() - 1);
  return result;
}

void ExpectSame(const Evaluated& a, const Evaluated& b, double tolerance) {
  EXPECT_NEAR(a.energy, b.energy, tolerance * std::abs(b.energy));
  ASSERT_EQ(a.gradient.size(), b.gradient.size());
  double largest = 0, difference = 0;
  for (size_t i = 0; i < b.gradient.size(); ++i) {
    largest = std::max(largest, b.gradient[i].cwiseAbs().maxCoeff());
    difference = std::max(difference, (a.gradient[i] - b.gradient[i]).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(difference, tolerance * largest);
}

// Noise of 8e-3 on edges of length .1 makes creases of tens of degrees.
TEST(PathEnergy, KernelsEqualTheAutomaticDerivativesOfTheFunctors) {
  const ShapeFamily bar = testing::Stiffened(MakeBar(6, 1, 1, 12, 2, 2));
  for (const testing::Blend& test : testing::AllBlends()) {
    const auto metric = FreezeMetric(test.options, bar.connectivity, {bar.pose(0), bar.pose(80)});
    for (int inner : {1, 2, 3, 4, 5, 7, 8, 17}) {
      SCOPED_TRACE(std::string(test.name) + ", inner shapes: " + std::to_string(inner));
      const std::vector<Shape> shapes =
          NoisyBlend(bar.pose(0) / metric->unit, bar.pose(80) / metric->unit, inner, 8e-3);
      ExpectSame(FromPathEnergy(metric, shapes, 0.7), FromDefinition(*metric, shapes, 0.7), 1e-12);
    }
  }
}

// The kernels process them in windows of 128 shapes.
TEST(PathEnergy, KernelsEqualTheFunctorsOnLongPaths) {
  const ShapeFamily bar = testing::Stiffened(MakeBar(2, 1, 1, 2, 1, 1));
  for (const testing::Blend& test : testing::AllBlends()) {
    const auto metric = FreezeMetric(test.options, bar.connectivity, {bar.pose(0), bar.pose(80)});
    for (int inner : {128, 129, 300}) {
      SCOPED_TRACE(std::string(test.name) + ", inner shapes: " + std::to_string(inner));
      const std::vector<Shape> shapes =
          NoisyBlend(bar.pose(0) / metric->unit, bar.pose(80) / metric->unit, inner, 8e-3);
      ExpectSame(FromPathEnergy(metric, shapes, 0.7), FromDefinition(*metric, shapes, 0.7), 1e-12);
    }
  }
}

TEST(PathEnergy, KernelsEqualTheFunctorsOnManyBlocksOfRows) {
  const ShapeFamily sheet = MakeSheet(2, 1, 60, 40);  // 2501 vertices: nine blocks
  const auto metric = FreezeMetric({}, sheet.connectivity, {sheet.pose(0), sheet.pose(90)});
  const std::vector<Shape> shapes =
      NoisyBlend(sheet.pose(0) / metric->unit, sheet.pose(90) / metric->unit, 4, 2e-3);
  ExpectSame(FromPathEnergy(metric, shapes, 1), FromDefinition(*metric, shapes, 1), 1e-12);
}

TEST(PathEnergy, CollapsedTrianglesMakeNoNan) {
  const ShapeFamily sheet = MakeSheet(1, 1, 4, 4);
  const auto metric = FreezeMetric({}, sheet.connectivity, {sheet.pose(0)});
  const Shape flat = sheet.pose(0) / metric->unit;
  const Evaluated result = FromPathEnergy(metric, {flat, 0 * flat, flat}, 1);
  EXPECT_TRUE(std::isfinite(result.energy));
  EXPECT_TRUE(result.gradient[0].allFinite());
}

TEST(PathEnergy, PaperEnergyIsTheMidpointFormAndAQuarticPart) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1);
  MetricOptions options = MetricOptions::Paper();
  const auto paper = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(90)});
  options.discretization = Discretization::kMidpoint;
  const auto midpoint = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(90)});
  const std::vector<Shape> shapes =
      NoisyBlend(bar.pose(0) / paper->unit, bar.pose(90) / paper->unit, 5, 1e-2);
  double quartic = 0;
  for (size_t i = 0; i + 1 < shapes.size(); ++i) {
    for (int e = 0; e < bar.connectivity->NumEdges(); ++e) {
      const Eigen::Vector2i v = bar.connectivity->Edges().col(e);
      const Eigen::Vector3d turn = shapes[i + 1].col(v(1)) - shapes[i + 1].col(v(0)) -
                                   shapes[i].col(v(1)) + shapes[i].col(v(0));
      quartic += 0.5 * turn.squaredNorm() * turn.squaredNorm();
    }
  }
  const double expected = FromPathEnergy(midpoint, shapes, 1).energy + quartic;
  EXPECT_NEAR(FromPathEnergy(paper, shapes, 1).energy, expected, 1e-12 * expected);
}

TEST(PathEnergy, RigidMetricVanishesOnFiniteRigidMotions) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  MetricOptions options = MetricOptions::Rigid();
  options.lambda = 0;
  const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(40)});
  const Shape shape = bar.pose(40) / metric->unit;
  std::vector<Shape> shapes;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(1.2 * i, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    shapes.push_back((turn * shape).colwise() + i * Eigen::Vector3d(0.3, 0, -2));
  }
  const Evaluated result = FromPathEnergy(metric, shapes, 1);
  EXPECT_LT(result.energy, 1e-24);
}

TEST(PathEnergy, RigidMetricHasTheGradientOfCentralDifferences) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 3, 1, 1);
  for (Weighting weights : {Weighting::kArea, Weighting::kUniform}) {
    MetricOptions options = MetricOptions::Rigid();
    options.weights = weights;
    const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(90)});
    std::vector<Shape> shapes =
        NoisyBlend(bar.pose(0) / metric->unit, bar.pose(90) / metric->unit, 3, 2e-2);
    const Evaluated result = FromPathEnergy(metric, shapes, 1);
    for (int i = 1; i <= 3; ++i) {
      for (int v : {0, 5}) {
        for (int axis = 0; axis < 3; ++axis) {
          constexpr double kStep = 1e-5;
          double& x = shapes[i](axis, v);
          const double middle = x;
          x = middle + kStep;
          const double more = FromPathEnergy(metric, shapes, 1).energy;
          x = middle - kStep;
          const double less = FromPathEnergy(metric, shapes, 1).energy;
          x = middle;
          EXPECT_NEAR(result.gradient[i - 1](axis, v), (more - less) / (2 * kStep),
                      1e-7 * result.gradient[i - 1].norm());
        }
      }
    }
  }
}

TEST(PathEnergy, DoesNotDependOnFrameOrNumberingOfVertices) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  const int num_vertices = bar.connectivity->NumVertices();
  std::vector<int> number(num_vertices);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(3));
  Eigen::Matrix3Xi triangles = bar.connectivity->Triangles();
  for (int& v : triangles.reshaped()) v = number[v];
  const auto renumbered = Connectivity::FromTriangles(num_vertices, triangles);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2, Eigen::Vector3d(1, 1, 3).normalized()).toRotationMatrix();

  const auto energy = [](const std::shared_ptr<const Connectivity>& connectivity,
                         const std::vector<Shape>& shapes) {
    MetricOptions options;
    options.volume = 0.3;
    const auto metric = FreezeMetric(options, connectivity, {shapes.front(), shapes.back()});
    std::vector<Shape> scaled;
    for (const Shape& shape : shapes) scaled.push_back(shape / metric->unit);
    return FromPathEnergy(metric, scaled, 1).energy;
  };
  const std::vector<Shape> shapes = NoisyBlend(bar.pose(0), bar.pose(60), 3, 2e-2);
  std::vector<Shape> turned, shuffled;
  for (const Shape& shape : shapes) {
    turned.push_back((turn * shape).colwise() + Eigen::Vector3d(5, -3, 1));
    shuffled.emplace_back(3, num_vertices);
    for (int v = 0; v < num_vertices; ++v) shuffled.back().col(number[v]) = shape.col(v);
  }
  const double expected = energy(bar.connectivity, shapes);
  EXPECT_NEAR(energy(bar.connectivity, turned), expected, 1e-11 * expected);
  EXPECT_NEAR(energy(renumbered, shuffled), expected, 1e-11 * expected);
}

TEST(PathEnergy, DoesNotDependOnTheCornerAtWhichPolygonsBegin) {
  // A prism over a concave polygon of seven corners, inclined to one side and to the other.
  constexpr int kCorners = 7;
  Shape straight(3, 2 * kCorners);
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * M_PI * k / kCorners, radius = k % 2 == 0 ? 1 : 0.4;
    straight.col(k) << radius * std::cos(angle), radius * std::sin(angle), 0;
    straight.col(kCorners + k) = straight.col(k) + Eigen::Vector3d(0, 0, 1.5);
  }
  Shape leaning = straight;
  leaning.row(0) += 0.5 * straight.row(2);
  leaning.row(1) += 0.2 * straight.row(2).cwiseAbs2();
  const std::vector<Shape> poses = {straight, leaning};
  const auto energy = [&](int first) {
    std::vector<std::vector<int>> polygons(2);
    for (int k = 0; k < kCorners; ++k) {
      const int next = (k + 1) % kCorners;
      polygons[0].insert(polygons[0].begin(), k);
      polygons[1].push_back(kCorners + k);
      polygons.push_back({k, next, kCorners + next, kCorners + k});
    }
    std::vector<int> begin = {0}, corners;
    for (std::vector<int>& polygon : polygons) {
      std::rotate(polygon.begin(), polygon.begin() + first % polygon.size(), polygon.end());
      corners.insert(corners.end(), polygon.begin(), polygon.end());
      begin.push_back(static_cast<int>(corners.size()));
    }
    const auto connectivity = Connectivity::Make(2 * kCorners, begin, corners, {}, {},
                                                 Triangulate(begin, corners, poses));
    const auto metric = FreezeMetric({}, connectivity, poses);
    return FromPathEnergy(metric,
                          NoisyBlend(straight / metric->unit, leaning / metric->unit, 3, 1e-2), 1)
        .energy;
  };
  const double expected = energy(0);
  for (int first = 1; first < kCorners; ++first) {
    EXPECT_NEAR(energy(first), expected, 1e-12 * expected) << "beginning at corner " << first;
  }
}

// tests/solvers/lower_bound_test.cc compares minima with the bound.
TEST(EnergyLowerBound, IsReachedByAnEdgeWhoseSquaredLengthGrowsEvenly) {
  MetricOptions membrane = MetricOptions::Isometric();
  membrane.bending = membrane.lambda = 0;
  std::vector<Shape> shapes;
  for (int i = 0; i <= 4; ++i) {
    shapes.emplace_back(Shape::Zero(3, 2));
    shapes.back()(0, 1) = std::sqrt(1 + 0.75 * i);
  }
  const auto metric =
      FreezeMetric(membrane, testing::SingleEdge(), {shapes.front(), shapes.back()});
  const double energy = FromPathEnergy(metric, shapes, 1).energy;
  EXPECT_NEAR(EnergyLowerBound(*metric, shapes.front(), shapes.back(), 4), energy, 1e-14 * energy);
}

TEST(EnergyLowerBound, IsNotKnownForTheRigidMetric) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 3, 1, 1);
  const auto metric = FreezeMetric(MetricOptions::Rigid(), bar.connectivity, {bar.pose(0)});
  EXPECT_TRUE(std::isnan(EnergyLowerBound(*metric, bar.pose(0), bar.pose(10), 3)));
}

// At least their stencils and weights.
TEST(PathEnergy, EstimateOfMemoryCountsTheElementsOfAllFeatures) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  MetricOptions options = MetricOptions::Isometric();
  const auto freeze = [&] { return FreezeMetric(options, bar.connectivity, {bar.pose(0)}); };
  const double without = PathEnergy::EstimateBytes(*freeze(), 7);
  options.strain = options.volume = 1;
  const auto metric = freeze();
  double least = 0;
  for (const auto& feature : metric->features) {
    if (feature->As<TriangleStrain>() == nullptr && feature->As<LogLength>() == nullptr &&
        feature->As<VolumeFeature>() == nullptr) {
      continue;
    }
    least +=
        feature->NumElements() * (sizeof(int) * feature->VerticesPerElement() + sizeof(double));
  }
  EXPECT_GT(least, 0);
  EXPECT_GE(PathEnergy::EstimateBytes(*metric, 7) - without, least);
}

TEST(PathEnergy, StoreGivesBackWhatLoadTook) {
  const ShapeFamily sheet = MakeSheet(1, 1, 5, 3);
  const auto metric = FreezeMetric({}, sheet.connectivity, {sheet.pose(0)});
  const std::vector<Shape> shapes = NoisyBlend(sheet.pose(0), sheet.pose(90), 3, 0.1);
  PathEnergy energy(metric, 3);
  std::vector<double> unknowns(energy.Size());
  energy.Load(shapes, unknowns.data());
  std::vector<Shape> stored(5);
  energy.Store(unknowns.data(), &stored);
  for (int i = 1; i <= 3; ++i) EXPECT_TRUE(stored[i] == shapes[i]);
}

TEST(PathEnergy, OfAnotherNumberOfShapesIsThatOfANewObject) {
  const ShapeFamily sheet = MakeSheet(1, 1, 5, 3);
  const auto metric = FreezeMetric({}, sheet.connectivity, {sheet.pose(0), sheet.pose(90)});
  PathEnergy kept(metric, 3);
  for (int inner : {3, 17, 1}) {
    const std::vector<Shape> shapes = NoisyBlend(sheet.pose(0), sheet.pose(90), inner, 0.1);
    kept.SetInner(inner);
    PathEnergy fresh(metric, inner);
    ASSERT_EQ(kept.Size(), fresh.Size());
    std::vector<double> unknowns(kept.Size()), gradient(kept.Size()), other(kept.Size());
    fresh.Load(shapes, unknowns.data());
    kept.Load(shapes, unknowns.data());
    EXPECT_EQ(kept.Evaluate(unknowns.data(), gradient.data()),
              fresh.Evaluate(unknowns.data(), other.data()));
    EXPECT_EQ(gradient, other);
  }
  EXPECT_THROW(kept.SetInner(0), InvalidOptions);
}

// The energy is computed by kernels of its own.
TEST(ChordLengths, TheirSquaresAddUpToTheEnergy) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 12, 3, 3);
  for (MetricOptions options : {MetricOptions(), MetricOptions::Isometric()}) {
    options.volume = 1;
    const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(90)});
    const std::vector<Shape> shapes = NoisyBlend(bar.pose(0), bar.pose(90), 6, 0.1);
    const std::vector<double> lengths = ChordLengths(*metric, shapes);
    ASSERT_EQ(lengths.size(), 7u);
    PathEnergy energy(metric, 6);
    std::vector<double> unknowns(energy.Size());
    energy.Load(shapes, unknowns.data());
    double sum = 0;
    for (const double length : lengths) sum += length * length;
    EXPECT_NEAR(sum, energy.Evaluate(unknowns.data(), nullptr), 1e-12 * sum);
  }
  const auto rigid = FreezeMetric(MetricOptions::Rigid(), bar.connectivity, {bar.pose(0)});
  EXPECT_TRUE(std::isnan(ChordLengths(*rigid, {bar.pose(0), bar.pose(9)})[0]));
}

TEST(PathEnergy, RefusesWrongSizes) {
  const ShapeFamily sheet = MakeSheet(1, 1, 2, 2);
  const auto metric = FreezeMetric({}, sheet.connectivity, {sheet.pose(0)});
  EXPECT_THROW(PathEnergy(metric, 0), InvalidOptions);
  PathEnergy energy(metric, 2);
  std::vector<double> unknowns(energy.Size());
  const Shape shape = sheet.pose(0);
  EXPECT_THROW(energy.Load({shape, shape, shape}, unknowns.data()), MeshError);
  EXPECT_THROW(energy.Load({shape, shape, shape.leftCols(3), shape}, unknowns.data()), MeshError);
}

// The values at the ends are kept from one path to the next.
TEST(PathEnergy, ForgetsEarlierEnds) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(60)});
  const auto shape = [&](double angle) -> Shape { return bar.pose(angle) / metric->unit; };
  const Shape nothing = Shape::Zero(3, bar.connectivity->NumVertices());
  const std::vector<std::vector<Shape>> paths = {
      {nothing, shape(10), nothing},    {shape(0), shape(20), shape(50)},
      {shape(0), shape(30), shape(50)}, {shape(0), shape(20), shape(60)},
      {shape(5), shape(20), shape(60)}, {shape(5), shape(20), shape(60)}};
  for (const PathEnergy::End end : {PathEnergy::End::kFixed, PathEnergy::End::kFree}) {
    PathEnergy energy(metric, end == PathEnergy::End::kFixed ? 1 : 2, end);
    std::vector<double> unknowns(energy.Size()), gradient(energy.Size()), expected(energy.Size());
    for (size_t i = 0; i < paths.size(); ++i) {
      PathEnergy fresh(metric, energy.Inner(), end);
      fresh.Load(paths[i], expected.data());
      const double right = fresh.Evaluate(expected.data(), gradient.data());
      energy.Load(paths[i], unknowns.data());
      EXPECT_EQ(unknowns, expected);
      std::vector<double> own(energy.Size());
      EXPECT_EQ(energy.Evaluate(unknowns.data(), own.data()), right) << i;
      EXPECT_EQ(own, gradient) << i;
      // At the end of the next path, if the end is free.
      const std::vector<Shape>& next = paths[(i + 1) % paths.size()];
      fresh.Load(next, expected.data());
      energy.Evaluate(expected.data(), own.data());
    }
  }
}

}  // namespace
}  // namespace shapespace
