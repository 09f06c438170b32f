#include <unistd.h>
#include <zlib.h>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <shapespace/bodies/sheet.h>
#include <shapespace/correspondence/landmark_file.h>
#include <shapespace/correspondence/marker_file.h>
#include <shapespace/correspondence/surface_map.h>
#include <shapespace/deformation/handle_file.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/files/point_cache.h>
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/selection.h>
#include <shapespace/metric/metric.h>
#include <shapespace/output/detail/materials.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/path_file.h>
#include <shapespace/statistics/modes_file.h>
#include <shapespace/statistics/pose_table.h>
#include <shapespace/statistics/shape_model.h>

#include "fuzz/targets.h"

namespace shapespace::fuzz {
namespace {

// A folder of this process that goes with it.
const std::filesystem::path& Folder() {
  struct Made {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("shapespace_fuzz_" + std::to_string(::getpid()));
    Made() { std::filesystem::create_directories(path); }
    ~Made() { std::filesystem::remove_all(path); }
  };
  static const Made folder;
  return folder.path;
}

// A file with these bytes in that folder.
class BytesFile {
 public:
  BytesFile(const std::string& bytes, const std::string& name) : file_(Folder() / name) {
    std::ofstream(file_, std::ios::binary) << bytes;
  }
  operator std::string() const { return file_.string(); }

 private:
  const std::filesystem::path file_;
};

// A .path, .space, .modes or record with the checksum that fits, without which hardly any input
// would get beyond the checksum.
std::string WithChecksum(std::string bytes) {
  constexpr size_t kChecksum = 12, kCovered = 16;
  if (bytes.size() < kCovered) return bytes;
  const auto sum =
      static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(&bytes[kCovered]),
                                       static_cast<uInt>(bytes.size() - kCovered)));
  std::memcpy(&bytes[kChecksum], &sum, sizeof sum);
  return bytes;
}

// What was read, as all tools go on with it: as two poses, triangulated, with a metric.
void CheckRead(const Soup& soup) {
  Expect(soup.vertices.allFinite(), "a vertex that is not finite was read");
  soup.appearance.Validate(soup.NumVertices(), soup.NumPolygons(),
                           static_cast<int>(soup.corners.size()));
  for (const Finding& finding : CheckSoup(soup)) {
    Expect(!finding.message.empty(), "a finding without a message");
  }
  ReadOptions options;
  options.allow_nonmanifold = true;
  const Poses poses = MakePoses({soup, soup}, options);
  const auto metric = FreezeMetric({}, poses.connectivity, poses.shapes);
  Expect(metric->unit > 0 && std::isfinite(metric->unit), "the unit of a metric is no length");
  for (const auto& feature : metric->features) {
    Expect(feature->Weights().allFinite(), "a weight of a metric is not finite");
  }
}

// The format of a mesh read from a stream; a name in a folder that does not exist.
template <MeshFormat format>
void ReadMesh(const std::string& bytes) {
  std::istringstream stream(bytes);
  CheckRead(ReadSoup(stream, "nowhere/bytes", format));
}

// glTF and its morph targets.
void ReadGlb(const std::string& bytes) {
  for (const Soup& soup : ReadSoups(BytesFile(bytes, "bytes.glb"))) CheckRead(soup);
}

template <bool is_pc2>
void ReadCache(const std::string& bytes) {
  const PointCache cache = ReadPointCache(BytesFile(bytes, is_pc2 ? "bytes.pc2" : "bytes.mdd"));
  for (const Shape& shape : cache.shapes) {
    Expect(shape.allFinite(), "a vertex that is not finite was read");
  }
}

// An OBJ whose materials are the bytes. Outputs read the materials, not the reader of OBJ.
void ReadMtl(const std::string& bytes) {
  static const Soup soup = ReadSoup(BytesFile(
      "mtllib bytes.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", "with_materials.obj"));
  const BytesFile materials(bytes, "bytes.mtl");
  std::vector<std::string> warnings;
  for (const auto& material : internal::ReadMaterials(soup.appearance, false, &warnings)) {
    Expect(!material || (material->colour.minCoeff() >= 0 && material->colour.maxCoeff() <= 1 &&
                         material->opacity >= 0 && material->opacity <= 1),
           "a share that is not from 0 to 1");
  }
}

