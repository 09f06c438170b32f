#include <shapespace/output/gltf.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/base/atomic_file.h>
#include <shapespace/base/error.h>
#include <shapespace/output/colour.h>
#include <shapespace/output/key_shapes.h>
#include <shapespace/output/legend.h>
#include <shapespace/output/tinygltf.h>
#include <shapespace/path/quality.h>

namespace shapespace {
namespace {

using tinygltf::Model;
using tinygltf::Value;

// More morph targets are slow in browsers, and no smoother to see.
constexpr int kMostKeys = 32;

// The share of the duration for which the shapes rest, at either end, so that the poses are seen.
constexpr double kRest = 0.1;

constexpr double kRoughness = 0.7;

// Cosines of 1 and 46 degrees. Of polyhedra and folded paper most edges are either flat or sharper
// than that; of scanned animals under a quarter is, and of a tube with eight sides none.
constexpr double kBentCosine = 0.9998477, kSharpCosine = 0.6946584;

// Sizes whose squares, and a millionth of which, are still numbers of single precision.
constexpr double kSmallest = 1e-15, kLargest = 1e15;

// What the format can count, less plenty for the header.
constexpr double kMostBytes = 4.2e9;

// The largest index that viewers with 16 bits draw; the next one means something else to GPUs.
constexpr int kLargestShortIndex = 65534;

void CheckRange(const char* field, double value, double least, double most) {
  if (value >= least && value <= most) return;
  nlohmann::json range = {value, least, most};
  throw InvalidOptions(std::string(field) + ": " + range[0].dump() + " is not in " +
                       range[1].dump() + " .. " + range[2].dump());
}

void CheckPath(const std::string& file, const Path& path) {
  if (path.shapes.empty()) throw MeshError(file + ": the path has no shape");
  const size_t count = path.shapes.size();
  if (path.parameters.size() != count || path.motions.size() != count) {
    throw MeshError(file + ": the path needs a parameter and a motion for each of its " +
                    std::to_string(count) + " shapes");
  }
  for (const int pose : path.poses) {
    if (pose < 0 || pose >= path.NumShapes()) {
      throw MeshError(file + ": the path's pose " + std::to_string(pose) + " is none of its " +
                      std::to_string(count) + " shapes");
    }
  }
  for (size_t i = 0; i < count; ++i) {
    if (i > 0 && !(path.parameters[i] > path.parameters[i - 1])) {
      throw MeshError(file + ": the path's parameters do not rise at shape " + std::to_string(i));
    }
    if (path.shapes[i].cols() != path.metric->connectivity->NumVertices()) {
      throw MeshError(file + ": shape " + std::to_string(i) + " has " +
                      std::to_string(path.shapes[i].cols()) + " vertices, its connectivity " +
                      std::to_string(path.metric->connectivity->NumVertices()));
    }
  }
}

// The shapes with indices `keys` as placed, all others only looked at.
std::vector<Shape> PlacedKeys(const std::string& file, const Path& path,
                              const std::vector<int>& keys) {
  std::vector<Shape> placed;
  for (int i = 0; i < path.NumShapes(); ++i) {
    Shape shape = path.Placed(i);
    for (Eigen::Index v = 0; v < shape.cols(); ++v) {
      if (!shape.col(v).allFinite()) {
        throw MeshError(file + ": shape " + std::to_string(i) + ": vertex " + std::to_string(v) +
                        " is not finite");
      }
    }
    if (keys[placed.size()] == i) placed.push_back(std::move(shape));
  }
  return placed;
}

void CheckSize(const std::string& file, const std::vector<Shape>& shapes,
               const Eigen::Vector3d& origin) {
  double size = 0;
  for (const Shape& shape : shapes) {
    size = std::max(size, (shape.colwise() - origin).cwiseAbs().maxCoeff());
  }
  if (size >= kSmallest && size <= kLargest) return;
  throw MeshError(file + ": single precision cannot hold a mesh of size " +
                  nlohmann::json(size).dump() + "; choose another unit of length");
}

Eigen::Vector3d TriangleNormal(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c) {
  return (b - a).cross(c - a);
}

// Whether most of the hinges that are not flat all the time are sharp at some time.
bool IsFaceted(const Connectivity& connectivity, const std::vector<Shape>& shapes) {
  const Eigen::Matrix4Xi& hinges = connectivity.Hinges();
  int bent = 0, sharp = 0;
  for (Eigen::Index h = 0; h < hinges.cols(); ++h) {
    double least_cosine = 1;
    for (const Shape& shape : shapes) {
      const auto corner = [&](int k) { return shape.col(hinges(k, h)); };
      const Eigen::Vector3d first = TriangleNormal(corner(0), corner(1), corner(2));
      const Eigen::Vector3d second = TriangleNormal(corner(1), corner(0), corner(3));
      const double areas = first.norm() * second.norm();
      if (areas > 0) least_cosine = std::min(least_cosine, first.dot(second) / areas);
    }
    bent += least_cosine < kBentCosine;
    sharp += least_cosine < kSharpCosine;
  }
  return 2 * sharp > bent;
}

Eigen::Matrix3Xd SmoothNormals(const Connectivity& connectivity, const Shape& shape) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, shape.cols());
  for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
    const auto corner = [&](int k) { return shape.col(triangles(k, f)); };
    const Eigen::Vector3d normal = TriangleNormal(corner(0), corner(1), corner(2));
    for (int k = 0; k < 3; ++k) normals.col(triangles(k, f)) += normal;
  }
  for (Eigen::Index v = 0; v < normals.cols(); ++v) {
    // Where no triangle has an area any unit vector will do; the format allows no other.
    const double length = normals.col(v).stableNorm();
    normals.col(v) =
        length > 0 ? Eigen::Vector3d(normals.col(v) / length) : Eigen::Vector3d::UnitY();
  }
  return normals;
}

