#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/base/internal/within_folder.h>
#include <shapespace/files/detail/merge.h>
#include <shapespace/files/detail/read_formats.h>
#include <shapespace/files/internal/tinygltf.h>

namespace shapespace::internal {
namespace {

using tinygltf::Accessor;
using tinygltf::Model;
using tinygltf::Node;
using tinygltf::Primitive;
using Json = nlohmann::json;

// Objects and lists within each other. Exporters need ten; TinyGLTF calls itself for each, and the
// stack holds some ten thousand.
constexpr int kDeepest = 100;

// Vertices and corners, of all poses together, for which there is always memory, and how many more
// every byte of the file allows. A pose that is written in full has less than one a byte; files of
// hundreds of poses, each of which moves a small part of the mesh, have up to thirty.
constexpr double kAlwaysAllowed = 5e7, kAllowedPerByte = 100;

// Allows positions, and displacements of targets, in integers of one or two bytes, which the node
// scales and moves to their places:
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_mesh_quantization
constexpr char kQuantization[] = "KHR_mesh_quantization";

constexpr std::int64_t kMaxBytesOfBuffers = std::numeric_limits<int>::max();

bool IsGlb(const std::string& bytes) { return bytes.compare(0, 4, "glTF") == 0; }

// The part of the file that is text; empty if it is cut off.
std::string_view TextOf(const std::string& bytes) {
  constexpr size_t kHeader = 20, kLength = 12;
  if (!IsGlb(bytes)) return bytes;
  if (bytes.size() < kHeader) return {};
  const size_t length = ReadLittleEndian<std::uint32_t>(bytes.data() + kLength);
  return std::string_view(bytes).substr(kHeader, length);
}

// TinyGLTF 2.9 asks for the size of a file first, and demands that all callbacks are set; 2.7 has
// no callback for the size. Any size will do, because BufferFiles has a limit of its own.
template <typename Callbacks>
auto AcceptAnySize(Callbacks* callbacks) -> decltype(callbacks->GetFileSizeInBytes, void()) {
  callbacks->GetFileSizeInBytes = [](size_t* size, std::string*, const std::string&, void*) {
    *size = 0;
    return true;
  };
}
inline void AcceptAnySize(...) {}

// Reads buffers that are files of their own, for TinyGLTF.
class BufferFiles {
 public:
  BufferFiles(const std::string& folder, bool allow_outside_files)
      : folder_(folder), allow_outside_files_(allow_outside_files) {}

  tinygltf::FsCallbacks Callbacks() {
    tinygltf::FsCallbacks callbacks;
    callbacks.FileExists = [](const std::string&, void*) { return true; };
    callbacks.ExpandFilePath = [](const std::string& file, void*) { return file; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string*,
                                 const std::string& file, void* self) {
      *bytes = static_cast<BufferFiles*>(self)->Read(file);
      return true;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&,
                                  const std::vector<unsigned char>&, void*) { return false; };
    AcceptAnySize(&callbacks);
    callbacks.user_data = this;
    return callbacks;
  }

 private:
  std::vector<unsigned char> Read(const std::string& file) {
    if (!allow_outside_files_ && !IsWithinFolder(folder_, file)) {
      throw FileError(file + kOutsideRemedy);
    }
    const std::string bytes = ReadFile(file, bytes_left_);
    bytes_left_ -= static_cast<std::int64_t>(bytes.size());
    return {bytes.begin(), bytes.end()};
  }

  const std::string& folder_;
  const bool allow_outside_files_;
  std::int64_t bytes_left_ = kMaxBytesOfBuffers;  // of all buffers together
};

class GltfReader {
 public:
  GltfReader(const std::string& file, const std::string& bytes, bool allow_outside_files)
      : file_(file) {
    CheckText(TextOf(bytes));
    Parse(bytes, allow_outside_files);
    num_bytes_ = static_cast<double>(bytes.size());
    for (const tinygltf::Buffer& buffer : model_.buffers) num_bytes_ += buffer.data.size();
  }