void ReadAnyPath(const std::string& bytes) {
  const Path path = ReadPath(BytesFile(WithChecksum(bytes), "bytes.path"));
  path.Validate();
  for (const Shape& shape : path.Placed()) Expect(shape.allFinite(), "a shape is not finite");
  const std::vector<double> lengths = SquaredLengths(path.metric, path.shapes);
  Expect(lengths.size() + 1 == path.shapes.size(), "lengths and shapes differ in number");
}

const ShapeFamily& Sheet() {
  static const ShapeFamily sheet = MakeSheet(2, 1, 4, 2);
  return sheet;
}

Poses SheetPoses() {
  Poses poses;
  poses.connectivity = Sheet().connectivity;
  poses.shapes = {Sheet().pose(0)};
  poses.names = {"sheet"};
  return poses;
}

// The first byte tells which of the three forms it is.
void ReadAnyLandmarks(const std::string& bytes) {
  const char first = bytes.empty() ? ' ' : bytes.front();
  const char* name = first == '{' ? "bytes.mrk.json" : first == '#' ? "bytes.fcsv" : "bytes.txt";
  for (const Landmark& landmark : ReadLandmarks(BytesFile(bytes, name))) {
    Expect(landmark.position.allFinite(), "a landmark is not finite");
  }
}

void ReadAnyCurve(const std::string& bytes) {
  static const PoseSpace space = [] {
    ExploreOptions options;
    options.depth = 0;
    return Explore(Sheet().connectivity, {Sheet().pose(0), Sheet().pose(30), Sheet().pose(60)},
                   {"a", "b", "c"}, options)
        .space;
  }();
  for (const Eigen::Vector2d& point : ReadCurve(BytesFile(bytes, "curve.txt"), space)) {
    Expect(point.allFinite(), "a point is not finite");
  }
}

void ReadAnySpace(const std::string& bytes) {
  const PoseSpace space = ReadSpace(BytesFile(WithChecksum(bytes), "bytes.space"));
  space.Validate();
  for (int i = 0; i < space.NumNodes(); ++i) {
    Expect(space.At(space.points.col(i)).allFinite(), "a shape is not finite");
  }
}

void ReadAnyModes(const std::string& bytes) {
  const PoseModes modes = ReadModes(BytesFile(WithChecksum(bytes), "bytes.modes"));
  modes.Validate();
  for (int i = 0; i < modes.NumPoses(); ++i) {
    Expect(modes.PlacedPose(i).allFinite(), "a shape is not finite");
  }
  const ShapeModel model(modes);
  Expect(model.Preview(Eigen::VectorXd::Zero(modes.NumModes())).cols() == modes.mean.cols(),
         "the mean has another number of vertices");
}

// The record of a midpoint, in an exploration that finds it. Where the bytes have 32 zeros, the
// record has the digest of the geodesic, which depends on the machine's sine.
void ReadRecord(const std::string& bytes) {
  static const ShapeFamily sheet = MakeSheet(1, 1, 2, 1);
  static const std::vector<Shape> poses = {sheet.pose(0), sheet.pose(60)};
  ExploreOptions options;
  options.geodesic.shapes = 1;
  options.geodesic.max_iterations = 2;
  options.depth = 1;
  options.threshold = 1e-6;
  options.records = (Folder() / "records").string();
  static const std::filesystem::path file = [&] {
    Explore(sheet.connectivity, poses, {}, options);
    std::filesystem::path longest;
    for (const auto& entry : std::filesystem::directory_iterator(options.records)) {
      if (longest.empty() || entry.file_size() > std::filesystem::file_size(longest)) {
        longest = entry.path();
      }
    }
    return longest;
  }();
  std::string record = bytes;
  const std::string zeros(32, '0');
  if (const size_t at = record.find(zeros); at != std::string::npos) {
    record.replace(at, zeros.size(), file.stem().string());
  }
  std::ofstream(file, std::ios::binary) << WithChecksum(record);
  const ExploreResult result = Explore(sheet.connectivity, poses, {}, options);
  for (const Shape& node : result.space.nodes) {
    Expect(node.cols() == sheet.connectivity->NumVertices(), "a node of another mesh");
    Expect(node.allFinite(), "a node is not finite");
  }
}

