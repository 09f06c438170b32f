#include <shapespace/geodesic/detail/unwrap_hinges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/sheet.h>
#include <shapespace/path/energy.h>
#include "support/paths.h"

namespace shapespace {
namespace {

using internal::UnwrapHinges;

// A sheet with a hinge far from its boundary, and checks for paths between two of its poses.
struct Sheet {
  static constexpr int kSegments = 8;

  explicit Sheet(MetricOptions options = {})
      : body(MakeSheet(1, 1, 8, 8)),
        metric(FreezeMetric(options, body.connectivity, {body.pose(0)})),
        rest(body.pose(0) / metric->unit) {
    const Eigen::Matrix4Xi& hinges = body.connectivity->Hinges();
    double nearest = 1;
    for (int h = 0; h < hinges.cols(); ++h) {
      const double distance = (rest.col(hinges(0, h)) + rest.col(hinges(1, h))).norm();
      if (distance < nearest) {
        nearest = distance;
        hinge = hinges.col(h);
      }
    }
  }

  // The sheet with one of the two triangles rotated about the hinge's edge.
  Shape Turned(double angle) const {
    const Eigen::Vector3d a = rest.col(hinge(0)), axis = rest.col(hinge(1)) - a;
    Shape shape = rest;
    shape.col(hinge(2)) =
        a + Eigen::AngleAxisd(angle, axis.normalized()) * (rest.col(hinge(2)) - a);
    return shape;
  }

  double Energy(const std::vector<Shape>& shapes) const {
    PathEnergy energy(metric, static_cast<int>(shapes.size()) - 2);
    std::vector<double> unknowns(energy.Size());
    energy.Load(shapes, unknowns.data());
    return energy.Evaluate(unknowns.data(), nullptr);
  }

  const ShapeFamily body;
  std::shared_ptr<const Metric> metric;
  const Shape rest;
  Eigen::Vector4i hinge;
};

// One triangle makes a full turn at constant speed, and ends where it began.
std::vector<Shape> FullTurn(const Sheet& sheet) {
  std::vector<Shape> shapes;
  for (int i = 0; i <= Sheet::kSegments; ++i) {
    shapes.push_back(sheet.Turned(2 * M_PI * i / Sheet::kSegments));
  }
  shapes.back() = shapes.front();
  return shapes;
}

TEST(UnwrapHinges, AFullTurnIsTakenBack) {
  const Sheet sheet;
  std::vector<Shape> shapes = FullTurn(sheet);
  UnwrapHinges(*sheet.metric, &shapes);
  for (const Shape& shape : shapes) EXPECT_LT((shape - sheet.rest).norm(), 1e-12);
}

// In two segments, none of which turns by more than 180 degrees.
TEST(UnwrapHinges, TheLongWayRoundIsTakenBack) {
  const Sheet sheet;
  std::vector<Shape> shapes = {sheet.rest, sheet.Turned(5 * M_PI / 6), sheet.Turned(5 * M_PI / 3)};
  const double before = sheet.Energy(shapes);
  UnwrapHinges(*sheet.metric, &shapes);
  EXPECT_LT(sheet.Energy(shapes), 0.3 * before);
}

TEST(UnwrapHinges, AJumpIsSpreadOverAllSegments) {
  const Sheet sheet;
  std::vector<Shape> shapes(Sheet::kSegments, sheet.rest);
  shapes.push_back(sheet.Turned(1.5));
  const std::vector<Shape> before = shapes;
  UnwrapHinges(*sheet.metric, &shapes);
  EXPECT_EQ(shapes.front(), before.front());
  EXPECT_EQ(shapes.back(), before.back());
  EXPECT_LT(sheet.Energy(shapes), 0.3 * sheet.Energy(before));
}

TEST(UnwrapHinges, WhatTurnsEvenlyTheShortWayStaysAsItIs) {
  const Sheet sheet;
  std::vector<Shape> shapes;
  for (int i = 0; i <= Sheet::kSegments; ++i) {
    shapes.push_back(sheet.Turned(0.9 * M_PI * i / Sheet::kSegments));
  }
  const std::vector<Shape> before = shapes;
  UnwrapHinges(*sheet.metric, &shapes);
  EXPECT_EQ(shapes, before);
}

TEST(UnwrapHinges, NothingMovesThatWouldCostMore) {
  const Sheet sheet;
  for (int seed : {1, 2, 3}) {
    std::vector<Shape> shapes = testing::NoisyBlend(sheet.rest, sheet.rest, 7, 0.1);
    for (Shape* end : {&shapes.front(), &shapes.back()}) {
      *end += testing::Noise(static_cast<int>(end->cols()), 0.1, 10 * seed + (end == &shapes[0]));
    }
    const double before = sheet.Energy(shapes);
    UnwrapHinges(*sheet.metric, &shapes);
    EXPECT_LT(sheet.Energy(shapes), before);
  }
}

// By elements, each with its feature's weight, as the kernels have it of all.
TEST(UnwrapHinges, EnergiesOfElementsAddUpToThatOfThePath) {
  MetricOptions options;
  options.strain = 0.5;
  const Sheet even(options);
  options.stretching_stiffness = Eigen::VectorXd::LinSpaced(even.rest.cols(), 1, 50);
  options.bending_stiffness = Eigen::VectorXd::LinSpaced(even.rest.cols(), 30, 1);
  const Sheet sheet(options);
  const std::vector<Shape> shapes = testing::NoisyBlend(sheet.rest, sheet.Turned(1), 3, 0.05);
  double sum = 0;
  for (size_t f = 0; f < sheet.metric->features.size(); ++f) {
    for (int e = 0; e < sheet.metric->features[f]->NumElements(); ++e) {
      sum += internal::ElementEnergy(*sheet.metric, {static_cast<int>(f), e}, shapes);
    }
  }
  EXPECT_NEAR(2 * sum, sheet.Energy(shapes), 1e-11 * sum);
}

TEST(UnwrapHinges, MovesWithTheBody) {
  const Sheet sheet;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Shape> shapes = testing::NoisyBlend(sheet.rest, sheet.Turned(2), 7, 0.1);
  std::vector<Shape> turned;
  for (const Shape& shape : shapes) turned.push_back(turn * shape);
  UnwrapHinges(*sheet.metric, &shapes);
  UnwrapHinges(*sheet.metric, &turned);
  for (size_t i = 0; i < shapes.size(); ++i) {
    EXPECT_LT((turn * shapes[i] - turned[i]).norm(), 1e-9 * shapes[i].norm());
  }
}

TEST(UnwrapHinges, AMetricThatSeesNoHingesHasNoneToUnwind) {
  MetricOptions options;
  options.bending = 0;
  const Sheet sheet(options);
  std::vector<Shape> shapes = FullTurn(sheet);
  const std::vector<Shape> before = shapes;
  UnwrapHinges(*sheet.metric, &shapes);
  EXPECT_EQ(shapes, before);
}

}  // namespace
}  // namespace shapespace
