#include <shapespace/output/detail/gltf_mesh.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/surface.h>
#include <shapespace/output/detail/gltf_arrays.h>
#include <shapespace/output/detail/gltf_file.h>
#include <shapespace/output/detail/materials.h>
#include <shapespace/output/detail/seams.h>
#include <shapespace/output/internal/colour.h>

namespace shapespace::internal {
namespace {

using tinygltf::Model;

constexpr double kRoughness = 0.7;

// Cosines of 1 and 46 degrees. In polyhedra and folded paper most edges are either flat or sharper
// than that; in scanned animals less than a quarter, and in a tube with eight sides none.
constexpr double kBentCosine = 0.9998477, kSharpCosine = 0.6946584;

// Sizes whose squares, and a millionth of which, are representable in single precision.
constexpr double kSmallest = 1e-15, kLargest = 1e15;

// The limit of the format, with a margin for the header.
constexpr double kMaxGlbBytes = 4.2e9;

// The largest 16-bit index for viewers; the next one has a special meaning for GPUs.
constexpr int kLargestShortIndex = 65534;

void CheckSinglePrecision(const std::string& file, const std::vector<Shape>& shapes,
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
      const Eigen::Vector3d first = AreaNormal(corner(0), corner(1), corner(2));
      const Eigen::Vector3d second = AreaNormal(corner(1), corner(0), corner(3));
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

// Textures from image files, each of which is embedded once. -1, with a warning, if that fails.
class Textures {
 public:
  Textures(const GltfBody& body, Model* model, std::vector<std::string>* warnings)
      : body_(body), model_(model), warnings_(warnings) {}

  int Add(const std::string& file) {
    const auto [found, is_new] = known_.try_emplace(file, -1);
    if (is_new) found->second = AddNew(file);
    return found->second;
  }

 private:
  int AddNew(const std::string& file) {
    const std::optional<TextureImage> read =
        ReadTexture(file, body_.appearance, body_.allow_outside_files, warnings_);
    if (!read) return -1;
    tinygltf::Image image;
    image.mimeType = read->type;
    image.name = AsUtf8(std::filesystem::u8path(file).filename().u8string());
    image.bufferView = AddBytes(read->bytes.data(), read->bytes.size(), 0, model_);
    tinygltf::Texture texture;
    texture.source = static_cast<int>(model_->images.size());
    model_->images.push_back(image);
    model_->textures.push_back(texture);
    return static_cast<int>(model_->textures.size()) - 1;
  }

  const GltfBody& body_;
  Model* model_;
  std::vector<std::string>* warnings_;
  std::map<std::string, int> known_;
};

tinygltf::Material MaterialFromLibrary(const std::string& name, const Material& described,
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

std::vector<Part> PartsByMaterial(const Connectivity& connectivity, const CutMesh& mesh,
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
  std::vector<std::vector<int>> indices = CornersByMaterial(connectivity, mesh, appearance);
  const std::vector<std::optional<Material>> described =
      ReadMaterials(appearance, allow_outside_files, warnings);
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

void CheckBytes(const std::string& file, double bytes, size_t num_keys) {
  if (bytes <= kMaxGlbBytes) return;
  throw MeshError(file + ": " + std::to_string(num_keys) +
                  " shapes of so many vertices need more than the 4 GB that the format can hold; "
                  "resample the path to fewer");
}

}  // namespace

Eigen::Matrix3Xf GroupColours(const Eigen::VectorXi& groups) {
  Eigen::Matrix3Xf colours(3, groups.size());
  for (Eigen::Index v = 0; v < groups.size(); ++v) colours.col(v) = GroupColour(groups(v));
  return colours;
}

Eigen::MatrixXf LinearColours(const Eigen::MatrixXd& colours) {
  Eigen::MatrixXf linear = colours.cast<float>();
  if (linear.size() > 0) linear.topRows<3>() = linear.topRows<3>().unaryExpr(&ToLinear);
  return linear;
}

Eigen::Vector3d MiddleOf(const Shape& shape) {
  return (shape.rowwise().minCoeff() + shape.rowwise().maxCoeff()) / 2;
}

std::vector<int> AddGltfMesh(const std::string& file, const GltfBody& body,
                             const Eigen::Vector3d& origin, Model* model,
                             std::vector<std::string>* warnings) {
  CheckSinglePrecision(file, body.shapes, origin);
  const Connectivity& connectivity = body.connectivity;
  const tinygltf::Material plain =
      PlainMaterial(body.colours.size() > 0 ? Colour::Ones().eval() : FromHex(kPoseHex));
  model->buffers.emplace_back();
  const CutMesh cut = CutAtSeams(connectivity, body.appearance);
  if (!cut.texture.allFinite()) {
    throw MeshError(file + ": single precision cannot hold a texture coordinate");
  }
  Textures textures(body, model, warnings);
  const std::vector<Part> parts = PartsByMaterial(connectivity, cut, body.appearance, plain,
                                                  body.allow_outside_files, &textures, warnings);
  CheckBytes(file,
             model->buffers[0].data.size() +
                 4.0 * ((6.0 * body.shapes.size() + 6) * cut.source.size() +
                        3.0 * std::max(connectivity.NumTriangles(), connectivity.NumEdges())),
             body.shapes.size());

  tinygltf::Primitive vertices = AddVertices(connectivity, body.shapes, origin, cut.source, model);
  if (cut.texture.cols() > 0) {
    vertices.attributes["TEXCOORD_0"] =
        Add(cut.texture, TINYGLTF_TYPE_VEC2, TINYGLTF_TARGET_ARRAY_BUFFER, model);
  }
  if (body.colours.size() > 0) AddColours(body.colours, cut.source, &vertices, model);
  const bool opaque = body.colours.rows() < 4 || (body.colours.row(3).array() == 1).all();
  AddMesh(parts, vertices, opaque, static_cast<int>(cut.source.size()),
          static_cast<int>(body.shapes.size()), model);
  return cut.source;
}

}  // namespace shapespace::internal
