#include <shapespace/path/path_file.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <type_traits>

#include <zlib.h>
#include <nlohmann/json.hpp>

#include <shapespace/base/atomic_file.h>
#include <shapespace/base/error.h>
#include <shapespace/base/read_file.h>

namespace shapespace {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kMagic[8] = {'S', 'H', 'A', 'P', 'P', 'A', 'T', 'H'};
constexpr uint32_t kVersion = 2;
// Magic, version, checksum, length of the header.
constexpr size_t kPreamble = sizeof kMagic + 2 * sizeof(uint32_t) + sizeof(uint64_t);

uint32_t Checksum(const std::string& bytes, size_t from) {
  uLong sum = crc32(0, nullptr, 0);
  while (from < bytes.size()) {
    const size_t count = std::min<size_t>(bytes.size() - from, 1 << 30);
    sum = crc32(sum, reinterpret_cast<const Bytef*>(bytes.data() + from), static_cast<uInt>(count));
    from += count;
  }
  return static_cast<uint32_t>(sum);
}

// The arrays behind the header, in its order.
class ArrayWriter {
 public:
  template <typename Scalar>
  void Add(const std::string& name, const Scalar* data, size_t rows, size_t columns) {
    static_assert(std::is_same_v<Scalar, double> || std::is_same_v<Scalar, int>);
    const char* const type = std::is_same_v<Scalar, double> ? "f8" : "i4";
    table_.push_back({{"name", name}, {"type", type}, {"rows", rows}, {"columns", columns}});
    bytes_.append(reinterpret_cast<const char*>(data), rows * columns * sizeof(Scalar));
  }
  template <typename Matrix>
  void Add(const std::string& name, const Matrix& matrix) {
    Add(name, matrix.data(), matrix.rows(), matrix.cols());
  }
  const Json& Table() const { return table_; }
  const std::string& Bytes() const { return bytes_; }

 private:
  Json table_ = Json::array();
  std::string bytes_;
};

class ArrayReader {
 public:
  ArrayReader(const Json& table, const std::string& bytes, size_t begin) : bytes_(bytes) {
    for (const Json& entry : table) {
      Array array;
      array.type = entry.at("type").get<std::string>();
      array.rows = entry.at("rows").get<size_t>();
      array.columns = entry.at("columns").get<size_t>();
      array.begin = begin;
      const size_t size = array.type == "f8" ? 8 : 4;
      constexpr size_t kMost = std::numeric_limits<int>::max();
      if (array.rows > kMost || array.columns > kMost) {
        throw FileError("its arrays have sizes out of range");
      }
      if (array.columns != 0 && array.rows > (bytes.size() - begin) / size / array.columns) {
        throw FileError("its arrays are longer than the file");
      }
      begin += array.rows * array.columns * size;
      arrays_[entry.at("name").get<std::string>()] = array;
    }
    if (begin != bytes.size()) throw FileError("it is longer than its arrays");
  }

  // A matrix of `rows` x `columns`; either may be Eigen::Dynamic for any.
  template <typename Matrix>
  Matrix Get(const std::string& name, Eigen::Index rows, Eigen::Index columns) const {
    using Scalar = typename Matrix::Scalar;
    const auto found = arrays_.find(name);
    if (found == arrays_.end()) throw FileError("it lacks the array " + name);
    const Array& array = found->second;
    const bool fits = array.type == (std::is_same_v<Scalar, double> ? "f8" : "i4") &&
                      (rows == Eigen::Dynamic || static_cast<size_t>(rows) == array.rows) &&
                      (columns == Eigen::Dynamic || static_cast<size_t>(columns) == array.columns);
    if (!fits) throw FileError("its array " + name + " has the wrong type or size");
    Matrix matrix(array.rows, array.columns);
    // An empty matrix may have no address, which memcpy must not be given.
    if (matrix.size() > 0) {
      std::memcpy(matrix.data(), bytes_.data() + array.begin, matrix.size() * sizeof(Scalar));
    }
    if constexpr (std::is_same_v<Scalar, double>) {
      if (!matrix.allFinite()) throw FileError("its array " + name + " holds a non-finite number");
    }
    return matrix;
  }

