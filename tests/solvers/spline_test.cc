#include <shapespace/spline/spline.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/path/path_file.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"
#include "support/temporary_file.h"

namespace shapespace {
namespace {

using testing::Diameter;
using testing::Distance;
using testing::MessageOf;
using testing::Names;
using testing::Rotation;

SplineOptions Fine(SplineEnds ends, int shapes = 7, double hold_limit = 3) {
  SplineOptions options;
  options.ends = ends;
  options.hold_limit = hold_limit;
  options.geodesic.shapes = shapes;
  options.geodesic.tolerance = 1e-9;
  options.geodesic.max_iterations = 5000;
  return options;
}

const ShapeFamily& Tube() {
  static const ShapeFamily tube = MakeTube(400);
  return tube;
}

std::vector<Shape> PosesAt(const ShapeFamily& body, const std::vector<double>& values) {
  std::vector<Shape> poses;
  for (double value : values) poses.push_back(body.pose(value));
  return poses;
}

// The greatest mean distance of the path's shapes from the body's, after rigid alignment, as a
// share of the diameter.
double Error(const Path& path, const ShapeFamily& body, double (*value)(double)) {
  double greatest = 0;
  for (int i = 0; i < path.NumShapes(); ++i) {
    const Shape truth = body.pose(value(path.parameters[i])), shape = path.Placed(i);
    const RigidMotion motion = FitRigidMotion(shape, truth, Eigen::VectorXd::Ones(shape.cols()));
    greatest =
        std::max(greatest, (motion(shape) - truth).colwise().norm().mean() / Diameter(truth));
  }
  return greatest;
}

// A sheet that rolls up isometrically, with an angle that is cubic in time.
TEST(Spline, IsExactForMotionsThatAreCubicInTime) {
  const ShapeFamily sheet = MakeSheet(2, 1, 16, 8);
  const auto angle = [](double t) { return 20 + 40 * t + 100 * t * t - 60 * t * t * t; };
  for (const std::vector<double>& times :
       {std::vector<double>{0, 0.25, 0.5, 0.75, 1}, {0, 0.1, 0.4, 0.8, 1}}) {
    std::vector<Shape> poses;
    for (double t : times) poses.push_back(sheet.pose(angle(t)));
    SplineOptions options = Fine(SplineEnds::kNotAKnot, 7, 0);
    options.times = times;
    const auto [path, summary] = Spline(sheet.connectivity, poses, options);
    EXPECT_TRUE(summary.smooth);
    EXPECT_LT(Error(path, sheet, angle), 1e-5);
  }
}

TEST(Spline, JumpsOfVelocityFallWithTheSquareOfTheSegments) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 60, 70, 120});
  double before = 0;
  for (int shapes : {7, 15, 31}) {
    for (const SplineEnds ends : {SplineEnds::kNatural, SplineEnds::kPeriodic}) {
      const SplineSummary summary = Spline(Tube().connectivity, poses, Fine(ends, shapes)).summary;
      EXPECT_GT(summary.jump_before, 1);
      if (ends == SplineEnds::kPeriodic) {
        EXPECT_LT(summary.jump_after, shapes == 7 ? 0.2 : 0.06);
        continue;
      }
      if (before > 0) {
        EXPECT_NEAR(before / summary.jump_after, 4, 0.8);
      } else {
        EXPECT_LT(summary.jump_after, 0.05);
      }
      before = summary.jump_after;
    }
  }
}

TEST(Spline, MeetsThePosesAtTheirTimes) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 90, 30, 60});
  SplineOptions options = Fine(SplineEnds::kNatural, 3);
  options.times = {2, 3, 7, 12};
  const auto [path, summary] = Spline(Tube().connectivity, poses, options);
  EXPECT_TRUE(path.smooth);
  ASSERT_EQ(path.poses.size(), poses.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(Distance(path.Placed(path.poses[i]), poses[i]), 1e-12);
    EXPECT_NEAR(path.parameters[path.poses[i]], (options.times[i] - 2) / 10, 1e-15);
  }
}

