#include <shapespace/output/skinned_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/files/internal/tinygltf.h>
#include <shapespace/output/detail/gltf_arrays.h>
#include <shapespace/output/detail/gltf_file.h>
#include <shapespace/output/detail/gltf_mesh.h>
#include <shapespace/output/detail/joint_tracks.h>
#include <shapespace/output/detail/playback.h>
#include <shapespace/output/internal/colour.h>

namespace shapespace {
namespace {

using internal::JointPose;
using tinygltf::Value;

constexpr int kWholeWeight = 65535;  // the integer that stands for weight 1
constexpr int kBonesOfSet = 4;       // in each of JOINTS_0, JOINTS_1

// Weights as integers with the given sum: rounded down, and those with the greatest remainders one
// more.
std::vector<int> RoundedWeights(const Eigen::Ref<const Eigen::VectorXd>& weights) {
  std::vector<int> rounded(weights.size());
  std::vector<std::pair<double, int>> remainders;
  const Eigen::VectorXd whole = kWholeWeight / weights.sum() * weights;
  int left = kWholeWeight;
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    rounded[k] = static_cast<int>(whole(k));
    left -= rounded[k];
    remainders.emplace_back(rounded[k] - whole(k), static_cast<int>(k));
  }
  std::sort(remainders.begin(), remainders.end());
  for (int k = 0; k < left; ++k) ++rounded[remainders[k].second];
  return rounded;
}

// Adds JOINTS_n and WEIGHTS_n of the mesh's vertices to all primitives; a weight of 0 belongs to
// joint 0, as the format requires.
template <typename Index>
void AddWeights(const SkinnedPath& path, const std::vector<int>& source, tinygltf::Model* model) {
  const int most = static_cast<int>(path.weights.rows());
  const Eigen::Index count = static_cast<Eigen::Index>(source.size());
  for (int set = 0; set * kBonesOfSet < most; ++set) {
    Eigen::Matrix<Index, kBonesOfSet, Eigen::Dynamic> joints(kBonesOfSet, count);
    Eigen::Matrix<uint16_t, kBonesOfSet, Eigen::Dynamic> weights(kBonesOfSet, count);
    joints.setZero();
    weights.setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::vector<int> rounded = RoundedWeights(path.weights.col(source[i]));
      for (int k = 0; k < std::min(kBonesOfSet, most - set * kBonesOfSet); ++k) {
        const int weight = rounded[set * kBonesOfSet + k];
        if (weight == 0) continue;
        weights(k, i) = static_cast<uint16_t>(weight);
        joints(k, i) = static_cast<Index>(path.bones(set * kBonesOfSet + k, source[i]));
      }
    }
    const int of_joints =
        internal::Add(joints, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER, model);
    const int of_weights =
        internal::Add(weights, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER, model);
    model->accessors[of_weights].normalized = true;
    for (tinygltf::Primitive& primitive : model->meshes[0].primitives) {
      primitive.attributes["JOINTS_" + std::to_string(set)] = of_joints;
      primitive.attributes["WEIGHTS_" + std::to_string(set)] = of_weights;
    }
  }
}

bool IsScaled(const SkinnedPath& path) {
  return std::any_of(path.motions.begin(), path.motions.end(), [](const JointMotion& motion) {
    return motion.scale != Eigen::Vector3d::Ones();
  });
}

// The nodes of the joints: of each, and in a scaled skin of each bone's scale.
struct JointNodes {
  std::vector<int> joints, scales;
  const std::vector<int>& OfSkin() const { return scales.empty() ? joints : scales; }
};

// Node 0 has the mesh, and node 1 the placement and the skeleton below it. (Players ignore the
// placement of a skinned mesh's own node.)
JointNodes AddNodes(const SkinnedPath& path, const Eigen::Vector3d& origin,
                    const GltfOptions& options, tinygltf::Model* model) {
  tinygltf::Node mesh;
  mesh.name = "shape";
  mesh.mesh = 0;
  mesh.skin = 0;
  tinygltf::Node skeleton = internal::PlacedNode(origin, options);
  skeleton.name = "skeleton";
  skeleton.mesh = -1;
  model->nodes = {mesh, skeleton};
  JointNodes nodes;
  for (int b = 0; b < path.NumJoints(); ++b) {
    const JointPose rest = internal::RestPoseOf(path, b, origin);
    tinygltf::Node node;
    node.name = internal::AsUtf8(path.joints[b].name);
    node.translation = {rest.translation.x(), rest.translation.y(), rest.translation.z()};
    const Eigen::Quaterniond& q = rest.rotation;
    node.rotation = {q.x(), q.y(), q.z(), q.w()};
    const int parent = path.joints[b].parent;
    nodes.joints.push_back(static_cast<int>(model->nodes.size()));
    model->nodes[parent < 0 ? 1 : nodes.joints[parent]].children.push_back(nodes.joints[b]);
    model->nodes.push_back(std::move(node));
  }
  if (!IsScaled(path)) return nodes;
  for (int b = 0; b < path.NumJoints(); ++b) {
    tinygltf::Node node;
    node.name = model->nodes[nodes.joints[b]].name + "_scale";
    nodes.scales.push_back(static_cast<int>(model->nodes.size()));
    model->nodes[nodes.joints[b]].children.push_back(nodes.scales[b]);
    model->nodes.push_back(std::move(node));
  }
  return nodes;
}