 private:
  struct Array {
    std::string type;
    size_t rows, columns, begin;
  };
  const std::string& bytes_;
  std::map<std::string, Array> arrays_;
};

Json OptionsToJson(const MetricOptions& options) {
  return {{"isometric", options.isometric},
          {"strain", options.strain},
          {"rigid", options.rigid},
          {"lambda", options.lambda},
          {"bending", options.bending},
          {"volume", options.volume},
          {"weights", options.weights == Weights::kUniform ? "uniform" : "area"},
          {"discretization",
           options.discretization == Discretization::kTrapezoid ? "trapezoid" : "midpoint"}};
}

MetricOptions OptionsFromJson(const Json& json) {
  MetricOptions options;
  json.at("isometric").get_to(options.isometric);
  json.at("strain").get_to(options.strain);
  json.at("rigid").get_to(options.rigid);
  json.at("lambda").get_to(options.lambda);
  json.at("bending").get_to(options.bending);
  json.at("volume").get_to(options.volume);
  options.weights = json.at("weights") == "uniform" ? Weights::kUniform : Weights::kArea;
  options.discretization = json.at("discretization") == "trapezoid" ? Discretization::kTrapezoid
                                                                    : Discretization::kMidpoint;
  options.Validate();
  return options;
}

// What a feature holds besides stencils and weights. An overload each; most hold nothing.
template <typename Feature>
Json Constants(const Feature&) {
  return Json::object();
}
Json Constants(const LogLength& f) { return {{"epsilon_squared", f.epsilon_squared}}; }
Json Constants(const TriangleStrain& f) { return {{"epsilon_squared", f.epsilon_squared}}; }
Json Constants(const Dihedral& f) {
  return {{"normal_epsilon_squared", f.normal_epsilon_squared},
          {"edge_epsilon_squared", f.edge_epsilon_squared}};
}
Json Constants(const Volume& f) { return {{"reference", f.reference}}; }

template <typename Feature>
void SetConstants(const Json&, Feature*) {}
void SetConstants(const Json& json, LogLength* f) {
  json.at("epsilon_squared").get_to(f->epsilon_squared);
}
void SetConstants(const Json& json, TriangleStrain* f) {
  json.at("epsilon_squared").get_to(f->epsilon_squared);
}
void SetConstants(const Json& json, Dihedral* f) {
  json.at("normal_epsilon_squared").get_to(f->normal_epsilon_squared);
  json.at("edge_epsilon_squared").get_to(f->edge_epsilon_squared);
}
void SetConstants(const Json& json, Volume* f) { json.at("reference").get_to(f->reference); }

// Adds the feature called `name` to the metric if it is this one.
template <typename Feature>
bool ReadFeature(const std::string& name, const Json& constants, const std::string& prefix,
                 const ArrayReader& arrays, Metric* metric) {
  if (name != Feature::kName) return false;
  Feature feature;
  feature.stencils = arrays.Get<decltype(feature.stencils)>(prefix + "stencils", Feature::kVertices,
                                                            Eigen::Dynamic);
  const bool inside = feature.stencils.size() == 0 ||
                      (feature.stencils.minCoeff() >= 0 &&
                       feature.stencils.maxCoeff() < metric->connectivity->NumVertices());
  if (!inside) throw FileError("a stencil of the feature " + name + " has an index out of range");
  feature.weights = arrays.Get<Eigen::VectorXd>(prefix + "weights",
                                                Feature::kSum ? 1 : feature.stencils.cols(), 1);
  SetConstants(constants, &feature);
  metric->features.emplace_back(std::move(feature));
  return true;
}

// JSON holds text in UTF-8 only: any other name stands as the list of its bytes.
Json NameToJson(const std::string& name) {
  try {
    (void)Json(name).dump();
    return name;
  } catch (const Json::exception&) {
    return std::vector<uint8_t>(name.begin(), name.end());
  }
}

std::string NameFromJson(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  const auto bytes = json.get<std::vector<uint8_t>>();
  return {bytes.begin(), bytes.end()};
}

Json NamesToJson(const std::vector<std::string>& names) {
  Json json = Json::array();
  for (const std::string& name : names) json.push_back(NameToJson(name));
  return json;
}

std::vector<std::string> NamesFromJson(const Json& json) {
  std::vector<std::string> names;
  for (const Json& name : json) names.push_back(NameFromJson(name));
  return names;
}

// Names in the header, numbers in the arrays. Libraries lie relative to `file`, so that all can be
// moved together.
Json AddAppearance(const Appearance& appearance, const std::string& file, ArrayWriter* arrays) {
  const auto add_indices = [arrays](const std::string& name, const std::vector<int>& indices) {
    arrays->Add(name, indices.data(), indices.size(), 1);
  };
  arrays->Add("texture_coordinates", appearance.texture_coordinates);
  add_indices("corner_texture", appearance.corner_texture);
  add_indices("polygon_material", appearance.materials.of_polygon);
  add_indices("polygon_group", appearance.groups.of_polygon);
  add_indices("polygon_object", appearance.objects.of_polygon);
  arrays->Add("vertex_colours", appearance.vertex_colours);
  const auto here = std::filesystem::current_path();
  const auto folder = (here / appearance.folder)
                          .lexically_normal()
                          .lexically_proximate((here / file).parent_path().lexically_normal());
  const bool has_libraries = !appearance.material_libraries.empty();
  return {{"material_libraries", NamesToJson(appearance.material_libraries)},
          {"folder", NameToJson(has_libraries ? folder.string() : "")},
          {"materials", NamesToJson(appearance.materials.names)},
          {"groups", NamesToJson(appearance.groups.names)},
          {"objects", NamesToJson(appearance.objects.names)}};
}

Appearance ReadAppearance(const Json& json, const std::filesystem::path& folder,
                          const ArrayReader& arrays) {
  const auto indices = [&arrays](const std::string& name) {
    const auto column = arrays.Get<Eigen::VectorXi>(name, Eigen::Dynamic, 1);
    return std::vector<int>(column.begin(), column.end());
  };
  Appearance appearance;
  appearance.texture_coordinates =
      arrays.Get<Eigen::Matrix2Xd>("texture_coordinates", 2, Eigen::Dynamic);
  appearance.corner_texture = indices("corner_texture");
  appearance.material_libraries = NamesFromJson(json.at("material_libraries"));
  appearance.folder = (folder / NameFromJson(json.at("folder"))).lexically_normal().string();
  appearance.materials = {NamesFromJson(json.at("materials")), indices("polygon_material")};
  appearance.groups = {NamesFromJson(json.at("groups")), indices("polygon_group")};
  appearance.objects = {NamesFromJson(json.at("objects")), indices("polygon_object")};
  appearance.vertex_colours =
      arrays.Get<Eigen::MatrixXd>("vertex_colours", Eigen::Dynamic, Eigen::Dynamic);
  return appearance;
}

Path Parse(const std::string& file, const std::string& bytes) {
  if (bytes.size() < kPreamble || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    throw FileError("this is no .path file");
  }
  uint32_t version, checksum;
  uint64_t header_size;
  std::memcpy(&version, bytes.data() + 8, sizeof version);
  std::memcpy(&checksum, bytes.data() + 12, sizeof checksum);
  std::memcpy(&header_size, bytes.data() + 16, sizeof header_size);
  if (version != kVersion) {
    throw FileError("version " + std::to_string(version) + " of the format is not read, only " +
                    std::to_string(kVersion) +
                    " is; use the shapespace that wrote it, or make the path again with this one");
  }
  if (Checksum(bytes, 16) != checksum || header_size > bytes.size() - kPreamble) {
    throw FileError("it is damaged or was cut off (its checksum does not fit); make it again");
  }
  const Json header = Json::parse(bytes.substr(kPreamble, header_size));
  const ArrayReader arrays(header.at("arrays"), bytes, kPreamble + header_size);

  const int num_vertices = header.at("vertices").get<int>();
  const auto begin = arrays.Get<Eigen::VectorXi>("polygon_begin", Eigen::Dynamic, 1);
  const auto corners = arrays.Get<Eigen::VectorXi>("corners", Eigen::Dynamic, 1);
  const auto pairs = [&](const char* name) {
    const auto columns = arrays.Get<Eigen::Matrix2Xi>(name, 2, Eigen::Dynamic);
    std::vector<std::pair<int, int>> result;
    result.reserve(columns.cols());
    for (int i = 0; i < columns.cols(); ++i) result.emplace_back(columns(0, i), columns(1, i));
    return result;
  };
  const auto metric = std::make_shared<Metric>();
  metric->connectivity =
      Connectivity::Make(num_vertices, {begin.begin(), begin.end()},
                         {corners.begin(), corners.end()}, pairs("segments"), pairs("extra_edges"),
                         arrays.Get<Eigen::Matrix3Xi>("triangles", 3, Eigen::Dynamic));
  const Connectivity& connectivity = *metric->connectivity;
  metric->options = OptionsFromJson(header.at("metric"));
  metric->unit = header.at("unit").get<double>();
  metric->vertex_area = arrays.Get<Eigen::VectorXd>("vertex_area", num_vertices, 1);
  metric->edge_area = arrays.Get<Eigen::VectorXd>("edge_area", connectivity.NumEdges(), 1);
  metric->hinge_area = arrays.Get<Eigen::VectorXd>("hinge_area", connectivity.NumHinges(), 1);
  int index = 0;
  for (const Json& entry : header.at("features")) {
    const std::string name = entry.at("name").get<std::string>();
    const Json& constants = entry.at("constants");
    const std::string prefix = "feature" + std::to_string(index++) + "_";
    if (!ReadFeature<EdgeLength>(name, constants, prefix, arrays, metric.get()) &&
        !ReadFeature<LogLength>(name, constants, prefix, arrays, metric.get()) &&
        !ReadFeature<TriangleStrain>(name, constants, prefix, arrays, metric.get()) &&
        !ReadFeature<Position>(name, constants, prefix, arrays, metric.get()) &&
        !ReadFeature<Dihedral>(name, constants, prefix, arrays, metric.get()) &&
        !ReadFeature<Volume>(name, constants, prefix, arrays, metric.get())) {
      throw FileError("its metric has an unknown feature, " + name);
    }
  }
  metric->rigid.weights = arrays.Get<Eigen::VectorXd>("rigid_weights", Eigen::Dynamic, 1);
  if (metric->rigid.Active() && metric->rigid.weights.size() != num_vertices) {
    throw FileError("its array rigid_weights has the wrong size");
  }

  Path path;
  path.metric = metric;
  const int num_shapes = header.at("shapes").get<int>();
  const auto parameters = arrays.Get<Eigen::VectorXd>("parameters", num_shapes, 1);
  path.parameters.assign(parameters.begin(), parameters.end());
  const auto poses = arrays.Get<Eigen::VectorXi>("poses", Eigen::Dynamic, 1);
  path.poses.assign(poses.begin(), poses.end());
  path.extrapolated = header.at("extrapolated").get<int>();
  path.converged = header.at("converged").get<bool>();
  const auto rotations = arrays.Get<Eigen::Matrix3Xd>("rotations", 3, 3 * num_shapes);
  const auto translations = arrays.Get<Eigen::Matrix3Xd>("translations", 3, num_shapes);
  for (int i = 0; i < num_shapes; ++i) {
    path.motions.push_back({rotations.middleCols<3>(3 * i), translations.col(i)});
    path.shapes.push_back(arrays.Get<Shape>("shape" + std::to_string(i), 3, num_vertices));
  }
  path.provenance = header.at("provenance").get<std::string>();
  path.appearance =
      ReadAppearance(header.at("appearance"), std::filesystem::path(file).parent_path(), arrays);
  path.Validate();
  return path;
}

}  // namespace

