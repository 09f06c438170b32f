#include <shapespace/output/detail/page_scene.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include <zlib.h>
#include <nlohmann/json.hpp>

#include <shapespace/analysis/intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/analysis/vertex_energy.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/json.h>
#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/base/parallel.h>
#include <shapespace/output/detail/legend.h>
#include <shapespace/output/detail/page_textures.h>
#include <shapespace/output/detail/ray_scene.h>
#include <shapespace/output/internal/view.h>
#include <shapespace/output/vertex_colours.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr int kPositionSteps = 65535;  // of a position, along the longest side of the box
constexpr float kEdgeRadius = 0.005f;  // of a graph's edges, when a view is chosen
constexpr int kShades = 255;           // of a deviation
constexpr double kMaxBytes = 1e9;      // before compression; more is slow or impossible in browsers

// Positions of one shape in quantisation steps, three per vertex.
using Steps = std::vector<uint16_t>;

// The cube that contains all shapes.
struct Box {
  Eigen::Vector3d low;
  double side;
};

Box BoxAround(const std::vector<Shape>& shapes) {
  Eigen::Vector3d low = shapes[0].rowwise().minCoeff(), high = shapes[0].rowwise().maxCoeff();
  for (const Shape& shape : shapes) {
    low = low.cwiseMin(shape.rowwise().minCoeff());
    high = high.cwiseMax(shape.rowwise().maxCoeff());
  }
  return {low, (high - low).maxCoeff()};
}

Steps Quantise(const Shape& shape, const Box& box) {
  const double scale = box.side > 0 ? kPositionSteps / box.side : 0;
  Steps steps(shape.size());
  for (Eigen::Index i = 0; i < shape.size(); ++i) {
    const double place = (shape.data()[i] - box.low[i % 3]) * scale;
    steps[i] = static_cast<uint16_t>(std::clamp<long>(std::lround(place), 0, kPositionSteps));
  }
  return steps;
}

// Maps numbers of small magnitude to small numbers, whatever their sign.
uint16_t ZigZag(uint16_t difference) {
  const auto x = static_cast<int16_t>(difference);
  return static_cast<uint16_t>(2 * x ^ (x >> 15));
}

uint32_t ZigZag(uint32_t difference) {
  const auto x = static_cast<int32_t>(difference);
  return static_cast<uint32_t>(2 * int64_t{x}) ^ static_cast<uint32_t>(x >> 31);
}

// A prediction of shape i from those before it.
std::vector<Steps> PredictAlongPath(const std::vector<Steps>& shapes) {
  std::vector<Steps> predicted(shapes.size(), Steps(shapes[0].size(), 0));
  for (size_t i = 1; i < shapes.size(); ++i) {
    for (size_t k = 0; k < shapes[i].size(); ++k) {
      const int before = shapes[i - 1][k];
      predicted[i][k] = static_cast<uint16_t>(i == 1 ? before : 2 * before - shapes[i - 2][k]);
    }
  }
  return predicted;
}

std::vector<Steps> PredictFromParents(const std::vector<Steps>& shapes,
                                      const std::vector<std::array<int, 2>>& parents) {
  std::vector<Steps> predicted(shapes.size(), Steps(shapes[0].size(), 0));
  const size_t poses = shapes.size() - parents.size();
  for (size_t i = 1; i < shapes.size(); ++i) {
    const bool is_pose = i < poses;
    const Steps& a = shapes[is_pose ? i - 1 : parents[i - poses][0]];
    const Steps& b = is_pose ? a : shapes[parents[i - poses][1]];
    for (size_t k = 0; k < a.size(); ++k)
      predicted[i][k] = static_cast<uint16_t>((a[k] + b[k]) / 2);
  }
  return predicted;
}

