#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "properties/compare.h"
#include "properties/methods.h"
#include "properties/random_body.h"
#include "support/motions.h"
#include "support/threads.h"

namespace shapespace {
namespace {

using testing::AreCongruent;
using testing::AreNear;
using testing::BodyKind;
using testing::Method;
using testing::RandomBody;

class AnyMethod : public ::testing::TestWithParam<Method> {
 protected:
  // Calls test(body, random numbers of its own, result) for bodies of all kinds.
  template <class Test>
  void ForBodies(const std::vector<int>& seeds, const Test& test) const {
    for (int kind = 0; kind < testing::kNumBodyKinds; ++kind) {
      if (static_cast<BodyKind>(kind) == BodyKind::kGraph && !GetParam().takes_graphs) continue;
      for (const int seed : seeds) {
        const RandomBody body =
            testing::MakeRandomBody(static_cast<BodyKind>(kind), seed, GetParam().poses);
        SCOPED_TRACE(body.name);
        testing::Random random(seed);
        test(body, &random, Run(body));
      }
    }
  }
  std::vector<Shape> Run(const RandomBody& body) const { return GetParam().run(body); }
};

TEST_P(AnyMethod, ScalesAndTurnsWithTheBody) {
  ForBodies({1, 2}, [&](const RandomBody& body, testing::Random* random, const auto& result) {
    const double scale = std::pow(10, random->Between(-6, 6));
    const Eigen::Matrix3d rotation = random->Rotation();
    const Eigen::Vector3d way = scale * random->Between(0, 10) * random->Direction();
    std::vector<Shape> back;
    for (const Shape& shape : Run(Moved(body, scale, rotation, way))) {
      back.push_back(rotation.transpose() * (shape.colwise() - way) / scale);
    }
    EXPECT_TRUE(AreNear(body, back, result, GetParam().accuracy));
  });
}

// At a million times its size from the origin, coordinates have ten digits of the body.
TEST_P(AnyMethod, IsTheSameFarAway) {
  ForBodies({1}, [&](const RandomBody& body, testing::Random* random, const auto& result) {
    const Eigen::Vector3d way = 1e6 * random->Direction();
    const Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    std::vector<Shape> back;
    for (const Shape& shape : Run(Moved(body, 1, rotation, way))) {
      back.push_back(shape.colwise() - way);
    }
    EXPECT_TRUE(AreNear(body, back, result, GetParam().accuracy));
  });
}

TEST_P(AnyMethod, DoesNotCareWhereEachPoseIs) {
  ForBodies({1, 2}, [&](const RandomBody& body, testing::Random* random, const auto& result) {
    RandomBody moved = body;
    for (Shape& pose : moved.poses) {
      const Eigen::Matrix3d rotation = random->Rotation();
      pose = (rotation * pose).colwise() + random->Between(0, 10) * random->Direction();
    }
    EXPECT_TRUE(AreCongruent(body, Run(moved), result, GetParam().accuracy));
  });
}

TEST_P(AnyMethod, DoesNotDependOnTheOrderOfVerticesAndPolygons) {
  ForBodies({1, 2}, [&](const RandomBody& body, testing::Random* random, const auto& result) {
    const testing::Renumbered renumbered = testing::Renumber(body, random->Below(1000));
    std::vector<Shape> back;
    for (const Shape& shape : Run(renumbered.body)) back.push_back(renumbered.Back(shape));
    EXPECT_TRUE(AreNear(body, back, result, GetParam().accuracy));
  });
}

TEST_P(AnyMethod, HasTheSameBitsOnAnyThreads) {
  ForBodies({1}, [&](const RandomBody& body, testing::Random*, const auto& result) {
    for (const auto& other : testing::OnThreads([&] { return Run(body); })) {
      EXPECT_TRUE(other == result);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(, AnyMethod, ::testing::ValuesIn(testing::AllMethods()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace shapespace
