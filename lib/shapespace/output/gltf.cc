#include <shapespace/output/gltf.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/internal/json.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/within_folder.h>
#include <shapespace/files/internal/tinygltf.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/surface.h>
#include <shapespace/output/detail/key_shapes.h>
#include <shapespace/output/detail/legend.h>
#include <shapespace/output/detail/materials.h>
#include <shapespace/output/detail/playback.h>
#include <shapespace/output/detail/seams.h>
#include <shapespace/output/internal/colour.h>

namespace shapespace {
namespace {

using tinygltf::Model;
using tinygltf::Value;

// More morph targets are slow in browsers, without a visible improvement.
constexpr int kMaxKeys = 32;

constexpr double kRoughness = 0.7;

// Cosines of 1 and 46 degrees. In polyhedra and folded paper most edges are either flat or sharper
// than that; in scanned animals less than a quarter, and in a tube with eight sides none.
constexpr double kBentCosine = 0.9998477, kSharpCosine = 0.6946584;

// Sizes whose squares, and a millionth of which, are representable in single precision.
constexpr double kSmallest = 1e-15, kLargest = 1e15;

// The limit of the format, with a margin for the header.
constexpr double kMaxBytes = 4.2e9;

// The largest 16-bit index for viewers; the next one has a special meaning for GPUs.
constexpr int kLargestShortIndex = 65534;

void CheckPath(const std::string& file, const Path& path) {
  try {
    path.Validate();
  } catch (const MeshError& error) {
    throw MeshError(file + ": " + error.what());
  }
}

void CheckSize(const std::string& file, const std::vector<Shape>& shapes,
               const Eigen::Vector3d& origin) {
  double size = 0;
  for (const Shape& shape : shapes) {
    const Shape arms = shape.colwise() - origin;
    size = std::max(size, arms.allFinite() ? arms.cwiseAbs().maxCoeff() : HUGE_VAL);
  }
  if (size >= kSmallest && size <= kLargest) return;
  throw MeshError(file + ": single precision cannot hold a mesh of size " +
                  nlohmann::json(size).dump() + "; choose another unit of length");
}

// Whether most of the hinges that are bent at some time are sharp at some time.
bool IsFaceted(const Connectivity& connectivity, const std::vector<Shape>& shapes) {
  const Eigen::Matrix4Xi& hinges = connectivity.Hinges();
  int bent = 0, sharp = 0;
  for (Eigen::Index h = 0; h < hinges.cols(); ++h) {
    double least_cosine = 1;
    for (const Shape& shape : shapes) {
      const auto corner = [&](int k) { return shape.col(hinges(k, h)); };
      const Eigen::Vector3d first = internal::AreaNormal(corner(0), corner(1), corner(2));
      const Eigen::Vector3d second = internal::AreaNormal(corner(1), corner(0), corner(3));
      const double areas = first.norm() * second.norm();
      if (areas > 0) least_cosine = std::min(least_cosine, first.dot(second) / areas);
    }
    bent += least_cosine < kBentCosine;
    sharp += least_cosine < kSharpCosine;
  }
  return 2 * sharp > bent;
}

// The normals of vertices without area are arbitrary unit vectors, because the format requires one.
Eigen::Matrix3Xd SmoothNormals(const Connectivity& connectivity, const Shape& shape) {
  Eigen::Matrix3Xd normals = VertexNormals(connectivity, shape);
  for (auto normal : normals.colwise()) {
    if (normal.isZero(0)) normal = Eigen::Vector3d::UnitY();
  }
  return normals;
}

Eigen::Matrix3Xf DeviationColours(const Path& path, const Shape& reference, double* scale_end) {
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

Eigen::Matrix3Xf GroupColours(const Eigen::VectorXi& groups) {
  Eigen::Matrix3Xf colours(3, groups.size());
  for (Eigen::Index v = 0; v < groups.size(); ++v)
    colours.col(v) = internal::GroupColour(groups(v));
  return colours;
}

// Converts sRGB, with opacities in a fourth row, to linear light.
Eigen::MatrixXf LinearColours(const Eigen::MatrixXd& colours) {
  Eigen::MatrixXf linear = colours.cast<float>();
  if (linear.size() > 0) linear.topRows<3>() = linear.topRows<3>().unaryExpr(&internal::ToLinear);
  return linear;
}

constexpr int ComponentType(uint16_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT; }
constexpr int ComponentType(uint32_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT; }
constexpr int ComponentType(float) { return TINYGLTF_COMPONENT_TYPE_FLOAT; }

// Appends bytes to the model's buffer and returns their view.
int AddBytes(const void* data, size_t size, int target, Model* model) {
  std::vector<unsigned char>& bytes = model->buffers[0].data;
  bytes.resize((bytes.size() + 3) / 4 * 4);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = size;
  view.target = target;
  const auto* const begin = static_cast<const unsigned char*>(data);
  bytes.insert(bytes.end(), begin, begin + size);
  model->bufferViews.push_back(view);
  return static_cast<int>(model->bufferViews.size()) - 1;
}

// Appends numbers, or vectors, to the model's buffer and returns their accessor.
template <typename Array>
int Add(const Array& array, int type, int target, Model* model) {
  using Scalar = typename Array::Scalar;
  tinygltf::Accessor accessor;
  accessor.bufferView = AddBytes(array.data(), array.size() * sizeof(Scalar), target, model);
  accessor.componentType = ComponentType(Scalar());
  accessor.type = type;
  accessor.count = array.size() / tinygltf::GetNumComponentsInType(type);
  model->accessors.push_back(accessor);
  return static_cast<int>(model->accessors.size()) - 1;
}

// The same with the bounds that the format requires for positions and times.
template <typename Array>
int AddWithBounds(const Array& array, int type, int target, Model* model) {
  const int index = Add(array, type, target, model);
  for (Eigen::Index r = 0; r < array.rows(); ++r) {
    model->accessors[index].minValues.push_back(array.row(r).minCoeff());
    model->accessors[index].maxValues.push_back(array.row(r).maxCoeff());
  }
  return index;
}

template <typename Index>
int AddIndices(const Eigen::Ref<const Eigen::VectorXi>& indices, Model* model) {
  const Eigen::Matrix<Index, Eigen::Dynamic, 1> array = indices.cast<Index>();
  return Add(array, TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, model);
}

int AddIndices(const Eigen::Ref<const Eigen::VectorXi>& indices, size_t num_vertices,
               Model* model) {
  return num_vertices <= kLargestShortIndex + 1 ? AddIndices<uint16_t>(indices, model)
                                                : AddIndices<uint32_t>(indices, model);
}

// A primitive without indices: the vertices of the first of `shapes`, with the others as morph
// targets. `source` gives the mesh's vertex of each.
tinygltf::Primitive AddVertices(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                                const Eigen::Vector3d& origin, const std::vector<int>& source,
                                Model* model) {
  const auto add_bounded = [&](const Eigen::Matrix3Xf& array) {
    const Eigen::Matrix3Xf copies = array(Eigen::all, source);
    return AddWithBounds(copies, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER, model);
  };
  const auto add = [&](const Eigen::Matrix3Xf& array) {
    const Eigen::Matrix3Xf copies = array(Eigen::all, source);
    return Add(copies, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER, model);
  };
  tinygltf::Primitive primitive;
  const bool graph = connectivity.IsGraph();
  primitive.mode = graph ? TINYGLTF_MODE_LINE : TINYGLTF_MODE_TRIANGLES;
  const Eigen::Matrix3Xf positions = (shapes[0].colwise() - origin).cast<float>();
  primitive.attributes["POSITION"] = add_bounded(positions);
  // Players use flat shading for triangles without normals.
  const bool smooth = !graph && !IsFaceted(connectivity, shapes);
  Eigen::Matrix3Xf normals;
  if (smooth) {
    normals = SmoothNormals(connectivity, shapes[0]).cast<float>();
    primitive.attributes["NORMAL"] = add(normals);
  }
  for (size_t k = 1; k < shapes.size(); ++k) {
    // Relative to the rounded first shape, so that rounding errors do not accumulate.
    const Shape arms = shapes[k].colwise() - origin;
    std::map<std::string, int> target = {
        {"POSITION", add_bounded((arms - positions.cast<double>()).cast<float>())}};
    if (smooth) {
      const Eigen::Matrix3Xd turned = SmoothNormals(connectivity, shapes[k]);
      target["NORMAL"] = add((turned - normals.cast<double>()).cast<float>());
    }
    primitive.targets.push_back(target);
  }
  return primitive;
}

// `colours` (3 or 4 rows) of the mesh's vertices.
void AddColours(const Eigen::MatrixXf& colours, const std::vector<int>& source,
                tinygltf::Primitive* primitive, Model* model) {
  const Eigen::MatrixXf copies = colours(Eigen::all, source);
  primitive->attributes["COLOR_0"] =
      Add(copies, colours.rows() == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_VEC4,
          TINYGLTF_TARGET_ARRAY_BUFFER, model);
}

// The weights of the morph targets over time. `parameters`, of the key shapes, increase from 0 to
// 1; `shapes` is the number of shapes of the whole path.
tinygltf::Animation AddAnimation(const std::vector<double>& parameters, int shapes,
                                 const GltfOptions& options, Model* model) {
  const std::vector<std::pair<double, double>> moments =
      internal::PlaybackMoments(parameters, shapes, options);
  Eigen::RowVectorXf times(moments.size());
  Eigen::MatrixXf weights = Eigen::MatrixXf::Zero(parameters.size() - 1, moments.size());
  float least = 0;
  for (size_t m = 0; m < moments.size(); ++m) {
    const auto [time, point] = moments[m];
    // Parameters may differ by less than single precision resolves, but times must increase.
    times[m] = std::max(least, static_cast<float>(time));
    least = std::nextafter(times[m], std::numeric_limits<float>::max());
    // The key shapes on both sides; the first has no target, because it is the mesh itself.
    const auto after = std::lower_bound(parameters.begin(), parameters.end(), point);
    const int key = static_cast<int>(after - parameters.begin());
    const double part = key == 0 ? 0 : (*after - point) / (*after - *(after - 1));
    if (key > 0) weights(key - 1, m) = static_cast<float>(1 - part);
    if (key > 1) weights(key - 2, m) = static_cast<float>(part);
  }

  tinygltf::AnimationSampler sampler;
  sampler.input = AddWithBounds(times, TINYGLTF_TYPE_SCALAR, 0, model);
  sampler.output = Add(weights, TINYGLTF_TYPE_SCALAR, 0, model);
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

// Transforms user's coordinates relative to `origin` to glTF's, in metres and with y up.
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

// File names in a provenance may contain any bytes; JSON may not.
std::string AsUtf8(const std::string& text) {
  return nlohmann::json::parse(internal::JsonText(nlohmann::json(text)));
}

tinygltf::Material PlainMaterial(const internal::Colour& colour) {
  tinygltf::Material material;
  material.name = "shape";
  material.doubleSided = true;
  tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
  pbr.baseColorFactor = {colour[0], colour[1], colour[2], 1};
  pbr.metallicFactor = 0;
  pbr.roughnessFactor = kRoughness;
  return material;
}

// Textures from image files in `folder` and below it, or anywhere, each of which is embedded once.
// -1, with a warning, if that fails.
class Textures {
 public:
  Textures(const std::string& folder, bool allow_outside_files, Model* model,
           std::vector<std::string>* warnings)
      : folder_(folder),
        allow_outside_files_(allow_outside_files),
        model_(model),
        warnings_(warnings) {}

  int Add(const std::string& file) {
    const auto [found, is_new] = known_.try_emplace(file, -1);
    if (is_new) found->second = AddNew(file);
    return found->second;
  }

 private:
  int AddNew(const std::string& file) {
    if (!allow_outside_files_ && !internal::IsWithinFolder(folder_, file)) {
      warnings_->push_back("texture " + file + internal::kOutsideRemedy);
      return -1;
    }
    tinygltf::Image image;
    std::string bytes;
    try {
      bytes = internal::ReadFile(file);
    } catch (const FileError& error) {
      warnings_->push_back("texture " + std::string(error.what()) + "; it is left out");
      return -1;
    }
    // The signatures of PNG and JPEG.
    if (bytes.compare(0, 8, "\x89PNG\r\n\x1a\n") == 0) {
      image.mimeType = "image/png";
    } else if (bytes.compare(0, 3, "\xff\xd8\xff") == 0) {
      image.mimeType = "image/jpeg";
    } else {
      warnings_->push_back("texture " + file +
                           ": is neither PNG nor JPEG, the formats of glTF; it is left out");
      return -1;
    }
    image.name = AsUtf8(std::filesystem::path(file).filename().string());
    image.bufferView = AddBytes(bytes.data(), bytes.size(), 0, model_);
    tinygltf::Texture texture;
    texture.source = static_cast<int>(model_->images.size());
    model_->images.push_back(image);
    model_->textures.push_back(texture);
    return static_cast<int>(model_->textures.size()) - 1;
  }

  const std::string& folder_;
  const bool allow_outside_files_;
  Model* model_;
  std::vector<std::string>* warnings_;
  std::map<std::string, int> known_;
};

tinygltf::Material MaterialFromLibrary(const std::string& name, const internal::Material& described,
                                       bool has_texture_coordinates, Textures* textures) {
  const bool textured = has_texture_coordinates && !described.texture.empty();
  const int texture = textured ? textures->Add(described.texture) : -1;
  // The colour of a material with a texture is often black or grey without meaning.
  const Eigen::Vector3d colour = texture >= 0 ? Eigen::Vector3d::Ones() : described.colour;
  tinygltf::Material material = PlainMaterial(LinearColours(colour));
  material.name = AsUtf8(name);
  material.pbrMetallicRoughness.baseColorFactor[3] = described.opacity;
  material.pbrMetallicRoughness.baseColorTexture.index = texture;
  if (described.opacity < 1) material.alphaMode = "BLEND";
  return material;
}

// Triangles, or a graph's segments, with the same material.
struct Part {
  tinygltf::Material material;
  std::vector<int> indices;
};

std::vector<Part> PartsByMaterial(const Connectivity& connectivity, const internal::CutMesh& mesh,
                                  const Appearance& appearance, const tinygltf::Material& plain,
                                  bool allow_outside_files, Textures* textures,
                                  std::vector<std::string>* warnings) {
  if (connectivity.IsGraph()) {
    Part lines = {plain, {}};
    for (const auto& [a, b] : connectivity.Segments()) {
      lines.indices.insert(lines.indices.end(), {a, b});
    }
    return {lines};
  }
  std::vector<std::vector<int>> indices(appearance.materials.names.size() + 1);  // last: of none
  const std::vector<int>& material_of = appearance.materials.of_polygon;
  const std::vector<int> polygons = internal::PolygonsOfTriangles(connectivity);
  for (size_t f = 0; f < polygons.size(); ++f) {
    const int material = material_of.empty() ? -1 : material_of[polygons[f]];
    std::vector<int>& part = material < 0 ? indices.back() : indices[material];
    for (const int vertex : mesh.triangles.col(f)) part.push_back(vertex);
  }
  const std::vector<std::optional<internal::Material>> described =
      internal::ReadMaterials(appearance, allow_outside_files, warnings);
  std::vector<Part> parts;
  for (size_t i = 0; i < indices.size(); ++i) {
    if (indices[i].empty()) continue;
    Part part = {plain, std::move(indices[i])};
    if (i < described.size()) {
      const std::string& name = appearance.materials.names[i];
      part.material.name = AsUtf8(name);
      if (described[i]) {
        part.material = MaterialFromLibrary(name, *described[i], mesh.texture.cols() > 0, textures);
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

// The mesh with one primitive and material for each part.
void AddMesh(const std::vector<Part>& parts, const tinygltf::Primitive& vertices, bool opaque,
             int num_vertices, int num_keys, Model* model) {
  tinygltf::Mesh mesh;
  mesh.name = "shape";
  for (const Part& part : parts) {
    tinygltf::Primitive primitive = vertices;
    primitive.indices =
        AddIndices(Eigen::Map<const Eigen::VectorXi>(part.indices.data(), part.indices.size()),
                   num_vertices, model);
    primitive.material = static_cast<int>(model->materials.size());
    mesh.primitives.push_back(std::move(primitive));
    model->materials.push_back(part.material);
    if (!opaque) model->materials.back().alphaMode = "BLEND";
  }
  mesh.weights.assign(num_keys - 1, 0);
  model->meshes = {mesh};
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
    return DeviationColours(path, reference, colour_end);
  }
  if (options.groups.size() != 0) return GroupColours(options.groups);
  return LinearColours(path.appearance.vertex_colours);
}

void CheckBytes(const std::string& file, double bytes, size_t num_keys) {
  if (bytes <= kMaxBytes) return;
  throw MeshError(file + ": " + std::to_string(num_keys) +
                  " shapes of so many vertices need more than the 4 GB that the format can hold; "
                  "resample the path to fewer");
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

GltfSummary WriteGltf(const std::string& file, const Path& path, const GltfOptions& options) {
  options.Validate();
  CheckPath(file, path);
  const Connectivity& connectivity = *path.metric->connectivity;
  const int num_vertices = connectivity.NumVertices();
  internal::CheckCount("reference", options.reference.cols(), num_vertices, "vertices");
  internal::CheckCount("groups", options.groups.size(), num_vertices, "vertices");
  const std::vector<int> keys = internal::KeyShapes(path.NumShapes(), path.poses, kMaxKeys);
  std::vector<Shape> shapes;
  shapes.reserve(keys.size());
  for (const int key : keys) shapes.push_back(path.Placed(key));
  const Eigen::Vector3d origin =
      (shapes[0].rowwise().minCoeff() + shapes[0].rowwise().maxCoeff()) / 2;
  CheckSize(file, shapes, origin);

  GltfSummary summary;
  summary.keys = static_cast<int>(keys.size());
  summary.subsampled = summary.keys < path.NumShapes();

  const Appearance none;
  const Appearance& appearance =
      options.colour_by_deviation || options.groups.size() != 0 ? none : path.appearance;
  const Eigen::MatrixXf colours = VertexColours(path, options, &summary.colour_end);
  const tinygltf::Material plain = PlainMaterial(
      colours.size() > 0 ? internal::Colour::Ones().eval() : internal::FromHex(internal::kPoseHex));

  Model model;
  model.buffers.emplace_back();
  const internal::CutMesh cut = internal::CutAtSeams(connectivity, appearance);
  if (!cut.texture.allFinite()) {
    throw MeshError(file + ": single precision cannot hold a texture coordinate");
  }
  Textures textures(appearance.own_folder, options.allow_outside_files, &model, &summary.warnings);
  const std::vector<Part> parts =
      PartsByMaterial(connectivity, cut, appearance, plain, options.allow_outside_files, &textures,
                      &summary.warnings);
  CheckBytes(file,
             model.buffers[0].data.size() +
                 4.0 * ((6.0 * keys.size() + 6) * cut.source.size() +
                        3.0 * std::max(connectivity.NumTriangles(), connectivity.NumEdges())),
             keys.size());

  tinygltf::Primitive vertices = AddVertices(connectivity, shapes, origin, cut.source, &model);
  if (cut.texture.cols() > 0) {
    vertices.attributes["TEXCOORD_0"] =
        Add(cut.texture, TINYGLTF_TYPE_VEC2, TINYGLTF_TARGET_ARRAY_BUFFER, &model);
  }
  if (colours.size() > 0) AddColours(colours, cut.source, &vertices, &model);
  const bool opaque = colours.rows() < 4 || (colours.row(3).array() == 1).all();
  AddMesh(parts, vertices, opaque, static_cast<int>(cut.source.size()), summary.keys, &model);
  model.nodes = {PlacedNode(origin, options)};
  if (keys.size() > 1) {
    model.animations = {AddAnimation(KeyTimes(path, keys), path.NumShapes(), options, &model)};
  }
  tinygltf::Scene scene;
  scene.nodes = {0};
  model.scenes = {scene};
  model.defaultScene = 0;

  model.asset.generator = "shapespace " SHAPESPACE_VERSION;
  Value::Object extras = {{"metric", Value(DescribeMetric(path.metric->options))},
                          {"shapes", Value(path.NumShapes())},
                          {"provenance", Value(AsUtf8(path.provenance))}};
  if (options.colour_by_deviation) extras["last_colour_deviation"] = Value(summary.colour_end);
  model.asset.extras = Value(extras);

  internal::WriteFileAtomically(file, [&](std::ostream& stream) {
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
    summary.bytes = static_cast<size_t>(stream.tellp());
  });
  return summary;
}

}  // namespace shapespace