// The differences from the prediction, as differences from vertex to vertex; low and high bytes of
// each axis separately, which compresses best.
void AppendPositions(const std::vector<Steps>& shapes, const std::vector<Steps>& predicted,
                     std::string* bytes) {
  for (size_t i = 0; i < shapes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      std::string low, high;
      uint16_t last = 0;
      for (size_t k = axis; k < shapes[i].size(); k += 3) {
        const auto off = static_cast<uint16_t>(shapes[i][k] - predicted[i][k]);
        const uint16_t code = ZigZag(static_cast<uint16_t>(off - last));
        last = off;
        low.push_back(static_cast<char>(code & 255));
        high.push_back(static_cast<char>(code >> 8));
      }
      *bytes += low + high;
    }
  }
}

// Differences between consecutive indices, ordered by bytes of equal significance.
void AppendIndices(const int* indices, size_t count, std::string* bytes) {
  std::string planes(4 * count, 0);
  uint32_t last = 0;
  for (size_t k = 0; k < count; ++k) {
    const auto index = static_cast<uint32_t>(indices[k]);
    const uint32_t code = ZigZag(index - last);
    last = index;
    for (int plane = 0; plane < 4; ++plane) {
      planes[plane * count + k] = static_cast<char>(code >> (8 * plane) & 255);
    }
  }
  *bytes += planes;
}

void AppendConnectivity(const Connectivity& connectivity, OrderedJson* header, std::string* bytes) {
  std::vector<int> segments;
  if (connectivity.IsGraph()) {
    for (const auto& [a, b] : connectivity.Segments()) segments.insert(segments.end(), {a, b});
  }
  (*header)["vertices"] = connectivity.NumVertices();
  (*header)["triangles"] = connectivity.NumTriangles();
  (*header)["segments"] = segments.size() / 2;
  AppendIndices(connectivity.Triangles().data(), connectivity.Triangles().size(), bytes);
  AppendIndices(segments.data(), segments.size(), bytes);
}

std::vector<Steps> QuantiseAll(const std::vector<Shape>& shapes, OrderedJson* header) {
  const Box box = BoxAround(shapes);
  (*header)["shapes"] = shapes.size();
  (*header)["low"] = {box.low[0], box.low[1], box.low[2]};
  (*header)["side"] = box.side;
  std::vector<Steps> steps(shapes.size());
  ParallelFor(static_cast<int>(shapes.size()), [&](int i) { steps[i] = Quantise(shapes[i], box); });
  return steps;
}

// What of `view` is zero is that of a film strip of `shapes`.
void AppendView(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                const PageView& view, OrderedJson* header) {
  const Box box = BoxAround(shapes);
  std::vector<Shape> small;
  for (const Shape& shape : shapes) {
    small.push_back((shape.colwise() - box.low).array() / std::max(box.side, 1e-300) /
                    std::sqrt(3.0));
  }
  const RayTracer tracer(connectivity, kEdgeRadius);
  std::vector<RayScene> scenes;
  for (const Shape& shape : small) scenes.emplace_back(tracer, shape, Eigen::VectorXf());
  Eigen::Vector3d up = view.up.isZero(0) ? ChooseUp(connectivity, small) : view.up.normalized();
  if (view.up.isZero(0) && !view.eye.isZero(0)) up = UpBeside(view.eye, up);
  const Eigen::Vector3d eye =
      view.eye.isZero(0) ? Eigen::Vector3d(ChooseView(connectivity, small, scenes, up).col(2))
                         : view.eye.normalized();
  (*header)["up"] = {up[0], up[1], up[2]};
  (*header)["eye"] = {eye[0], eye[1], eye[2]};
}

// Values of every vertex and shape, of which `end` has the last shade, as differences from shape to
// shape.
void AppendShades(const std::vector<Eigen::VectorXd>& values, double end, std::string* bytes) {
  std::string last(values[0].size(), 0);
  for (const Eigen::VectorXd& of_shape : values) {
    for (Eigen::Index v = 0; v < of_shape.size(); ++v) {
      const auto shade = static_cast<char>(std::lround(kShades * std::min(1.0, of_shape[v] / end)));
      bytes->push_back(static_cast<char>(shade - last[v]));
      last[v] = shade;
    }
  }
}

