// The plane of a space: where points are, walks over it, and how points are placed and joined.

#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/exploration/embedding.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/exploration/triangulation.h>

#include "mesh/files.h"
#include "solvers/exploration/spaces.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::Distance;
using testing::MadeUpSpace;
using testing::MessageOf;
using testing::Names;
using testing::Refuses;
using testing::SmallTube;

// Two triangles of different sizes and no right angle.
PoseSpace SkewSpace() {
  PoseSpace space = MadeUpSpace(SmallTube());
  space.points << 0, 3, 4, -1, 2, 0, 1, 5, 2, 2.5;
  return space;
}

TEST(PoseSpace, WeightsOfAPointAreThoseOfTheCornersAround) {
  const PoseSpace space = SkewSpace();
  for (int t = 0; t < 2; ++t) {
    const Eigen::Vector3i corners = space.triangles.col(t);
    for (const std::array<double, 3>& w :
         {std::array<double, 3>{.5, .3, .2}, {.1, .3, .6}, {.05, .9, .05}, {.9, .01, .09}}) {
      const Eigen::Vector2d point = space.points(Eigen::all, corners) * Eigen::Vector3d(w.data());
      const PlaneLocation location = space.Locate(point);
      EXPECT_TRUE(location.inside);
      EXPECT_EQ(location.point, point);
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(location.nodes[k], corners(k));
        EXPECT_NEAR(location.weights[k], w[k], 1e-12);
      }
      const Shape expected = w[0] * space.nodes[corners(0)] + w[1] * space.nodes[corners(1)] +
                             w[2] * space.nodes[corners(2)];
      EXPECT_LT(Distance(BlendNodes(space.nodes, location, 7), 7 * expected), 1e-11);
      EXPECT_LT(Distance(space.At(point),
                         Shape((space.metric->unit * expected).colwise() + space.translation)),
                1e-11);
    }
  }
}

