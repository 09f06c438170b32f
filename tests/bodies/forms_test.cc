#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/body.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/catenoid.h>
#include <shapespace/bodies/miura.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/steffen.h>
#include <shapespace/bodies/tube.h>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

Eigen::Vector3d SizeOf(const Shape& shape) {
  return shape.rowwise().maxCoeff() - shape.rowwise().minCoeff();
}

TEST(BodyTest, BodiesHaveTheirSizesRangesAndParameters) {
  struct Case {
    Eigen::Vector3d size;
    double begin, end;
    std::string parameter;
  };
  const double zigzag = std::cos(60 / kDegrees);
  const std::map<std::string, Case> cases = {
      {"tube", {{6 + 0.6 + 0.5, 0, 0}, 0, 150, "bend angle, degrees"}},
      {"bar", {{5, 1, 1}, 0, 360, "bend angle, degrees"}},
      {"sheet", {{3, 2, 0}, 0, 360, "roll angle, degrees"}},
      {"strip", {{12.5, 1.5, 0}, 0, 0, "hinge angle, degrees"}},
      {"catenoid",
       {{2 * std::cosh(1.0), 2 * std::cosh(1.0), 2}, 0, 90, "angle of association, degrees"}},
      {"bricard", {{0, 0, 0}, -35, 50, "angle of edge 0-2 to the plane of symmetry, degrees"}},
      {"steffen",
       {{17, 0, 0}, -12.5, 12.5, "angle of vertex 8 about the line from 2 to 3, degrees"}},
      {"miura", {{16 * std::sin(60 / kDegrees), 16 + zigzag, 0}, 0, 85, "fold angle, degrees"}},
      {"quadruped", {{0, 0, 0}, 0, 1, "part of the way from standing to stretching"}}};
  for (const auto& [name, expected] : cases) {
    SCOPED_TRACE(name);
    const ShapeFamily body = MakeBody(name);
    EXPECT_EQ(body.begin, expected.begin);
    if (expected.end != 0) {
      EXPECT_EQ(body.end, expected.end);
    }
    EXPECT_EQ(body.parameter, expected.parameter);
    const Eigen::Vector3d size = SizeOf(body.pose(0));
    for (int k = 0; k < 3; ++k) {
      if (expected.size(k) == 0) continue;
      EXPECT_NEAR(size(k), expected.size(k), 1e-2) << k;
    }
  }
}

TEST(BodyTest, ValuesOutsideByRoundingAreTheEnds) {
  const ShapeFamily body = MakeBody("bricard");
  EXPECT_EQ(body.pose(body.begin - 5e-11), body.pose(body.begin));
  EXPECT_EQ(body.pose(body.end + 5e-11), body.pose(body.end));
  EXPECT_NE(body.pose(body.end), body.pose(body.begin));
  EXPECT_TRUE(
      testing::Names(Refusal([&] { body.pose(body.end + 1e-9); }), {"parameter:", "50", "-35"}));
}

// What is divided is divided in two different ways, alternately.
TEST(GridTest, DiagonalsAlternate) {
  const ShapeFamily sheet = MakeSheet(3, 2, 2, 3);
  Eigen::Matrix3Xi expected(3, 12);
  // Vertices are numbered along y first.
  expected << 0, 0, 1, 2, 2, 2, 4, 5, 5, 5, 6, 7,  //
      4, 5, 5, 5, 6, 7, 8, 8, 9, 10, 10, 10,       //
      5, 1, 2, 6, 7, 3, 5, 9, 10, 6, 7, 11;
  EXPECT_EQ(sheet.connectivity->Triangles(), expected);
}

TEST(SheetTest, ItsPlacesAndItsRange) {
  const ShapeFamily sheet = MakeSheet(3, 2, 2, 4);
  EXPECT_EQ(sheet.end, 180);
  EXPECT_EQ(MakeSheet(3, 2, 8, 1).end, 360);
  const Shape rest = sheet.pose(0);
  EXPECT_EQ(rest.col(0), Eigen::Vector3d(-1.5, -1, 0));
  EXPECT_EQ(rest.col(5 + 1), Eigen::Vector3d(0, -0.5, 0));
  EXPECT_EQ(rest.col(10 + 4), Eigen::Vector3d(1.5, 1, 0));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeSheet(-2, 1, 2, 2); }), {"length:", "-2"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeSheet(1, 1, 2, 0); }), {"ny:", "0", "1"}));
}