void AppendDeviations(const Path& path, OrderedJson* header, std::string* bytes) {
  std::vector<Eigen::VectorXd> deviations(path.NumShapes());
  std::vector<RmsAndMax> edges(path.NumShapes());
  ParallelFor(path.NumShapes(), [&](int i) {
    deviations[i] = EdgeDeviation(path, i);
    edges[i] = DeviationFromFirst(path, i);
  });
  const double end = EndOfScale(deviations);
  (*header)["scaleEnd"] = end;
  for (const RmsAndMax& edge : edges) {
    (*header)["rms"].push_back(edge.rms);
    (*header)["max"].push_back(edge.max);
  }
  AppendShades(deviations, end, bytes);
}

// Where the motion costs its energy, if the metric says so.
void AppendEnergies(const Path& path, OrderedJson* header, std::string* bytes) {
  (*header)["energyEnd"] = nullptr;
  if (path.metric->rigid.Active() || path.NumShapes() < 2) return;
  const std::vector<Eigen::VectorXd> energies = VertexEnergy(path);
  const double end = EndOfScale(energies);
  (*header)["energyEnd"] = end;
  AppendShades(energies, end, bytes);
}

// The squared speed in every segment.
std::vector<double> SquaredSpeeds(const Path& path) {
  std::vector<double> speeds = SquaredLengths(path.metric, path.shapes);
  for (size_t i = 0; i < speeds.size(); ++i) {
    const double time = path.parameters[i + 1] - path.parameters[i];
    speeds[i] /= time * time;
  }
  return speeds;
}

// Red, green and blue of every vertex.
void AppendColours(const Eigen::MatrixXd& colours, std::string* bytes) {
  for (Eigen::Index v = 0; v < colours.cols(); ++v) {
    for (int k = 0; k < 3; ++k) {
      bytes->push_back(static_cast<char>(std::lround(255 * colours(k, v))));
    }
  }
}

// Those of an appearance, which may have none.
void AppendOwnColours(const Eigen::MatrixXd& colours, OrderedJson* header, std::string* bytes) {
  (*header)["colours"] = colours.size() > 0;
  AppendColours(colours, bytes);
}

// Colours of the near-rigid parts, if there are any.
void AppendParts(const Path& path, OrderedJson* header, std::string* bytes) {
  const RigidParts parts = FindRigidParts(path);
  (*header)["parts"] = parts.parts.size();
  if (!parts.parts.empty()) AppendColours(ColourByGroup(parts.of_vertex), bytes);
}

// Where the surface passes through itself: of each shape the vertices of triangles that intersect.
void AppendIntersections(const Path& path, OrderedJson* header, std::string* bytes) {
  (*header)["intersections"] = nullptr;
  const Connectivity& connectivity = *path.metric->connectivity;
  if (connectivity.NumTriangles() == 0) return;
  struct OfShape {
    size_t pairs = 0;
    std::vector<int> vertices;  // ascending
  };
  std::vector<OfShape> shapes(path.NumShapes());
  ParallelFor(path.NumShapes(), [&](int i) {
    auto& [pairs, vertices] = shapes[i];
    for (const auto& [a, b] : FindIntersections(connectivity, path.shapes[i])) {
      ++pairs;
      for (const int f : {a, b}) {
        const auto corners = connectivity.Triangles().col(f);
        vertices.insert(vertices.end(), corners.begin(), corners.end());
      }
    }
    SortUnique(&vertices);
  });
  std::vector<int> all;
  for (const auto& [pairs, vertices] : shapes) {
    (*header)["intersections"].push_back({{"pairs", pairs}, {"vertices", vertices.size()}});
    all.insert(all.end(), vertices.begin(), vertices.end());
  }
  AppendIndices(all.data(), all.size(), bytes);
}

// Numbers as their bits in single precision.
void AppendFloats(const Eigen::VectorXf& numbers, std::string* bytes) {
  std::vector<int> bits(numbers.size());
  static_assert(sizeof(int) == sizeof(float));
  std::memcpy(bits.data(), numbers.data(), sizeof(int) * bits.size());
  AppendIndices(bits.data(), bits.size(), bytes);
}

