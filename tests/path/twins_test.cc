#include <cmath>

#include <shapespace/analysis/deviation_sites.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/analysis/vertex_energy.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/path/anchor.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/path.h>
#include <shapespace/path/path_file.h>

#include <gtest/gtest.h>

#include "support/cut_body.h"
#include "support/temporary_file.h"

namespace shapespace {
namespace {

using testing::CutBody;

// A bar as a soup, and whole, in the same motion.
struct CutBar {
  ShapeFamily bar = MakeBar(4, 1, 1, 8, 2, 2);
  CutBody cut = testing::CutIntoPolygons(*bar.connectivity);
  std::vector<Shape> placed = {bar.pose(0), bar.pose(30), bar.pose(60)};

  Path Whole(const MetricOptions& options = {}) const {
    return MakePath(FreezeMetric(options, bar.connectivity, placed), placed);
  }
  Path Cut(const MetricOptions& options = {}) const {
    std::vector<Shape> shapes;
    for (const Shape& shape : placed) shapes.push_back(cut.Of(shape));
    const auto connectivity = testing::Joined(cut, *bar.connectivity);
    return MakePath(FreezeMetric(options, connectivity, shapes), shapes);
  }
};

TEST(PathOfTwins, ShapesHaveNoGapWherePosesHave) {
  const CutBar body;
  Path path = body.Cut();
  for (Shape& shape : path.shapes) shape.rightCols(3).setConstant(7);
  for (int i = 0; i < path.NumShapes(); ++i) EXPECT_TRUE(body.cut.HasNoGap(path.Placed(i)));
  for (const Shape& shape : path.Placed()) EXPECT_TRUE(body.cut.HasNoGap(shape));
}

TEST(PathOfTwins, MetricIsThatOfTheWholeBody) {
  const CutBar body;
  for (const bool rigid : {false, true}) {
    MetricOptions options = rigid ? MetricOptions::Rigid() : MetricOptions();
    options.weights = rigid ? Weighting::kUniform : Weighting::kArea;
    options.stretching_stiffness.setOnes(body.bar.connectivity->NumVertices());
    options.stretching_stiffness(3) = 20;
    MetricOptions of_cut = options;
    of_cut.stretching_stiffness.setConstant(body.cut.source.size(), 1e6);  // but for those below
    of_cut.stretching_stiffness.head(options.stretching_stiffness.size()) =
        options.stretching_stiffness;
    const Path whole = body.Whole(options), cut = body.Cut(of_cut);
    EXPECT_NEAR(cut.metric->unit, whole.metric->unit, 1e-14 * whole.metric->unit);
    const std::vector<double> lengths = SquaredLengths(whole.metric, whole.shapes);
    const std::vector<double> of_twins = SquaredLengths(cut.metric, cut.shapes);
    for (size_t i = 0; i < lengths.size(); ++i) {
      EXPECT_NEAR(of_twins[i], lengths[i], 1e-10 * lengths[i]);
    }
  }
}

TEST(PathOfTwins, AnchorsCountEveryPointOnce) {
  const CutBar body;
  std::vector<int> part, of_cut;
  for (size_t v = 0; v < body.cut.source.size(); ++v) {
    const int point = body.cut.source[v];
    if (body.placed[0](0, point) > -1.6) continue;
    if (point == static_cast<int>(v)) part.push_back(point);
    // Half of them are named by their last copies only.
    if (static_cast<int>(v) == (point % 2 == 0 ? body.cut.LastCopy(point) : point)) {
      of_cut.push_back(static_cast<int>(v));
    }
  }
  Path whole = body.Whole(), cut = body.Cut();
  Anchor(&whole, part);
  Anchor(&cut, of_cut);
  for (int i = 0; i < whole.NumShapes(); ++i) {
    EXPECT_LT((cut.Placed(i) - body.cut.Of(whole.Placed(i))).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(PathOfTwins, FilesKeepThem) {
  const CutBar body;
  const std::string file = testing::TemporaryFile("twins.path");
  const Path path = body.Cut();
  WritePath(file, path);
  const Path again = ReadPath(file);
  const Connectivity &kept = *again.metric->connectivity, &given = *path.metric->connectivity;
  EXPECT_EQ(kept.Representatives(), body.cut.source);
  EXPECT_EQ(kept.Triangles(), given.Triangles());
  EXPECT_EQ(kept.FileTriangles(), given.FileTriangles());
  EXPECT_EQ(kept.Corners(), given.Corners());
  EXPECT_EQ(kept.Edges(), given.Edges());
  EXPECT_EQ(again.shapes, path.shapes);
}

TEST(PathOfTwins, WhatIsMeasuredAtVerticesIsThatOfTheWholeBody) {
  CutBar body;
  for (Shape& shape : body.placed) {  // not symmetric, so that no two vertices deviate alike
    for (int v = 0; v < shape.cols(); ++v) shape.col(v) *= 1 + 0.01 * std::sin(v);
  }
  const Path whole = body.Whole(), cut = body.Cut();
  const auto same = [&](const Eigen::VectorXd& of_cut, const Eigen::VectorXd& of_whole) {
    for (size_t v = 0; v < body.cut.source.size(); ++v) {
      EXPECT_NEAR(of_cut(v), of_whole(body.cut.source[v]), 1e-9 * of_whole.maxCoeff());
    }
  };
  same(EdgeDeviation(*cut.metric, cut.shapes[0], cut.shapes[2]),
       EdgeDeviation(*whole.metric, whole.shapes[0], whole.shapes[2]));
  same(VertexEnergy(cut)[1], VertexEnergy(whole)[1]);
  const RigidParts parts = FindRigidParts(cut), expected = FindRigidParts(whole);
  same(parts.of_vertex.cast<double>(), expected.of_vertex.cast<double>());
  const auto sites = FindDeviationSites(cut, parts);
  const auto expected_sites = FindDeviationSites(whole, expected);
  ASSERT_EQ(sites.size(), expected_sites.size());
  for (size_t i = 0; i < sites.size(); ++i) {
    EXPECT_EQ(sites[i].vertex, expected_sites[i].vertex);
    EXPECT_NEAR(sites[i].share, expected_sites[i].share, 1e-9);
  }
}

}  // namespace
}  // namespace shapespace