Eigen::Matrix3Xf DeviationColours(const Path& path, const Shape& reference, double* scale_end) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(reference.cols());
  for (const Shape& shape : path.shapes) {
    largest = largest.cwiseMax(EdgeDeviation(*path.metric, reference, shape));
  }
  *scale_end = EndOfScale({largest});
  Eigen::Matrix3Xf colours(3, largest.size());
  for (Eigen::Index v = 0; v < largest.size(); ++v) {
    colours.col(v) = ValueColour(static_cast<float>(std::min(1.0, largest[v] / *scale_end)));
  }
  return colours;
}

Eigen::Matrix3Xf GroupColours(const Eigen::VectorXi& groups) {
  Eigen::Matrix3Xf colours(3, groups.size());
  for (Eigen::Index v = 0; v < groups.size(); ++v) colours.col(v) = GroupColour(groups(v));
  return colours;
}

constexpr int ComponentType(uint16_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT; }
constexpr int ComponentType(uint32_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT; }
constexpr int ComponentType(float) { return TINYGLTF_COMPONENT_TYPE_FLOAT; }

// Appends numbers, or columns of three, to the model's buffer. Returns their accessor.
template <typename Array>
int Add(const Array& array, int target, Model* model) {
  using Scalar = typename Array::Scalar;
  constexpr bool kVectors = Array::RowsAtCompileTime == 3;
  std::vector<unsigned char>& bytes = model->buffers[0].data;
  bytes.resize((bytes.size() + 3) / 4 * 4);

  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = array.size() * sizeof(Scalar);
  view.target = target;
  const auto* const data = reinterpret_cast<const unsigned char*>(array.data());
  bytes.insert(bytes.end(), data, data + view.byteLength);

  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model->bufferViews.size());
  accessor.componentType = ComponentType(Scalar());
  accessor.type = kVectors ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR;
  accessor.count = kVectors ? array.cols() : array.size();
  model->bufferViews.push_back(view);
  model->accessors.push_back(accessor);
  return static_cast<int>(model->accessors.size()) - 1;
}

// The same with the bounds that the format asks for of positions and times.
template <typename Array>
int AddWithBounds(const Array& array, int target, Model* model) {
  const int index = Add(array, target, model);
  for (Eigen::Index r = 0; r < array.rows(); ++r) {
    model->accessors[index].minValues.push_back(array.row(r).minCoeff());
    model->accessors[index].maxValues.push_back(array.row(r).maxCoeff());
  }
  return index;
}

template <typename Index>
int AddIndices(const Eigen::Ref<const Eigen::VectorXi>& indices, Model* model) {
  const Eigen::Matrix<Index, Eigen::Dynamic, 1> array = indices.cast<Index>();
  return Add(array, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, model);
}

