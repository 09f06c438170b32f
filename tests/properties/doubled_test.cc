#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/path/align.h>

#include "properties/compare.h"
#include "properties/methods.h"
#include "properties/random_body.h"

namespace shapespace {
namespace {

using testing::AreNear;
using testing::BodyKind;
using testing::Method;
using testing::RandomBody;

// The body with its poses turned onto each other, because two bodies together are turned as one.
RandomBody Aligned(RandomBody body) {
  const auto metric = FreezeMetric(body.metric, body.connectivity, body.poses);
  body.poses = AlignPoses(*metric, body.poses).shapes;
  return body;
}

// The body and a copy of it in the same place, where it matters to nothing that does not look for
// contact. Farther away, each component could turn on its own at next to no cost, where a body
// alone is turned back exactly, so that less accurate results could be compared only. In the unit
// in which both together have area 1, the area of either is a half, and so are the squares of its
// lengths: positions cost a quarter of what they did, stretching a half and bending, which has no
// area, as much as before.
RandomBody Doubled(const RandomBody& body) {
  RandomBody both = body;
  const Connectivity& one = *body.connectivity;
  const int vertices = one.NumVertices();
  std::vector<int> begin = one.PolygonBegin(), corners = one.Corners();
  std::vector<std::pair<int, int>> segments = one.Segments();
  for (int p = 1; p <= one.NumPolygons(); ++p) {
    begin.push_back(static_cast<int>(one.Corners().size()) + one.PolygonBegin()[p]);
  }
  for (const int v : one.Corners()) corners.push_back(vertices + v);
  for (const auto& [a, b] : one.Segments()) segments.emplace_back(vertices + a, vertices + b);
  both.connectivity = Connectivity::Make(2 * vertices, begin, corners, segments);
  for (Shape& pose : both.poses) {
    const Shape copy = pose;
    pose.conservativeResize(3, 2 * vertices);
    pose.rightCols(vertices) = copy;
  }
  both.metric.lambda *= 2;
  both.metric.bending /= 2;
  for (std::vector<int>* handle : {&both.held, &both.moved}) {
    const size_t size = handle->size();
    for (size_t i = 0; i < size; ++i) handle->push_back(vertices + (*handle)[i]);
  }
  for (Eigen::VectorXd* stiffness :
       {&both.metric.stretching_stiffness, &both.metric.bending_stiffness}) {
    const Eigen::VectorXd alone = *stiffness;
    stiffness->resize(2 * alone.size());
    *stiffness << alone, alone;
  }
  return both;
}

class DoubledBody : public ::testing::TestWithParam<Method> {};

// Two components may turn against each other, which costs next to nothing, so that solvers end less
// near the minimum than for a body alone.
constexpr double kComponents = 1e-3;

TEST_P(DoubledBody, MovesAsEachAlone) {
  const Method& method = GetParam();
  if (method.name == std::string("Repair")) {
    GTEST_SKIP() << "the distance from the distorted shape is not in the metric's unit";
  }
  for (int kind = 0; kind < testing::kNumBodyKinds; ++kind) {
    // A graph has another unit.
    if (static_cast<BodyKind>(kind) == BodyKind::kGraph) continue;
    for (const int seed : {1, 2}) {
      const RandomBody body =
          Aligned(testing::MakeRandomBody(static_cast<BodyKind>(kind), seed, method.poses));
      SCOPED_TRACE(body.name);
      const int vertices = body.connectivity->NumVertices();
      const std::vector<Shape> alone = method.run(body);
      std::vector<Shape> first, second;
      for (const Shape& shape : method.run(Doubled(body))) {
        first.push_back(shape.leftCols(vertices));
        second.push_back(shape.rightCols(vertices));
      }
      EXPECT_TRUE(AreNear(body, first, alone, kComponents));
      EXPECT_TRUE(AreNear(body, second, alone, kComponents));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, DoubledBody, ::testing::ValuesIn(testing::AllMethods()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace shapespace
