// Deformations in which the body does not pass through itself.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/analysis/intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/contact/internal/contact_model.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/mesh/connectivity.h>

#include "support/cut_ring.h"
#include "support/listener.h"
#include "support/message_of.h"
#include "support/threads.h"

namespace shapespace {
namespace {

using testing::MostIntersections;

// A round rod bent to nine tenths of a circle about the z axis. Its middle is held; one of its ends
// is moved past the other.
struct OpenRing {
  explicit OpenRing(double of_unit = 1) : unit(of_unit) {
    TubeForm form;
    form.length = 6.9;
    form.base_radius = form.tip_radius = 0.15;
    form.knuckle = 0;
    const ShapeFamily tube = MakeTube(1000, form);
    connectivity = tube.connectivity;
    rest = tube.pose(0);
    const double curvature = 0.9 * 2 * M_PI / 6.9;
    for (int v = 0; v < rest.cols(); ++v) {
      const double along = rest(0, v), aside = rest(1, v), radius = 1 / curvature - rest(2, v);
      const double angle = curvature * (along - 3.45);
      rest.col(v) << radius * std::sin(angle), -radius * std::cos(angle), aside;
      if (along > 6.7) last.push_back(v);
      if (along < 0.2) first.push_back(v);
      if (std::abs(along - 3.45) < 0.3) middle.push_back(v);
    }
    rest *= unit;
  }
  DeformationHandle Held(const std::vector<int>& vertices) const {
    DeformationHandle handle;
    handle.vertices = vertices;
    return handle;
  }
  // The last end moves along the ring and a little to a side, through the first end.
  DeformationHandle Moved(double by) const {
    DeformationHandle handle = Held(last);
    handle.motion.translation = unit * Eigen::Vector3d(-by, 0, 0.05);
    return handle;
  }
  DeformationResult Solve(const std::vector<DeformationHandle>& handles, bool avoid_contact,
                          double balance = 0.01) const {
    DeformationOptions options;
    options.balance = balance;
    options.avoid_contact = avoid_contact;
    return Deform(connectivity, rest, handles, options);
  }
  double unit;
  std::shared_ptr<const Connectivity> connectivity;
  Shape rest;
  std::vector<int> first, middle, last;
};

TEST(DeformationContactTest, AnEndPushesTheOtherAside) {
  const OpenRing ring;
  const std::vector<DeformationHandle> handles = {ring.Held(ring.middle), ring.Moved(1)};
  const DeformationResult through = ring.Solve(handles, false);
  EXPECT_GT(MostIntersections(through.path), 0);
  EXPECT_EQ(through.summary.uncertified_segments, -1);
  const DeformationResult past = ring.Solve(handles, true);
  EXPECT_TRUE(past.summary.Converged()) << past.summary.FullReport();
  EXPECT_EQ(past.summary.uncertified_segments, 0) << past.summary.FullReport();
  EXPECT_EQ(MostIntersections(past.path), 0);
  // That of the path, not of the one that it started from.
  const internal::ContactModel model(past.path.metric, {past.path.shapes[0]},
                                     internal::ContactModel::Intersections::kExempt);
  const double distance = internal::LeastDistance(model, past.path.shapes);
  EXPECT_GT(distance, 2 * internal::LeastDistance(model, through.path.shapes));
  EXPECT_NEAR(past.summary.contact_distance, distance, 0.05 * distance);  // turned differently
  EXPECT_GT(past.summary.energy, through.summary.energy);
  EXPECT_EQ(past.summary.levels.back().start, "contact");
  EXPECT_EQ(past.summary.levels.back().vertices, past.summary.vertices);
  EXPECT_EQ(past.summary.levels.back().shapes, 5);
  EXPECT_LE(past.summary.levels.back().value, past.summary.levels.back().initial_value);
  EXPECT_GT(past.summary.contact_seconds, 0);
  EXPECT_EQ(through.summary.contact_seconds, 0);
  for (const auto& handle : past.summary.handles) EXPECT_LT(handle.residual_max, 1e-12);
  for (int i = 0; i < past.path.NumShapes(); ++i) {
    const Shape places = past.path.Placed(i)(Eigen::all, ring.last);
    const Eigen::Vector3d way = handles[1].motion.translation * i / 5.;
    EXPECT_LT((places.colwise() - way - ring.rest(Eigen::all, ring.last)).norm(), 1e-12) << i;
  }
}

TEST(DeformationContactTest, ASoftHandleDrawsAsFarAsNothingTouches) {
  const OpenRing ring;
  DeformationHandle soft = ring.Moved(0.8);
  soft.hard = false;
  const std::vector<DeformationHandle> handles = {ring.Held(ring.middle), ring.Held(ring.first),
                                                  soft};
  const DeformationResult through = ring.Solve(handles, false, 0.3);
  EXPECT_GT(MostIntersections(through.path), 0);
  const DeformationResult past = ring.Solve(handles, true, 0.3);
  EXPECT_EQ(past.summary.uncertified_segments, 0) << past.summary.FullReport();
  EXPECT_EQ(MostIntersections(past.path), 0);
  EXPECT_GT(past.summary.handles[2].residual_rms, 2 * through.summary.handles[2].residual_rms);
}

// Few shapes, between which the straight motion of the shapes on the way passes through the body.
TEST(DeformationContactTest, WhereOnlySoftHandlesMoveAllSegmentsAreFree) {
  const OpenRing ring;
  DeformationHandle soft = ring.Moved(0.9);
  soft.hard = false;
  DeformationOptions options;
  options.avoid_contact = true;
  options.balance = 0.1;
  options.shapes = 2;
  const DeformationResult result = Deform(
      ring.connectivity, ring.rest, {ring.Held(ring.middle), ring.Held(ring.first), soft}, options);
  EXPECT_EQ(result.summary.uncertified_segments, 0) << result.summary.FullReport();
  EXPECT_TRUE(result.summary.warnings.empty()) << result.summary.warnings.front();
  EXPECT_TRUE(result.summary.Converged());
}

// A hard handle is where it is to be at each time, even if few shapes do not suffice then.
TEST(DeformationContactTest, WhereAHardHandleMovesItKeepsItsTimes) {
  const OpenRing ring;
  const std::vector<DeformationHandle> handles = {ring.Held(ring.middle), ring.Moved(1.4)};
  DeformationOptions options;
  options.avoid_contact = true;
  options.balance = 0.1;
  options.shapes = 2;
  const auto [path, summary] = Deform(ring.connectivity, ring.rest, handles, options);
  EXPECT_EQ(summary.warnings.size(), static_cast<size_t>(summary.uncertified_segments > 0));
  for (int i = 0; i <= 2; ++i) {
    const Shape places = path.Placed(i)(Eigen::all, ring.last);
    const Eigen::Vector3d way = handles[1].motion.translation * i / 2.;
    EXPECT_LT((places.colwise() - way - ring.rest(Eigen::all, ring.last)).norm(), 1e-12) << i;
  }
}

// The last shape of a path moves as the others do, and keeps off what it touches as they do, by a
// share of an edge: a plate that is held at one end, while the other is drawn through a table.
TEST(DeformationContactTest, TheLastShapeKeepsItsDistance) {
  constexpr double kEdge = 0.5;
  const ShapeFamily plate = MakeSheet(6 * kEdge, 2 * kEdge, 6, 2);
  const Shape rest = plate.pose(0).colwise() + Eigen::Vector3d(0, 0, 0.5);
  DeformationHandle held, drawn;
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(0, v) < -0.9) held.vertices.push_back(v);
    if (rest(0, v) > 1.4) drawn.vertices.push_back(v);
  }
  drawn.hard = false;
  drawn.motion.translation = {0, 0, -0.7};
  DeformationOptions options;
  options.avoid_contact = true;
  options.balance = 0.05;
  options.obstacle = testing::Rectangle({-3, -3.1}, {3.2, 3.3}, 0);
  for (const int shapes : {1, 3}) {
    options.shapes = shapes;
    const auto [path, summary] = Deform(plate.connectivity, rest, {held, drawn}, options);
    EXPECT_EQ(summary.uncertified_segments, 0) << shapes;
    EXPECT_GT(summary.contact_distance, 0.01 * kEdge) << shapes;
    EXPECT_NEAR(path.Placed(shapes).row(2).minCoeff(), summary.contact_distance, 1e-9) << shapes;
  }
}

