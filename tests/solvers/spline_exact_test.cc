// Splines of rigid copies of a tiny body, which move on cubics exactly.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/spline/spline.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Refuses;
using testing::Rotation;

// A tetrahedron without symmetries, some sixty units large.
struct Tetrahedron {
  std::shared_ptr<const Connectivity> connectivity =
      Connectivity::Make(4, {0, 3, 6, 9, 12}, {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}, {});
  Shape shape = 20 * (Shape(3, 4) << 0, 3, 1, 0.5, 0, 0.3, 2, 0.4, 0, -0.2, 0.5, 2.5).finished();
  Eigen::Vector3d way{3, -4, 12};  // 13 units

  // Its centre of area in the origin.
  Shape Centred() const {
    const auto metric = FreezeMetric({}, connectivity, {shape});
    return shape.colwise() - Centroid(shape, metric->vertex_area);
  }
  std::vector<Shape> MovedBy(const std::vector<double>& ways) const {
    std::vector<Shape> poses;
    for (double by : ways) poses.push_back(shape.colwise() + by * way);
    return poses;
  }
};

SplineOptions Ends(SplineEnds ends, int shapes = 7) {
  SplineOptions options;
  options.ends = ends;
  options.hold_limit = 0;
  options.geodesic.shapes = shapes;
  return options;
}

double Cubic(double t) { return 5 - 2 * t + 0.75 * t * t - 0.0625 * t * t * t; }
double CubicSlope(double t) { return -2 + 1.5 * t - 0.1875 * t * t; }

TEST(SplineExactTest, CopiesThatAreShiftedFollowTheirCubic) {
  const Tetrahedron body;
  for (const std::vector<double>& times : {std::vector<double>{2, 3, 5, 9}, {2, 9}, {0, 1, 2}}) {
    for (const SplineEnds ends : {SplineEnds::kNotAKnot, SplineEnds::kClamped}) {
      if (ends == SplineEnds::kNotAKnot && times.size() < 4) continue;
      SplineOptions options = Ends(ends);
      if (times.front() > 0) options.times = times;  // else evenly spaced
      std::vector<double> ways;
      for (double t : times) ways.push_back(Cubic(t));
      if (ends == SplineEnds::kClamped) {
        options.first_velocity = CubicSlope(times.front()) * body.way.replicate(1, 4);
        options.last_velocity = CubicSlope(times.back()) * body.way.replicate(1, 4);
      }
      const auto [path, summary] = Spline(body.connectivity, body.MovedBy(ways), options);
      EXPECT_TRUE(summary.smooth);
      EXPECT_EQ(summary.ends, ends);
      EXPECT_EQ(path.parameters.front(), 0);
      EXPECT_EQ(path.parameters.back(), 1);
      for (int k = 0; k < path.NumShapes(); ++k) {
        const size_t piece = std::min<size_t>(k / 8, times.size() - 2);
        const double t = times[piece] + (k - 8. * static_cast<double>(piece)) / 8 *
                                            (times[piece + 1] - times[piece]);
        EXPECT_NEAR(path.parameters[k], (t - times.front()) / (times.back() - times.front()),
                    1e-14);
        const Shape expected = body.shape.colwise() + Cubic(t) * body.way;
        EXPECT_LT((path.Placed(k) - expected).norm(), 1e-8) << k;
      }
    }
  }
}

// Both the motion and the shapes in its frame turn, since a given velocity is one of the vertices.
TEST(SplineExactTest, CopiesThatAreTurnedFollowTheirCubic) {
  const Tetrahedron body;
  const Shape centred = body.Centred();
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3, place(70, -20, 40);
  const std::vector<double> times = {2, 3, 5, 6};
  const auto pose_at = [&](double t) -> Shape {
    return (Rotation(20 * Cubic(t), axis) * centred).colwise() + (place + Cubic(t) * body.way);
  };
  const auto velocity_at = [&](double t) {
    Tangent velocity = pose_at(t).colwise() - (place + Cubic(t) * body.way);
    for (int v = 0; v < 4; ++v) {
      velocity.col(v) = CubicSlope(t) *
                        (20 * M_PI / 180 * axis.cross(Eigen::Vector3d(velocity.col(v))) + body.way);
    }
    return velocity;
  };
  SplineOptions options = Ends(SplineEnds::kClamped, 15);
  options.times = times;
  options.first_velocity = velocity_at(times.front());
  options.last_velocity = velocity_at(times.back());
  std::vector<Shape> poses;
  for (double t : times) poses.push_back(pose_at(t));
  const Path path = Spline(body.connectivity, poses, options).path;
  for (int k = 0; k < path.NumShapes(); ++k) {
    const double t = 2 + 4 * path.parameters[k];
    EXPECT_LT((path.Placed(k) - pose_at(t)).norm(), 1e-3 * centred.norm()) << k;
  }
}

