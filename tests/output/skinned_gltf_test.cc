#include <shapespace/output/skinned_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/files/point_cache.h>
#include <shapespace/output/detail/joint_tracks.h>

#include "output/read_glb.h"
#include "output/skinned_body.h"
#include "output/skinned_player.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::Refuses;

// Rounding of weights to 16 bits (1.5e-5), times the distances to which a vertex' bones move it, up
// to 4 for a body of radius 1; other roundings are of single precision.
constexpr double kRounding = 6e-5;

SkinnedGltfOptions Once(double key_error = 0) {
  SkinnedGltfOptions options;
  options.gltf.playback = GltfPlayback::kLoop;
  options.gltf.duration = 2;
  options.key_error = key_error;
  return options;
}

double Farthest(const Shape& a, const Shape& b) { return (a - b).colwise().norm().maxCoeff(); }

TEST(WriteSkinnedGltfTest, PlaysEveryShapeAtItsTime) {
  for (const bool scale : {false, true}) {
    const SkinnedPath path = SkinnedSphere(5, scale);
    const std::string file = GlbFile(scale ? "skin_scaled" : "skin");
    const SkinnedGltfSummary summary = WriteSkinnedGltf(file, path, Once());
    EXPECT_LE(summary.keys, summary.all_keys);
    EXPECT_TRUE(summary.warnings.empty());
    const Glb glb(file);
    const SkinnedPlayer player(glb);
    for (int i = 0; i < path.NumShapes(); ++i) {
      EXPECT_LT(Farthest(player.At(2 * path.parameters[i]), path.Skinned(i)), kRounding)
          << scale << ", shape " << i;
    }
    EXPECT_LT(Farthest(player.AtRest(), path.rest), kRounding);
  }
}

TEST(WriteSkinnedGltfTest, PlacesTheSkeletonInMetresWithYUp) {
  const Eigen::Vector3d place(1e5, -2e5, 3e5);
  const SkinnedPath near = SkinnedSphere(3, false), far = SkinnedSphere(3, false, 3, place);
  SkinnedGltfOptions options = Once();
  options.gltf.up = 'z';
  options.gltf.unit = 0.001;
  const std::string file = GlbFile("skin_placed");
  WriteSkinnedGltf(file, far, options);
  const Glb glb(file);
  Shape expected = near.Skinned(1).colwise() + place;
  expected = (0.001 * expected).eval();
  expected.row(1).swap(expected.row(2));
  expected.row(2) *= -1;
  EXPECT_LT(Farthest(SkinnedPlayer(glb).At(1), expected), 0.001 * kRounding);
}

TEST(WriteSkinnedGltfTest, WeightsSumToOneAsTheyAreStored) {
  const SkinnedPath path = SkinnedSphere(3, false, 3);
  const std::string file = GlbFile("skin_weights");
  WriteSkinnedGltf(file, path, Once());
  const Glb glb(file);
  const Eigen::MatrixXd weights = glb.Attribute("WEIGHTS_0");
  EXPECT_EQ(weights.colwise().sum(), Eigen::RowVectorXd::Constant(weights.cols(), 65535));
  EXPECT_LT((weights.topRows(3) / 65535 - path.weights).cwiseAbs().maxCoeff(), 1.0 / 65535);
  EXPECT_FALSE(glb.Primitive()["attributes"].contains("WEIGHTS_1"));
}

TEST(WriteSkinnedGltfTest, MoreThanFourBonesAreASecondSet) {
  SkinnedPath path = SkinnedSphere(3, false, 6);
  const std::string file = GlbFile("skin_sets");
  WriteSkinnedGltf(file, path, Once());
  const Glb glb(file);
  const Eigen::MatrixXd first = glb.Attribute("WEIGHTS_0"), second = glb.Attribute("WEIGHTS_1");
  EXPECT_EQ(first.colwise().sum() + second.colwise().sum(),
            Eigen::RowVectorXd::Constant(first.cols(), 65535));
  EXPECT_LT(Farthest(SkinnedPlayer(glb).At(1), path.Skinned(1)), kRounding);
}

TEST(WriteSkinnedGltfTest, RotationsTakeTheShorterWay) {
  const SkinnedPath path = SkinnedSphere(9, false);
  const std::string file = GlbFile("skin_turns");
  WriteSkinnedGltf(file, path, Once());
  const Glb glb(file);
  int rotations = 0;
  for (const auto& channel : glb.json["animations"][0]["channels"]) {
    if (channel["target"]["path"] != "rotation") continue;
    ++rotations;
    const auto& sampler = glb.json["animations"][0]["samplers"][channel["sampler"].get<int>()];
    const Eigen::MatrixXd values = glb.Read(sampler["output"]);
    for (Eigen::Index k = 1; k < values.cols(); ++k) {
      EXPECT_GT(values.col(k).dot(values.col(k - 1)), 0);
    }
  }
  EXPECT_EQ(rotations, path.NumJoints());
}

