#include <shapespace/bodies/quadruped.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/bodies/body.h>
#include <shapespace/mesh/topology.h>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

// Number of hinges with a fold sharper than at the tip of a coarse ear.
int Folds(const SkinnedBody& body, const std::string& pose) {
  return (HingeAngles(*body.connectivity, body.pose(pose)).array().abs() > 120).count();
}

TEST(QuadrupedTest, IsOneClosedSurfaceWithoutHandlesAtEverySize) {
  for (int triangles : {500, 600, 800, 2000, 20000}) {
    SCOPED_TRACE(triangles);
    const SkinnedBody body = MakeQuadruped(triangles);
    EXPECT_NEAR(body.connectivity->NumTriangles(), triangles, 0.1 * triangles);
    const Topology topology = ComputeTopology(*body.connectivity);
    EXPECT_TRUE(topology.manifold);
    EXPECT_EQ(topology.components, 1);
    EXPECT_TRUE(topology.boundary_loops.empty());
    EXPECT_EQ(topology.genus, 0);
    EXPECT_GT(VolumeOf(*body.connectivity, body.pose("stand")), 0.2);
  }
}

TEST(QuadrupedTest, HasNoSlivers) {
  for (int triangles : {500, 2000, 20000}) {
    const SkinnedBody body = MakeQuadruped(triangles);
    EXPECT_GT(SmallestAngle(*body.connectivity, body.pose("stand")), 20) << triangles;
  }
}

TEST(QuadrupedTest, KeepsItsExtremitiesWhenCoarse) {
  const auto size = [](int triangles) -> Eigen::Vector3d {
    const Shape shape = MakeQuadruped(triangles).pose("stand");
    return shape.rowwise().maxCoeff() - shape.rowwise().minCoeff();
  };
  const Eigen::Vector3d fine = size(20000);
  EXPECT_LT((size(500) - fine).cwiseAbs().maxCoeff(), 0.15);
  EXPECT_LT((size(2000) - fine).cwiseAbs().maxCoeff(), 0.04);
}

TEST(QuadrupedTest, StandsUprightOnTheFloorInEveryPose) {
  const SkinnedBody body = MakeQuadruped(2000);
  EXPECT_EQ(body.pose_names, (std::vector<std::string>{"stand", "stride", "sit", "stretch", "rear",
                                                       "pass", "other_stride", "other_pass"}));
  for (const std::string& name : body.pose_names) {
    EXPECT_EQ(body.pose(name).row(1).minCoeff(), 0) << name;
  }
  // Left and right are symmetric at rest, and the head is in front.
  const Shape rest = body.pose("stand");
  EXPECT_NEAR(rest.row(0).maxCoeff(), -rest.row(0).minCoeff(), 0.02);
  Eigen::Index highest;
  rest.row(1).maxCoeff(&highest);
  EXPECT_GT(rest(2, highest), 0.4);
}

// According to the pictures, all other folds are in the skin behind the knees of the sitting pose.
TEST(QuadrupedTest, FoldsNowhereButBehindTheKnees) {
  const SkinnedBody body = MakeQuadruped(20000);
  for (const std::string& name : body.pose_names) EXPECT_EQ(Folds(body, name), 0) << name;
  for (const char* form : {"long", "short", "heavy"}) {
    const SkinnedBody other = MakeQuadruped(20000, NamedQuadrupedForm(form));
    for (const std::string& name : body.pose_names) {
      EXPECT_LE(Folds(other, name), name == "sit" ? 30 : 2) << form << " " << name;
    }
  }
}

TEST(QuadrupedTest, PosesKeepTheVolumeAndMostEdges) {
  const SkinnedBody body = MakeQuadruped(5000);
  const Shape rest = body.pose("stand");
  const Eigen::ArrayXd before = EdgeLengths(*body.connectivity, rest);
  for (const std::string& name : body.pose_names) {
    const Shape shape = body.pose(name);
    EXPECT_NEAR(VolumeOf(*body.connectivity, shape), VolumeOf(*body.connectivity, rest), 0.02)
        << name;
    const Eigen::ArrayXd strain = EdgeLengths(*body.connectivity, shape).array() / before - 1;
    EXPECT_LT((strain.abs() > 0.2).count(), 0.15 * strain.size()) << name;
    if (name != "stand") {
      EXPECT_GT((shape - rest).colwise().norm().maxCoeff(), 0.3) << name;
    }
  }
}

TEST(QuadrupedTest, OneLegDoesNotMoveAnother) {
  const SkinnedBody body = MakeQuadruped(5000);
  // In "stride" the bones of all four lower legs are rigid: their edges keep their lengths, which
  // they would not if another leg's joint influenced them.
  const Shape rest = body.pose("stand"), stride = body.pose("stride");
  int checked = 0;
  for (const auto& edge : body.connectivity->Edges().colwise()) {
    if (rest(1, edge(0)) > 0.02 || rest(1, edge(1)) > 0.02) continue;  // soles
    const double before = (rest.col(edge(0)) - rest.col(edge(1))).norm();
    const double after = (stride.col(edge(0)) - stride.col(edge(1))).norm();
    EXPECT_NEAR(after, before, 0.03 * before);
    ++checked;
  }
  EXPECT_GT(checked, 40);
}