TEST(PoseSpace, OutsideTheNearestSideIsTakenWhicheverItIs) {
  const PoseSpace space = SkewSpace();
  const int sides[][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  for (const auto& [a, b] : sides) {
    const Eigen::Vector2d p = space.points.col(a), side = space.points.col(b) - p;
    const Eigen::Vector2d outwards(side.y(), -side.x());
    const Eigen::Vector2d foot = p + 0.3 * side;
    const PlaneLocation location = space.Locate(foot + 0.1 * outwards);
    EXPECT_FALSE(location.inside);
    EXPECT_LT((location.point - foot).norm(), 1e-12);
    double of_a = 0, of_b = 0;
    for (int k = 0; k < 3; ++k) {
      (location.nodes[k] == a ? of_a : of_b) += location.weights[k];
      EXPECT_TRUE(location.nodes[k] == a || location.nodes[k] == b);
    }
    EXPECT_NEAR(of_a, 0.7, 1e-12);
    EXPECT_NEAR(of_b, 0.3, 1e-12);
  }
  // Rounding does not put a point outside.
  EXPECT_TRUE(space.Locate(0.7 * space.points.col(0) + 0.3 * space.points.col(1)).inside);
}

TEST(PoseSpace, OnALineTheToleranceIsAShareOfItsExtent) {
  PoseSpace space = MadeUpSpace(SmallTube());
  space.points << 0, 300, 400, 0, 0, 0, 0, 0, 0, 0;
  space.triangles.resize(3, 0);
  space.segments.resize(2, 2);
  space.segments << 0, 1, 1, 2;
  EXPECT_TRUE(space.Locate({350, 0.99 * kFlatSpread * 400}).inside);
  EXPECT_FALSE(space.Locate({350, 1.01 * kFlatSpread * 400}).inside);
  const PlaneLocation location = space.Locate({325, 0});
  EXPECT_EQ(location.nodes[0], 1);
  EXPECT_EQ(location.nodes[1], 2);
  EXPECT_DOUBLE_EQ(location.weights[0], 0.75);
  EXPECT_DOUBLE_EQ(location.weights[1], 0.25);
}

TEST(WalkAlong, TellsWhereEachFrameIs) {
  PoseSpace space = MadeUpSpace(SmallTube());
  space.appearance.vertex_colours =
      Eigen::MatrixXd::Constant(3, space.metric->connectivity->NumVertices(), 0.5);
  // Of lengths 0.25, 0.75 and 0.25.
  const std::vector<Eigen::Vector2d> curve = {{0.5, 0}, {0.5, 0.25}, {0.5, 1}, {0.5, 1.25}};
  const PlaneWalk walk = WalkAlong(space, curve, 6);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(walk.path.parameters[i], i / 5.0, 1e-15);
    EXPECT_LT((walk.locations[i].point - Eigen::Vector2d(0.5, std::min(1.0, i / 4.0))).norm(),
              1e-14);
    EXPECT_EQ(walk.path.motions[i].translation, space.translation);
    EXPECT_TRUE(walk.path.motions[i].rotation.isIdentity(0));
    EXPECT_LT(Distance(walk.path.shapes[i], BlendNodes(space.nodes, walk.locations[i])), 1e-15);
  }
  EXPECT_EQ(walk.outside, 1);
  EXPECT_TRUE(walk.path.poses.empty());
  EXPECT_EQ(walk.path.metric, space.metric);
  EXPECT_EQ(walk.path.appearance.vertex_colours, space.appearance.vertex_colours);

  const PlaneWalk one = WalkAlong(space, {{1, 0}, {0, 0}}, 1);
  EXPECT_EQ(one.path.parameters, std::vector<double>{0});
  EXPECT_EQ(one.path.poses, std::vector<int>{0});
  // A curve of a single point, and one that turns back.
  const PlaneWalk still = WalkAlong(space, {{0, 1}}, 3);
  EXPECT_EQ(still.path.poses, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(still.path.Placed(1), space.Placed(3));
  const PlaneWalk back = WalkAlong(space, {{0, 0}, {1, 0}, {0, 0}}, 5);
  EXPECT_EQ(back.path.poses, (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(back.path.Placed(2), space.Placed(1));
  EXPECT_LT(Distance(back.path.Placed(3), back.path.Placed(1)), 1e-13);
}

TEST(WalkAlong, WhatIsWrongIsNamed) {
  const PoseSpace space = MadeUpSpace(SmallTube());
  const auto message = [&](const std::vector<Eigen::Vector2d>& curve, int frames) {
    return MessageOf<InvalidOptions>([&] { WalkAlong(space, curve, frames); });
  };
  EXPECT_TRUE(Names(message({}, 3), {"points:"}));
  EXPECT_TRUE(Names(message({{0, 0}}, 0), {"frames:", "1"}));
  EXPECT_TRUE(Names(message({{0, 0}, {std::nan(""), 0}}, 2), {"points:"}));
  EXPECT_TRUE(Names(message({{-1e308, 0}, {1e308, 0}}, 2), {"points:"}));
}

TEST(PoseSpace, EveryThingAtOddsIsNamed) {
  const ShapeFamily tube = SmallTube();
  const auto message = [&](const auto& spoil) {
    PoseSpace space = MadeUpSpace(tube);
    spoil(&space);
    return MessageOf<MeshError>([&] { space.Validate(); });
  };
  const double nan = std::nan("");
  const std::string number = "the space: its nodes, points, parents and distances differ in number";
  const std::string finite = "the space: a point or a distance is not finite";
  const std::string distances = "the space: its distances are negative, all zero, or not symmetric";
  const std::string range = "the space: a triangle or a segment has an index out of range";
  const std::string parents = "the space: a node comes before its parents";
  const std::string poses = "the space: must have at least two poses, and a name for each";
  EXPECT_EQ(message([](PoseSpace*) {}), "nothing was thrown");
  EXPECT_EQ(message([](PoseSpace* s) { s->names.resize(6); }), poses);
  EXPECT_EQ(message([](PoseSpace* s) { s->names.resize(1); }), poses);
  EXPECT_EQ(message([](PoseSpace* s) { s->distances.conservativeResize(3, 4); }), number);
  EXPECT_EQ(message([](PoseSpace* s) { s->distances.conservativeResize(4, 3); }), number);
  EXPECT_EQ(message([](PoseSpace* s) { s->points.conservativeResize(2, 4); }), number);
  EXPECT_EQ(message([](PoseSpace* s) { s->parents.push_back({0, 1}); }), number);
  EXPECT_TRUE(
      Names(message([&](PoseSpace* s) { s->nodes[4](1, 2) = nan; }), {"the space:", "node"}));
  EXPECT_EQ(message([&](PoseSpace* s) { s->points(1, 4) = nan; }), finite);
  EXPECT_EQ(message([&](PoseSpace* s) { s->distances(2, 1) = nan; }), finite);
  EXPECT_EQ(message([&](PoseSpace* s) { s->translation.z() = nan; }), finite);
  EXPECT_EQ(message([](PoseSpace* s) { s->distances(3, 1) = s->distances(1, 3) = -1; }), distances);
  EXPECT_EQ(message([](PoseSpace* s) { s->distances.setZero(); }), distances);
  EXPECT_EQ(message([](PoseSpace* s) { s->distances(3, 1) = 2; }), distances);
  EXPECT_EQ(message([](PoseSpace* s) { s->triangles(2, 1) = -1; }), range);
  EXPECT_EQ(message([](PoseSpace* s) { s->triangles(2, 1) = 5; }), range);
  EXPECT_EQ(message([](PoseSpace* s) { s->triangles(2, 1) = 4; }), "nothing was thrown");
  EXPECT_EQ(message([](PoseSpace* s) { s->segments = Eigen::Vector2i(0, 5); }), range);
  EXPECT_EQ(message([](PoseSpace* s) { s->segments = Eigen::Vector2i(-1, 1); }), range);
  EXPECT_TRUE(
      Names(message([](PoseSpace* s) { s->triangles.resize(3, 0); }), {"the space:", "triangle"}));
  EXPECT_EQ(message([](PoseSpace* s) { s->parents[0] = {4, 0}; }), parents);
  EXPECT_EQ(message([](PoseSpace* s) { s->parents[0] = {0, -1}; }), parents);
  EXPECT_EQ(message([](PoseSpace* s) { s->parents[0] = {3, 2}; }), "nothing was thrown");
  EXPECT_NE(message([](PoseSpace* s) { s->appearance.vertex_colours.setZero(3, 2); }),
            "nothing was thrown");
}

class CurveFileTest : public testing::FilesTest {};

TEST_F(CurveFileTest, ALineAndLaterMidpointsComeBack) {
  PoseSpace space = MadeUpSpace(SmallTube());
  space.nodes.emplace_back(0.5 * (space.nodes[1] + space.nodes[4]));
  space.points.conservativeResize(2, 6);
  space.points.col(5) << 0.75, 0.25;
  space.parents.push_back({1, 4});
  space.triangles.resize(3, 0);
  space.segments.resize(2, 2);
  space.segments << 0, 4, 4, 2;
  space.distances(0, 2) = space.distances(2, 0) = 1.5;
  space.appearance.vertex_colours =
      Eigen::MatrixXd::Constant(3, space.metric->connectivity->NumVertices(), 0.5);
  WriteSpace(Path("line.space"), space);
  const PoseSpace read = ReadSpace(Path("line.space"));
  EXPECT_EQ(read.segments, space.segments);
  EXPECT_EQ(read.triangles.cols(), 0);
  EXPECT_EQ(read.parents, space.parents);
  EXPECT_EQ(read.points, space.points);
  EXPECT_EQ(read.nodes, space.nodes);
  EXPECT_EQ(read.distances, space.distances);
  EXPECT_EQ(read.appearance.vertex_colours, space.appearance.vertex_colours);
}

TEST_F(CurveFileTest, MessagesNameThePointAndWhatItMustBe) {
  const PoseSpace space = MadeUpSpace(SmallTube());
  const auto message = [&](const std::string& points) {
    File("curve.json", R"({"$schema": "any", "points": )" + points + "}");
    return MessageOf<FileError>([&] { ReadCurve(Path("curve.json"), space); });
  };
  const std::string file = Path("curve.json") + ": points (point ";
  EXPECT_EQ(message(R"(["a", [2, 3], "d"])"), "nothing was thrown");
  EXPECT_TRUE(Names(message(R"(["a", "e"])"), {file + "2)", "'e'"}));
  EXPECT_TRUE(Names(message("[[1, 2], [1, 2], [1, 2, 3]]"), {file + "3)"}));
  EXPECT_TRUE(Names(message(R"([{"x": 1, "y": 2}])"), {file + "1)"}));
  EXPECT_EQ(message("[[1, \"2\"]]").rfind(file + "1)", 0), 0u);
  const auto points = ReadCurve(File("c.json", R"({"points": ["d", "b", [-3, 7]]})"), space);
  EXPECT_EQ(points, (std::vector<Eigen::Vector2d>{{0, 1}, {1, 0}, {-3, 7}}));
}

Eigen::MatrixXd PlaneDistances(const Eigen::Matrix2Xd& points) {
  Eigen::MatrixXd distances(points.cols(), points.cols());
  for (int i = 0; i < points.cols(); ++i) {
    distances.row(i) = (points.colwise() - points.col(i)).colwise().norm();
  }
  return distances;
}

TEST(Embed, PutsPointsOnTheirPrincipalAxesAndTheFarthestOnThePositiveSide) {
  Eigen::Matrix2Xd points(2, 5);
  points << 0, 1, 2, -1, 7, 0, 3, -1, 1, 0.5;
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Matrix2Xd embedded = Embed(PlaneDistances(sign * points)).points;
    EXPECT_LT(embedded.rowwise().mean().norm(), 1e-8);
    const Eigen::Matrix2d spread = embedded * embedded.transpose();
    EXPECT_NEAR(spread(0, 1), 0, 1e-7);
    EXPECT_GT(spread(0, 0), 2 * spread(1, 1));
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_GT(embedded.row(axis).maxCoeff(), -embedded.row(axis).minCoeff()) << axis;
    }
  }
}

TEST(Embed, EndsAsItsOptionsSay) {
  // The corners of a cube with one edge longer.
  Eigen::Matrix3Xd cube(3, 8);
  for (int i = 0; i < 8; ++i) cube.col(i) << 1.3 * (i & 1), (i & 2) / 2, 0.9 * (i & 4) / 4;
  Eigen::MatrixXd distances(8, 8);
  for (int i = 0; i < 8; ++i) distances.row(i) = (cube.colwise() - cube.col(i)).colwise().norm();
  EmbeddingOptions options;
  options.max_iterations = 3;
  options.tolerance = 1e-12;
  const Embedding three = Embed(distances, options);
  EXPECT_EQ(three.stresses.size(), 4u);
  EXPECT_FALSE(three.converged);
  EXPECT_EQ(three.stress, three.stresses.back());
  EXPECT_LT(three.stresses[1], three.stresses[0]);
  // A tolerance between the first two decreases.
  const auto decrease = [&](int i) { return 1 - three.stresses[i + 1] / three.stresses[i]; };
  ASSERT_GT(decrease(0), decrease(1));
  options.tolerance = (decrease(0) + decrease(1)) / 2;
  const Embedding two = Embed(distances, options);
  const size_t rounds = two.stresses.size();
  ASSERT_GE(rounds, 2u);
  EXPECT_LT(1 - two.stresses[rounds - 1] / two.stresses[rounds - 2], options.tolerance);
  EXPECT_TRUE(two.converged);
  Eigen::MatrixXd off = distances;
  off(3, 3) = 1e-3;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { Embed(off); }, {"distances:"}));
}

