#include <algorithm>
#include <cmath>
#include <random>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/contact/detail/separation_potential.h>
#include <shapespace/contact/internal/path_contact.h>

#include "support/threads.h"

namespace shapespace::internal {
namespace {

FourPoints RandomPoints(std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  FourPoints points;
  for (double& x : points.reshaped()) x = uniform(*random);
  return points;
}

TEST(PairPotentialTest, TheKernelIsTheFunctorAndItsDerivatives) {
  using Jet = ceres::Jet<double, 12>;
  std::mt19937 random(1);
  int near = 0, parallel = 0;
  for (int i = 0; i < 2000; ++i) {
    for (const PairKind kind : {PairKind::kVertexTriangle, PairKind::kEdgeEdge}) {
      const FourPoints points = RandomPoints(&random);
      const PairPotential potential = {kind, 0.7, 1.2, 5};
      const Separation separation = NearestPoints(kind, points);
      Jet x[12];
      for (int k = 0; k < 12; ++k) x[k] = Jet(points.reshaped()(k), k);
      const Jet expected = potential(x, separation);
      FourPoints gradient = FourPoints::Constant(3);
      const double value = potential.Add(points, separation, 2, &gradient);
      EXPECT_NEAR(value, 2 * expected.a, 1e-11 * (1 + value));
      EXPECT_LE((gradient.reshaped() - 2 * expected.v - Eigen::VectorXd::Constant(12, 3)).norm(),
                1e-10 * (1 + expected.v.norm()));
      near += value > 0 ? 1 : 0;
      const Eigen::Vector3d a = points.col(1) - points.col(0), b = points.col(3) - points.col(2);
      if (kind == PairKind::kEdgeEdge && value > 0 && a.cross(b).squaredNorm() < 5) ++parallel;
    }
  }
  EXPECT_GT(near, 500);
  EXPECT_GT(parallel, 100);
}

TEST(PairPotentialTest, DerivativesAreThoseOfTheValue) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    for (const PairKind kind : {PairKind::kVertexTriangle, PairKind::kEdgeEdge}) {
      const FourPoints points = RandomPoints(&random), direction = RandomPoints(&random);
      const PairPotential potential = {kind, 0.7, 1.2, 5};
      const auto value = [&](const FourPoints& at, FourPoints* gradient) {
        return potential.Add(at, NearestPoints(kind, at), 1, gradient);
      };
      FourPoints gradient = FourPoints::Zero(), ignored = gradient;
      value(points, &gradient);
      constexpr double kStep = 1e-6;
      const double differences = (value(points + kStep * direction, &ignored) -
                                  value(points - kStep * direction, &ignored)) /
                                 (2 * kStep);
      EXPECT_NEAR(differences, gradient.cwiseProduct(direction).sum(),
                  1e-5 * (1 + gradient.norm()));
    }
  }
}

TEST(PairPotentialTest, ThereIsNoneFromTheReachOnAndItGrowsTowardsContact) {
  const auto at_height = [](double height) {
    FourPoints points;
    points << 1, 0, 3, 0,  //
        1, 0, 0, 3,        //
        height, 0, 0, 0;
    FourPoints gradient = FourPoints::Zero();
    const PairPotential potential = {PairKind::kVertexTriangle, 1, 0.5, 0};
    return potential.Add(points, NearestPoints(potential.kind, points), 1, &gradient);
  };
  EXPECT_EQ(at_height(0.5), 0);
  EXPECT_EQ(at_height(2), 0);
  EXPECT_DOUBLE_EQ(at_height(0.25), 1. / 6);
  EXPECT_GT(at_height(1e-6), at_height(1e-3));
}

// A folded strip whose halves approach each other and part again.
struct Folding {
  Folding()
      : body(MakeSheet(6, 1, 18, 3)),
        metric(FreezeMetric({}, body.connectivity, {Folded(1), Folded(1.2)})),
        model(metric, {Folded(1) / metric->unit, Folded(1.2) / metric->unit},
              ContactModel::Intersections::kExempt),
        energy(metric, 3),
        shapes({Folded(1), Folded(0.1), Folded(0.06), Folded(0.09), Folded(1.2)}),
        start(energy.Size()) {
    for (Shape& shape : shapes) shape /= metric->unit;
    energy.Load(shapes, start.data());
  }
  // The strip with its second half above the first.
  Shape Folded(double height) const {
    Shape shape = body.pose(0);
    const double middle = (shape.row(0).maxCoeff() + shape.row(0).minCoeff()) / 2;
    for (int v = 0; v < shape.cols(); ++v) {
      if (shape(0, v) <= middle) continue;
      shape(0, v) = 2 * middle - shape(0, v);
      shape(2, v) += height;
    }
    shape.row(0) += 0.02 * shape.row(1);
    return shape;
  }
  PathContact Contact(int times) const {
    return {model, energy, shapes, PathContact::Segments(5), times};
  }

  ShapeFamily body;
  std::shared_ptr<const Metric> metric;
  ContactModel model;
  PathEnergy energy;
  std::vector<Shape> shapes;
  std::vector<double> start;
};