TEST(DeformationContactTest, WithoutContactItIsTheSame) {
  const OpenRing ring;
  const std::vector<DeformationHandle> handles = {ring.Held(ring.middle), ring.Moved(-0.3)};
  const DeformationResult free = ring.Solve(handles, false), past = ring.Solve(handles, true);
  EXPECT_EQ(past.path.shapes, free.path.shapes);
  EXPECT_EQ(past.summary.uncertified_segments, 0);
}

TEST(DeformationContactTest, EndsWhenItIsStopped) {
  const OpenRing ring;
  const std::vector<DeformationHandle> handles = {ring.Held(ring.middle), ring.Moved(1)};
  DeformationOptions options;
  options.avoid_contact = true;
  for (const int last : testing::StopsSince("round contacts", [&](Progress* all) {
         Deform(ring.connectivity, ring.rest, handles, options, all);
       })) {
    testing::Listener listener(last);  // counts it as a failure if there are further reports
    const DeformationResult result =
        Deform(ring.connectivity, ring.rest, handles, options, &listener);
    EXPECT_EQ(result.summary.termination, Termination::kCancelled) << last;
    EXPECT_EQ(result.path.NumShapes(), 6);
    for (const std::string& warning : result.summary.warnings) {
      EXPECT_EQ(warning.find("no deformation"), std::string::npos) << warning;
    }
  }
}