TEST(WriteSkinnedGltfTest, LeavesKeysOutWithinTheError) {
  SkinnedPath path = SkinnedSphere(40, true);
  for (int i = 0; i < path.NumShapes(); ++i) {
    for (int b = 0; b < path.NumJoints(); ++b) {
      const double part = std::sin(0.1 * i + b);
      JointMotion& motion = path.motions[i * path.NumJoints() + b];
      motion.rotation = Eigen::AngleAxisd(0.5 * part, Eigen::Vector3d(b, 1, 2).normalized());
      motion.scale << 1 + 0.2 * part, 1, 1;
      motion.place = path.joints[b].pivot + 0.3 * part * Eigen::Vector3d::UnitX();
    }
  }
  double last_off = 0;
  int last_keys = std::numeric_limits<int>::max();
  for (const double key_error : {0.0, 1e-3, 1e-2}) {
    const std::string file = GlbFile("skin_thinned");
    const SkinnedGltfSummary summary = WriteSkinnedGltf(file, path, Once(key_error));
    EXPECT_LT(summary.keys, last_keys);
    EXPECT_LE(summary.keys, summary.all_keys);
    const Glb glb(file);
    const SkinnedPlayer player(glb);
    double off = 0;
    for (int i = 0; i < path.NumShapes(); ++i) {
      off = std::max(off, Farthest(player.At(2 * path.parameters[i]), path.Skinned(i)));
    }
    // Half the diagonal is the root of 3. Each of three joints behind each other is off by its
    // translation, its rotation and its scale.
    EXPECT_LT(off, 3 * 3 * key_error * std::sqrt(3.0) + kRounding);
    EXPECT_GT(off, last_off);
    last_off = off;
    last_keys = summary.keys;
  }
}

TEST(WriteSkinnedGltfTest, PlaysACycleAround) {
  SkinnedPath path = SkinnedSphere(4, false);
  const std::string back = GlbFile("skin_back"), around = GlbFile("skin_around");
  WriteSkinnedGltf(back, path);
  std::copy_n(path.motions.begin(), path.NumJoints(), path.motions.end() - path.NumJoints());
  WriteSkinnedGltf(around, path);
  // There and back both ends are held; around, the last shape is reached when all ends.
  const Glb there(back), cycle(around);
  const double end = SkinnedGltfOptions().gltf.duration;
  EXPECT_LT(Farthest(SkinnedPlayer(there).At(end), path.Skinned(0)), kRounding);
  EXPECT_LT(Farthest(SkinnedPlayer(cycle).At(end / 3), path.Skinned(1)), kRounding);
  EXPECT_GT(Farthest(SkinnedPlayer(there).At(end / 3), path.Skinned(1)), kRounding);
}

TEST(WriteSkinnedGltfTest, HoldsAndReturnsAsOtherAnimations) {
  const SkinnedPath path = SkinnedSphere(4, false);
  SkinnedGltfOptions options = Once();
  options.gltf.playback = GltfPlayback::kThereAndBack;
  const std::string file = GlbFile("skin_there_and_back");
  WriteSkinnedGltf(file, path, options);
  const Glb glb(file);
  const SkinnedPlayer player(glb);
  EXPECT_LT(Farthest(player.At(0), path.Skinned(0)), kRounding);
  EXPECT_LT(Farthest(player.At(1), path.Skinned(3)), kRounding);
  EXPECT_LT(Farthest(player.At(2), path.Skinned(0)), kRounding);
}

TEST(WriteSkinnedGltfTest, OneShapeHasNoAnimation) {
  const std::string file = GlbFile("skin_one_shape");
  const SkinnedPath path = SkinnedSphere(1, false);
  EXPECT_EQ(WriteSkinnedGltf(file, path).keys, 0);
  const Glb glb(file);
  EXPECT_FALSE(glb.json.contains("animations"));
  EXPECT_LT(Farthest(SkinnedPlayer(glb).AtRest(), path.rest), kRounding);
}

TEST(WriteSkinnedGltfTest, RefusesWhatItCannotWrite) {
  const SkinnedPath path = SkinnedSphere(3, false);
  SkinnedGltfOptions options;
  options.key_error = 0.2;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { options.Validate(); }, {"key_error"}));
  options = {};
  options.gltf.colour_by_deviation = true;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { options.Validate(); }, {"colour_by_deviation"}));
  options = {};
  options.gltf.groups = Eigen::VectorXi::Zero(3);
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { WriteSkinnedGltf(GlbFile("skin_no"), path, options); },
                                      {"groups"}));
  SkinnedPath broken = path;
  broken.weights(0, 3) = std::nan("");
  EXPECT_THROW(WriteSkinnedGltf(GlbFile("skin_no"), broken), MeshError);
}

TEST(ThinnedKeys, KeepsWhatLinearInterpolationNeeds) {
  // A function with two corners: at 3 and at 7.
  const std::vector<double> values = {0, 1, 2, 3, 3, 3, 3, 3, 1, -1, -3};
  const auto off = [&](int first, int key, int last) {
    const double part = static_cast<double>(key - first) / (last - first);
    return std::abs((1 - part) * values[first] + part * values[last] - values[key]);
  };
  EXPECT_EQ(internal::ThinnedKeys(11, 1e-9, off), (std::vector<int>{0, 3, 7, 10}));
  EXPECT_EQ(internal::ThinnedKeys(1, 0.1, off), (std::vector<int>{0}));
}

// For a test of other players: the folder is an environment variable.
TEST(WriteSkinnedGltfTest, WritesForOtherPlayers) {
  const char* const folder = std::getenv("SHAPESPACE_PAGE_DIR");
  if (folder == nullptr) GTEST_SKIP() << "SHAPESPACE_PAGE_DIR is not set";
  const SkinnedPath path = SkinnedSphere(10, true);
  WriteSkinnedGltf(folder + std::string("/skinned.glb"), path, Once());
  std::vector<Shape> shapes;
  for (int i = 0; i < path.NumShapes(); ++i) shapes.push_back(path.Skinned(i));
  WritePointCache(folder + std::string("/skinned.pc2"), shapes);
  EXPECT_EQ(ReadPointCache(folder + std::string("/skinned.pc2")).shapes.size(), shapes.size());
}

}  // namespace
}  // namespace shapespace