void AddSkin(const SkinnedPath& path, const Eigen::Vector3d& origin, const JointNodes& nodes,
             tinygltf::Model* model) {
  Eigen::MatrixXf inverses(16, path.NumJoints());
  for (int b = 0; b < path.NumJoints(); ++b) {
    const Joint& joint = path.joints[b];
    Eigen::Matrix4d inverse = Eigen::Matrix4d::Identity();
    inverse.topLeftCorner<3, 3>() = joint.axes.transpose();
    inverse.topRightCorner<3, 1>() = joint.axes.transpose() * (origin - joint.pivot);
    inverses.col(b) = inverse.reshaped().cast<float>();
  }
  tinygltf::Skin skin;
  skin.name = "skin";
  skin.inverseBindMatrices = internal::Add(inverses, TINYGLTF_TYPE_MAT4, 0, model);
  skin.skeleton = nodes.joints[0];
  skin.joints = nodes.OfSkin();
  model->skins = {skin};
}

// The channels of one animation; samplers with the same times share these.
class Channels {
 public:
  Channels(const Eigen::RowVectorXf& times, tinygltf::Model* model)
      : times_(times), model_(model) {}

  // Values, a column per time, of which `kept` are written.
  void Add(int node, const char* target, int type, const Eigen::MatrixXf& values,
           const std::vector<int>& kept) {
    tinygltf::AnimationSampler sampler;
    sampler.input = TimesAt(kept);
    const Eigen::MatrixXf few = values(Eigen::all, kept);
    sampler.output = internal::Add(few, type, 0, model_);
    sampler.interpolation = "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation_.samplers.size());
    channel.target_node = node;
    channel.target_path = target;
    animation_.samplers.push_back(std::move(sampler));
    animation_.channels.push_back(std::move(channel));
    keys_ += static_cast<int>(kept.size());
  }

  int Keys() const { return keys_; }
  const tinygltf::Animation& Result() const { return animation_; }

 private:
  int TimesAt(const std::vector<int>& kept) {
    for (const auto& [known, accessor] : known_) {
      if (known == kept) return accessor;
    }
    const Eigen::RowVectorXf few = times_(kept);
    known_.emplace_back(kept, internal::AddWithBounds(few, TINYGLTF_TYPE_SCALAR, 0, model_));
    return known_.back().second;
  }

  const Eigen::RowVectorXf& times_;
  tinygltf::Model* const model_;
  tinygltf::Animation animation_;
  std::vector<std::pair<std::vector<int>, int>> known_;
  int keys_ = 0;
};

// The greatest distance of a point of the body from a joint, at rest.
double ReachOf(const SkinnedPath& path, int joint) {
  return std::sqrt(
      (path.rest.colwise() - path.joints[joint].pivot).colwise().squaredNorm().maxCoeff());
}

// Translation, rotation and scale of a joint over time.
void AddChannels(const SkinnedPath& path, int joint, const JointNodes& nodes,
                 const std::vector<JointPose>& poses, const Eigen::RowVectorXf& times,
                 double tolerance, Channels* channels) {
  const int count = static_cast<int>(poses.size());
  Eigen::MatrixXf translations(3, count), rotations(4, count), scales(3, count);
  for (int k = 0; k < count; ++k) {
    translations.col(k) = poses[k].translation.cast<float>();
    rotations.col(k) = poses[k].rotation.coeffs().cast<float>();
    scales.col(k) = poses[k].scale.cast<float>();
  }
  const double reach = ReachOf(path, joint);
  const auto part = [&](int first, int key, int last) {
    return static_cast<double>(times(key) - times(first)) / (times(last) - times(first));
  };
  const auto apart = [&](const auto& value) {
    return [&, value](int first, int key, int last) -> double {
      const double p = part(first, key, last);
      return ((1 - p) * value(first) + p * value(last) - value(key)).norm();
    };
  };
  const auto off_translation = apart([&](int k) { return poses[k].translation; });
  const auto off_scale = apart([&](int k) { return poses[k].scale; });
  const auto off_rotation = [&](int first, int key, int last) {
    return poses[first]
        .rotation.slerp(part(first, key, last), poses[last].rotation)
        .angularDistance(poses[key].rotation);
  };
  channels->Add(nodes.joints[joint], "translation", TINYGLTF_TYPE_VEC3, translations,
                internal::ThinnedKeys(count, tolerance, off_translation));
  channels->Add(nodes.joints[joint], "rotation", TINYGLTF_TYPE_VEC4, rotations,
                internal::ThinnedKeys(count, tolerance / reach, off_rotation));
  if (nodes.scales.empty()) return;
  channels->Add(nodes.scales[joint], "scale", TINYGLTF_TYPE_VEC3, scales,
                internal::ThinnedKeys(count, tolerance / reach, off_scale));
}