TEST(BarTest, EndsOfItsRange) {
  EXPECT_EQ(MakeBar(4, 1, 1, 2, 1, 3).end, 180);
  // Bent to 1.8 lengths over heights, the inner face keeps a tenth of its length.
  const ShapeFamily bar = MakeBar(2, 5, 3, 30, 1, 1);
  EXPECT_NEAR(bar.end, 0.9 * 2 * 2 / 3 * kDegrees, 1e-12);
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBar(1, 1, -3, 1, 1, 1); }), {"height:", "-3"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBar(1, 1, 1, 0, 1, 1); }), {"nx:", "0", "1"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBar(1, 1, 1, 1, 1, -7); }), {"nz:", "-7", "1"}));
}

TEST(StripTest, ShortOnesEndAsFourTriangles) {
  const double end = MakeStrip(1, 1.5, 4).end;
  EXPECT_EQ(MakeStrip(1, 1.5, 2).end, end);
  EXPECT_EQ(MakeStrip(1, 1.5, 3).end, end);
  EXPECT_LT(MakeStrip(1, 1.5, 5).end, end);
  EXPECT_TRUE(testing::Names(Refusal([] { MakeStrip(1, 0, 4); }), {"width:", "0"}));
}

TEST(CatenoidTest, AssociatedSurfacesAreMixtures) {
  const ShapeFamily body = MakeCatenoid(1.2, 7, 4);
  ASSERT_EQ(body.connectivity->NumVertices(), 8 * 5);
  EXPECT_EQ(body.connectivity->NumTriangles(), 2 * 7 * 4);
  const Shape catenoid = body.pose(0), helicoid = body.pose(90), third = body.pose(30);
  EXPECT_LT((third - (std::sqrt(0.75) * catenoid + 0.5 * helicoid)).cwiseAbs().maxCoeff(), 1e-14);
  for (int v = 0; v < catenoid.cols(); ++v) {
    // Where the catenoid has the height v, the helicoid is sinh v from its axis.
    EXPECT_NEAR(std::hypot(helicoid(0, v), helicoid(1, v)), std::abs(std::sinh(catenoid(2, v))),
                1e-14);
    // The catenoid's azimuth is the helicoid's depth.
    EXPECT_NEAR(
        std::remainder(std::atan2(catenoid(1, v), catenoid(0, v)) + helicoid(2, v), 2 * M_PI), 0,
        1e-14);
  }
  EXPECT_LT((catenoid.col(0) - Eigen::Vector3d(-std::cosh(1.2), 0, -1.2)).norm(), 1e-14);
  EXPECT_LT((helicoid.col(0) - Eigen::Vector3d(0, std::sinh(1.2), M_PI)).norm(), 1e-14);
  EXPECT_NO_THROW(MakeCatenoid(20, 3, 1));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeCatenoid(1, 3, 0); }), {"along:", "0", "1"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeCatenoid(1, 10000, 10000); }),
                             {"triangles:", "200000000", "0", "20000000"}));
}

TEST(MiuraTest, ParallelogramsHaveTheGivenSidesAndCorner) {
  const double a = 1.3, b = 0.7;
  const ShapeFamily body = MakeMiura(a, b, 50, 3, 4);
  for (const double angle : {0.0, 40.0}) {
    const Shape shape = body.pose(angle);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 4; ++j) {
        const Eigen::Vector3d corner = shape.col(5 * i + j);
        const Eigen::Vector3d u = shape.col(5 * (i + 1) + j) - corner;
        const Eigen::Vector3d v = shape.col(5 * i + j + 1) - corner;
        EXPECT_NEAR(u.norm(), b, 1e-14);
        EXPECT_NEAR(v.norm(), a, 1e-14);
        // The corners alternate along x.
        EXPECT_NEAR(std::acos(u.dot(v) / (a * b)) * kDegrees, i % 2 == 0 ? 50 : 130, 1e-12);
      }
    }
  }
  EXPECT_TRUE(testing::Names(Refusal([] { MakeMiura(1, -1, 60, 2, 2); }), {"b:", "-1"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeMiura(1, 1, 9.9, 2, 2); }), {"corner:", "10", "80"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeMiura(1, 1, 60, 0, 2); }), {"nx:", "0", "1"}));
}