// Those of the path's surface, if there are any.
void AppendTextures(const PagePath& scene, OrderedJson* header, std::string* bytes,
                    std::vector<std::string>* warnings) {
  (*header)["textures"] = nullptr;
  const std::optional<PageTextures> textures =
      FindPageTextures(*scene.path->metric->connectivity, scene.path->appearance,
                       scene.allow_outside_files, warnings);
  if (!textures) return;
  if (!textures->coordinates.allFinite()) {
    throw MeshError(scene.name + ": single precision cannot hold a texture coordinate");
  }
  OrderedJson& of_header = (*header)["textures"];
  of_header = {{"vertices", textures->source.size()}};
  for (const PageTextures::Part& part : textures->parts) {
    OrderedJson colour;
    if (part.colour) colour = std::vector<double>(part.colour->begin(), part.colour->end());
    of_header["parts"].push_back(
        {{"triangles", part.triangles}, {"image", part.image}, {"colour", colour}});
  }
  for (const TextureImage& image : textures->images) {
    of_header["images"].push_back({{"type", image.type}, {"bytes", image.bytes.size()}});
  }
  AppendIndices(textures->source.data(), textures->source.size(), bytes);
  AppendIndices(textures->corners.data(), textures->corners.size(), bytes);
  for (int k = 0; k < 2; ++k) AppendFloats(textures->coordinates.row(k).transpose(), bytes);
  for (const TextureImage& image : textures->images) *bytes += image.bytes;
}

std::string Compress(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string compressed(size, 0);
  if (compress(reinterpret_cast<Bytef*>(compressed.data()), &size,
               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != Z_OK) {
    throw std::bad_alloc();
  }
  compressed.resize(size);
  return compressed;
}

std::string Pack(const OrderedJson& header, const std::string& arrays) {
  const std::string text = JsonText(header);
  std::string all;
  AppendLittleEndian(static_cast<std::uint32_t>(text.size()), &all);
  return Compress(all + text + arrays);
}

void CheckSize(const std::string& name, size_t shapes, int vertices, int bytes_a_vertex) {
  const double bytes = static_cast<double>(shapes) * vertices * bytes_a_vertex;
  if (bytes <= kMaxBytes) return;
  throw MeshError(name + ": " + std::to_string(shapes) + " shapes of " + std::to_string(vertices) +
                  " vertices are too many for a page; use fewer shapes or a smaller mesh");
}

void CheckNodes(const std::string& name, const char* what, const int* nodes, Eigen::Index count,
                size_t num_nodes) {
  for (Eigen::Index k = 0; k < count; ++k) {
    if (nodes[k] < 0 || static_cast<size_t>(nodes[k]) >= num_nodes) {
      throw MeshError(name + ": " + what + " refer to a node that does not exist");
    }
  }
}

void CheckColours(const std::string& name, const Eigen::MatrixXd& colours, Eigen::Index vertices) {
  if (colours.size() > 0 && (colours.rows() < 3 || colours.cols() != vertices ||
                             !(colours.array() >= 0 && colours.array() <= 1).all())) {
    throw MeshError(name + ": vertex colours do not fit");
  }
}

void CheckShapes(const std::string& name, const Connectivity& connectivity,
                 const std::vector<Shape>& shapes) {
  for (const Shape& shape : shapes) {
    if (shape.cols() != connectivity.NumVertices() || !shape.allFinite()) {
      throw MeshError(name + ": a shape has another number of vertices, or is not finite");
    }
  }
}

void CheckModes(const PageModes& modes) {
  const size_t count = modes.shares.size();
  const auto poses = static_cast<Eigen::Index>(modes.names.size());
  const auto scalars = static_cast<Eigen::Index>(modes.scalars.size());
  const auto fail = [&] { throw MeshError(modes.name + ": numbers of keys or modes do not fit"); };
  if (modes.connectivity == nullptr || count == 0 || modes.places.empty()) fail();
  if (modes.keys.size() != 1 + count * modes.places.size() + count * (count - 1) / 2) fail();
  if (modes.coordinates.rows() != poses || modes.coordinates.cols() != modes.NumModes()) fail();
  if (scalars > 0 && (modes.intercept.size() != modes.NumModes() ||
                      modes.slopes.rows() != modes.NumModes() || modes.slopes.cols() != scalars)) {
    fail();
  }
  CheckShapes(modes.name, *modes.connectivity, modes.keys);
  CheckColours(modes.name, modes.vertex_colours, modes.keys[0].cols());
}

void CheckSpace(const PageSpace& space) {
  const size_t num_nodes = space.nodes.size();
  if (space.connectivity == nullptr || num_nodes == 0) throw MeshError(space.name + ": no shape");
  if (static_cast<size_t>(space.points.cols()) != num_nodes ||
      space.names.size() + space.parents.size() != num_nodes || space.names.empty()) {
    throw MeshError(space.name + ": numbers of nodes, points, names and parents do not fit");
  }
  CheckShapes(space.name, *space.connectivity, space.nodes);
  CheckColours(space.name, space.vertex_colours, space.nodes[0].cols());
  if (!space.points.allFinite()) throw MeshError(space.name + ": a point is not finite");
  CheckNodes(space.name, "triangles", space.triangles.data(), space.triangles.size(), num_nodes);
  CheckNodes(space.name, "segments", space.segments.data(), space.segments.size(), num_nodes);
  for (size_t i = 0; i < space.parents.size(); ++i) {
    CheckNodes(space.name, "parents", space.parents[i].data(), 2, space.names.size() + i);
  }
}

template <typename Matrix>
OrderedJson Columns(const Matrix& matrix) {
  OrderedJson columns = OrderedJson::array();
  for (Eigen::Index c = 0; c < matrix.cols(); ++c) {
    const auto column = matrix.col(c);
    columns.push_back(std::vector<typename Matrix::Scalar>(column.begin(), column.end()));
  }
  return columns;
}

}  // namespace