// The first shape of `shapes` with the others as morph targets.
tinygltf::Primitive AddPrimitive(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                                 const Eigen::Vector3d& origin, Model* model) {
  constexpr int kTarget = TINYGLTF_TARGET_ARRAY_BUFFER;
  tinygltf::Primitive primitive;
  const bool graph = connectivity.IsGraph();
  primitive.mode = graph ? TINYGLTF_MODE_LINE : TINYGLTF_MODE_TRIANGLES;
  const int* const data = graph ? connectivity.Edges().data() : connectivity.Triangles().data();
  const Eigen::Index count = graph ? connectivity.Edges().size() : connectivity.Triangles().size();
  const Eigen::Map<const Eigen::VectorXi> indices(data, count);
  primitive.indices = connectivity.NumVertices() - 1 <= kLargestShortIndex
                          ? AddIndices<uint16_t>(indices, model)
                          : AddIndices<uint32_t>(indices, model);

  const Eigen::Matrix3Xf positions = (shapes[0].colwise() - origin).cast<float>();
  primitive.attributes["POSITION"] = AddWithBounds(positions, kTarget, model);
  // Players give triangles without normals flat shading.
  const bool smooth = !graph && !IsFaceted(connectivity, shapes);
  Eigen::Matrix3Xf normals;
  if (smooth) {
    normals = SmoothNormals(connectivity, shapes[0]).cast<float>();
    primitive.attributes["NORMAL"] = Add(normals, kTarget, model);
  }
  for (size_t k = 1; k < shapes.size(); ++k) {
    // From the rounded first shape, so that rounding errors do not add up.
    const Eigen::Matrix3Xf move =
        ((shapes[k].colwise() - origin) - positions.cast<double>()).cast<float>();
    std::map<std::string, int> target = {{"POSITION", AddWithBounds(move, kTarget, model)}};
    if (smooth) {
      const Eigen::Matrix3Xf turn =
          (SmoothNormals(connectivity, shapes[k]) - normals.cast<double>()).cast<float>();
      target["NORMAL"] = Add(turn, kTarget, model);
    }
    primitive.targets.push_back(target);
  }
  return primitive;
}

// Key shape by key shape with a rest at either end, and back. `parameters` rise from 0 to 1.
tinygltf::Animation AddAnimation(const std::vector<double>& parameters, double duration,
                                 Model* model) {
  const int count = static_cast<int>(parameters.size());
  const double rest = kRest * duration;
  std::vector<std::pair<double, int>> samples = {{0, 0}};  // when which key is seen
  for (int k = 0; k < count; ++k) {
    samples.emplace_back(rest / 2 + parameters[k] * (duration / 2 - rest), k);
  }
  for (int k = count - 1; k >= 0; --k) samples.emplace_back(duration - samples[k + 1].first, k);
  samples.emplace_back(duration, 0);

  Eigen::RowVectorXf times(samples.size());
  Eigen::MatrixXf weights = Eigen::MatrixXf::Zero(count - 1, samples.size());
  float least = 0;
  for (size_t s = 0; s < samples.size(); ++s) {
    // Parameters may be closer together than single precision tells, but times must rise.
    times[s] = std::max(least, static_cast<float>(samples[s].first));
    least = std::nextafter(times[s], std::numeric_limits<float>::max());
    if (samples[s].second > 0) weights(samples[s].second - 1, s) = 1;
  }

  tinygltf::AnimationSampler sampler;
  sampler.input = AddWithBounds(times, 0, model);
  sampler.output = Add(weights, 0, model);
  sampler.interpolation = "LINEAR";
  tinygltf::AnimationChannel channel;
  channel.sampler = 0;
  channel.target_node = 0;
  channel.target_path = "weights";
  tinygltf::Animation animation;
  animation.name = "there and back";
  animation.samplers = {sampler};
  animation.channels = {channel};
  return animation;
}

// Carries user's coordinates less `origin` to glTF's, in metres and with y up.
tinygltf::Node PlacedNode(const Eigen::Vector3d& origin, const GltfOptions& options) {
  tinygltf::Node node;
  node.name = "shape";
  node.mesh = 0;
  Eigen::Vector3d place = options.unit * origin;
  if (options.up == 'z') {
    place = Eigen::Vector3d(place.x(), place.z(), -place.y());
    node.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  }
  node.translation = {place.x(), place.y(), place.z()};
  if (options.unit != 1) node.scale = {options.unit, options.unit, options.unit};
  return node;
}

tinygltf::Material PlainMaterial(const Colour& colour) {
  tinygltf::Material material;
  material.name = "shape";
  material.doubleSided = true;
  tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
  pbr.baseColorFactor = {colour[0], colour[1], colour[2], 1};
  pbr.metallicFactor = 0;
  pbr.roughnessFactor = kRoughness;
  return material;
}