TEST(BricardTest, OppositeEdgesAreEqualAndHaveTheirLengths) {
  const ShapeFamily body = MakeBricard();
  const Shape shape = body.pose(17);
  const auto length = [&](int i, int j) { return (shape.col(i) - shape.col(j)).norm(); };
  const std::pair<std::array<int, 4>, double> edges[] = {{{0, 2, 1, 3}, 2},   {{0, 3, 1, 2}, 3},
                                                         {{0, 4, 1, 4}, 2.5}, {{2, 4, 3, 4}, 2.2},
                                                         {{0, 5, 1, 5}, 3},   {{2, 5, 3, 5}, 2.6}};
  for (const auto& [e, expected] : edges) {
    EXPECT_NEAR(length(e[0], e[1]), expected, 1e-14);
    EXPECT_NEAR(length(e[2], e[3]), expected, 1e-14);
  }
}

TEST(SteffenTest, HasTheLengthsOfTheBooks) {
  const ShapeFamily body = MakeSteffen();
  std::map<int, int> lengths;
  for (const double length : EdgeLengths(*body.connectivity, body.pose(7))) {
    ++lengths[static_cast<int>(std::lround(length))];
  }
  EXPECT_EQ(lengths, (std::map<int, int>{{5, 4}, {10, 6}, {11, 2}, {12, 8}, {17, 1}}));
  const Shape shape = body.pose(7);
  const Eigen::Vector3d from_line = shape.col(8) - (shape.col(2) + shape.col(3)) / 2;
  EXPECT_NEAR(std::atan2(from_line.x(), from_line.z()) * kDegrees, 7, 1e-12);
}

// The vertex of a tube at rest that is nearest to `x` along its axis.
int NearestTo(const Shape& rest, double x) {
  int nearest;
  (rest.row(0).array() - x).abs().minCoeff(&nearest);
  return nearest;
}

double RadiusAt(const Shape& rest, double x) {
  const int v = NearestTo(rest, x);
  return std::hypot(rest(1, v), rest(2, v));
}

TEST(TubeTest, KnucklesAndCapsHaveTheirRadii) {
  const double length = 6;
  const ShapeFamily tube = MakeTube(30000, {length, 0.5, 0.3, 0.1});
  const Shape rest = tube.pose(0);
  // The radius changes from base to tip by a smooth step, which is 1/2 in the middle; there are
  // knuckles at 0.33 and 0.7, up to 0.15 from there.
  EXPECT_NEAR(RadiusAt(rest, 0.5149 * length), 0.4 - 0.2 * 15.0 / 8 * 0.0149, 1e-3);
  const auto step = [](double x) { return x * x * x * (10 - 15 * x + 6 * x * x); };
  EXPECT_NEAR(RadiusAt(rest, 0.33 * length), 0.5 - 0.2 * step(0.33) + 0.1, 2e-3);
  EXPECT_NEAR(RadiusAt(rest, 0.7 * length), 0.5 - 0.2 * step(0.7) + 0.1, 2e-3);
  EXPECT_NEAR(RadiusAt(rest, 0.255 * length), 0.5 - 0.2 * step(0.255) + 0.05, 4e-3);
  EXPECT_NEAR(RadiusAt(rest, 0.16 * length), 0.5 - 0.2 * step(0.16), 1e-3);
  EXPECT_NEAR(RadiusAt(rest, 0.87 * length), 0.5 - 0.2 * step(0.87), 1e-3);
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(0, v) < -1e-9) {
      EXPECT_NEAR(rest.col(v).norm(), 0.5, 1e-12);
    }
    if (rest(0, v) > length + 1e-9) {
      EXPECT_NEAR((rest.col(v) - Eigen::Vector3d(length, 0, 0)).norm(), 0.3, 1e-12);
    }
  }
}