void AddSkinnedAnimation(const SkinnedPath& path, const Eigen::Vector3d& origin,
                         const JointNodes& nodes, const SkinnedGltfOptions& options,
                         tinygltf::Model* model, SkinnedGltfSummary* summary) {
  const double first = path.parameters.front(), range = path.parameters.back() - first;
  std::vector<double> shares;
  for (const double parameter : path.parameters) shares.push_back((parameter - first) / range);
  GltfOptions gltf = options.gltf;
  gltf.playback = internal::DecidePlayback(gltf.playback, path.NumShapes(), path.Skinned(0),
                                           path.Skinned(path.NumShapes() - 1));
  const auto moments = internal::PlaybackMoments(shares, path.NumShapes(), gltf);
  std::vector<double> points;
  for (const auto& [time, share] : moments) {
    // Those of the path's own shapes exactly.
    const auto own = std::lower_bound(shares.begin(), shares.end(), share);
    points.push_back(own != shares.end() && *own == share ? path.parameters[own - shares.begin()]
                                                          : first + share * range);
  }
  const Eigen::RowVectorXf times = internal::TimesOf(moments);
  const double half = (path.rest.rowwise().maxCoeff() - path.rest.rowwise().minCoeff()).norm() / 2;
  Channels channels(times, model);
  for (int b = 0; b < path.NumJoints(); ++b) {
    AddChannels(path, b, nodes, internal::PosesAt(path, b, origin, points), times,
                options.key_error * half, &channels);
  }
  summary->keys = channels.Keys();
  summary->all_keys = static_cast<int>(channels.Result().channels.size() * points.size());
  model->animations = {channels.Result()};
  model->animations[0].name = "motion";
}

}  // namespace

void SkinnedGltfOptions::Validate() const {
  gltf.Validate();
  if (gltf.colour_by_deviation) {
    throw InvalidOptions("colour_by_deviation", "cannot be shown by bones; write the path itself");
  }
  internal::CheckRange("key_error", key_error, 0.0, 0.1);
}

SkinnedGltfSummary WriteSkinnedGltf(const std::string& file, const SkinnedPath& path,
                                    const SkinnedGltfOptions& options) {
  options.Validate();
  path.Validate();
  const GltfOptions& gltf = options.gltf;
  internal::CheckCount("groups", gltf.groups.size(), path.connectivity->NumVertices(), "vertices");
  SkinnedGltfSummary summary;
  const Eigen::Vector3d origin = internal::MiddleOf(path.rest);
  const Appearance none;
  const bool grouped = gltf.groups.size() != 0;
  const Eigen::MatrixXf colours = grouped ? Eigen::MatrixXf(internal::GroupColours(gltf.groups))
                                          : internal::LinearColours(path.appearance.vertex_colours);
  tinygltf::Model model;
  const std::vector<int> source = internal::AddGltfMesh(file,
                                                        {*path.connectivity,
                                                         {path.rest},
                                                         grouped ? none : path.appearance,
                                                         colours,
                                                         gltf.allow_outside_files},
                                                        origin, &model, &summary.warnings);
  // Few readers know joints of 16 bits.
  if (path.NumJoints() <= 256) {
    AddWeights<uint8_t>(path, source, &model);
  } else {
    AddWeights<uint16_t>(path, source, &model);
  }
  const JointNodes nodes = AddNodes(path, origin, gltf, &model);
  AddSkin(path, origin, nodes, &model);
  if (path.NumShapes() > 1) AddSkinnedAnimation(path, origin, nodes, options, &model, &summary);
  tinygltf::Scene scene;
  scene.nodes = {0, 1};
  model.scenes = {scene};
  model.defaultScene = 0;
  summary.bytes =
      internal::WriteGltfModel(file,
                               {{"joints", Value(path.NumJoints())},
                                {"shapes", Value(path.NumShapes())},
                                {"provenance", Value(internal::AsUtf8(path.provenance))}},
                               &model);
  return summary;
}

}  // namespace shapespace
