#include <shapespace/bodies/body.h>

#include <set>

#include <gtest/gtest.h>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

TEST(BodyTest, MakesEveryListedBodyAtItsDefaultSize) {
  std::set<std::string> names;
  for (const BodyInfo& info : ListBodies()) {
    const ShapeFamily body = MakeBody(info.name);
    EXPECT_EQ(body.name, info.name);
    EXPECT_FALSE(info.description.empty());
    EXPECT_FALSE(body.parameter.empty());
    EXPECT_LT(body.begin, body.end);
    EXPECT_NEAR(body.connectivity->NumTriangles(), info.default_triangles,
                0.03 * info.default_triangles);
    names.insert(info.name);
  }
  EXPECT_EQ(names, (std::set<std::string>{"bar", "bricard", "catenoid", "miura", "quadruped",
                                          "sheet", "steffen", "strip", "tube"}));
}

TEST(BodyTest, SizesComeNearToWhatIsAsked) {
  for (const BodyInfo& info : ListBodies()) {
    if (info.name == "bricard" || info.name == "steffen") continue;
    for (int triangles : {200, 1000, 30000}) {
      if (info.name == "quadruped" && triangles < 500) continue;
      const int made = MakeBody(info.name, triangles).connectivity->NumTriangles();
      EXPECT_NEAR(made, triangles, 0.1 * triangles) << info.name;
    }
  }
  EXPECT_EQ(MakeBody("bricard", 1000).connectivity->NumTriangles(), 8);
}

TEST(BodyTest, PosesAreFiniteAndMoveWithoutJumps) {
  for (const BodyInfo& info : ListBodies()) {
    for (int triangles : {1, 300}) {
      const ShapeFamily body = MakeBody(info.name, triangles);
      const Shape first = body.pose(body.begin);
      ASSERT_EQ(first.cols(), body.connectivity->NumVertices()) << info.name;
      const double size = (first.rowwise().maxCoeff() - first.rowwise().minCoeff()).norm();
      Shape previous = first;
      constexpr int kSteps = 50;
      for (int i = 1; i <= kSteps; ++i) {
        const Shape shape = body.pose(body.begin + (body.end - body.begin) * i / kSteps);
        ASSERT_TRUE(shape.allFinite()) << info.name;
        EXPECT_LT((shape - previous).colwise().norm().maxCoeff(), 0.1 * size) << info.name;
        previous = shape;
      }
      EXPECT_GT((previous - first).colwise().norm().maxCoeff(), 0.1 * size) << info.name;
    }
  }
}

TEST(BodyTest, ThoseSaidToBeIsometricAreAndOthersAreNot) {
  for (const BodyInfo& info : ListBodies()) {
    const ShapeFamily body = MakeBody(info.name);
    const double middle = (body.begin + body.end) / 2;
    const double strain =
        LargestStrain(*body.connectivity, body.pose(body.begin), body.pose(middle));
    if (body.isometric) {
      EXPECT_LT(strain, 1e-12) << info.name;
    } else {
      EXPECT_GT(strain, 1e-4) << info.name;
    }
  }
}

TEST(BodyTest, SmallestMeshesStandInForSmallerNumbers) {
  const std::map<std::string, int> smallest = {{"tube", 50}, {"bar", 12},     {"sheet", 2},
                                               {"strip", 2}, {"catenoid", 6}, {"bricard", 8},
                                               {"miura", 2}, {"steffen", 14}};
  for (const auto& [name, triangles] : smallest) {
    EXPECT_EQ(MakeBody(name, 1).connectivity->NumTriangles(), triangles) << name;
  }
}

TEST(BodyTest, RefusesUnknownNamesNamingTheKnownOnes) {
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBody("cube"); }), {"name:", "'cube'"}));
}

TEST(BodyTest, RefusesAbsurdSizes) {
  EXPECT_TRUE(
      testing::Names(Refusal([] { MakeBody("bar", -5); }), {"triangles:", "-5", "0", "10000000"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBody("tube", 2'000'000'000); }),
                             {"triangles:", "2000000000", "0", "10000000"}));
}

TEST(BodyTest, RefusesParametersOutsideTheRange) {
  for (const BodyInfo& info : ListBodies()) {
    const ShapeFamily body = MakeBody(info.name, 100);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (double value : {body.begin - 1e-6, body.end + 1e-6, nan}) {
      const std::string refusal = Refusal([&] { body.pose(value); });
      EXPECT_EQ(refusal.rfind("parameter: ", 0), 0u) << refusal;
      EXPECT_NE(refusal.find(body.parameter + ", of body '" + body.name + "'"), std::string::npos)
          << refusal;
    }
  }
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBody("bar").pose(400); }),
                             {"parameter:", "400", "0", "360", "'bar'"}));
}

}  // namespace
}  // namespace shapespace