TEST(TubeTest, TheFirstJointBendsByItsShare) {
  const double length = 6, angle = 100;
  const ShapeFamily tube = MakeTube(30000, {length, 0.5, 0.3, 0.1});
  const Shape rest = tube.pose(0), bent = tube.pose(angle);
  // Between the joints, which end 0.175 from 0.33 and from 0.7, the tube is straight: of the ring
  // there, the vertices on the inner side and on the outer one tell the direction.
  const int v = NearestTo(rest, 0.515 * length);
  int inner = v, outer = v;
  for (int w = 0; w < rest.cols(); ++w) {
    if (std::abs(rest(0, w) - rest(0, v)) > 1e-9) continue;
    if (rest(2, w) > rest(2, inner)) inner = w;
    if (rest(2, w) < rest(2, outer)) outer = w;
  }
  ASSERT_GT(std::abs(rest(0, v) / length - 0.515), 0);
  ASSERT_LT(std::abs(rest(0, v) / length - 0.515), 0.01);
  const auto direction = [&](int from, int to) {
    const Eigen::Vector3d before = rest.col(to) - rest.col(from);
    const Eigen::Vector3d after = bent.col(to) - bent.col(from);
    return std::remainder(
        (std::atan2(after.z(), after.x()) - std::atan2(before.z(), before.x())) * kDegrees, 360);
  };
  EXPECT_NEAR(direction(outer, inner), 0.55 * angle, 1e-9);
  // Before the first joint nothing moves.
  for (int w = 0; w < rest.cols(); ++w) {
    if (rest(0, w) >= 0.155 * length) continue;
    EXPECT_LT((bent.col(w) - rest.col(w)).norm(), 1e-12);
  }
}

TEST(TubeTest, ThickOnesEndWhereTheInnerSideKeepsATenth) {
  // The steepest slope of the smooth step is 15/8; the first joint, of a reach of 0.175 to both
  // sides, takes a share of 0.55.
  EXPECT_NEAR(MakeTube(1000, {2, 0.4, 0.8, 0.1}).end,
              0.9 * 2 * 0.175 * 2 / (15.0 / 8 * 0.55 * 0.9) * kDegrees, 1e-9);
  EXPECT_TRUE(testing::Names(Refusal([] {
                               MakeTube(1000, {-6, 0.5, 0.5, 0});
                             }),
                             {"length:", "-6"}));
  EXPECT_TRUE(testing::Names(Refusal([] {
                               MakeTube(1000, {6, 0, 0.5, 0});
                             }),
                             {"base_radius:", "0"}));
  EXPECT_TRUE(testing::Names(Refusal([] {
                               MakeTube(1000, {0.5, 0.4, 0.6, 0.61});
                             }),
                             {"knuckle:", "0"}));
  EXPECT_NO_THROW(MakeTube(100, {0.5, 0.4, 0.6, 0.6}));
}

TEST(SkinnedBodyTest, DefaultsAreThoseOfTheList) {
  const std::vector<SkinnedBodyInfo> list = ListSkinnedBodies();
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].name, "quadruped");
  EXPECT_EQ(list[0].poses, QuadrupedPoses());
  EXPECT_EQ(list[0].proportions, (std::vector<std::string>{"normal", "long", "short", "heavy"}));
  const Shape low = MakeSkinnedBody("quadruped", 600, "short").pose("sit");
  EXPECT_EQ(low, MakeQuadruped(600, NamedQuadrupedForm("short")).pose("sit"));
  EXPECT_EQ(MakeSkinnedBody("quadruped", 600).pose("sit"), MakeQuadruped(600).pose("sit"));
  EXPECT_NEAR(MakeSkinnedBody("quadruped").connectivity->NumTriangles(), 20000, 600);
  EXPECT_EQ(MakeQuadruped(600).name, "quadruped");
  EXPECT_EQ(MakeBody("quadruped", 600).pose(0), MakeQuadruped(600).pose("stand"));
}