// The mean speed is then the same between all poses.
TEST(Spline, MeetsPosesAtTimesByLength) {
  SplineOptions options = Fine(SplineEnds::kNatural, 7);
  options.by_length = true;
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 60, 80, 120});
  const auto [path, summary] = Spline(Tube().connectivity, poses, options);
  EXPECT_LT(summary.jump_after, 0.02);
  std::vector<double> lengths;
  for (size_t i = 0; i + 1 < poses.size(); ++i) {
    lengths.push_back(
        std::sqrt(Interpolate(Tube().connectivity, {poses[i], poses[i + 1]}, options.geodesic)
                      .summary.energy));
  }
  const double all = lengths[0] + lengths[1] + lengths[2];
  // Lengths are in the unit of each metric, and metrics depend a little on the poses.
  EXPECT_NEAR(path.parameters[path.poses[1]], lengths[0] / all, 0.02);
  EXPECT_NEAR(path.parameters[path.poses[2]], (lengths[0] + lengths[1]) / all, 0.02);
  options.times = {0, 1, 2, 3};
  EXPECT_THROW(options.Validate(), InvalidOptions);
  options.times.clear();
  EXPECT_TRUE(Names(MessageOf<InvalidOptions>([&] {
                      Spline(Tube().connectivity, PosesAt(Tube(), {0, 60, 60, 30}), options);
                    }),
                    {"by_length:", "poses 2", "3"}));
}

// The chain has the least energy of all paths through the poses at evenly spaced times.
TEST(Spline, TellsItsEnergy) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 60, 70, 120});
  const SplineSummary smooth =
      Spline(Tube().connectivity, poses, Fine(SplineEnds::kNatural, 15)).summary;
  EXPECT_GT(smooth.energy, 1.01 * smooth.geodesic.energy);
  EXPECT_LT(smooth.energy, 4 * smooth.geodesic.energy);
  const SplineSummary chain =
      Spline(Tube().connectivity, PosesAt(Tube(), {0, 60}), Fine(SplineEnds::kNatural, 7)).summary;
  EXPECT_NEAR(chain.energy, chain.geodesic.energy, 1e-9 * chain.energy);
}

TEST(Spline, OfTwoPosesIsTheGeodesic) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 90});
  const SplineOptions options = Fine(SplineEnds::kNatural);
  const SplineResult spline = Spline(Tube().connectivity, poses, options);
  const Path chain = Interpolate(Tube().connectivity, poses, options.geodesic).path;
  EXPECT_EQ(spline.path.shapes, chain.shapes);
  EXPECT_FALSE(spline.summary.smooth);
}

// Rigid copies: no shape changes, and the placement follows the cubic spline of the angles.
TEST(Spline, OfRigidCopiesTurnsOnItsCubic) {
  Shape body = Tube().pose(40);
  body.colwise() -=
      Centroid(body, FreezeMetric(MetricOptions(), Tube().connectivity, {body})->vertex_area);
  const auto angle = [](double t) { return 90 * t * t * t; };
  const Eigen::Vector3d axis(1, 2, 3);
  std::vector<Shape> poses;
  for (int i = 0; i < 5; ++i) poses.push_back(Rotation(angle(i / 4.0), axis) * body);
  const Path path = Spline(Tube().connectivity, poses, Fine(SplineEnds::kNotAKnot, 7, 0)).path;
  for (int i = 0; i < path.NumShapes(); ++i) {
    const Shape expected = Rotation(angle(path.parameters[i]), axis) * body;
    EXPECT_LT(Distance(path.Placed(i), expected), 1e-6 * Diameter(body)) << i;
  }
}

// A cylinder whose end is turned by more than a full turn between two poses keeps its way.
TEST(Spline, KeepsTheWayOfLargeTurns) {
  const ShapeFamily sheet = MakeSheet(6, 1, 36, 6);
  const auto twisted = [&](double degrees) {
    Shape shape = sheet.pose(0);
    const double length = shape.row(0).maxCoeff() - shape.row(0).minCoeff();
    for (int v = 0; v < shape.cols(); ++v) {
      const double share = (shape(0, v) - shape.row(0).minCoeff()) / length;
      shape.col(v) = Rotation(share * degrees, {1, 0, 0}) * shape.col(v);
    }
    return shape;
  };
  const std::vector<Shape> poses = {twisted(0), twisted(120), twisted(240), twisted(420)};
  const auto [path, summary] = Spline(sheet.connectivity, poses, Fine(SplineEnds::kNatural, 15));
  EXPECT_LT(summary.jump_after, 0.05 * summary.jump_before);
  for (int i = 0; i < path.NumShapes(); ++i) {
    EXPECT_LT(Diameter(path.shapes[i]), 1.1 * Diameter(path.shapes[0])) << i;
  }
}