TEST(PathContactTest, DerivativesAreThoseOfTheValueAndTheSameOnAnyThreads) {
  const Folding folding;
  const size_t size = folding.start.size();
  const auto gradient_and_value = [&] {
    std::vector<double> result(size, 0.);
    result.push_back(folding.Contact(6).Evaluate(folding.start.data(), 2, result.data()));
    return result;
  };
  const std::vector<std::vector<double>> results = testing::OnThreads(gradient_and_value);
  for (const std::vector<double>& other : results) EXPECT_EQ(other, results.front());
  EXPECT_GT(results.front().back(), 0);

  PathContact contact = folding.Contact(6);
  std::vector<double> direction(size, 0.), ignored(size, 0.);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int stride = folding.energy.Stride(), inner = folding.energy.Inner();
  double expected = 0;
  for (size_t i = 0; i < size; ++i) {
    if (static_cast<int>(i % stride) >= inner) continue;  // padding
    direction[i] = uniform(random);
    expected += direction[i] * results.front()[i];
  }
  const auto moved = [&](double step) {
    std::vector<double> x = folding.start;
    for (size_t i = 0; i < size; ++i) x[i] += step * direction[i];
    return contact.Evaluate(x.data(), 2, ignored.data());
  };
  constexpr double kStep = 1e-7;
  EXPECT_NEAR((moved(kStep) - moved(-kStep)) / (2 * kStep), expected, 1e-5 * std::abs(expected));
}

TEST(PathContactTest, AListOfNearPairsGivesTheSameAsANewOneWhileThereIsRoom) {
  const Folding folding;
  MotionContact contact(folding.model, 6);
  const Shape &from = folding.shapes[2], &to = folding.shapes[3];
  const double room = 0.3 * folding.model.MeanLength();
  contact.Prepare(from, to, room);
  const Tangent move = 0.9 * room / std::sqrt(3.) * Tangent::Random(3, from.cols());
  ASSERT_GE(contact.Room(from + move, to - move), 0);
  EXPECT_LT(contact.Room(from + 2 * move, to - move), 0);
  EXPECT_LT(contact.Room(from + move, to - 2 * move), 0);
  MotionContact fresh(folding.model, 6);
  fresh.Prepare(from + move, to - move, 0);
  const double value = fresh.Evaluate(from + move, to - move, nullptr);
  EXPECT_GT(value, 0);
  EXPECT_NEAR(contact.Evaluate(from + move, to - move, nullptr), value, 1e-12 * value);
}

TEST(PartingTest, TheKernelIsTheFunctorAndItsDerivatives) {
  using Jet = ceres::Jet<double, 6>;
  std::mt19937 random(5);
  int near = 0;
  for (int i = 0; i < 1000; ++i) {
    const Shape points = RandomPoints(&random).leftCols<2>();
    const SeparationPair pair = {1, 0, 0.7, 1.5};
    Jet x[6];
    for (int k = 0; k < 6; ++k) x[k] = Jet(points.reshaped()(k), k);
    const Jet expected = pair(x + 3, x);
    Tangent gradient = Tangent::Constant(3, 2, 3);
    const double value = pair.Add(points, &gradient);
    EXPECT_NEAR(value, expected.a, 1e-14);
    EXPECT_LE((gradient.reshaped() - expected.v - Eigen::VectorXd::Constant(6, 3)).norm(), 1e-13);
    near += value > 0 ? 1 : 0;
  }
  EXPECT_GT(near, 200);
}

TEST(PartingTest, DerivativesAreThoseOfTheValueAndTheSameOnAnyThreads) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 8, 2, 2);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(60)};
  const auto metric = FreezeMetric({}, bar.connectivity, poses, 1);
  std::vector<Shape> path = {poses[0], 0.7 * poses[0], 0.6 * poses[1], poses[1]};
  PathEnergy energy(metric, 2);
  SeparationPotential parting(*metric, poses, 2);
  ASSERT_GT(parting.Pairs().size(), 100u);
  std::vector<double> unknowns(energy.Size()), none(energy.Size());
  energy.Load(path, unknowns.data());
  const auto gradients = testing::OnThreads([&] {
    std::vector<double> gradient(energy.Size());
    EXPECT_GT(parting.Evaluate(energy, unknowns.data(), 3, &path, gradient.data()), 0);
    return gradient;
  });
  for (const std::vector<double>& gradient : gradients) EXPECT_EQ(gradient, gradients.front());
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 10; ++i) {
    std::vector<double> there = unknowns, back = unknowns;
    double slope = 0;
    constexpr double kStep = 1e-6;
    for (size_t k = 0; k < unknowns.size(); ++k) {
      const double direction = uniform(random);
      there[k] += kStep * direction;
      back[k] -= kStep * direction;
      slope += direction * gradients.front()[k];
    }
    const double difference = parting.Evaluate(energy, there.data(), 3, &path, none.data()) -
                              parting.Evaluate(energy, back.data(), 3, &path, none.data());
    EXPECT_NEAR(difference / (2 * kStep), slope, 1e-6 * std::abs(slope));
  }
}

TEST(PartingTest, PosesHaveNone) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 8, 2, 2);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(60)};
  const SeparationPotential parting(*FreezeMetric({}, bar.connectivity, poses, 1), poses, 2);
  for (const Shape& pose : poses) {
    Tangent force = Tangent::Zero(3, pose.cols());
    for (const SeparationPair& pair : parting.Pairs()) EXPECT_EQ(pair.Add(pose, &force), 0);
    EXPECT_EQ(force.norm(), 0);
  }
}

}  // namespace
}  // namespace shapespace::internal