// Where it moves at constant speed between poses, jumps are differences of speeds.
TEST(SplineExactTest, JumpsAreThoseOfTheSpeedAsAShareOfTheMean) {
  const Tetrahedron body;
  const auto jump = [&](const std::vector<double>& ways, SplineEnds ends,
                        const std::vector<double>& times) {
    SplineOptions options = Ends(ends);
    options.times = times;
    const SplineSummary summary = Spline(body.connectivity, body.MovedBy(ways), options).summary;
    EXPECT_LT(summary.jump_after, 0.2 * summary.jump_before + 1e-9);
    return summary.jump_before;
  };
  // Of speeds 1 and 2; 2, 3 and -1; 1, 4 and 5 for half the time, whose mean is 5/2.
  EXPECT_NEAR(jump({0, 1, 3}, SplineEnds::kNatural, {}), 2. / 3, 1e-9);
  EXPECT_NEAR(jump({0, 2, 5, 4}, SplineEnds::kNatural, {}), 4. / 2, 1e-9);
  EXPECT_NEAR(jump({0, 1, 5}, SplineEnds::kNatural, {3, 4, 5}), 3. / 2.5, 1e-9);
  EXPECT_NEAR(jump({0, 1, 5}, SplineEnds::kNatural, {3, 4, 8}), 0, 1e-9);
  // Speeds 1, 3, and -4 on the way back; and 4, -1 and -3, whose greatest jump is at the first
  // pose.
  EXPECT_NEAR(jump({0, 1, 4}, SplineEnds::kPeriodic, {}), 7 / (8. / 3), 1e-9);
  EXPECT_NEAR(jump({0, 4, 3}, SplineEnds::kPeriodic, {}), 7 / (8. / 3), 1e-9);
  EXPECT_NEAR(jump({4, 3, 0}, SplineEnds::kPeriodic, {}), 7 / (8. / 3), 1e-9);
}

TEST(SplineExactTest, OfOnePoseThatReturnsIsTheGeodesic) {
  const Tetrahedron body;
  const auto [path, summary] =
      Spline(body.connectivity, body.MovedBy({2}), Ends(SplineEnds::kPeriodic));
  EXPECT_EQ(path.poses, (std::vector<int>{0, 8}));
  EXPECT_FALSE(summary.smooth);
  ASSERT_EQ(summary.warnings.size(), summary.geodesic.warnings.size() + 1);
  EXPECT_TRUE(Names(summary.warnings.back(), {"two poses"}));
}

TEST(SplineExactTest, TellsWhichShapeItSmooths) {
  struct Recorder : Progress {
    bool Report(const std::string& stage, int done, int total) override {
      if (stage == "smoothing") shapes.emplace_back(done, total);
      return true;
    }
    std::vector<std::pair<int, int>> shapes;
  } recorder;
  const Tetrahedron body;
  Spline(body.connectivity, body.MovedBy({0, 1, 3}), Ends(SplineEnds::kNatural, 2), &recorder);
  EXPECT_EQ(recorder.shapes, (std::vector<std::pair<int, int>>{{1, 7}, {2, 7}, {4, 7}, {5, 7}}));
}

TEST(SplineExactTest, AssessesThePathThatItReturns) {
  const Tetrahedron body;
  std::vector<Shape> poses = {body.shape, 1.5 * body.shape, 1.2 * body.shape};
  poses[1].row(1) *= 1.3;
  SplineOptions options = Ends(SplineEnds::kNatural);
  const auto [path, summary] = Spline(body.connectivity, poses, options);
  const PathQuality quality = MeasureQuality(path);
  EXPECT_EQ(summary.quality.edge_rms, quality.edge_rms);
  EXPECT_EQ(summary.quality.first_max, quality.first_max);
  EXPECT_NE(summary.quality.edge_rms, summary.geodesic.quality.edge_rms);
  EXPECT_GT(summary.energy, summary.geodesic.energy);
  EXPECT_GT(summary.spline_seconds, 0);
  EXPECT_GE(summary.total_seconds, summary.spline_seconds + summary.geodesic.total_seconds);
  options.geodesic.assess = false;
  EXPECT_NE(Spline(body.connectivity, poses, options).summary.quality.edge_rms, quality.edge_rms);
}