  std::vector<Soup> Read() {
    const int node = MeshNode();
    const tinygltf::Mesh& mesh = At(model_.meshes, model_.nodes[node].mesh, "mesh");
    CountElements(mesh);
    for (const Primitive& primitive : mesh.primitives) AddPrimitive(primitive);
    if (NumVertices() == 0) Fail("the mesh has no vertices");
    skinned_ = model_.nodes[node].skin >= 0;
    // Vertices of a skinned mesh are placed by its skeleton, not by its node.
    return Soups(skinned_ ? Eigen::Affine3d::Identity() : Placement(node), Names(mesh));
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { FailAt(file_, 0, what); }

  // Refuses what TinyGLTF would take without limits.
  void CheckText(std::string_view text) const {
    const auto watch = [this](int depth, Json::parse_event_t, Json&) {
      if (depth > kDeepest) {
        Fail("its lists and objects are nested more than " + std::to_string(kDeepest) + " deep" +
             kReexport);
      }
      return true;
    };
    // What is not valid JSON is reported later.
    const Json json = Json::parse(text.begin(), text.end(), watch, /*allow_exceptions=*/false);
    if (!json.is_object() || !json.contains("buffers")) return;
    int unnamed = 0;
    for (const Json& buffer : json["buffers"]) {
      unnamed += buffer.is_object() && !buffer.contains("uri");
    }
    // Each would be a copy of the binary part.
    if (unnamed > 1) Fail(std::string("has more than one buffer without a file") + kReexport);
  }

  void Parse(const std::string& bytes, bool allow_outside_files) {
    tinygltf::TinyGLTF library;
    // Images are not needed.
    library.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                              const unsigned char*, int, void*) { return true; },
                           nullptr);
    const std::string folder = std::filesystem::u8path(file_).parent_path().u8string();
    BufferFiles files(folder, allow_outside_files);
    library.SetFsCallbacks(files.Callbacks());
    const auto size = static_cast<unsigned>(bytes.size());
    std::string error, warning;
    bool read = false;
    try {
      read =
          IsGlb(bytes)
              ? library.LoadBinaryFromMemory(&model_, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()),
                                             size, folder)
              : library.LoadASCIIFromString(&model_, &error, &warning, bytes.data(), size, folder);
    } catch (const FileError& exception) {
      Fail(std::string("its buffer ") + exception.what());
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& exception) {
      error += exception.what();
    }
    if (!read) {
      Fail("is not valid glTF 2.0: " + error.substr(0, error.find_last_not_of("\r\n") + 1) +
           kReexport);
    }
    for (const std::string& extension : model_.extensionsRequired) {
      // Those that compress positions.
      if (extension.find("mesh") != extension.npos && extension != kQuantization) {
        Fail("needs the extension " + extension +
             ", which is not read; export the file without compression");
      }
    }
    for (const auto* extensions : {&model_.extensionsRequired, &model_.extensionsUsed}) {
      quantized_ =
          quantized_ || std::count(extensions->begin(), extensions->end(), kQuantization) > 0;
    }
  }

  template <typename T>
  const T& At(const std::vector<T>& items, int index, const char* what) const {
    if (index < 0 || static_cast<size_t>(index) >= items.size()) {
      Fail(std::string("refers to a ") + what + " that does not exist" + kReexport);
    }
    return items[index];
  }

  // The one node that has a mesh.
  int MeshNode() const {
    std::vector<int> found;
    std::string names;
    for (size_t i = 0; i < model_.nodes.size(); ++i) {
      if (model_.nodes[i].mesh < 0) continue;
      found.push_back(static_cast<int>(i));
      names += (names.empty() ? "" : ", ") + Quoted(model_.nodes[i].name);
    }
    if (found.empty()) Fail("has no mesh");
    if (found.size() > 1) {
      Fail("has " + std::to_string(found.size()) + " meshes, " + names +
           "; join them, or export the one that is meant");
    }
    return found[0];
  }

  Eigen::Affine3d OwnPlacement(const Node& node) const {
    Eigen::Affine3d placement = Eigen::Affine3d::Identity();
    if (node.matrix.size() == 16) {
      placement.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    } else {
      if (node.translation.size() == 3) {
        placement.translate(Eigen::Map<const Eigen::Vector3d>(node.translation.data()));
      }
      if (node.rotation.size() == 4) {
        const Eigen::Map<const Eigen::Vector4d> coefficients(node.rotation.data());
        placement.rotate(Eigen::Quaterniond(coefficients.stableNormalized()));
      }
      if (node.scale.size() == 3) {
        placement.scale(Eigen::Map<const Eigen::Vector3d>(node.scale.data()).eval());
      }
    }
    if (!placement.matrix().allFinite()) {
      Fail("node " + Quoted(node.name) + ": its transformation is not finite" + kReexport);
    }
    return placement;
  }