std::string EncodeScene(const PagePath& scene, const PageView& view,
                        std::vector<std::string>* warnings) {
  const Path& path = *scene.path;
  try {
    path.Validate();
  } catch (const MeshError& error) {
    throw MeshError(scene.name + ": " + error.what());
  }
  const Connectivity& connectivity = *path.metric->connectivity;
  CheckSize(scene.name, path.shapes.size(), connectivity.NumVertices(), 8);
  OrderedJson header = {
      {"version", kVersion}, {"kind", "path"}, {"name", scene.name}, {"file", scene.file}};
  std::string arrays;
  AppendConnectivity(connectivity, &header, &arrays);
  header["parameters"] = path.parameters;
  header["poses"] = path.poses;
  header["poseNames"] = path.pose_names;
  header["extrapolated"] = path.extrapolated;
  header["smooth"] = path.smooth;
  header["metric"] = DescribeMetric(path.metric->options);
  header["speeds"] = SquaredSpeeds(path);
  const std::vector<Shape> shapes = path.Placed();
  AppendView(connectivity, {shapes.front(), shapes.back()}, view, &header);
  const std::vector<Steps> steps = QuantiseAll(shapes, &header);
  AppendPositions(steps, PredictAlongPath(steps), &arrays);
  AppendDeviations(path, &header, &arrays);
  AppendEnergies(path, &header, &arrays);
  AppendParts(path, &header, &arrays);
  AppendIntersections(path, &header, &arrays);
  AppendOwnColours(path.appearance.vertex_colours, &header, &arrays);
  AppendTextures(scene, &header, &arrays, warnings);
  return Pack(header, arrays);
}

