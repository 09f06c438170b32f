// What paths are made of, and what is said of those that are wrong.

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/path/align.h>
#include <shapespace/path/anchor.h>
#include <shapespace/path/path.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::Distance;
using testing::Rotation;

std::string Problem(const std::function<void()>& call) {
  return testing::MessageOf<InvalidOptions>(call);
}

// A chain of four vertices, far from the origin, that turns, moves and lengthens.
std::vector<Shape> Chains(int count) {
  Shape rest = Shape::Zero(3, 4);
  rest << 0, 2, 2, 3, 0, 0, 1, 1, 0, 0, 0, 4;
  std::vector<Shape> shapes;
  for (int i = 0; i < count; ++i) {
    shapes.push_back((Rotation(25. * i, {1, 2, 3}) * (1 + 0.1 * i) * rest).colwise() +
                     Eigen::Vector3d(50 + i, -70, 90 - 2 * i));
  }
  return shapes;
}

std::shared_ptr<const Metric> ChainMetric() {
  const auto chain = Connectivity::Make(4, {0}, {}, {{0, 1}, {1, 2}, {2, 3}});
  return FreezeMetric({}, chain, {Chains(1)[0]});
}

TEST(AlignPoses, ShapesAreCentredTurnedOntoThoseBeforeAndPlacedWhereTheyWere) {
  const auto metric = ChainMetric();
  const std::vector<Shape> poses = Chains(3);
  const AlignedPoses aligned = AlignPoses(*metric, poses);
  for (int i = 0; i < 3; ++i) {
    const Shape& shape = aligned.shapes[i];
    EXPECT_LT((shape * metric->vertex_area).norm(), 1e-9);
    EXPECT_LT(Distance(aligned.motions[i](metric->unit * shape), poses[i]), 1e-10);
    // They differ by their sizes alone.
    EXPECT_LT(Distance(shape, (1 + 0.1 * i) * aligned.shapes[0]), 1e-9);
  }
  EXPECT_EQ(aligned.motions[0].rotation, Eigen::Matrix3d::Identity());
}

