#include <shapespace/path/internal/metric_arrays.h>

#include <filesystem>
#include <utility>
#include <vector>

#include <shapespace/metric/feature_registry.h>

namespace shapespace::internal {
namespace {

constexpr const char* kStretching = "stretching_stiffness";
constexpr const char* kRepresentatives = "representatives";
constexpr const char* kBending = "bending_stiffness";
constexpr const char* kVertices = "vertices";
constexpr const char* kEdges = "edges";
constexpr const char* kNumbers = "numbers";

HeaderJson OptionsToJson(const MetricOptions& options) {
  HeaderJson features = HeaderJson::array();
  for (const FeatureTerm& term : options.features) {
    features.push_back({{"name", term.name}, {"coefficient", term.coefficient}});
  }
  return {{"isometric", options.isometric},
          {"strain", options.strain},
          {"rigid", options.rigid},
          {"lambda", options.lambda},
          {"bending", options.bending},
          {"volume", options.volume},
          {"features", features},
          {"weights", options.weights == Weighting::kUniform ? "uniform" : "area"},
          {"discretization",
           options.discretization == Discretization::kTrapezoid ? "trapezoid" : "midpoint"},
          {"stiffness_on", options.stiffness_on == StiffnessOn::kEdges ? kEdges : kVertices}};
}

// Whether `key` of the metric is `second` rather than `first`, the only other value that it may
// have.
bool IsSecond(const HeaderJson& json, const char* key, const char* first, const char* second) {
  const HeaderJson& value = json.at(key);
  if (value == first || value == second) return value == second;
  throw FileError(std::string("metric.") + key + ": must be " + first + " or " + second +
                  "; was the file made by a later version?");
}

MetricOptions OptionsFromJson(const HeaderJson& json) {
  MetricOptions options;
  json.at("isometric").get_to(options.isometric);
  json.at("strain").get_to(options.strain);
  json.at("rigid").get_to(options.rigid);
  json.at("lambda").get_to(options.lambda);
  json.at("bending").get_to(options.bending);
  json.at("volume").get_to(options.volume);
  for (const HeaderJson& term : json.at("features")) {
    options.features.push_back(
        {term.at("name").get<std::string>(), term.at("coefficient").get<double>()});
  }
  options.weights =
      IsSecond(json, "weights", "area", "uniform") ? Weighting::kUniform : Weighting::kArea;
  options.discretization = IsSecond(json, "discretization", "midpoint", "trapezoid")
                               ? Discretization::kTrapezoid
                               : Discretization::kMidpoint;
  options.stiffness_on = IsSecond(json, "stiffness_on", kVertices, kEdges) ? StiffnessOn::kEdges
                                                                           : StiffnessOn::kVertices;
  return options;
}

void ReadStiffness(const ArrayReader& arrays, const Connectivity& connectivity,
                   MetricOptions* options) {
  const int count = options->stiffness_on == StiffnessOn::kEdges ? connectivity.NumEdges()
                                                                 : connectivity.NumVertices();
  for (const auto& [name, field] : {std::pair(kStretching, &options->stretching_stiffness),
                                    std::pair(kBending, &options->bending_stiffness)}) {
    if (arrays.Has(name)) *field = arrays.Get<Eigen::VectorXd>(name, count, 1);
  }
}

std::shared_ptr<const Feature> ReadFeature(const std::string& name, const HeaderJson& constants,
                                           const std::string& prefix, const ArrayReader& arrays,
                                           int num_vertices) {
  FeatureKind kind;
  try {
    kind = FindFeature(name);
  } catch (const InvalidOptions& error) {
    throw FileError(std::string("its metric: ") + error.what());
  }
  const auto stencils =
      arrays.Get<Eigen::MatrixXi>(prefix + "stencils", kind.vertices, Eigen::Dynamic);
  const auto weights = arrays.Get<Eigen::VectorXd>(prefix + "weights", Eigen::Dynamic, 1);
  Eigen::MatrixXd numbers(kind.numbers, stencils.cols());
  if (kind.numbers > 0) {
    numbers = arrays.Get<Eigen::MatrixXd>(prefix + kNumbers, kind.numbers, stencils.cols());
  }
  auto feature = kind.restore(stencils, weights, numbers, [&](const std::string& constant) {
    return constants.at(constant).get<double>();
  });
  CheckFeature(*feature, num_vertices);
  return feature;
}

// JSON contains text in UTF-8 only; any other name becomes a list of its bytes.
HeaderJson NameToJson(const std::string& name) {
  try {
    (void)HeaderJson(name).dump();
    return name;
  } catch (const HeaderJson::exception&) {
    return std::vector<uint8_t>(name.begin(), name.end());
  }
}

std::string NameFromJson(const HeaderJson& json) {
  if (json.is_string()) return json.get<std::string>();
  const auto bytes = json.get<std::vector<uint8_t>>();
  return {bytes.begin(), bytes.end()};
}

}  // namespace

HeaderJson NamesToJson(const std::vector<std::string>& names) {
  HeaderJson json = HeaderJson::array();
  for (const std::string& name : names) json.push_back(NameToJson(name));
  return json;
}

std::vector<std::string> NamesFromJson(const HeaderJson& json) {
  std::vector<std::string> names;
  for (const HeaderJson& name : json) names.push_back(NameFromJson(name));
  return names;
}

void AddConnectivity(const Connectivity& connectivity, HeaderJson* header, ArrayWriter* arrays) {
  arrays->Add("polygon_begin", connectivity.PolygonBegin().data(),
              connectivity.PolygonBegin().size(), 1);
  arrays->Add("corners", connectivity.Corners().data(), connectivity.Corners().size(), 1);
  arrays->Add("triangles", connectivity.FileTriangles());
  if (!connectivity.Twins().empty()) {
    const std::vector<int>& representatives = connectivity.Representatives();
    arrays->Add(kRepresentatives, representatives.data(), representatives.size(), 1);
  }
  Eigen::Matrix2Xi segments(2, connectivity.Segments().size());
  for (Eigen::Index i = 0; i < segments.cols(); ++i) {
    segments.col(i) << connectivity.Segments()[i].first, connectivity.Segments()[i].second;
  }
  arrays->Add("segments", segments);
  arrays->Add("extra_edges", Eigen::Matrix2Xi(connectivity.Edges().rightCols(
                                 connectivity.NumEdges() - connectivity.NumTriangleEdges())));
  (*header)["vertices"] = connectivity.NumVertices();
}

std::shared_ptr<const Connectivity> ReadConnectivity(int num_vertices, const ArrayReader& arrays) {
  const auto begin = arrays.Get<Eigen::VectorXi>("polygon_begin", Eigen::Dynamic, 1);
  const auto corners = arrays.Get<Eigen::VectorXi>("corners", Eigen::Dynamic, 1);
  const auto pairs = [&](const char* name) {
    const auto columns = arrays.Get<Eigen::Matrix2Xi>(name, 2, Eigen::Dynamic);
    std::vector<std::pair<int, int>> result;
    result.reserve(columns.cols());
    for (int i = 0; i < columns.cols(); ++i) result.emplace_back(columns(0, i), columns(1, i));
    return result;
  };
  std::vector<int> representatives;
  if (arrays.Has(kRepresentatives)) representatives = IndicesFrom(arrays, kRepresentatives);
  return Connectivity::Make(
      num_vertices, {begin.begin(), begin.end()}, {corners.begin(), corners.end()},
      pairs("segments"), pairs("extra_edges"),
      arrays.Get<Eigen::Matrix3Xi>("triangles", 3, Eigen::Dynamic), std::move(representatives));
}

void AddMetric(const Metric& metric, HeaderJson* header, ArrayWriter* arrays) {
  AddConnectivity(*metric.connectivity, header, arrays);
  arrays->Add("vertex_area", metric.vertex_area);
  arrays->Add("edge_area", metric.edge_area);
  arrays->Add("hinge_area", metric.hinge_area);
  HeaderJson features = HeaderJson::array();
  for (const auto& feature : metric.features) {
    const std::string prefix = "feature" + std::to_string(features.size()) + "_";
    HeaderJson constants = HeaderJson::object();
    for (const auto& [name, number] : feature->Constants()) constants[name] = number;
    features.push_back({{"name", feature->Name()}, {"constants", constants}});
    arrays->Add(prefix + "stencils", feature->Element(0), feature->VerticesPerElement(),
                feature->NumElements());
    arrays->Add(prefix + "weights", feature->Weights());
    if (feature->NumbersPerElement() > 0) {
      arrays->Add(prefix + kNumbers, feature->Numbers(0), feature->NumbersPerElement(),
                  feature->NumElements());
    }
  }
  for (const auto& [name, field] : {std::pair(kStretching, &metric.options.stretching_stiffness),
                                    std::pair(kBending, &metric.options.bending_stiffness)}) {
    if (field->size() > 0) arrays->Add(name, *field);
  }
  arrays->Add("rigid_weights", metric.rigid.weights);
  (*header)["unit"] = metric.unit;
  (*header)["metric"] = OptionsToJson(metric.options);
  (*header)["features"] = features;
}

std::shared_ptr<const Metric> ReadMetric(const HeaderJson& header, const ArrayReader& arrays) {
  const int num_vertices = CountFrom(header, "vertices");
  const auto metric = std::make_shared<Metric>();
  // First, because it shows that the file is large enough for so many vertices.
  metric->vertex_area = arrays.Get<Eigen::VectorXd>("vertex_area", num_vertices, 1);
  metric->connectivity = ReadConnectivity(num_vertices, arrays);
  const Connectivity& connectivity = *metric->connectivity;
  metric->options = OptionsFromJson(header.at("metric"));
  ReadStiffness(arrays, connectivity, &metric->options);
  metric->options.Validate();
  metric->unit = header.at("unit").get<double>();
  if (!(metric->unit > 0)) throw FileError("its unit of length is not positive");
  metric->edge_area = arrays.Get<Eigen::VectorXd>("edge_area", connectivity.NumEdges(), 1);
  metric->hinge_area = arrays.Get<Eigen::VectorXd>("hinge_area", connectivity.NumHinges(), 1);
  int index = 0;
  for (const HeaderJson& entry : header.at("features")) {
    const std::string name = entry.at("name").get<std::string>();
    const HeaderJson& constants = entry.at("constants");
    const std::string prefix = "feature" + std::to_string(index++) + "_";
    metric->features.push_back(ReadFeature(name, constants, prefix, arrays, num_vertices));
  }
  metric->rigid.weights = arrays.Get<Eigen::VectorXd>("rigid_weights", Eigen::Dynamic, 1);
  if (metric->rigid.Active() && metric->rigid.weights.size() != num_vertices) {
    throw FileError("its array rigid_weights has the wrong size");
  }
  const auto check = [](const Eigen::VectorXd& areas, const char* name) {
    if (areas.size() > 0 && areas.minCoeff() < 0) {
      throw FileError(std::string("its array ") + name + " holds a negative number");
    }
  };
  check(metric->vertex_area, "vertex_area");
  check(metric->edge_area, "edge_area");
  check(metric->hinge_area, "hinge_area");
  check(metric->rigid.weights, "rigid_weights");
  return metric;
}

void AddMotions(const std::vector<RigidMotion>& motions, ArrayWriter* arrays) {
  const auto count = static_cast<Eigen::Index>(motions.size());
  Eigen::Matrix3Xd rotations(3, 3 * count), translations(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    rotations.middleCols<3>(3 * i) = motions[i].rotation;
    translations.col(i) = motions[i].translation;
  }
  arrays->Add("rotations", rotations);
  arrays->Add("translations", translations);
}

std::vector<RigidMotion> ReadMotions(const ArrayReader& arrays, Eigen::Index count) {
  const auto rotations = arrays.Get<Eigen::Matrix3Xd>("rotations", 3, 3 * count);
  const auto translations = arrays.Get<Eigen::Matrix3Xd>("translations", 3, count);
  std::vector<RigidMotion> motions;
  for (Eigen::Index i = 0; i < count; ++i) {
    motions.push_back({rotations.middleCols<3>(3 * i), translations.col(i)});
  }
  return motions;
}

void AddAppearance(const Appearance& appearance, const std::string& file, HeaderJson* header,
                   ArrayWriter* arrays) {
  const auto add_indices = [arrays](const std::string& name, const std::vector<int>& indices) {
    arrays->Add(name, indices.data(), indices.size(), 1);
  };
  arrays->Add("texture_coordinates", appearance.texture_coordinates);
  add_indices("corner_texture", appearance.corner_texture);
  add_indices("polygon_material", appearance.materials.of_polygon);
  add_indices("polygon_group", appearance.groups.of_polygon);
  add_indices("polygon_object", appearance.objects.of_polygon);
  arrays->Add("vertex_colours", appearance.vertex_colours);
  namespace fs = std::filesystem;
  const fs::path here = fs::current_path();
  const fs::path folder_of_file = (here / fs::u8path(file)).parent_path().lexically_normal();
  const fs::path folder =
      (here / fs::u8path(appearance.folder)).lexically_normal().lexically_proximate(folder_of_file);
  const bool has_libraries = !appearance.material_libraries.empty();
  (*header)["appearance"] = {{"material_libraries", NamesToJson(appearance.material_libraries)},
                             {"folder", NameToJson(has_libraries ? folder.generic_u8string() : "")},
                             {"materials", NamesToJson(appearance.materials.names)},
                             {"groups", NamesToJson(appearance.groups.names)},
                             {"objects", NamesToJson(appearance.objects.names)}};
}

Appearance ReadAppearance(const HeaderJson& header, const std::string& file,
                          const ArrayReader& arrays) {
  const HeaderJson& json = header.at("appearance");
  namespace fs = std::filesystem;
  const fs::path folder = fs::u8path(file).parent_path();
  Appearance appearance;
  appearance.texture_coordinates =
      arrays.Get<Eigen::Matrix2Xd>("texture_coordinates", 2, Eigen::Dynamic);
  appearance.corner_texture = IndicesFrom(arrays, "corner_texture");
  appearance.material_libraries = NamesFromJson(json.at("material_libraries"));
  appearance.folder =
      (folder / fs::u8path(NameFromJson(json.at("folder")))).lexically_normal().u8string();
  appearance.own_folder = folder.u8string();
  appearance.materials = {NamesFromJson(json.at("materials")),
                          IndicesFrom(arrays, "polygon_material")};
  appearance.groups = {NamesFromJson(json.at("groups")), IndicesFrom(arrays, "polygon_group")};
  appearance.objects = {NamesFromJson(json.at("objects")), IndicesFrom(arrays, "polygon_object")};
  appearance.vertex_colours =
      arrays.Get<Eigen::MatrixXd>("vertex_colours", Eigen::Dynamic, Eigen::Dynamic);
  return appearance;
}

}  // namespace shapespace::internal