TEST(SplineExactTest, KeepsTheAppearanceOfItsPoses) {
  const Tetrahedron body;
  Poses poses;
  poses.connectivity = body.connectivity;
  poses.shapes = body.MovedBy({0, 1, 3});
  poses.soup.appearance.folder = "of the poses";
  EXPECT_EQ(Spline(poses, Ends(SplineEnds::kNatural, 2)).path.appearance.folder, "of the poses");
}

TEST(SplineExactTest, RefusalsNameWhatIsWrong) {
  const Tetrahedron body;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto refusal = [&](const SplineOptions& options) {
    return MessageOf<InvalidOptions>([&] {
      Spline(body.connectivity, body.MovedBy({0, 1, 3}), options);
    });
  };
  const SplineOptions natural = Ends(SplineEnds::kNatural, 2);
  SplineOptions options = natural;
  for (const std::vector<double>& times :
       {std::vector<double>{0, 0, 1}, {1, 2, 2}, {0, 1, kInfinity}, {kNaN, 1, 2}, {2, 1, 3}}) {
    options.times = times;
    EXPECT_TRUE(Names(refusal(options), {"times:"}));
  }
  options.times = {0, 1, 2, 3};
  EXPECT_TRUE(Names(refusal(options), {"times:", "3", "4"}));
  options.ends = SplineEnds::kPeriodic;  // the first pose again
  EXPECT_EQ(refusal(options), "nothing was thrown");
  options = natural;
  options.by_length = true;
  EXPECT_TRUE(Names(refusal(options), {"by_length:", "poses 1", "2"}));
  for (const int same : {0, 1}) {
    const Shape moved = body.MovedBy({3})[0], larger = 1.5 * body.shape;
    const std::vector<Shape> poses = {same == 0 ? body.shape : larger, moved,
                                      same == 0 ? larger : body.shape};
    EXPECT_TRUE(Refuses<InvalidOptions>(
        [&] { Spline(body.connectivity, poses, options); },
        {"by_length:", std::to_string(same + 1), std::to_string(same + 2)}));
  }
  options.times = {0, 1, 2};
  EXPECT_TRUE(Names(refusal(options), {"by_length:"}));
  options = natural;
  for (double limit : {-1., kNaN, kInfinity}) {
    options.hold_limit = limit;
    EXPECT_TRUE(Names(refusal(options), {"hold_limit:"}));
  }
  const Tangent velocity = Tangent::Ones(3, 4);
  for (const bool first : {true, false}) {
    options = natural;
    (first ? options.first_velocity : options.last_velocity) = velocity;
    EXPECT_TRUE(Names(refusal(options), {"first_velocity, last_velocity:"}));
    options.ends = SplineEnds::kClamped;
    EXPECT_TRUE(Names(refusal(options), {"first_velocity, last_velocity:"}));
    for (const Tangent& wrong :
         {Tangent(Tangent::Ones(3, 5)), Tangent(Tangent::Constant(3, 4, kNaN))}) {
      options.first_velocity = first ? wrong : velocity;
      options.last_velocity = first ? velocity : wrong;
      EXPECT_TRUE(Names(refusal(options), {"first_velocity, last_velocity:"}));
    }
  }
  options = natural;
  options.geodesic.shapes = -1;
  EXPECT_EQ(refusal(options).rfind("shapes:", 0), 0u);
  options = Ends(SplineEnds::kPeriodic, 2);
  EXPECT_TRUE(Refuses<MeshError>(
      [&] {
        Spline(body.connectivity, body.MovedBy({0, 1, 0}), options);
      },
      {"last pose"}));
}

// That the spline needs much more than its chain where there are many poses.
TEST(SplineExactTest, KeepsTheLimitOfMemoryOfItsOwn) {
  const Tetrahedron body;
  SplineOptions options = Ends(SplineEnds::kNatural, 1);
  options.geodesic.memory_limit = 1;
  EXPECT_TRUE(Refuses<SolverError>(
      [&] {
        Spline(body.connectivity, body.MovedBy({0, 1, 3}), options);
      },
      {"memory_limit"}));
}

}  // namespace
}  // namespace shapespace