void WritePath(const std::string& file, const Path& path) {
  try {
    path.Validate();
  } catch (const MeshError& error) {
    throw MeshError(file + ": " + error.what());
  }
  const Metric& metric = *path.metric;
  const Connectivity& connectivity = *metric.connectivity;
  ArrayWriter arrays;
  arrays.Add("polygon_begin", connectivity.PolygonBegin().data(),
             connectivity.PolygonBegin().size(), 1);
  arrays.Add("corners", connectivity.Corners().data(), connectivity.Corners().size(), 1);
  arrays.Add("triangles", connectivity.Triangles());
  Eigen::Matrix2Xi segments(2, connectivity.Segments().size());
  for (Eigen::Index i = 0; i < segments.cols(); ++i) {
    segments.col(i) << connectivity.Segments()[i].first, connectivity.Segments()[i].second;
  }
  arrays.Add("segments", segments);
  arrays.Add("extra_edges", Eigen::Matrix2Xi(connectivity.Edges().rightCols(
                                connectivity.NumEdges() - connectivity.NumTriangleEdges())));
  arrays.Add("vertex_area", metric.vertex_area);
  arrays.Add("edge_area", metric.edge_area);
  arrays.Add("hinge_area", metric.hinge_area);
  Json features = Json::array();
  for (const AnyFeature& any : metric.features) {
    std::visit(
        [&](const auto& feature) {
          const std::string prefix = "feature" + std::to_string(features.size()) + "_";
          features.push_back({{"name", feature.kName}, {"constants", Constants(feature)}});
          arrays.Add(prefix + "stencils", feature.stencils);
          arrays.Add(prefix + "weights", feature.weights);
        },
        any);
  }
  arrays.Add("rigid_weights", metric.rigid.weights);
  arrays.Add("parameters", path.parameters.data(), path.parameters.size(), 1);
  arrays.Add("poses", path.poses.data(), path.poses.size(), 1);
  Eigen::Matrix3Xd rotations(3, 3 * path.NumShapes()), translations(3, path.NumShapes());
  for (int i = 0; i < path.NumShapes(); ++i) {
    rotations.middleCols<3>(3 * i) = path.motions[i].rotation;
    translations.col(i) = path.motions[i].translation;
  }
  arrays.Add("rotations", rotations);
  arrays.Add("translations", translations);
  for (int i = 0; i < path.NumShapes(); ++i) {
    arrays.Add("shape" + std::to_string(i), path.shapes[i]);
  }
  const Json appearance = AddAppearance(path.appearance, file, &arrays);

  const Json header = {{"vertices", connectivity.NumVertices()},  //
                       {"shapes", path.NumShapes()},
                       {"extrapolated", path.extrapolated},
                       {"converged", path.converged},
                       {"unit", metric.unit},
                       {"metric", OptionsToJson(metric.options)},
                       {"features", features},
                       {"provenance", path.provenance},
                       {"appearance", appearance},
                       {"arrays", arrays.Table()}};
  // A provenance may name files in bytes that are no UTF-8: those are replaced.
  std::string header_text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  header_text.resize((header_text.size() + 7) / 8 * 8, ' ');  // arrays begin on whole words

  const uint64_t header_size = header_text.size();
  std::string checked(reinterpret_cast<const char*>(&header_size), sizeof header_size);
  checked += header_text;
  checked += arrays.Bytes();
  const uint32_t checksum = Checksum(checked, 0);
  WriteFileAtomically(file, [&](std::ostream& out) {
    out.write(kMagic, sizeof kMagic);
    out.write(reinterpret_cast<const char*>(&kVersion), sizeof kVersion);
    out.write(reinterpret_cast<const char*>(&checksum), sizeof checksum);
    out.write(checked.data(), static_cast<std::streamsize>(checked.size()));
  });
}

Path ReadPath(const std::string& file) {
  const std::string bytes = ReadFile(file);
  try {
    return Parse(file, bytes);
  } catch (const std::exception& error) {
    throw FileError(file + ": " + error.what());
  }
}

}  // namespace shapespace
