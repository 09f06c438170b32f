#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <shapespace/mesh/seams.h>
#include <shapespace/metric/metric.h>

#include "properties/compare.h"
#include "properties/methods.h"
#include "properties/random_body.h"
#include "support/cut_body.h"

namespace shapespace {
namespace {

using testing::BodyKind;
using testing::CutBody;
using testing::Method;
using testing::RandomBody;

constexpr BodyKind kManifolds[] = {BodyKind::kPlate, BodyKind::kTube, BodyKind::kBall,
                                   BodyKind::kTorus};

// A soup, or a few islands that cross each other at random.
CutBody Cut(const RandomBody& body, bool into_polygons) {
  if (into_polygons) return testing::CutIntoPolygons(*body.connectivity);
  testing::Random random(1);
  std::vector<int> island(body.connectivity->NumPolygons());
  for (int& number : island) number = random.Below(4);
  return testing::CutIntoIslands(*body.connectivity, island);
}

// The body with its copies joined. What it is told of copies differs from what holds of the
// vertices that represent them, or names the copies in their place.
RandomBody Joined(const RandomBody& body, const CutBody& cut) {
  RandomBody joined = body;
  joined.connectivity = testing::Joined(cut, *body.connectivity);
  for (Shape& pose : joined.poses) pose = cut.Of(pose);
  for (std::vector<int>* handle : {&joined.held, &joined.moved}) {
    for (int& v : *handle) v = cut.LastCopy(v);
  }
  if (body.metric.stiffness_on == StiffnessOn::kEdges) return joined;
  for (Eigen::VectorXd* field :
       {&joined.metric.stretching_stiffness, &joined.metric.bending_stiffness}) {
    if (field->size() == 0) continue;
    const Eigen::VectorXd alone = *field;
    *field = Eigen::VectorXd::Constant(static_cast<int>(cut.source.size()), 1e3);
    field->head(alone.size()) = alone;
  }
  return joined;
}

TEST(CutBodies, AreFoundToBeWhole) {
  for (const BodyKind kind : kManifolds) {
    for (const bool into_polygons : {false, true}) {
      const RandomBody body = testing::MakeRandomBody(kind, 1, 3);
      SCOPED_TRACE(body.name);
      const CutBody cut = Cut(body, into_polygons);
      std::vector<Shape> poses;
      for (const Shape& pose : body.poses) poses.push_back(cut.Of(pose));
      const Seams seams = FindSeams(cut.polygon_begin, cut.corners, poses);
      EXPECT_EQ(seams.representatives, cut.source);
      EXPECT_EQ(seams.joined,
                static_cast<int>(cut.source.size()) - body.connectivity->NumVertices());
      EXPECT_EQ(seams.unclear, 0);
    }
  }
}

class CutBodyMethods : public ::testing::TestWithParam<Method> {};

TEST_P(CutBodyMethods, MoveItAsTheWhole) {
  const Method& method = GetParam();
  for (int kind = 0; kind < testing::kNumBodyKinds; ++kind) {
    if (static_cast<BodyKind>(kind) == BodyKind::kGraph) continue;  // has no polygons
    const RandomBody body = testing::MakeRandomBody(static_cast<BodyKind>(kind), 1, method.poses);
    SCOPED_TRACE(body.name);
    const std::vector<Shape> whole = method.run(body);
    for (const bool into_polygons : {false, true}) {
      const CutBody cut = Cut(body, into_polygons);
      std::vector<Shape> moved = method.run(Joined(body, cut));
      for (Shape& shape : moved) {
        EXPECT_TRUE(cut.HasNoGap(shape));
        shape = Shape(shape.leftCols(body.connectivity->NumVertices()));
      }
      EXPECT_TRUE(testing::AreNear(body, moved, whole, method.accuracy));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, CutBodyMethods, ::testing::ValuesIn(testing::AllMethods()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace shapespace