TEST(MakePath, TakesTimesAndPosesFromTheShapes) {
  const auto metric = ChainMetric();
  const std::vector<Shape> shapes = Chains(5);
  const Path even = MakePath(metric, shapes);
  EXPECT_EQ(even.parameters, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(even.poses, (std::vector<int>{0, 4}));
  EXPECT_EQ(even.extrapolated, 0);
  EXPECT_EQ(even.metric, metric);
  ASSERT_EQ(even.Placed().size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_LT(Distance(even.Placed()[i], shapes[i]), 1e-10);
  EXPECT_EQ(MakePath(metric, shapes, {0, 1, 2, 4, 9}).parameters,
            (std::vector<double>{0, 1, 2, 4, 9}));
  const Path one = MakePath(metric, Chains(1));
  EXPECT_EQ(one.parameters, std::vector<double>{0});
  EXPECT_EQ(one.poses, std::vector<int>{0});
  const auto message = [&](const std::vector<Shape>& of, const std::vector<double>& times) {
    return testing::MessageOf<MeshError>([&] { MakePath(metric, of, times); });
  };
  EXPECT_TRUE(testing::Names(message({}, {}), {"shape"}));
  EXPECT_TRUE(testing::Names(message({shapes[0], Shape::Zero(3, 3)}, {}), {"vertices"}));
  EXPECT_TRUE(testing::Names(message(shapes, {0, 1}), {"5"}));
  EXPECT_TRUE(testing::Names(message(shapes, {0, 1, 2, 2, 3}), {"parameters"}));
}

Path Marked() {
  Path path = MakePath(ChainMetric(), Chains(6), {0, 1, 2, 4, 7, 9});
  path.poses = {0, 2, 4};
  path.pose_names = {"stand", "sit", "lie"};
  path.extrapolated = 1;
  path.converged = false;
  path.smooth = true;
  path.provenance = "by hand";
  return path;
}

TEST(SelectShapes, KeepsWhatIsSaidOfThePath) {
  const Path path = Marked(), some = SelectShapes(path, {1, 2, 4, 5});
  EXPECT_EQ(some.metric, path.metric);
  EXPECT_EQ(some.parameters, (std::vector<double>{0, 1, 6, 8}));
  EXPECT_EQ(some.poses, (std::vector<int>{1, 2}));
  EXPECT_EQ(some.pose_names, (std::vector<std::string>{"sit", "lie"}));
  EXPECT_EQ(some.extrapolated, 1);
  EXPECT_FALSE(some.converged);
  EXPECT_TRUE(some.smooth);
  EXPECT_EQ(some.provenance, "by hand");
  const std::vector<int> indices = {1, 2, 4, 5};
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT(Distance(some.Placed(k), path.Placed(indices[k])), 1e-12);
  }
  const Path back = SelectShapes(path, {5, 4, 1});
  EXPECT_EQ(back.parameters, (std::vector<double>{0, 2, 8}));
  EXPECT_EQ(back.poses, std::vector<int>{1});
  EXPECT_EQ(back.pose_names, std::vector<std::string>{"lie"});
  EXPECT_EQ(back.extrapolated, 0);
}

TEST(ResamplePath, KeepsWhatIsSaidOfThePath) {
  const Path path = Marked(), other = Resample(path, {1, 2, 5, 7, 7.5, 8});
  EXPECT_EQ(other.metric, path.metric);
  EXPECT_EQ(other.parameters, (std::vector<double>{1, 2, 5, 7, 7.5, 8}));
  EXPECT_EQ(other.poses, (std::vector<int>{1, 3}));
  EXPECT_EQ(other.pose_names, (std::vector<std::string>{"sit", "lie"}));
  EXPECT_EQ(other.extrapolated, 2);
  EXPECT_FALSE(other.converged);
  EXPECT_TRUE(other.smooth);
  EXPECT_EQ(other.provenance, "by hand; resampled");
  EXPECT_LT(Distance(other.Placed(1), path.Placed(2)), 1e-12);
  EXPECT_LT(Distance(other.Placed(3), path.Placed(4)), 1e-12);
}

TEST(Path, SaysWhichArgumentIsWrongAndHow) {
  const Path path = Marked();
  EXPECT_TRUE(testing::Names(Problem([&] { SelectShapes(path, {}); }), {"indices:"}));
  EXPECT_TRUE(testing::Names(Problem([&] { SelectShapes(path, {2, 6}); }), {"indices:", "6"}));
  EXPECT_TRUE(testing::Names(Problem([&] {
                               SelectShapes(path, {4, 2, -1});
                             }),
                             {"indices:", "-1", "6"}));
  EXPECT_TRUE(testing::Names(Problem([&] { SelectShapes(path, {4, 1, 2}); }), {"indices:"}));
  for (const int count : {0, 7}) {
    EXPECT_TRUE(testing::Names(Problem([&] { FirstShapes(path, count); }), {"count:", "1", "6"}));
  }
  EXPECT_EQ(FirstShapes(path, 6).NumShapes(), 6);
  EXPECT_TRUE(testing::Names(Problem([&] { Resample(path, {}); }), {"times:"}));
  EXPECT_TRUE(testing::Names(Problem([&] {
                               Resample(path, {1, 2, 9.5});
                             }),
                             {"times:", "9.5", "0", "9"}));
  EXPECT_TRUE(testing::Names(Problem([&] {
                               Resample(path, {-0.5, 2});
                             }),
                             {"times:", "-0.5", "0", "9"}));
  EXPECT_TRUE(testing::Names(Problem([&] { Resample(path, {1, 3, 2.5}); }), {"times:", "2.5"}));
  EXPECT_TRUE(testing::Names(Problem([&] {
                               Resample(path.shapes, {0, 1}, {0.5});
                             }),
                             {"parameters:"}));
  Path moved = path;
  EXPECT_TRUE(testing::Names(Problem([&] { Anchor(&moved, {}); }), {"vertices:"}));
  EXPECT_TRUE(testing::Names(Problem([&] {
                               Anchor(&moved, {0, 4});
                             }),
                             {"vertices:", "4", "0", "3"}));
  EXPECT_TRUE(testing::Names(Problem([&] {
                               Anchor(&moved, {3, -1, 9});
                             }),
                             {"vertices:", "-1", "0", "3"}));
  EXPECT_TRUE(testing::Names(Problem([&] { Ground(&moved, 3, 0); }), {"axis:", "0", "1", "2"}));
  EXPECT_TRUE(testing::Names(Problem([&] { Ground(&moved, 0, -1e61); }), {"height:", "1e60"}));
}

// Any four shapes give a cubic in time exactly, but a polynomial of degree four tells which of them
// were taken.
TEST(Resample, TakesTheFourNearestShapes) {
  const auto power = [](double t) { return t * t * t * t; };
  const std::vector<double> times = {0, 1, 3, 4, 6, 7};
  std::vector<Shape> shapes;
  for (const double t : times) shapes.push_back(Shape::Constant(3, 1, power(t)));
  const auto expected = [&](double t, int begin) {  // t^4 less the polynomial with these zeros
    double rest = 1;
    for (int i = begin; i < begin + 4; ++i) rest *= t - times[i];
    return power(t) - rest;
  };
  const std::vector<double> wanted = {0.5, 2, 3.5, 5, 6.5};
  const std::vector<int> begins = {0, 0, 1, 2, 2};
  const std::vector<Shape> result = Resample(shapes, times, wanted);
  for (size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_NEAR(result[k](0, 0), expected(wanted[k], begins[k]), 1e-9) << wanted[k];
  }
  // Of three shapes all are taken.
  shapes.resize(3);
  const Shape three = Resample(shapes, {0, 1, 3}, {2})[0];
  EXPECT_NEAR(three(1, 0), 0 * -1. / 3 + 1 * 1. + 81. / 3, 1e-12);
}

}  // namespace
}  // namespace shapespace