TEST(DeformationContactTest, SaysThatHandlesMeet) {
  const OpenRing ring;
  // Both ends are held, the one in the way of the other.
  const std::vector<DeformationHandle> handles = {ring.Held(ring.first), ring.Held(ring.middle),
                                                  ring.Moved(0.8)};
  const DeformationResult result = ring.Solve(handles, true);
  EXPECT_GT(result.summary.uncertified_segments, 0);
  ASSERT_FALSE(result.summary.warnings.empty());
  EXPECT_TRUE(testing::Names(result.summary.warnings.front(), {"of their way"}))
      << result.summary.warnings.front();
  EXPECT_EQ(result.path.shapes, ring.Solve(handles, false).path.shapes);
}

TEST(DeformationContactTest, ScalesWithTheBodyOnAnyThreads) {
  const OpenRing ring, large(1024);
  const auto solve = [](const OpenRing& of) {
    return of.Solve({of.Held(of.middle), of.Moved(0.8)}, true);
  };
  const std::vector<Shape> placed = solve(ring).path.Placed();
  const std::vector<Shape> scaled = solve(large).path.Placed();
  for (size_t i = 0; i < placed.size(); ++i) {
    EXPECT_LT((scaled[i] / 1024 - placed[i]).norm(), 1e-9) << i;
  }
  for (const auto& shapes : testing::OnThreads([&] { return solve(ring).path.Placed(); })) {
    EXPECT_EQ(shapes, placed);
  }
}

// A rod that is held at one end, and a shelf below its middle.
struct RodOverShelf {
  explicit RodOverShelf(double of_unit = 1) : unit(of_unit) {
    TubeForm form;
    form.length = 6.9;
    form.base_radius = form.tip_radius = 0.15;
    form.knuckle = 0;
    const ShapeFamily tube = MakeTube(1000, form);
    connectivity = tube.connectivity;
    rest = tube.pose(0);
    DeformationHandle held, end;
    for (int v = 0; v < rest.cols(); ++v) {
      if (rest(0, v) < 0.2) held.vertices.push_back(v);
      if (rest(0, v) > 6.7) end.vertices.push_back(v);
    }
    rest *= unit;
    end.motion.translation = unit * Eigen::Vector3d(-0.5, 0, -2);
    handles = {held, end};
    shelf = testing::Rectangle({2.5, -1}, {3.5, 1}, -0.3);
    shelf.shape *= unit;
  }
  DeformationResult Solve(bool past_shelf) const {
    DeformationOptions options;
    options.avoid_contact = true;
    if (past_shelf) options.obstacle = shelf;
    return Deform(connectivity, rest, handles, options);
  }
  double unit;
  std::shared_ptr<const Connectivity> connectivity;
  Shape rest;
  std::vector<DeformationHandle> handles;
  Obstacle shelf;
};

