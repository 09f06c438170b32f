#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/path/anchor.h>

#include "mesh/bodies.h"
#include "support/message_of.h"
#include "support/motions.h"
#include "support/path_of.h"
#include "support/paths.h"

// The motion of a part between poses, worked out from the velocities that it should have there.

namespace shapespace {
namespace {

using testing::Connected;
using testing::Distance;
using testing::Grid;
using testing::MessageOf;
using testing::Names;
using testing::PathOf;
using testing::Rotation;

const std::vector<int> kHeldPart = {0, 1, 2, 5, 6, 7, 12};
const Eigen::Vector3d kAxis(1, 2, 3), kWay(2, -1, 2);  // kWay has the length 3

// At a share s of an interval of length l, from the values and the slopes at its ends.
double Hermite(double s, double l, double from, double from_slope, double to, double to_slope) {
  return (1 + 2 * s) * (1 - s) * (1 - s) * from + s * (1 - s) * (1 - s) * l * from_slope +
         s * s * (3 - 2 * s) * to + s * s * (s - 1) * l * to_slope;
}

struct AnchoredGrid {
  Soup grid = Grid(4, 4);
  Path path;
  Eigen::Vector3d centre;

  // Turned by `degrees` about the part's centroid and moved by `moves` along kWay.
  AnchoredGrid(const std::vector<double>& parameters, const std::vector<int>& poses,
               const std::vector<double>& degrees, const std::vector<double>& moves) {
    const Path still = PathOf(Connected(grid), {grid.vertices, grid.vertices});
    centre = Centroid(grid.vertices(Eigen::all, kHeldPart), still.metric->vertex_area(kHeldPart));
    std::vector<Shape> shapes;
    for (size_t i = 0; i < moves.size(); ++i) shapes.push_back(At(degrees[i], moves[i]));
    path = PathOf(Connected(grid), shapes);
    path.parameters = parameters;
    path.poses = poses;
    path.extrapolated = path.NumShapes() - 1 - poses.back();
    path.smooth = true;
    Anchor(&path, kHeldPart);
  }