// File names in a provenance may hold any bytes; JSON may not.
std::string AsUtf8(const std::string& text) {
  using Json = nlohmann::json;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

void GltfOptions::Validate() const {
  CheckRange("duration", duration, 0.1, 3600);
  if (up != 'y' && up != 'z') {
    throw InvalidOptions(std::string("up: '") + up + "' is neither 'y' nor 'z'");
  }
  CheckRange("unit", unit, 1e-12, 1e12);
  if (colour_by_deviation && groups.size() != 0) {
    throw InvalidOptions("groups: not together with colour_by_deviation");
  }
}

GltfSummary WriteGltf(const std::string& file, const Path& path, const GltfOptions& options) {
  options.Validate();
  CheckPath(file, path);
  const Connectivity& connectivity = *path.metric->connectivity;
  const std::vector<int> keys = KeyShapes(path.NumShapes(), path.poses, kMostKeys);
  const double bytes = 4.0 * (6.0 * connectivity.NumVertices() * keys.size() +
                              3.0 * std::max(connectivity.NumTriangles(), connectivity.NumEdges()));
  if (bytes > kMostBytes) {
    throw MeshError(file + ": " + std::to_string(keys.size()) +
                    " shapes of so many vertices need more than the 4 GB that the format can "
                    "hold; resample the path to fewer");
  }
  const bool by_group = options.groups.size() != 0;
  const auto check_count = [&](const char* field, Eigen::Index count) {
    if (count != 0 && count != connectivity.NumVertices()) {
      throw InvalidOptions(std::string(field) + ": given for " + std::to_string(count) +
                           " vertices, but there are " +
                           std::to_string(connectivity.NumVertices()));
    }
  };
  check_count("reference", options.reference.cols());
  check_count("groups", options.groups.size());
  const std::vector<Shape> shapes = PlacedKeys(file, path, keys);
  const Eigen::Vector3d origin =
      (shapes[0].rowwise().minCoeff() + shapes[0].rowwise().maxCoeff()) / 2;
  CheckSize(file, shapes, origin);

  GltfSummary summary;
  summary.keys = static_cast<int>(keys.size());
  summary.subsampled = summary.keys < path.NumShapes();

  Model model;
  model.buffers.emplace_back();
  tinygltf::Primitive primitive = AddPrimitive(connectivity, shapes, origin, &model);
  primitive.material = 0;
  if (options.colour_by_deviation) {
    const Shape& reference = options.reference.cols() > 0 ? options.reference : path.shapes[0];
    const Eigen::Matrix3Xf colours = DeviationColours(path, reference, &summary.colour_end);
    primitive.attributes["COLOR_0"] = Add(colours, TINYGLTF_TARGET_ARRAY_BUFFER, &model);
  } else if (by_group) {
    primitive.attributes["COLOR_0"] =
        Add(GroupColours(options.groups), TINYGLTF_TARGET_ARRAY_BUFFER, &model);
  }
  model.materials = {PlainMaterial(options.colour_by_deviation || by_group ? Colour::Ones().eval()
                                                                           : FromHex(kPoseHex))};
  tinygltf::Mesh mesh;
  mesh.name = "shape";
  mesh.primitives = {primitive};
  mesh.weights.assign(keys.size() - 1, 0);
  model.meshes = {mesh};
  model.nodes = {PlacedNode(origin, options)};
  if (keys.size() > 1) {
    std::vector<double> parameters;
    const double first = path.parameters.front(), last = path.parameters.back();
    for (const int key : keys)
      parameters.push_back((path.parameters[key] - first) / (last - first));
    model.animations = {AddAnimation(parameters, options.duration, &model)};
  }
  tinygltf::Scene scene;
  scene.nodes = {0};
  model.scenes = {scene};
  model.defaultScene = 0;

  model.asset.generator = "shapespace " SHAPESPACE_VERSION;
  Value::Object extras = {{"metric", Value(Describe(path.metric->options))},
                          {"shapes", Value(path.NumShapes())},
                          {"provenance", Value(AsUtf8(path.provenance))}};
  if (options.colour_by_deviation) extras["last_colour_deviation"] = Value(summary.colour_end);
  model.asset.extras = Value(extras);

  WriteFileAtomically(file, [&](std::ostream& stream) {
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
    summary.bytes = static_cast<size_t>(stream.tellp());
  });
  return summary;
}

}  // namespace shapespace