  // From the mesh's coordinates to those of the scene.
  Eigen::Affine3d Placement(int node) const {
    std::vector<int> parent(model_.nodes.size(), -1);
    for (size_t i = 0; i < model_.nodes.size(); ++i) {
      for (const int child : model_.nodes[i].children) {
        At(model_.nodes, child, "node");
        parent[child] = static_cast<int>(i);
      }
    }
    Eigen::Affine3d placement = Eigen::Affine3d::Identity();
    size_t steps = 0;
    for (int i = node; i >= 0; i = parent[i]) {
      if (++steps > parent.size()) Fail(std::string("a node is its own parent") + kReexport);
      placement = OwnPlacement(model_.nodes[i]) * placement;
    }
    return placement;
  }

  // Where an element of an accessor's numbers, of `size` bytes each, is stored.
  // \throw FileError if not all `count` of them lie in the buffer.
  std::pair<const unsigned char*, size_t> Elements(int view_index, size_t offset, size_t size,
                                                   size_t count) const {
    const tinygltf::BufferView& view = At(model_.bufferViews, view_index, "buffer view");
    const std::vector<unsigned char>& data = At(model_.buffers, view.buffer, "buffer").data;
    const size_t stride = view.byteStride > 0 ? view.byteStride : size;
    const size_t length = view.byteLength;
    const bool fits =
        view.byteOffset <= data.size() && length <= data.size() - view.byteOffset &&
        offset <= length &&
        (count == 0 || (length - offset >= size && (length - offset - size) / stride >= count - 1));
    if (!fits) Fail(std::string("a list of numbers is longer than its bytes") + kReexport);
    return {data.data() + view.byteOffset + offset, stride};
  }

  // Whether positions may be of this type of numbers.
  bool IsPositionType(int component_type) const {
    switch (component_type) {
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return true;
      case TINYGLTF_COMPONENT_TYPE_BYTE:
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      case TINYGLTF_COMPONENT_TYPE_SHORT:
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return quantized_;
      default:
        return false;
    }
  }

  // One of these numbers. If normalised, the greatest integer stands for 1, and the least of those
  // with a sign, which is one less than minus the greatest, for -1.
  static double Component(const char* bytes, int component_type, bool normalized) {
    const auto scaled = [normalized](double number, double greatest) {
      return normalized ? std::max(number / greatest, -1.0) : number;
    };
    switch (component_type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return scaled(ReadLittleEndian<std::int8_t>(bytes), 127);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return scaled(ReadLittleEndian<std::uint8_t>(bytes), 255);
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return scaled(ReadLittleEndian<std::int16_t>(bytes), 32767);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return scaled(ReadLittleEndian<std::uint16_t>(bytes), 65535);
      default:
        return ReadLittleEndian<float>(bytes);
    }
  }

