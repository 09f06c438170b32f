#include <shapespace/skinning/skinning.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/skinning/internal/summary_fields.h>

#include "solvers/skinning_bodies.h"
#include "support/listener.h"
#include "support/message_of.h"
#include "support/threads.h"

namespace shapespace {
namespace {

using testing::BonedBody;
using testing::Names;
using testing::Refuses;
using testing::Snake;

Path PathThrough(const std::shared_ptr<const Connectivity>& connectivity,
                 const std::vector<Shape>& shapes) {
  return MakePath(FreezeMetric(MetricOptions(), connectivity, shapes), shapes);
}

Path QuadrupedPath(int triangles) {
  const SkinnedBody body = MakeQuadruped(triangles);
  std::vector<Shape> shapes = {body.pose(body.pose_names[0])};
  for (const unsigned seed : {1, 2, 3, 4}) shapes.push_back(body.random_pose(seed));
  return PathThrough(body.connectivity, shapes);
}

SkinningOptions WithBones(int bones) {
  SkinningOptions options;
  options.bones = bones;
  return options;
}

double Extent(const Shape& shape) {
  return (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).norm();
}

// The weights of all bones, bones x vertices.
Eigen::MatrixXd DenseWeights(const SkinnedPath& path) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(path.NumJoints(), path.rest.cols());
  for (Eigen::Index v = 0; v < path.rest.cols(); ++v) {
    for (Eigen::Index k = 0; k < path.weights.rows(); ++k) {
      dense(path.bones(k, v), v) += path.weights(k, v);
    }
  }
  return dense;
}

// For each of the body's bones, the one that was found with the nearest weights.
std::vector<int> FoundBones(const BonedBody& body, const SkinnedPath& path) {
  const Eigen::MatrixXd dense = DenseWeights(path);
  std::vector<int> found;
  for (Eigen::Index b = 0; b < body.weights.rows(); ++b) {
    int nearest = 0;
    (dense.rowwise() - body.weights.row(b)).rowwise().squaredNorm().minCoeff(&nearest);
    found.push_back(nearest);
  }
  return found;
}

TEST(Skin, FindsBonesWeightsAndJointsThatAreKnown) {
  for (const unsigned seed : {1, 2, 3}) {
    const BonedBody body = Snake(5, 12, seed);
    SkinningOptions options = WithBones(5);
    options.max_iterations = 200;
    options.tolerance = 1e-6;
    const SkinningResult result = Skin(body.MakePath(), options);
    EXPECT_LT(result.summary.LiteratureError(), 0.01) << seed;
    const std::vector<int> found = FoundBones(body, result.path);
    const Eigen::MatrixXd dense = DenseWeights(result.path);
    for (size_t b = 0; b < found.size(); ++b) {
      EXPECT_LT((dense.row(found[b]) - body.weights.row(b)).cwiseAbs().maxCoeff(), 0.01)
          << seed << ", bone " << b;
    }
    // The skeleton is the row of bones, whichever of them is the root, with joints where they are.
    for (size_t b = 1; b < found.size(); ++b) {
      const std::vector<Joint>& joints = result.path.joints;
      const bool behind = joints[found[b]].parent == found[b - 1];
      ASSERT_TRUE(behind || joints[found[b - 1]].parent == found[b]) << seed << ", bone " << b;
      const Eigen::Vector3d pivot = joints[behind ? found[b] : found[b - 1]].pivot;
      EXPECT_LT((pivot - body.joints.col(b)).norm(), 0.01) << seed << ", bone " << b;
    }
  }
}

TEST(Skin, NoIterationRaisesTheError) {
  for (const bool scale : {false, true}) {
    SkinningOptions options = WithBones(12);
    options.scale = scale;
    const SkinningSummary summary = Skin(QuadrupedPath(2000), options).summary;
    ASSERT_GT(summary.errors.size(), 4u);
    for (size_t i = 1; i < summary.errors.size(); ++i) {
      EXPECT_LT(summary.errors[i], summary.errors[i - 1]) << i;
    }
    EXPECT_LT(summary.errors.back(), summary.errors.front() / 2);
  }
}

TEST(Skin, IsValidAndWhatItsSummarySays) {
  const Path path = QuadrupedPath(1500);
  const SkinningResult result = Skin(path, WithBones(10));
  result.path.Validate();
  const SkinningSummary& summary = result.summary;
  EXPECT_EQ(summary.bones, 10);
  EXPECT_EQ(result.path.NumJoints(), 10);
  double sum = 0, greatest = 0;
  for (int i = 0; i < path.NumShapes(); ++i) {
    const Eigen::VectorXd off = (result.path.Skinned(i) - path.Placed(i)).colwise().norm();
    sum += off.squaredNorm();
    greatest = std::max(greatest, off.maxCoeff());
  }
  const double rms = std::sqrt(sum / (path.NumShapes() * result.path.rest.cols()));
  EXPECT_NEAR(summary.error, rms, 1e-9 * rms);
  EXPECT_NEAR(summary.error, summary.errors.back(), 1e-6 * rms);
  EXPECT_NEAR(summary.relative_error, 2 * rms / Extent(path.Placed(0)), 1e-9);
  EXPECT_NEAR(summary.max_error, greatest, 1e-9 * greatest);
  EXPECT_NEAR((result.path.Skinned(summary.max_error_shape) - path.Placed(summary.max_error_shape))
                  .col(summary.max_error_vertex)
                  .norm(),
              greatest, 1e-9 * greatest);
  EXPECT_NEAR(std::sqrt(summary.vertex_errors.squaredNorm() / summary.vertex_errors.size()), rms,
              1e-9 * rms);
  EXPECT_NEAR(std::sqrt(summary.shape_errors.squaredNorm() / path.NumShapes()), rms, 1e-9 * rms);
  for (const JointMotion& motion : result.path.motions) {
    EXPECT_LT((motion.rotation * motion.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(),
              1e-12);
    EXPECT_GT(motion.rotation.determinant(), 0);
    EXPECT_EQ(motion.scale, Eigen::Vector3d::Ones());
  }
  // The rest pose is the first shape.
  EXPECT_LT((result.path.Skinned(0) - path.Placed(0)).cwiseAbs().maxCoeff(), 1e-12);
}

// Between two shapes, many weights reproduce the motion: the smooth ones are taken.
TEST(Skin, WeightsAreSmooth) {
  const SkinnedBody body = MakeQuadruped(2000);
  const Path path = PathThrough(body.connectivity, {body.pose("stand"), body.pose("rear")});
  const Eigen::MatrixXd dense = DenseWeights(Skin(path, WithBones(20)).path);
  double roughness = 0;
  for (const auto& edge : body.connectivity->Edges().colwise()) {
    roughness += (dense.col(edge(0)) - dense.col(edge(1))).squaredNorm();
  }
  EXPECT_LT(roughness, 500);  // 970 without regard to neighbours
}

TEST(Skin, GivesAsManyBonesAsAreAskedFor) {
  const SkinningSummary summary = Skin(QuadrupedPath(1500), WithBones(100)).summary;
  EXPECT_EQ(summary.bones, 100);
  EXPECT_TRUE(summary.warnings.empty());
}

TEST(Skin, MoreFreedomLowersTheError) {
  const Path path = QuadrupedPath(1500);
  const auto error = [&](const SkinningOptions& options) {
    return Skin(path, options).summary.error;
  };
  const SkinningOptions plain = WithBones(10);
  EXPECT_LT(error(WithBones(20)), 0.7 * error(plain));
  SkinningOptions one_weight = plain, scale = plain;
  one_weight.weights_per_vertex = 1;
  scale.scale = true;
  EXPECT_GT(error(one_weight), 1.5 * error(plain));
  EXPECT_LT(error(scale), error(plain));
}

TEST(Skin, TakesAsFewBonesAsTheErrorNeeds) {
  const Path path = QuadrupedPath(1000);
  SkinningOptions options = WithBones(0);
  options.error = 0.01;
  const SkinningSummary summary = Skin(path, options).summary;
  EXPECT_LE(summary.relative_error, 0.01);
  EXPECT_EQ(summary.warnings.size(), 0u);
  EXPECT_GT(Skin(path, WithBones(summary.bones - 1)).summary.relative_error, 0.01);
  // With fewer than these it says what it is that could not be had.
  options.most_bones = summary.bones / 2;
  const SkinningSummary few = Skin(path, options).summary;
  EXPECT_EQ(few.bones, options.most_bones);
  EXPECT_GT(few.relative_error, 0.01);
  ASSERT_EQ(few.warnings.size(), 1u);
  EXPECT_TRUE(Names(few.warnings[0], {std::to_string(options.most_bones)}));
}

TEST(Skin, IsTheSameOnAnyThreads) {
  const Path path = QuadrupedPath(1000);
  const auto results = testing::OnThreads([&] { return Skin(path, WithBones(8)).path; });
  for (const SkinnedPath& other : results) {
    EXPECT_EQ(other.bones, results[0].bones);
    EXPECT_EQ(other.weights, results[0].weights);
    for (size_t i = 0; i < other.motions.size(); ++i) {
      EXPECT_EQ(other.motions[i].rotation, results[0].motions[i].rotation);
      EXPECT_EQ(other.motions[i].place, results[0].motions[i].place);
    }
  }
}

TEST(Skin, MovesAndScalesWithThePath) {
  const BonedBody body = Snake(4, 6);
  const Path path = body.MakePath();
  const double scale = 37;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d away(1e5, -2e5, 3e5);
  std::vector<Shape> moved;
  for (const Shape& shape : body.shapes) {
    moved.push_back((scale * (turn * shape)).colwise() + away);
  }
  for (const bool stretched : {false, true}) {
    SkinningOptions options = WithBones(3);
    options.scale = stretched;
    const SkinnedPath here = Skin(path, options).path;
    const SkinnedPath there = Skin(PathThrough(body.connectivity, moved), options).path;
    for (int i = 0; i < path.NumShapes(); ++i) {
      const Shape expected = (scale * (turn * here.Skinned(i))).colwise() + away;
      EXPECT_LT((there.Skinned(i) - expected).cwiseAbs().maxCoeff(), 1e-6 * scale * 40)
          << stretched << ", shape " << i;
    }
    ASSERT_EQ(here.NumJoints(), there.NumJoints());
    for (int b = 0; b < here.NumJoints(); ++b) {
      EXPECT_EQ(here.joints[b].parent, there.joints[b].parent);
      const Eigen::Vector3d expected = scale * (turn * here.joints[b].pivot) + away;
      EXPECT_LT((there.joints[b].pivot - expected).norm(), 1e-6 * scale * 40);
    }
  }
}

TEST(Skin, GivesEachOfManyComponentsABone) {
  // Four tetrahedra, and a vertex in no triangle, which move independently of each other.
  Eigen::Matrix3Xi triangles(3, 16);
  Shape rest(3, 17);
  Eigen::Matrix<int, 3, 4> tetrahedron;
  tetrahedron << 0, 0, 0, 1, 1, 2, 3, 2, 2, 3, 1, 3;
  for (int c = 0; c < 4; ++c) {
    triangles.middleCols<4>(4 * c) = tetrahedron.array() + 4 * c;
    rest.middleCols<4>(4 * c) << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    rest.middleCols<4>(4 * c).row(0).array() += 3 * c;
  }
  rest.col(16) << 1, 5, 1;
  const auto connectivity = Connectivity::FromTriangles(17, triangles);
  std::vector<Shape> shapes = {rest};
  for (int i = 1; i < 5; ++i) {
    Shape shape = rest;
    for (int c = 0; c < 4; ++c) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(0.3 * i * (c + 1), Eigen::Vector3d::Unit(c % 3)).toRotationMatrix();
      shape.middleCols<4>(4 * c) = turn * rest.middleCols<4>(4 * c);
    }
    shape.col(16) *= i;
    shapes.push_back(shape);
  }
  const SkinningResult result = Skin(PathThrough(connectivity, shapes), WithBones(5));
  EXPECT_EQ(result.summary.bones, 5);
  EXPECT_LT(result.summary.relative_error, 1e-6);
  EXPECT_TRUE(result.summary.warnings.empty());
  result.path.Validate();
}

TEST(Skin, SaysWhyThereAreFewerBones) {
  const BonedBody body = Snake(1, 6);  // rigid copies
  const SkinningResult rigid = Skin(body.MakePath(), WithBones(7));
  EXPECT_EQ(rigid.summary.bones, 1);
  EXPECT_LT(rigid.summary.relative_error, 1e-9);
  EXPECT_TRUE(rigid.summary.Converged());
  ASSERT_EQ(rigid.summary.warnings.size(), 1u);
  EXPECT_TRUE(Names(rigid.summary.warnings[0], {"6", "7"}));

  // More bones than triangles.
  Shape triangle(3, 3), wider(3, 3);
  triangle << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  wider << 0, 2, 0, 0, 0, 1, 0, 0, 0;
  const auto connectivity = Connectivity::FromTriangles(3, Eigen::Vector3i(0, 1, 2));
  const SkinningResult few = Skin(PathThrough(connectivity, {triangle, wider}), WithBones(20));
  few.path.Validate();
  EXPECT_LT(few.summary.relative_error, 1e-6);
  EXPECT_EQ(few.summary.warnings.size(), 1u);
}

TEST(Skin, TwinsFollowTheirRepresentatives) {
  const BonedBody body = Snake(2, 4);
  std::vector<int> begin = body.connectivity->PolygonBegin();
  std::vector<int> corners = body.connectivity->Corners();
  const int vertices = body.connectivity->NumVertices();
  // The last vertex is stored twice.
  std::vector<int> representatives(vertices + 1);
  for (int v = 0; v < vertices; ++v) representatives[v] = v;
  representatives[vertices] = vertices - 1;
  corners.back() = vertices;
  const auto connectivity =
      Connectivity::Make(vertices + 1, begin, corners, {}, {}, {}, representatives);
  std::vector<Shape> shapes;
  for (const Shape& shape : body.shapes) {
    Shape longer(3, vertices + 1);
    longer << shape, shape.col(vertices - 1);
    shapes.push_back(longer);
  }
  const SkinnedPath path = Skin(PathThrough(connectivity, shapes), WithBones(2)).path;
  path.Validate();
  EXPECT_EQ(path.weights.col(vertices), path.weights.col(vertices - 1));
  EXPECT_EQ(path.bones.col(vertices), path.bones.col(vertices - 1));
}

TEST(Skin, RefusesWhatHasNoBones) {
  const BonedBody body = Snake(2, 4);
  Path path = body.MakePath();
  EXPECT_THROW(Skin(FirstShapes(path, 1)), MeshError);
  path.shapes[2](1, 7) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Skin(path), MeshError);