TEST(DelaunayTriangulation, OnALineCopiesAreLeftOutAndTheOthersJoined) {
  Eigen::Matrix2Xd points(2, 6);
  points << 1, 1, 8, 3, 8, 5, 0, 0, 0, 0, 0, 0;
  const Triangulation triangulation = DelaunayTriangulation(points);
  EXPECT_EQ(triangulation.left_out, (std::vector<int>{1, 4}));
  ASSERT_EQ(triangulation.segments.cols(), 3);
  Eigen::Matrix2Xi expected(2, 3);
  expected << 0, 3, 5, 3, 5, 2;
  const bool forwards = triangulation.segments(0, 0) == 0;
  EXPECT_EQ(triangulation.segments, forwards ? expected : Eigen::Matrix2Xi(expected.reverse()));
}

TEST(DelaunayTriangulation, AStripIsALineIfItIsNarrowEnough) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const double share : {0.5, 2.0}) {
      Eigen::Matrix2Xd points(2, 4);
      // Along a diagonal.
      points << 0, 3, 6, 10, 0, 3, 6, 10;
      points(0, 1) += share * kFlatSpread * 10 * 2;
      const Triangulation triangulation = DelaunayTriangulation(scale * points);
      EXPECT_EQ(triangulation.segments.cols(), share < 1 ? 3 : 0) << scale << ' ' << share;
      EXPECT_EQ(triangulation.triangles.cols() > 0, share > 1) << scale << ' ' << share;
    }
  }
  EXPECT_TRUE(Refuses<InvalidOptions>([] { DelaunayTriangulation(Eigen::Matrix2Xd::Ones(2, 3)); },
                                      {"points:"}));
}

}  // namespace
}  // namespace shapespace