  // The numbers of an accessor of `count` vertices, one column each.
  Eigen::MatrixXd Numbers(const Accessor& accessor, int type, size_t count,
                          const char* what) const {
    if (!IsPositionType(accessor.componentType) || accessor.type != type) {
      Fail(std::string(what) + " are not floating-point numbers; export them without compression");
    }
    const int rows = tinygltf::GetNumComponentsInType(type);
    const int component_size = tinygltf::GetComponentSizeInBytes(accessor.componentType);
    const auto size = static_cast<size_t>(rows) * component_size;
    if (accessor.count != count) {
      Fail(std::string(what) + " are not as many as the vertices" + kReexport);
    }
    const auto read = [&, rows](const unsigned char* bytes, double* numbers) {
      for (int row = 0; row < rows; ++row) {
        numbers[row] = Component(reinterpret_cast<const char*>(bytes + row * component_size),
                                 accessor.componentType, accessor.normalized);
      }
    };
    // Without a buffer view all numbers are 0, but for the sparse ones.
    Eigen::MatrixXd numbers;
    if (accessor.bufferView >= 0) {
      const auto [begin, stride] = Elements(accessor.bufferView, accessor.byteOffset, size, count);
      numbers.resize(rows, static_cast<Eigen::Index>(count));
      for (size_t i = 0; i < count; ++i) {
        read(begin + i * stride, numbers.col(static_cast<Eigen::Index>(i)).data());
      }
    } else {
      numbers.setZero(rows, static_cast<Eigen::Index>(count));
    }
    if (accessor.sparse.isSparse) {
      const auto& sparse = accessor.sparse;
      const std::vector<int> columns =
          Integers(sparse.indices.bufferView, sparse.indices.byteOffset,
                   sparse.indices.componentType, sparse.count, count);
      const auto [begin, stride] =
          Elements(sparse.values.bufferView, sparse.values.byteOffset, size, columns.size());
      for (size_t i = 0; i < columns.size(); ++i) {
        read(begin + i * stride, numbers.col(columns[i]).data());
      }
    }
    if (!numbers.allFinite()) Fail(std::string(what) + " are not all finite" + kReexport);
    return numbers;
  }

  std::vector<int> Integers(int view, size_t offset, int component_type, size_t count,
                            size_t end) const {
    const int size = tinygltf::GetComponentSizeInBytes(component_type);
    if (component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
      Fail(std::string("indices are not unsigned integers") + kReexport);
    }
    const auto [begin, stride] = Elements(view, offset, size, count);
    std::vector<int> integers(count);
    for (size_t i = 0; i < count; ++i) {
      const char* const bytes = reinterpret_cast<const char*>(begin + i * stride);
      const std::uint32_t index = size == 1   ? ReadLittleEndian<std::uint8_t>(bytes)
                                  : size == 2 ? ReadLittleEndian<std::uint16_t>(bytes)
                                              : ReadLittleEndian<std::uint32_t>(bytes);
      if (index >= end) {
        Fail("has the index " + std::to_string(index) + " where there are " + std::to_string(end) +
             " vertices" + kReexport);
      }
      integers[i] = static_cast<int>(index);
    }
    return integers;
  }

  // The accessors of the positions of a primitive and of its targets.
  std::vector<int> PositionAccessors(const Primitive& primitive) const {
    std::vector<int> accessors;
    const auto add = [&](const std::map<std::string, int>& attributes) {
      const auto position = attributes.find("POSITION");
      accessors.push_back(position == attributes.end() ? -1 : position->second);
    };
    add(primitive.attributes);
    for (const std::map<std::string, int>& target : primitive.targets) add(target);
    if (accessors[0] < 0) Fail(std::string("a part of the mesh has no positions") + kReexport);
    return accessors;
  }

  // -1 if there is none.
  static int TextureAccessor(const Primitive& primitive) {
    const auto found = primitive.attributes.find("TEXCOORD_0");
    return found == primitive.attributes.end() ? -1 : found->second;
  }

  // All that tells the vertices of primitives apart: accessors of positions and of texture
  // coordinates.
  using VerticesOf = std::pair<std::vector<int>, int>;

  // Refuses what would take far more memory than the file, before any of it is read.
  void CountElements(const tinygltf::Mesh& mesh) const {
    std::set<VerticesOf> counted;
    double elements = 0;  // vertices and corners, in all poses
    for (const Primitive& primitive : mesh.primitives) {
      const std::vector<int> accessors = PositionAccessors(primitive);
      const auto poses = static_cast<double>(accessors.size());
      const auto vertices =
          static_cast<double>(At(model_.accessors, accessors[0], "list of numbers").count);
      if (counted.insert({accessors, TextureAccessor(primitive)}).second) {
        elements += poses * vertices;
      }
      elements += poses * (primitive.indices < 0
                               ? vertices
                               : At(model_.accessors, primitive.indices, "list of indices").count);
      if (elements <= std::max(kAlwaysAllowed, kAllowedPerByte * num_bytes_)) continue;
      Fail("has " + std::to_string(accessors.size() - 1) +
           " morph targets, which together would take far more memory than a file of this size "
           "accounts for" +
           kReexport);
    }
  }