  const auto refuses = [&](const std::string& field, const auto& change) {
    SkinningOptions options;
    change(&options);
    EXPECT_TRUE(Refuses<InvalidOptions>([&] { Skin(body.MakePath(), options); }, {field}));
  };
  refuses("bones", [](auto* options) { options->bones = -1; });
  refuses("bones", [](auto* options) { options->bones = 501; });
  refuses("error", [](auto* options) { options->error = 0; });
  refuses("error", [](auto* options) { options->error = std::nan(""); });
  refuses("most_bones", [](auto* options) { options->most_bones = 0; });
  refuses("weights_per_vertex", [](auto* options) { options->weights_per_vertex = 9; });
  refuses("rest", [](auto* options) { options->rest = 4; });
  refuses("rest", [](auto* options) { options->rest = -1; });
  refuses("tolerance", [](auto* options) { options->tolerance = 1; });
  refuses("max_iterations", [](auto* options) { options->max_iterations = 0; });
}

TEST(Skin, StopsWhenAskedTo) {
  const Path path = QuadrupedPath(1000);
  testing::Listener at_once(1);
  EXPECT_THROW(Skin(path, WithBones(6), &at_once), Cancelled);
  for (const int bones : {6, 0}) {
    SkinningOptions options = WithBones(bones);
    options.error = 0.005;
    testing::Listener later(4);
    const SkinningResult result = Skin(path, options, &later);
    EXPECT_EQ(result.summary.termination, Termination::kCancelled);
    result.path.Validate();
  }
}

TEST(Skin, AnyShapeMayBeTheRestPose) {
  const BonedBody body = Snake(3, 5);
  SkinningOptions options = WithBones(3);
  options.rest = 3;
  const SkinnedPath path = Skin(body.MakePath(), options).path;
  EXPECT_LT((path.rest - body.shapes[3]).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((path.Skinned(3) - body.shapes[3]).cwiseAbs().maxCoeff(), 1e-10);
}

}  // namespace
}  // namespace shapespace