TEST(Spline, RestsAtAPoseThatIsHeld) {
  const Path path =
      Spline(Tube().connectivity, PosesAt(Tube(), {0, 90, 90, 30}), Fine(SplineEnds::kNatural))
          .path;
  for (int i = path.poses[1]; i <= path.poses[2]; ++i) {
    EXPECT_LT(Distance(path.Placed(i), Tube().pose(90)), 1e-9);
  }
  const Path swinging = Spline(Tube().connectivity, PosesAt(Tube(), {0, 90, 90, 30}),
                               Fine(SplineEnds::kNatural, 7, 0))
                            .path;
  EXPECT_GT(Distance(swinging.Placed(path.poses[1] + 4), Tube().pose(90)), 1e-2);
}

TEST(Spline, BeginsAndEndsWithGivenVelocities) {
  SplineOptions options = Fine(SplineEnds::kClamped, 31);
  options.times = {0, 2, 4};
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 60, 80});
  const Tangent velocity = 10 * (Tube().pose(1) - Tube().pose(0));  // ten degrees a unit of time
  options.first_velocity = velocity;
  options.last_velocity = Tangent::Zero(3, velocity.cols());
  const Path path = Spline(Tube().connectivity, poses, options).path;
  const double dt = 4 * path.parameters[1];
  const Tangent first = (4 * path.Placed(1) - 3 * path.Placed(0) - path.Placed(2)) / (2 * dt);
  EXPECT_LT((first - velocity).norm(), 0.05 * velocity.norm());
  const int last = path.NumShapes() - 1;
  const Tangent end =
      (3 * path.Placed(last) - 4 * path.Placed(last - 1) + path.Placed(last - 2)) / (2 * dt);
  EXPECT_LT(end.norm(), 0.05 * velocity.norm());
}

TEST(Spline, OfACycleDoesNotDependOnWhereItBegins) {
  SplineOptions options = Fine(SplineEnds::kPeriodic);
  const std::vector<double> angles = {0, 60, 100, 30};
  const Path a = Spline(Tube().connectivity, PosesAt(Tube(), angles), options).path;
  const Path b = Spline(Tube().connectivity, PosesAt(Tube(), {60, 100, 30, 0}), options).path;
  ASSERT_EQ(a.NumShapes(), 33);
  EXPECT_LT(Distance(a.Placed(32), a.Placed(0)), 1e-9);
  for (int i = 0; i < 32; ++i) {
    EXPECT_LT(Distance(a.Placed((i + 8) % 32), b.Placed(i)), 2e-3 * Diameter(a.Placed(0))) << i;
  }
}

TEST(Spline, NamesItsPosesIfTheyHaveNames) {
  SplineOptions options = Fine(SplineEnds::kPeriodic, 3);
  Poses poses;
  poses.connectivity = Tube().connectivity;
  poses.shapes = PosesAt(Tube(), {0, 60});
  EXPECT_TRUE(Spline(poses, options).path.pose_names.empty());
  poses.names = {"straight.obj", "bent.obj"};
  EXPECT_EQ(Spline(poses, options).path.pose_names,
            (std::vector<std::string>{"straight", "bent", "straight"}));
}

TEST(Spline, CommutesWithScaleAndPlaceAndReversesWithTime) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 90, 30});
  const SplineOptions options = Fine(SplineEnds::kNatural, 3);
  const Path path = Spline(Tube().connectivity, poses, options).path;
  const Eigen::Vector3d way(1e6, -2e6, 3e6);
  std::vector<Shape> moved, reversed(poses.rbegin(), poses.rend());
  for (const Shape& pose : poses) moved.push_back((1000 * pose).colwise() + way);
  const Path far = Spline(Tube().connectivity, moved, options).path;
  const Path back = Spline(Tube().connectivity, reversed, options).path;
  const double size = Diameter(poses[0]);
  for (int i = 0; i < path.NumShapes(); ++i) {
    const Shape expected = (1000 * path.Placed(i)).colwise() + way;
    EXPECT_LT(Distance(far.Placed(i), expected), 1e-4 * 1000 * size) << i;
    EXPECT_LT(Distance(back.Placed(path.NumShapes() - 1 - i), path.Placed(i)), 1e-3 * size) << i;
  }
}