std::string EncodeScene(const PageSpace& scene, const PageView& view) {
  CheckSpace(scene);
  CheckSize(scene.name, scene.nodes.size(), scene.connectivity->NumVertices(), 6);
  OrderedJson header = {{"version", kVersion}, {"kind", "space"}, {"name", scene.name}};
  std::string arrays;
  AppendConnectivity(*scene.connectivity, &header, &arrays);
  header["names"] = scene.names;
  header["points"] = Columns(scene.points);
  header["planeTriangles"] = Columns(scene.triangles);
  header["planeSegments"] = Columns(scene.segments);
  header["parents"] = scene.parents;
  AppendView(*scene.connectivity,
             {scene.nodes.begin(), scene.nodes.begin() + std::min<size_t>(scene.names.size(), 3)},
             view, &header);
  const std::vector<Steps> steps = QuantiseAll(scene.nodes, &header);
  AppendPositions(steps, PredictFromParents(steps, scene.parents), &arrays);
  AppendOwnColours(scene.vertex_colours, &header, &arrays);
  return Pack(header, arrays);
}

std::string EncodeScene(const PageModes& scene, const PageView& view) {
  CheckModes(scene);
  CheckSize(scene.name, scene.keys.size(), scene.connectivity->NumVertices(), 6);
  OrderedJson header = {
      {"version", kVersion}, {"kind", "modes"}, {"name", scene.name}, {"file", scene.file}};
  std::string arrays;
  AppendConnectivity(*scene.connectivity, &header, &arrays);
  header["places"] = scene.places;
  header["pairPlace"] = scene.pair_place;
  header["error"] = scene.error;
  header["shares"] = scene.shares;
  header["names"] = scene.names;
  header["coordinates"] = Columns(scene.coordinates.transpose().eval());
  header["scalars"] = OrderedJson::array();
  for (const PageModes::Scalar& scalar : scene.scalars) {
    header["scalars"].push_back({{"name", scalar.name},
                                 {"least", scalar.least},
                                 {"most", scalar.most},
                                 {"value", scalar.value}});
  }
  header["intercept"] = std::vector<double>(scene.intercept.begin(), scene.intercept.end());
  header["slopes"] = Columns(scene.slopes);
  PageView own_view = view;
  if (view.up.isZero(0) && view.eye.isZero(0)) own_view.up = scene.up;
  AppendView(*scene.connectivity, {scene.keys[0]}, own_view, &header);
  const std::vector<Steps> steps = QuantiseAll(scene.keys, &header);
  // Every key is predicted to be the mean.
  std::vector<Steps> predicted(steps.size(), steps[0]);
  predicted[0].assign(steps[0].size(), 0);
  AppendPositions(steps, predicted, &arrays);
  AppendOwnColours(scene.vertex_colours, &header, &arrays);
  return Pack(header, arrays);
}

std::string EncodeScene(const PageMesh& scene, const PageView& view) {
  if (scene.connectivity == nullptr) throw MeshError(scene.name + ": no mesh");
  CheckShapes(scene.name, *scene.connectivity, {scene.shape});
  CheckColours(scene.name, scene.vertex_colours, scene.shape.cols());
  CheckSize(scene.name, 1, scene.connectivity->NumVertices(), 6);
  const int vertices = scene.connectivity->NumVertices();
  for (const int vertex : scene.markers) {
    if (vertex < 0 || vertex >= vertices) {
      throw MeshError(scene.name + ": a marker is at vertex " + std::to_string(vertex) + " of " +
                      std::to_string(vertices) + ", counted from 0");
    }
  }
  OrderedJson header = {{"version", kVersion},
                        {"kind", "mesh"},
                        {"name", scene.name},
                        {"file", scene.file},
                        {"markers", scene.markers}};
  std::string arrays;
  AppendConnectivity(*scene.connectivity, &header, &arrays);
  AppendView(*scene.connectivity, {scene.shape}, view, &header);
  const std::vector<Steps> steps = QuantiseAll({scene.shape}, &header);
  AppendPositions(steps, {Steps(steps[0].size(), 0)}, &arrays);
  AppendOwnColours(scene.vertex_colours, &header, &arrays);
  return Pack(header, arrays);
}

}  // namespace shapespace::internal