TEST(QuadrupedTest, EveryMeasureChangesItsOwnPart) {
  double QuadrupedForm::*const fields[] = {
      &QuadrupedForm::body_length, &QuadrupedForm::body_girth, &QuadrupedForm::neck_length,
      &QuadrupedForm::neck_girth,  &QuadrupedForm::head_size,  &QuadrupedForm::ear_length,
      &QuadrupedForm::leg_length,  &QuadrupedForm::leg_girth,  &QuadrupedForm::tail_length};
  const char* const names[] = {"body_length", "body_girth", "neck_length",
                               "neck_girth",  "head_size",  "ear_length",
                               "leg_length",  "leg_girth",  "tail_length"};
  // By how much breadth, height and length grow if a measure is half as large again.
  const Eigen::Vector3d growth[] = {{0, 0, 0.510}, {0.120, 0.112, 0},     {0, 0.215, 0.120},
                                    {0.011, 0, 0}, {0.311, 0.168, 0.185}, {0.198, 0.071, 0},
                                    {0, 0.317, 0}, {0, 0.060, 0},         {0, 0, 0.154}};
  const Eigen::Vector3d normal = SizeOf(MakeQuadruped(600).pose("stand"));
  for (int i = 0; i < 9; ++i) {
    SCOPED_TRACE(names[i]);
    QuadrupedForm form;
    form.*fields[i] = 1.5;
    EXPECT_EQ(form.Measures()[i], std::make_pair(std::string(names[i]), 1.5));
    const Eigen::Vector3d size = SizeOf(MakeQuadruped(600, form).pose("stand"));
    EXPECT_LT((size - normal - growth[i]).cwiseAbs().maxCoeff(), 0.02) << (size - normal);
    for (const double factor : {0.29, 3.1}) {
      form.*fields[i] = factor;
      EXPECT_TRUE(testing::Names(Refusal([&] { MakeQuadruped(500, form); }),
                                 {names[i], factor < 1 ? "0.29" : "3.1", "0.3", "3"}));
    }
  }
}

Eigen::Vector3d CentreOf(const Connectivity& connectivity, const Shape& shape) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& t : connectivity.Triangles().colwise()) {
    const Eigen::Vector3d a = shape.col(t(0)), b = shape.col(t(1)), c = shape.col(t(2));
    sum += a.dot(b.cross(c)) / 24 * (a + b + c);
  }
  return sum / VolumeOf(connectivity, shape);
}

TEST(QuadrupedTest, PosesHaveTheirSizesAndCentres) {
  struct Case {
    const char* name;
    Eigen::Vector3d size, centre;
  };
  const Case poses[] = {{"stand", {0.678, 1.728, 2.032}, {0, 0.855, 0.062}},
                        {"stride", {0.698, 1.658, 2.204}, {0.041, 0.817, 0.064}},
                        {"sit", {0.678, 1.918, 1.456}, {0, 0.808, -0.052}},
                        {"stretch", {0.678, 1.612, 1.873}, {0, 0.719, 0.004}},
                        {"rear", {0.678, 2.296, 1.301}, {0.001, 1.124, -0.171}},
                        {"pass", {0.678, 1.704, 2.237}, {-0.001, 0.858, 0.067}},
                        {"other_stride", {0.698, 1.658, 2.204}, {-0.041, 0.817, 0.064}},
                        {"other_pass", {0.678, 1.704, 2.237}, {0.001, 0.858, 0.067}}};
  const Case forms[] = {{"normal", {0.678, 1.728, 2.032}, {0, 0.855, 0.062}},
                        {"long", {0.644, 2.380, 2.406}, {0, 1.132, 0.175}},
                        {"short", {0.813, 1.377, 2.329}, {0, 0.636, 0.256}},
                        {"heavy", {0.736, 1.673, 1.901}, {0, 0.860, 0.055}}};
  const SkinnedBody body = MakeQuadruped(3000);
  const auto expect = [&](const Case& expected, const Shape& shape) {
    EXPECT_LT((SizeOf(shape) - expected.size).cwiseAbs().maxCoeff(), 0.02) << expected.name;
    EXPECT_LT((CentreOf(*body.connectivity, shape) - expected.centre).cwiseAbs().maxCoeff(), 0.004)
        << expected.name;
  };
  for (const Case& pose : poses) expect(pose, body.pose(pose.name));
  for (const Case& form : forms) {
    expect(form, MakeQuadruped(3000, NamedQuadrupedForm(form.name)).pose("stand"));
  }
  expect({"random", {0.630, 1.415, 2.102}, {-0.016, 0.730, 0.069}}, body.random_pose(7));
}

// The same numbers on every machine.
TEST(QuadrupedTest, ARandomFormIsTheSameEverywhere) {
  const double expected[] = {1.21725181075993,  0.989257467604841, 1.08159309728547,
                             0.882618033638465, 1.04388926294656,  0.94274557159432,
                             0.903356251764657, 1.17536642141819,  1.17914194491043};
  const auto measures = RandomQuadrupedForm(QuadrupedForm(), 7).Measures();
  ASSERT_EQ(measures.size(), 9u);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(measures[i].second, expected[i], 1e-12) << i;
}

}  // namespace
}  // namespace shapespace