// Poses that are stretched in different ways, so that it would show if one of them was a reference.
std::vector<Shape> StretchedPoses(const ShapeFamily& sheet) {
  std::vector<Shape> poses;
  const Eigen::Vector3d stretches[] = {{1, 1, 1}, {1.6, 0.8, 1.2}, {0.9, 1.5, 1}, {1.2, 1, 1.7}};
  const double angles[] = {20, 80, 50, 140};
  for (int i = 0; i < 4; ++i) {
    poses.push_back(Rotation(30 * i, {1, 2, 3}) *
                    (stretches[i].asDiagonal() * sheet.pose(angles[i])));
  }
  return poses;
}

TEST(Spline, DoesNotDependOnWhichPoseIsFirst) {
  const ShapeFamily sheet = MakeSheet(2, 1, 8, 4);
  const std::vector<Shape> poses = StretchedPoses(sheet);
  const std::vector<Shape> reversed(poses.rbegin(), poses.rend());
  SplineOptions options = Fine(SplineEnds::kNatural);
  options.geodesic.tolerance = 1e-12;
  options.times = {0, 1, 2.5, 3};
  const Path path = Spline(sheet.connectivity, poses, options).path;
  options.times = {0, 0.5, 2, 3};
  const Path back = Spline(sheet.connectivity, reversed, options).path;
  const double size = Diameter(poses[0]);
  for (int i = 0; i < path.NumShapes(); ++i) {
    EXPECT_LT(Distance(back.Placed(path.NumShapes() - 1 - i), path.Placed(i)), 2e-5 * size) << i;
  }
  // A cycle, begun at another pose.
  options.times.clear();
  options.ends = SplineEnds::kPeriodic;
  const Path cycle = Spline(sheet.connectivity, poses, options).path;
  const Path later =
      Spline(sheet.connectivity, {poses[1], poses[2], poses[3], poses[0]}, options).path;
  for (int i = 0; i < 32; ++i) {
    EXPECT_LT(Distance(cycle.Placed((i + 8) % 32), later.Placed(i)), 1e-4 * size) << i;
  }
}

// A triangle without area in one pose has no rotation there, and the geodesics are not smooth.
TEST(Spline, IsSmoothWhereATriangleCollapsesOrSaysThatItIsNot) {
  const ShapeFamily sheet = MakeSheet(2, 1, 8, 4);
  std::vector<Shape> poses = PosesAt(sheet, {0, 60, 150, 100});
  poses[1].col(3) = poses[1].col(4);
  SplineOptions options;
  options.geodesic.shapes = 7;
  const SplineSummary summary = Spline(sheet.connectivity, poses, options).summary;
  EXPECT_TRUE(summary.smooth);
  EXPECT_LT(summary.jump_after, 0.3 * summary.jump_before);
  EXPECT_TRUE(summary.jump_after < 0.5 ||
              summary.warnings.size() > summary.geodesic.warnings.size());
}

TEST(Spline, OfABodyThatDoesNotMoveHasNoJumps) {
  const Shape pose = Tube().pose(40);
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1e6, -3e6, 2e6)}) {
    const Shape placed = pose.colwise() + place;
    for (const SplineEnds ends : {SplineEnds::kNatural, SplineEnds::kNotAKnot}) {
      const auto [path, summary] =
          Spline(Tube().connectivity, {placed, placed, placed}, Fine(ends, 3));
      EXPECT_EQ(summary.jump_before, 0);
      EXPECT_EQ(summary.jump_after, 0);
      for (int i = 0; i < path.NumShapes(); ++i) {
        EXPECT_LT(Distance(path.Placed(i), placed), 1e-8);
      }
    }
  }
}

// Whichever times are taken, the path is valid and its shapes are finite.
TEST(Spline, TimesThatNumbersCannotTellApartAreRefused) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 90, 30, 60});
  SplineOptions options = Fine(SplineEnds::kNatural, 3);
  const std::vector<std::vector<double>> refused = {
      {-1e308, 0, 1e308, 1.5e308}, {0, 1, 1 + 4.5e-16, 3}, {0, 1e-17, 1, 3},
      {0, 5e-324, 1e-323, 1},      {0, 1, 1e17, 2e17},     {-1, 1 - 1e-12, 1, 2}};
  for (const std::vector<double>& times : refused) {
    options.times = times;
    EXPECT_NE(MessageOf<InvalidOptions>([&] {
                Spline(Tube().connectivity, poses, options);
              }).find("times"),
              std::string::npos)
        << times[1];
  }
  const std::vector<std::vector<double>> taken = {{0, 1e-8, 1, 3},
                                                  {-8e307, 0, 4e307, 8e307},
                                                  {0, 1e-320, 2e-320, 4e-320},
                                                  {1e15, 1e15 + 1, 1e15 + 2, 1e15 + 4}};
  for (const std::vector<double>& times : taken) {
    options.times = times;
    const Path path = Spline(Tube().connectivity, poses, options).path;
    EXPECT_NO_THROW(path.Validate());
    for (int i = 0; i < path.NumShapes(); ++i) EXPECT_TRUE(path.Placed(i).allFinite());
  }
}