TEST(QuadrupedTest, ProportionsKeepTheConnectivityAndTheAnglesFair) {
  const SkinnedBody normal = MakeQuadruped(2000);
  std::map<std::string, Eigen::Vector3d> sizes;
  for (const std::string& form : QuadrupedProportions()) {
    const SkinnedBody body = MakeQuadruped(2000, NamedQuadrupedForm(form));
    ASSERT_EQ(body.connectivity->Triangles(), normal.connectivity->Triangles());
    const Shape shape = body.pose("stand");
    EXPECT_GT(SmallestAngle(*body.connectivity, shape), 15) << form;
    sizes[form] = shape.rowwise().maxCoeff() - shape.rowwise().minCoeff();
    sizes[form].x() = VolumeOf(*body.connectivity, shape);
  }
  EXPECT_GT(sizes["long"].y(), 1.25 * sizes["normal"].y());
  EXPECT_LT(sizes["short"].y(), 0.85 * sizes["normal"].y());
  EXPECT_GT(sizes["short"].z(), 1.05 * sizes["normal"].z());
  EXPECT_GT(sizes["heavy"].x(), 1.4 * sizes["normal"].x());
}

TEST(QuadrupedTest, GoesFromPoseToPose) {
  const SkinnedBody body = MakeQuadruped(1000);
  EXPECT_EQ(body.between("stand", "sit", 0), body.pose("stand"));
  EXPECT_LT((body.between("rear", "sit", 1) - body.pose("sit")).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(MakeBody("quadruped", 1000).pose(1), body.pose("stretch"));
  // Joints are interpolated: half way from a pose to itself is that pose.
  EXPECT_LT((body.between("sit", "sit", 0.5) - body.pose("sit")).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(QuadrupedTest, HasRandomPosesWithFewFolds) {
  const SkinnedBody body = MakeQuadruped(4000);
  const Shape rest = body.pose("stand");
  for (unsigned seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    const Shape shape = body.random_pose(seed);
    EXPECT_EQ(shape, body.random_pose(seed));
    EXPECT_EQ(shape.row(1).minCoeff(), 0);
    EXPECT_GT((shape - rest).colwise().norm().maxCoeff(), 0.2);
    EXPECT_GT((shape - body.random_pose(seed + 1)).colwise().norm().maxCoeff(), 0.2);
    EXPECT_LT((HingeAngles(*body.connectivity, shape).array().abs() > 120).count(), 20);
  }
}

TEST(QuadrupedTest, HasRandomFormsAroundAForm) {
  const QuadrupedForm slender = NamedQuadrupedForm("long");
  double least = 1, greatest = 1, mean_of_logarithms = 0;
  int count = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const QuadrupedForm form = RandomQuadrupedForm(slender, seed);
    EXPECT_NO_THROW(form.Validate());
    EXPECT_EQ(form.Measures(), RandomQuadrupedForm(slender, seed).Measures());
    EXPECT_NE(form.neck_length, RandomQuadrupedForm(slender, seed + 1).neck_length);
    for (size_t i = 0; i < form.Measures().size(); ++i) {
      const double factor = form.Measures()[i].second / slender.Measures()[i].second;
      least = std::min(least, factor);
      greatest = std::max(greatest, factor);
      mean_of_logarithms += std::log(factor);
      ++count;
    }
  }
  EXPECT_EQ(count, 450);
  EXPECT_NEAR(mean_of_logarithms / count, 0, 0.02);
  EXPECT_GE(least, 0.7499);
  EXPECT_LE(greatest, 1.3334);
  EXPECT_LT(least, 0.76);
  EXPECT_GT(greatest, 1.31);
  QuadrupedForm smallest;
  smallest.leg_length = 0.3;
  for (unsigned seed = 0; seed < 5; ++seed) {
    EXPECT_NO_THROW(RandomQuadrupedForm(smallest, seed).Validate());
  }
}

TEST(QuadrupedTest, RefusesWhatItDoesNotKnow) {
  const SkinnedBody body = MakeQuadruped(500);
  EXPECT_TRUE(testing::Names(Refusal([&] { body.pose("fly"); }),
                             {"pose:", "'fly'", "other_stride", "other_pass"}));
  EXPECT_TRUE(
      testing::Names(Refusal([&] { body.between("stand", "sit", 1.5); }), {"part:", "0", "1"}));
  EXPECT_TRUE(
      testing::Names(Refusal([] { NamedQuadrupedForm("huge"); }), {"proportions:", "'huge'"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeSkinnedBody("tube"); }), {"name:", "'tube'"}));
  QuadrupedForm form;
  form.leg_length = 10;
  EXPECT_TRUE(testing::Names(Refusal([&] { MakeQuadruped(500, form); }),
                             {"leg_length:", "10", "0.3", "3"}));
  EXPECT_TRUE(
      testing::Names(Refusal([] { MakeQuadruped(-1); }), {"triangles:", "-1", "0", "1000000"}));
}

}  // namespace
}  // namespace shapespace
