#include <shapespace/output/gltf.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/files/internal/tinygltf.h>
#include <shapespace/output/detail/gltf_arrays.h>
#include <shapespace/output/detail/gltf_file.h>
#include <shapespace/output/detail/gltf_mesh.h>
#include <shapespace/output/detail/key_shapes.h>
#include <shapespace/output/detail/legend.h>
#include <shapespace/output/detail/playback.h>
#include <shapespace/output/internal/colour.h>

namespace shapespace {
namespace {

using tinygltf::Model;
using tinygltf::Value;

// More morph targets are slow in browsers, without a visible improvement.
constexpr int kMaxKeys = 32;

void CheckPath(const std::string& file, const Path& path) {
  try {
    path.Validate();
  } catch (const MeshError& error) {
    throw MeshError(file + ": " + error.what());
  }
}

Eigen::Matrix3Xf LinearDeviationColours(const Path& path, const Shape& reference,
                                        double* scale_end) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(reference.cols());
  for (const Shape& shape : path.shapes) {
    largest = largest.cwiseMax(EdgeDeviation(*path.metric, reference, shape));
  }
  *scale_end = internal::EndOfScale({largest});
  Eigen::Matrix3Xf colours(3, largest.size());
  for (Eigen::Index v = 0; v < largest.size(); ++v) {
    colours.col(v) =
        internal::ValueColour(static_cast<float>(std::min(1.0, largest[v] / *scale_end)));
  }
  return colours;
}

// The weights of the morph targets over time. `parameters`, of the key shapes, increase from 0 to
// 1; `shapes` is the number of shapes of the whole path.
tinygltf::Animation AddAnimation(const std::vector<double>& parameters, int shapes,
                                 const GltfOptions& options, Model* model) {
  const std::vector<std::pair<double, double>> moments =
      internal::PlaybackMoments(parameters, shapes, options);
  Eigen::MatrixXf weights = Eigen::MatrixXf::Zero(parameters.size() - 1, moments.size());
  for (size_t m = 0; m < moments.size(); ++m) {
    const double point = moments[m].second;
    // The key shapes on both sides; the first has no target, because it is the mesh itself.
    const auto after = std::lower_bound(parameters.begin(), parameters.end(), point);
    const int key = static_cast<int>(after - parameters.begin());
    const double part = key == 0 ? 0 : (*after - point) / (*after - *(after - 1));
    if (key > 0) weights(key - 1, m) = static_cast<float>(1 - part);
    if (key > 1) weights(key - 2, m) = static_cast<float>(part);
  }

  tinygltf::AnimationSampler sampler;
  sampler.input =
      internal::AddWithBounds(internal::TimesOf(moments), TINYGLTF_TYPE_SCALAR, 0, model);
  sampler.output = internal::Add(weights, TINYGLTF_TYPE_SCALAR, 0, model);
  sampler.interpolation = "LINEAR";
  tinygltf::AnimationChannel channel;
  channel.sampler = 0;
  channel.target_node = 0;
  channel.target_path = "weights";
  tinygltf::Animation animation;
  animation.name = options.playback == GltfPlayback::kThereAndBack ? "there and back" : "there";
  animation.samplers = {sampler};
  animation.channels = {channel};
  return animation;
}

// The times of the keys, from 0 to 1.
std::vector<double> KeyTimes(const Path& path, const std::vector<int>& keys) {
  std::vector<double> times;
  times.reserve(keys.size());
  const double first = path.parameters.front(), last = path.parameters.back();
  for (const int key : keys) times.push_back((path.parameters[key] - first) / (last - first));
  return times;
}

// Red, green, blue (and opacity) of each vertex; none if they have no colours of their own.
Eigen::MatrixXf VertexColours(const Path& path, const GltfOptions& options, double* colour_end) {
  if (options.colour_by_deviation) {
    const Shape& reference = options.reference.cols() > 0 ? options.reference : path.shapes[0];
    return LinearDeviationColours(path, reference, colour_end);
  }
  if (options.groups.size() != 0) return internal::GroupColours(options.groups);
  return internal::LinearColours(path.appearance.vertex_colours);
}

}  // namespace

void GltfOptions::Validate() const {
  internal::CheckRange("duration", duration, 0.1, 3600.0);
  if (fps != 0) internal::CheckRange("fps", fps, 0.01, 1000.0);
  if (up != 'y' && up != 'z') {
    throw InvalidOptions("up", std::string("'") + up + "' is neither 'y' nor 'z'");
  }
  internal::CheckRange("unit", unit, 1e-12, 1e12);
  if (colour_by_deviation && groups.size() != 0) {
    throw InvalidOptions("groups", "not together with colour_by_deviation");
  }
}

GltfSummary WriteGltf(const std::string& file, const Path& path, const GltfOptions& given) {
  given.Validate();
  CheckPath(file, path);
  GltfOptions options = given;
  const Connectivity& connectivity = *path.metric->connectivity;
  const int num_vertices = connectivity.NumVertices();
  internal::CheckCount("reference", options.reference.cols(), num_vertices, "vertices");
  internal::CheckCount("groups", options.groups.size(), num_vertices, "vertices");
  const std::vector<int> keys = internal::KeyShapes(path.NumShapes(), path.poses, kMaxKeys);
  std::vector<Shape> shapes;
  shapes.reserve(keys.size());
  for (const int key : keys) shapes.push_back(path.Placed(key));
  options.playback =
      internal::DecidePlayback(given.playback, path.NumShapes(), shapes.front(), shapes.back());
  const Eigen::Vector3d origin = internal::MiddleOf(shapes[0]);

  GltfSummary summary;
  summary.keys = static_cast<int>(keys.size());
  summary.subsampled = summary.keys < path.NumShapes();

  const Appearance none;
  const Appearance& appearance =
      options.colour_by_deviation || options.groups.size() != 0 ? none : path.appearance;
  const Eigen::MatrixXf colours = VertexColours(path, options, &summary.colour_end);
  Model model;
  internal::AddGltfMesh(file,
                        {connectivity, shapes, appearance, colours, options.allow_outside_files},
                        origin, &model, &summary.warnings);
  model.nodes = {internal::PlacedNode(origin, options)};
  if (keys.size() > 1) {
    model.animations = {AddAnimation(KeyTimes(path, keys), path.NumShapes(), options, &model)};
  }
  tinygltf::Scene scene;
  scene.nodes = {0};
  model.scenes = {scene};
  model.defaultScene = 0;

  Value::Object extras = {{"metric", Value(DescribeMetric(path.metric->options))},
                          {"shapes", Value(path.NumShapes())},
                          {"provenance", Value(internal::AsUtf8(path.provenance))}};
  if (options.colour_by_deviation) extras["last_colour_deviation"] = Value(summary.colour_end);
  summary.bytes = internal::WriteGltfModel(file, extras, &model);
  return summary;
}

}  // namespace shapespace