TEST(Spline, MovesGraphsOnCubicsInSpace) {
  const auto graph = Connectivity::Make(2, {0}, {}, {{0, 1}});
  std::vector<Shape> poses;
  for (double angle : {0.0, 40.0, 60.0, 100.0}) {
    Shape pose(3, 2);
    pose << 0, std::cos(angle / 57.3), 0, std::sin(angle / 57.3), 0, 0;
    poses.push_back(pose);
  }
  const auto [path, summary] = Spline(graph, poses, Fine(SplineEnds::kNatural, 15));
  EXPECT_TRUE(summary.smooth);
  EXPECT_LT(summary.jump_after, 0.05 * summary.jump_before);
}

TEST(Spline, RefusesWhatItCannotDo) {
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 90, 30});
  const auto message = [&](const SplineOptions& options) {
    return MessageOf<InvalidOptions>([&] { Spline(Tube().connectivity, poses, options); });
  };
  SplineOptions options;
  options.times = {0, 2, 1};
  EXPECT_TRUE(Names(message(options), {"times:"}));
  options.times = {0, 1};
  EXPECT_TRUE(Names(message(options), {"times:", "3", "2"}));
  options = {};
  options.ends = SplineEnds::kClamped;
  EXPECT_TRUE(Names(message(options), {"clamped"}));
  options = {};
  options.hold_limit = -1;
  EXPECT_NE(message(options).find("hold_limit"), std::string::npos);
  options = {};
  options.ends = SplineEnds::kPeriodic;
  EXPECT_TRUE(Names(MessageOf<MeshError>([&] {
                      Spline(Tube().connectivity, PosesAt(Tube(), {0, 90, 0}), options);
                    }),
                    {"last pose"}));
}

TEST(Spline, WhenStoppedIsTheChainAndSaysSo) {
  struct StopWhileSmoothing : Progress {
    bool Report(const std::string& stage, int, int) override { return stage != "smoothing"; }
  } progress;
  const std::vector<Shape> poses = PosesAt(Tube(), {0, 90, 30});
  const SplineOptions options = Fine(SplineEnds::kNatural, 3);
  const auto [path, summary] = Spline(Tube().connectivity, poses, options, &progress);
  EXPECT_FALSE(summary.smooth);
  EXPECT_FALSE(path.smooth);
  EXPECT_FALSE(summary.Converged());
  EXPECT_FALSE(path.converged);
  EXPECT_EQ(path.shapes, Interpolate(Tube().connectivity, poses, options.geodesic).path.shapes);
  EXPECT_NE(summary.warnings.back().find("stopped"), std::string::npos);
}

TEST(Spline, StaysSmoothInFilesAndAtOtherTimes) {
  const Path path =
      Spline(Tube().connectivity, PosesAt(Tube(), {0, 90, 30}), Fine(SplineEnds::kNatural, 15))
          .path;
  const std::string file = testing::TemporaryFile("smooth.path");
  WritePath(file, path);
  EXPECT_TRUE(ReadPath(file).smooth);
  // Interpolated across the pose, where a chain would keep its corner.
  std::vector<double> times;
  for (int i = 0; i <= 40; ++i) times.push_back(0.45 + 0.1 * i / 40);
  const Path near = Resample(path, times);
  EXPECT_TRUE(near.smooth);
  double greatest = 0, mean = 0;
  for (int i = 1; i < 40; ++i) {
    greatest =
        std::max(greatest, (near.shapes[i + 1] - 2 * near.shapes[i] + near.shapes[i - 1]).norm());
    mean += (near.shapes[i + 1] - near.shapes[i]).norm() / 39;
  }
  EXPECT_LT(greatest, 0.1 * mean);
}

}  // namespace
}  // namespace shapespace