TEST(DeformationContactTest, ARodIsBentOverAShelf) {
  const RodOverShelf rod;
  const DeformationResult through = rod.Solve(false);
  EXPECT_GT(MostIntersections(through.path, rod.shelf), 0);
  const DeformationResult over = rod.Solve(true);
  EXPECT_EQ(MostIntersections(over.path, rod.shelf), 0) << over.summary.FullReport();
  EXPECT_EQ(over.summary.uncertified_segments, 0);
  EXPECT_GT(over.summary.contact_distance, 0);
  EXPECT_GT(over.summary.energy, 1.01 * through.summary.energy);
  EXPECT_LT(over.summary.handles[1].residual_max, 1e-12);
  // In another unit too.
  const RodOverShelf large(1024);
  const std::vector<Shape> placed = over.path.Placed(), scaled = large.Solve(true).path.Placed();
  for (size_t i = 0; i < placed.size(); ++i) {
    EXPECT_LT((scaled[i] / 1024 - placed[i]).norm(), 1e-9) << i;
  }
}

// A plate that is pressed through a table, in 25 steps.
TEST(DeformationContactTest, SaysHowFarTheHandlesGot) {
  const ShapeFamily plate = MakeSheet(2, 3, 2, 3);
  const Shape rest = plate.pose(0).colwise() + Eigen::Vector3d(0, 0, 1);
  DeformationHandle all;
  for (int v = 0; v < rest.cols(); ++v) all.vertices.push_back(v);
  all.motion.translation = {0, 0, -2};
  DeformationOptions options;
  options.avoid_contact = true;
  options.obstacle = testing::Rectangle({-3, -3.1}, {3.2, 3.3}, 0);
  const DeformationSummary summary = Deform(plate.connectivity, rest, {all}, options).summary;
  EXPECT_TRUE(testing::EachNames(summary.warnings, {{"obstacle", "48%"}}));
  EXPECT_EQ(summary.uncertified_segments, 1);
  EXPECT_NEAR(summary.contact_distance, 0, 1e-9);
  EXPECT_TRUE(summary.Converged());
  EXPECT_LT(summary.handles[0].residual_max, 1e-12);
}

// Two plates that cross each other and move as one.
TEST(DeformationContactTest, SaysThatTheMeshIntersectsItself) {
  const ShapeFamily plate = MakeSheet(2, 3, 2, 3);
  Shape other = plate.pose(0);
  other.row(2) = other.row(0).array() + 0.137;
  const Obstacle second = {plate.connectivity, other};
  const Shape rest = second.Joined(plate.pose(0));
  const auto connectivity = second.Joined(plate.connectivity);
  DeformationHandle all;
  for (int v = 0; v < rest.cols(); ++v) all.vertices.push_back(v);
  all.motion.translation = {0, 0, 0.5};
  DeformationOptions options;
  options.avoid_contact = true;
  const std::string count = std::to_string(CountIntersections(*connectivity, rest));
  ASSERT_NE(count, "0");
  const std::string there = count + " pairs of triangles";
  DeformationSummary summary = Deform(connectivity, rest, {all}, options).summary;
  EXPECT_TRUE(testing::EachNames(summary.warnings, {{"intersects itself", there}}));
  EXPECT_EQ(summary.uncertified_segments, 0);
  options.obstacle = testing::Rectangle({-3, -3.1}, {3.2, 3.3}, -9);
  summary = Deform(connectivity, rest, {all}, options).summary;
  EXPECT_TRUE(testing::EachNames(summary.warnings, {{"intersects itself or the obstacle", there}}));
}

TEST(DeformationContactTest, ObstaclesAreForDeformationsThatAvoidContact) {
  const RodOverShelf rod;
  DeformationOptions options;
  options.obstacle = rod.shelf;
  EXPECT_THROW(options.Validate(), InvalidOptions);
  options.avoid_contact = true;
  options.Validate();
  options.obstacle->shape(0, 0) = NAN;
  EXPECT_THROW(options.Validate(), MeshError);
}

TEST(DeformationContactTest, NeedsTriangles) {
  const auto chain = Connectivity::Make(3, {0}, {}, {{0, 1}, {1, 2}});
  Shape rest(3, 3);
  rest << 0, 1, 2, 0, 0, 0, 0, 0, 0;
  DeformationHandle held, moved;
  held.vertices = {0};
  moved.vertices = {2};
  moved.motion.translation.x() = 0.5;
  DeformationOptions options;
  options.avoid_contact = true;
  EXPECT_NE(testing::MessageOf<MeshError>([&] {
              Deform(chain, rest, {held, moved}, options);
            }).find("no triangles"),
            std::string::npos);
}

}  // namespace
}  // namespace shapespace