  // Appends the vertices of a primitive to all poses, unless another primitive had the same.
  // Returns the index of the first of them.
  int AddVertices(const Primitive& primitive) {
    const std::vector<int> accessors = PositionAccessors(primitive);
    const auto [found, is_new] =
        begin_of_.try_emplace(VerticesOf{accessors, TextureAccessor(primitive)}, NumVertices());
    const int begin = found->second;
    if (!is_new) return begin;
    if (!coordinates_.empty() && coordinates_.size() != accessors.size()) {
      Fail("parts of the mesh have different numbers of morph targets");
    }
    coordinates_.resize(accessors.size());
    Eigen::MatrixXd base;
    for (size_t k = 0; k < accessors.size(); ++k) {
      if (k > 0 && accessors[k] < 0) {
        Append(base, &coordinates_[k]);
        continue;
      }
      const Accessor& accessor = At(model_.accessors, accessors[k], "list of numbers");
      // Only targets may leave out the buffer, where all numbers but a few are 0.
      if (k == 0 && accessor.bufferView < 0) Fail(std::string("has no positions") + kReexport);
      const Eigen::MatrixXd numbers =
          Numbers(accessor, TINYGLTF_TYPE_VEC3, k == 0 ? accessor.count : base.cols(), "positions");
      if (k == 0) base = numbers;
      Append(k == 0 ? base : Eigen::MatrixXd(base + numbers), &coordinates_[k]);
    }
    AddTexture(primitive, base.cols());
    return begin;
  }

  static void Append(const Eigen::MatrixXd& columns, std::vector<double>* coordinates) {
    coordinates->insert(coordinates->end(), columns.data(), columns.data() + columns.size());
  }

  int NumVertices() const {
    return coordinates_.empty() ? 0 : static_cast<int>(coordinates_[0].size() / 3);
  }