  Shape At(double degrees, double move) const {
    return (Rotation(degrees, kAxis) * (grid.vertices.colwise() - centre)).colwise() +
           (centre + move * kWay);
  }
};

// Velocities at poses are those between the shapes beside them, but at most three times the slower
// mean velocity beside the pose: along the way in the second pose, of the turn in the third.
TEST(AnchorOfSmoothPaths, ThePartGoesOnCubicsWithTheLimitedVelocitiesOfThePath) {
  const std::vector<double> p = {0, 0.1, 0.15, 0.3, 0.4, 0.45, 0.6, 0.7, 0.9, 1};
  const std::vector<double> degrees = {-10, 0, 20, 30, 38, 39, 40, 75, 90, 100};
  const std::vector<double> moves = {-0.1, 0, 0.02, 0.1, 1, 1.5, 2, 2.2, 2.5, 2.6};
  const AnchoredGrid body(p, {1, 3, 6, 8}, degrees, moves);
  const double turns[] = {30 / 0.15, 18 / 0.25, 3 * 10 / 0.3, 25 / 0.3};
  const double speeds[] = {0.12 / 0.15, 3 * 0.1 / 0.2, 0.7 / 0.25, 0.4 / 0.3};
  const int poses[] = {1, 3, 6, 8};
  for (int k = 0; k < 3; ++k) {
    const int from = poses[k], to = poses[k + 1];
    const double l = p[to] - p[from];
    for (int i = from; i <= to; ++i) {
      const double s = (p[i] - p[from]) / l;
      const Shape expected =
          body.At(Hermite(s, l, degrees[from], turns[k], degrees[to], turns[k + 1]),
                  Hermite(s, l, moves[from], speeds[k], moves[to], speeds[k + 1]));
      EXPECT_LT(Distance(body.path.Placed(i), expected), 1e-10) << i;
    }
  }
  // Beyond the poses, at the velocities there.
  EXPECT_LT(Distance(body.path.Placed(0), body.At(-0.1 * turns[0], -0.1 * speeds[0])), 1e-10);
  EXPECT_LT(Distance(body.path.Placed(9), body.At(90 + 0.1 * turns[3], 2.5 + 0.1 * speeds[3])),
            1e-10);
}

TEST(AnchorOfSmoothPaths, WhereACycleClosesTheVelocityIsThatAcrossItsEnds) {
  const std::vector<double> p = {0, 0.1, 0.3, 0.5, 0.6, 0.9, 1};
  const std::vector<double> still(7, 0);
  // Limited by the mean velocity of the last piece, -0.125, or of the first, 0.1.
  const struct {
    std::vector<double> moves, speeds;
  } cases[] = {{{0, 0.3, 1, 0.6, 0.05, 0.2, 0}, {0.375, 0.75, -0.375, 0.375}},
               {{0, 0.3, 0.03, 0.6, 0.8, 0.2, 0}, {0.3, 0.3, -1, 0.3}},
               {{0, 0.3, 1, 0.6, 0.8, 0.2, 0}, {0.5, 0.75, -1, 0.5}}};
  for (const auto& [moves, speeds] : cases) {
    const AnchoredGrid body(p, {0, 2, 4, 6}, still, moves);
    for (int k = 0; k < 3; ++k) {
      const int from = 2 * k, to = from + 2;
      const double l = p[to] - p[from], s = (p[from + 1] - p[from]) / l;
      const Shape expected =
          body.At(0, Hermite(s, l, moves[from], speeds[k], moves[to], speeds[k + 1]));
      EXPECT_LT(Distance(body.path.Placed(from + 1), expected), 1e-10) << k;
    }
  }
}

// The axis of the turn differs from shape to shape.
TEST(AnchorOfSmoothPaths, ThePartTurnsAtAPoseAboutTheAxisOfThePath) {
  const Soup grid = Grid(4, 4);
  std::vector<Shape> shapes;
  std::vector<Eigen::Matrix3d> turns;
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 8.0;
    turns.push_back(Rotation(100 * t, {1, 2, 3}) * Rotation(80 * t * t, {2, -1, 0.5}));
    shapes.push_back(turns[i] * grid.vertices);
  }
  Path path = PathOf(Connected(grid), shapes);
  path.poses = {0, 4, 8};
  path.smooth = true;
  const struct { int pose, from, to; } cases[] = {{0, 0, 1}, {4, 3, 5}, {8, 7, 8}};
  for (const auto& [pose, from, to] : cases) {
    const double h = 1e-6, at = pose / 8.0;
    Path near = path;  // two shapes, shortly before the pose and shortly after it
    near.shapes = {path.shapes[2], path.shapes[2]};
    near.motions = {path.motions[2], path.motions[2]};
    near.parameters = {at - h, at + h};
    near.poses.clear();
    Anchor(path, kHeldPart, &near);
    const auto rate = [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, double time) {
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(b * a.transpose()));
      return Eigen::Vector3d(turn.angle() / time * turn.axis());
    };
    const Eigen::Vector3d expected = rate(turns[from], turns[to], (to - from) / 8.0);
    const Eigen::Vector3d found = rate(near.motions[0].rotation, near.motions[1].rotation, 2 * h);
    EXPECT_LT((found - expected).norm(), 1e-3) << found.transpose() << " at " << pose;
  }
}

TEST(Anchor, MessagesNameTheArgumentAndItsRange) {
  const Soup grid = Grid(4, 4);
  Path path = PathOf(Connected(grid), {grid.vertices, grid.vertices});
  const auto message = [](const std::function<void()>& call) {
    return MessageOf<InvalidOptions>(call);
  };
  EXPECT_TRUE(Names(message([&] { Anchor(&path, {}); }), {"vertices:"}));
  EXPECT_TRUE(Names(message([&] { Anchor(&path, {3, 25, 26}); }), {"vertices:", "25", "0", "24"}));
  EXPECT_TRUE(Names(message([&] { Anchor(&path, {-1}); }), {"vertices:", "-1", "0", "24"}));
  EXPECT_EQ(message([&] { Anchor(&path, {24, 0}); }), "nothing was thrown");
  EXPECT_TRUE(Names(message([&] { Ground(&path, 3, 0); }), {"axis:", "0", "1", "2"}));
  for (const double height : {1.1e60, -1.1e60}) {
    EXPECT_TRUE(Names(message([&] { Ground(&path, 1, height); }), {"height:", "1e60"}));
  }
  Path points = PathOf(Connectivity::Make(2, {0}, {}, {{0, 1}}), {Shape::Random(3, 2)});
  EXPECT_EQ(message([&] { Ground(&points, 1, -1e60); }), "nothing was thrown");
}

}  // namespace
}  // namespace shapespace