void CheckVertices(const std::vector<int>& vertices) {
  for (const int v : vertices) {
    Expect(v >= 0 && v < Sheet().connectivity->NumVertices(), "a vertex that is none");
  }
}

// The barycentric coordinates are checked as they are documented.
void CheckPoints(const SurfacePoints& points) {
  Expect(points.barycentric.cols() == points.triangle.size(), "not as many points as triangles");
  for (int v = 0; v < points.NumVertices(); ++v) {
    const auto weights = points.barycentric.col(v);
    Expect(points.triangle(v) >= 0 && points.triangle(v) < Sheet().connectivity->NumTriangles(),
           "a triangle that is none");
    Expect(weights.minCoeff() >= 0 && std::abs(weights.sum() - 1) < 1e-3,
           "a point outside of its triangle");
  }
}

// The beginning tells which of the files with numbers of vertices it is.
void ReadAnyField(const std::string& bytes) {
  const auto begins = [&](const char* with) { return bytes.rfind(with, 0) == 0; };
  std::string source = "field.txt", name;
  if (begins("ply")) source = "field.ply", name = ":f";
  if (begins("#") && bytes.find("vtk") < 4) source = "field.vtk", name = ":f";
  if (begins("<")) source = "field.vtp", name = ":f";
  Expect(ReadVertexField(std::string(BytesFile(bytes, source)) + name).allFinite(),
         "a number that is not finite");
}

}  // namespace

std::vector<Target> Readers() {
  return {
      {"obj", ReadMesh<MeshFormat::kObj>},
      {"mtl", ReadMtl},
      {"ply", ReadMesh<MeshFormat::kPly>},
      {"off", ReadMesh<MeshFormat::kOff>},
      {"stl", ReadMesh<MeshFormat::kStl>},
      {"gltf", ReadMesh<MeshFormat::kGltf>},
      {"glb", ReadGlb},
      {"vtk", ReadMesh<MeshFormat::kVtk>},
      {"vtp", ReadMesh<MeshFormat::kVtp>},
      {"pc2", ReadCache<true>},
      {"mdd", ReadCache<false>},
      {"path", ReadAnyPath},
      {"space", ReadAnySpace},
      {"record", ReadRecord},
      {"curve", ReadAnyCurve},
      {"modes", ReadAnyModes},
      {"handles",
       [](const std::string& bytes) {
         for (const DeformationHandle& handle : ReadHandles(
                  BytesFile(bytes, "bytes.json"), Sheet().pose(0), *Sheet().connectivity, {})) {
           CheckVertices(handle.vertices);
         }
       }},
      {"selection",
       [](const std::string& bytes) {
         CheckVertices(
             SelectVertices(ReadSelection(bytes), Sheet().pose(0), *Sheet().connectivity, {}));
       }},
      {"standing",
       [](const std::string& bytes) {
         for (const StandingPart& part :
              ReadStandingParts(bytes, Sheet().pose(0), *Sheet().connectivity, {})) {
           CheckVertices(part.vertices);
         }
       }},
      {"markers",
       [](const std::string& bytes) {
         for (const CorrespondenceMarker& marker :
              ReadMarkers(BytesFile(bytes, "bytes.txt"), SheetPoses(), SheetPoses())) {
           CheckVertices({marker.template_vertex, marker.target_vertex});
         }
       }},
      {"landmarks", ReadAnyLandmarks},
      {"map",
       [](const std::string& bytes) {
         const int triangles = Sheet().connectivity->NumTriangles();
         const SurfaceMap map = ReadSurfaceMap(BytesFile(bytes, "map.txt"), triangles, triangles);
         CheckPoints(map.to_target);
         CheckPoints(map.to_template);
       }},
      {"field", ReadAnyField},
      {"stiffeners",
       [](const std::string& bytes) { ReadStiffeners(BytesFile(bytes, "pairs.txt"), 9); }},
      {"table",
       [](const std::string& bytes) {
         const PoseTable table = ReadPoseTable(BytesFile(bytes, "table.csv"));
         Expect(table.LabelsOf(table.poses).size() == table.poses.size(), "a pose without a label");
         Expect(table.NumbersOf(table.poses).allFinite(), "a number that is not finite");
       }},
  };
}

}  // namespace shapespace::fuzz