  void AddTexture(const Primitive& primitive, Eigen::Index vertices) {
    const int index = TextureAccessor(primitive);
    texture_of_.resize(texture_of_.size() + vertices, -1);
    if (index < 0) return;
    Eigen::MatrixXd numbers;
    try {
      const Accessor& accessor = At(model_.accessors, index, "list of numbers");
      if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
        has_rounded_texture_ = true;
        return;
      }
      numbers = Numbers(accessor, TINYGLTF_TYPE_VEC2, vertices, "texture coordinates");
    } catch (const FileError& error) {
      // The mesh does not need them.
      bad_texture_ = error.what();
      return;
    }
    const Eigen::Index known = texture_.cols();
    texture_.conservativeResize(2, known + vertices);
    // glTF's v points down.
    texture_.rightCols(vertices).row(0) = numbers.row(0);
    texture_.rightCols(vertices).row(1) = 1 - numbers.row(1).array();
    for (Eigen::Index v = 0; v < vertices; ++v) {
      texture_of_[texture_of_.size() - vertices + v] = static_cast<int>(known + v);
    }
  }

  void AddPrimitive(const Primitive& primitive) {
    const int begin = AddVertices(primitive);
    const auto vertices = static_cast<size_t>(
        At(model_.accessors, primitive.attributes.at("POSITION"), "list of numbers").count);
    std::vector<int> indices(primitive.indices < 0 ? vertices : 0);
    for (size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<int>(i);
    if (primitive.indices >= 0) {
      const Accessor& accessor = model_.accessors[primitive.indices];
      indices = Integers(accessor.bufferView, accessor.byteOffset, accessor.componentType,
                         accessor.count, vertices);
    }
    const bool lines = primitive.mode == TINYGLTF_MODE_LINE;
    if (!lines && primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1) {
      Fail("has strips, fans or points; export it as triangles");
    }
    if (indices.size() % (lines ? 2 : 3) != 0) {
      Fail(std::string("the last triangle is not complete") + kReexport);
    }
    std::vector<int>& all = lines ? ends_ : corners_;
    for (const int index : indices) all.push_back(begin + index);
    if (primitive.material >= 0) has_materials_ = true;
    if (primitive.attributes.count("COLOR_0") > 0) has_colours_ = true;
  }

  // The names of the poses: those of the morph targets, and none for the mesh itself.
  std::vector<std::string> Names(const tinygltf::Mesh& mesh) const {
    std::vector<std::string> names(coordinates_.size());
    const bool named = mesh.extras.Has("targetNames") && mesh.extras.Get("targetNames").IsArray();
    for (size_t k = 1; k < names.size(); ++k) {
      names[k] = "target " + std::to_string(k);
      if (!named) continue;
      const tinygltf::Value& name = mesh.extras.Get("targetNames").Get(static_cast<int>(k - 1));
      if (name.IsString() && !name.Get<std::string>().empty()) names[k] = name.Get<std::string>();
    }
    return names;
  }

  std::vector<Soup> Soups(const Eigen::Affine3d& placement, const std::vector<std::string>& names) {
    // Where the node mirrors the mesh, the order of corners is that of the mirror image.
    if (placement.linear().determinant() < 0) {
      for (size_t corner = 0; corner < corners_.size(); corner += 3) {
        std::swap(corners_[corner + 1], corners_[corner + 2]);
      }
    }
    std::vector<Shape> shapes;
    const int num_vertices = NumVertices();
    for (std::vector<double>& coordinates : coordinates_) {
      shapes.emplace_back(Eigen::Map<const Shape>(coordinates.data(), 3, num_vertices));
      coordinates = {};
    }
    const Merged merged = MergeEqual(shapes);
    Soup soup;
    soup.file = file_;
    for (size_t corner = 0; corner < corners_.size(); ++corner) {
      soup.corners.push_back(merged.index[corners_[corner]]);
      if (corner % 3 == 2) soup.polygon_begin.push_back(static_cast<int>(corner) + 1);
      if (texture_.cols() > 0) {
        soup.appearance.corner_texture.push_back(texture_of_[corners_[corner]]);
      }
    }
    for (size_t end = 0; end < ends_.size(); end += 2) {
      soup.segments.emplace_back(merged.index[ends_[end]], merged.index[ends_[end + 1]]);
    }
    if (!soup.appearance.corner_texture.empty()) soup.appearance.texture_coordinates = texture_;
    const auto tell = [&](bool is, const std::string& what) {
      if (is) soup.dropped.push_back(what);
    };
    const size_t copies = merged.index.size() - merged.first.size();
    tell(copies > 0, std::to_string(copies) +
                         " vertices merged with others that are in the same place in all poses");
    tell(has_materials_, "materials and textures not kept");
    tell(has_colours_, "vertex colours not kept");
    tell(has_rounded_texture_, "texture coordinates that are not floating-point numbers not kept");
    tell(!bad_texture_.empty(), bad_texture_ + "; not kept");
    tell(!model_.skins.empty(), "the skeleton is not applied: the mesh is in its bind pose");
    // What would place the integers is part of the skeleton.
    tell(quantized_ && skinned_, "positions are in the units of the file's quantization");
    std::vector<Soup> soups;
    for (size_t k = 0; k < shapes.size(); ++k) {
      soups.push_back(soup);
      soups[k].name = names[k];
      soups[k].vertices = placement * shapes[k](Eigen::all, merged.first).colwise().homogeneous();
      if (!soups[k].vertices.allFinite()) Fail(std::string("positions are not finite") + kReexport);
    }
    return soups;
  }

  const std::string& file_;
  Model model_;
  double num_bytes_ = 0;  // of the file and its buffers
  // Of the vertices of the mesh and of its targets, in vectors, which many parts are added to in
  // the time that their numbers take.
  std::vector<std::vector<double>> coordinates_;
  std::map<VerticesOf, int> begin_of_;  // the index of the first vertex
  std::vector<int> corners_, ends_;     // of triangles, and of segments
  Eigen::Matrix2Xd texture_{2, 0};
  std::vector<int> texture_of_;  // of each vertex: its texture coordinates, or -1
  bool has_materials_ = false, has_colours_ = false, has_rounded_texture_ = false;
  std::string bad_texture_;  // what is wrong with texture coordinates, if anything
  bool quantized_ = false, skinned_ = false;
};

}  // namespace

std::vector<Soup> ReadGltf(const std::string& file, const std::string& bytes,
                           bool allow_outside_files) {
  return GltfReader(file, bytes, allow_outside_files).Read();
}

}  // namespace shapespace::internal
