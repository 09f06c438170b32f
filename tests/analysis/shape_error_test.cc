#include <shapespace/analysis/shape_error.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>

namespace shapespace {
namespace {

TEST(CompareShapes, SeesScale) {
  const ShapeFamily bar = MakeBar(3, 1, 1, 6, 2, 2);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0)});
  const ShapeError error = CompareShapes(metric, bar.pose(0), 0.9 * bar.pose(0));
  EXPECT_NEAR(error.edge_rms, 0.1, 1e-12);
  EXPECT_NEAR(error.edge_max, 0.1, 1e-8);
  EXPECT_NEAR(error.volume, std::pow(0.9, 3) - 1, 1e-12);
  EXPECT_EQ(error.inverted_hinges, 0);
}

TEST(CompareShapes, CountsHingesThatAreTurnedOver) {
  const ShapeFamily sheet = MakeSheet(2, 1, 2, 1);
  const auto metric = FreezeMetric({}, sheet.connectivity, {sheet.pose(0)});
  Shape folded = sheet.pose(0);
  folded.row(0) = folded.row(0).cwiseAbs();
  const ShapeError error = CompareShapes(metric, sheet.pose(0), folded);
  EXPECT_NEAR(error.edge_max, 0, 1e-8);
  EXPECT_EQ(error.inverted_hinges, 1);
  EXPECT_TRUE(std::isnan(error.volume));
}

// A flat tetrahedron is closed.
TEST(CompareShapes, WhatEnclosesNoVolumeHasNoShareOfIt) {
  const Eigen::Matrix3Xi triangles =
      (Eigen::Matrix3Xi(3, 4) << 0, 0, 0, 1, 1, 2, 3, 3, 2, 3, 1, 2).finished();
  const auto tetrahedron = Connectivity::FromTriangles(4, triangles);
  const Shape flat = (Shape(3, 4) << 0, 1, 1, 0, 0, 0, 1, 1, 0, 1e-9, 0, 0).finished();
  const auto metric = FreezeMetric({}, tetrahedron, {flat});
  Shape blown = flat;
  blown(2, 2) = 0.3;
  EXPECT_TRUE(std::isnan(CompareShapes(metric, flat, blown).volume));
  EXPECT_NEAR(CompareShapes(metric, blown, 2 * blown).volume, 7, 1e-6);
}

}  // namespace
}  // namespace shapespace
