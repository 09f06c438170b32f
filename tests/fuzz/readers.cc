#include <unistd.h>
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
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/selection.h>
#include <shapespace/path/path_file.h>
#include <shapespace/statistics/modes_file.h>
#include <shapespace/statistics/pose_table.h>

#include "fuzz/targets.h"

namespace shapespace::fuzz {
namespace {

// A file with these bytes, in a folder of this process that goes with it.
class BytesFile {
 public:
  BytesFile(const std::string& bytes, const std::string& name) : file_(Folder() / name) {
    std::ofstream(file_, std::ios::binary) << bytes;
  }
  operator std::string() const { return file_.string(); }

 private:
  static const std::filesystem::path& Folder() {
    struct Made {
      std::filesystem::path path = std::filesystem::temp_directory_path() /
                                   ("shapespace_fuzz_" + std::to_string(::getpid()));
      Made() { std::filesystem::create_directories(path); }
      ~Made() { std::filesystem::remove_all(path); }
    };
    static const Made folder;
    return folder.path;
  }
  const std::filesystem::path file_;
};

void CheckRead(const Soup& soup) {
  Expect(soup.vertices.allFinite(), "a vertex that is not finite was read");
  soup.appearance.Validate(soup.NumVertices(), soup.NumPolygons(),
                           static_cast<int>(soup.corners.size()));
  for (const Finding& finding : CheckSoup(soup)) {
    Expect(!finding.message.empty(), "a finding without a message");
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

// An OBJ whose materials are the bytes.
void ReadMaterials(const std::string& bytes) {
  const BytesFile materials(bytes, "bytes.mtl");
  CheckRead(ReadSoup(BytesFile("mtllib bytes.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n",
                               "with_materials.obj")));
}

void ReadAnyPath(const std::string& bytes) {
  const Path path = ReadPath(BytesFile(bytes, "bytes.path"));
  path.Validate();
  for (const Shape& shape : path.Placed()) Expect(shape.allFinite(), "a shape is not finite");
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

void CheckVertices(const std::vector<int>& vertices) {
  for (const int v : vertices) {
    Expect(v >= 0 && v < Sheet().connectivity->NumVertices(), "a vertex that is none");
  }
}

}  // namespace

std::vector<Target> Readers() {
  return {
      {"obj", ReadMesh<MeshFormat::kObj>},
      {"mtl", ReadMaterials},
      {"ply", ReadMesh<MeshFormat::kPly>},
      {"off", ReadMesh<MeshFormat::kOff>},
      {"stl", ReadMesh<MeshFormat::kStl>},
      {"gltf", ReadMesh<MeshFormat::kGltf>},
      {"glb", ReadGlb},
      {"vtk", ReadMesh<MeshFormat::kVtk>},
      {"vtp", ReadMesh<MeshFormat::kVtp>},
      {"path", ReadAnyPath},
      {"space", [](const std::string& bytes) { ReadSpace(BytesFile(bytes, "bytes.space")); }},
      {"curve", ReadAnyCurve},
      {"modes", [](const std::string& bytes) { ReadModes(BytesFile(bytes, "bytes.modes")); }},
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
         ReadSurfaceMap(BytesFile(bytes, "map.txt"), triangles, triangles);
       }},
      {"field",
       [](const std::string& bytes) {
         Expect(ReadVertexField(BytesFile(bytes, "field.txt")).allFinite(),
                "a number that is not finite");
       }},
      {"stiffeners",
       [](const std::string& bytes) { ReadStiffeners(BytesFile(bytes, "pairs.txt"), 9); }},
      {"table",
       [](const std::string& bytes) {
         const PoseTable table = ReadPoseTable(BytesFile(bytes, "table.csv"));
         Expect(table.NumbersOf({}).rows() == 0, "rows for no pose");
       }},
  };
}

}  // namespace shapespace::fuzz
