#include <shapespace/path/path_file.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <new>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/internal/array_file.h>

#include "support/message_of.h"
#include "support/paths.h"
#include "support/same_appearance.h"
#include "support/temporary_file.h"

namespace shapespace {
namespace {

using testing::TemporaryFile;

std::string Slurp(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void Spill(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

// A path with every kind of feature, a quadrilateral, a stiffener and a complete appearance.
Path MakePath() {
  const ShapeFamily bar = MakeBar(4, 1, 1, 3, 1, 1);
  MetricOptions options;
  options.strain = 0.2;
  options.volume = 0.3;
  options.rigid = 0.2;
  const auto connectivity =
      Connectivity::Make(bar.connectivity->NumVertices(), bar.connectivity->PolygonBegin(),
                         bar.connectivity->Corners(), {}, {{0, 7}});
  Path path;
  path.metric = FreezeMetric(options, connectivity, {bar.pose(0), bar.pose(70)});
  path.shapes = testing::NoisyBlend(bar.pose(0), bar.pose(70), 3, 0.1);
  path.parameters = {0, 0.2, 0.5, 0.9, 1};
  path.motions.resize(5);
  path.motions[2].translation = {1, 2, 3};
  path.motions[4].rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  path.poses = {0, 2};
  path.extrapolated = 2;
  path.converged = false;
  const int polygons = connectivity->NumPolygons();
  const int corners = static_cast<int>(connectivity->Corners().size());
  Appearance& appearance = path.appearance;
  appearance.texture_coordinates = Eigen::Matrix2Xd::Random(2, 7);
  for (int k = 0; k < corners; ++k) appearance.corner_texture.push_back(k % 8 - 1);
  appearance.material_libraries = {"bar.mtl", "d\xE9tail.mtl"};  // Latin-1, no UTF-8
  appearance.materials = {{"red", "gr\xC3\xBCn", "\xFF\xFE"}, {}};
  appearance.groups = {{"left", "right"}, {}};
  appearance.objects = {{"bar"}, std::vector<int>(polygons, 0)};
  for (int p = 0; p < polygons; ++p) {
    appearance.materials.of_polygon.push_back(p % 4 - 1);
    appearance.groups.of_polygon.push_back(p % 2);
  }
  appearance.vertex_colours =
      (Eigen::MatrixXd::Random(4, connectivity->NumVertices()).array() + 1) / 2;
  path.provenance = "a test, with \"quotes\" and \xC3\xA9";
  return path;
}

// CRC-32 as PNG's specification gives it, bit by bit.
uint32_t Checksum(const std::string& bytes) {
  uint32_t sum = 0xffffffff;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return ~sum;
}

// Replaces `entry` of the header in a file by `other`, which must not be longer.
void ReplaceEntry(const std::string& file, const std::string& entry, std::string other) {
  std::string bytes = Slurp(file);
  ASSERT_NE(bytes.find(entry), std::string::npos) << entry;
  other.resize(entry.size(), ' ');
  bytes.replace(bytes.find(entry), entry.size(), other);
  const uint32_t checksum = Checksum(bytes.substr(16));
  std::memcpy(&bytes[12], &checksum, sizeof checksum);
  Spill(file, bytes);
}

double Energy(const Path& path) {
  PathEnergy energy(path.metric, path.NumShapes() - 2);
  std::vector<double> unknowns(energy.Size());
  energy.Load(path.shapes, unknowns.data());
  return energy.Evaluate(unknowns.data(), nullptr);
}

TEST(PathFile, RoundTripKeepsEveryBit) {
  const Path path = MakePath();
  const std::string file = TemporaryFile("round_trip.path");
  WritePath(file, path);
  const Path read = ReadPath(file);
  ASSERT_EQ(read.NumShapes(), path.NumShapes());
  for (int i = 0; i < path.NumShapes(); ++i) {
    EXPECT_TRUE(read.shapes[i] == path.shapes[i]);
    EXPECT_TRUE(read.Placed(i) == path.Placed(i));
  }
  EXPECT_EQ(read.parameters, path.parameters);
  EXPECT_EQ(read.poses, path.poses);
  EXPECT_EQ(read.extrapolated, 2);
  EXPECT_FALSE(read.converged);
  EXPECT_EQ(read.provenance, path.provenance);
  testing::ExpectSame(read.appearance, path.appearance);
  EXPECT_EQ(read.metric->connectivity->Corners(), path.metric->connectivity->Corners());
  EXPECT_TRUE(read.metric->connectivity->Edges() == path.metric->connectivity->Edges());
  EXPECT_EQ(DescribeMetric(read.metric->options), DescribeMetric(path.metric->options));
  // The frozen metric is the same: the energies are equal to the last bit.
  EXPECT_EQ(Energy(read), Energy(path));
  // Writing what was read gives an identical file.
  const std::string again = TemporaryFile("again.path");
  WritePath(again, read);
  EXPECT_EQ(Slurp(again), Slurp(file));
}

TEST(PathFile, EveryDamageIsNoticed) {
  const std::string file = TemporaryFile("damaged.path");
  WritePath(file, MakePath());
  const std::string bytes = Slurp(file);
  std::mt19937 generator(5);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    const size_t at = i < 40 ? i : generator() % bytes.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (i % 8)));
    Spill(file, damaged);
    EXPECT_THROW(ReadPath(file), FileError) << "byte " << at;
  }
  for (size_t length : {size_t{0}, size_t{7}, size_t{20}, size_t{100}, bytes.size() - 1}) {
    Spill(file, bytes.substr(0, length));
    EXPECT_THROW(ReadPath(file), FileError) << "length " << length;
  }
  Spill(file, bytes + "x");
  EXPECT_THROW(ReadPath(file), FileError);
}

TEST(PathFile, ErrorsNameTheFileAndTheReason) {
  const auto message = [](const std::string& file) -> std::string {
    try {
      ReadPath(file);
    } catch (const FileError& error) {
      return error.what();
    }
    return "read";
  };
  EXPECT_NE(message("nowhere.path").find("nowhere.path"), std::string::npos);
  const std::string file = TemporaryFile("text.path");
  Spill(file, "v 1 2 3 this is an OBJ file, is it not?\n");
  EXPECT_TRUE(testing::Names(message(file), {".path"})) << message(file);
  WritePath(file, MakePath());
  std::string later = Slurp(file);
  later[8] = 9;
  Spill(file, later);
  EXPECT_NE(message(file).find("version 9"), std::string::npos) << message(file);
}

TEST(PathFile, AFolderOfSuchANameIsAFolder) {
  const std::string folder = TemporaryFile("folder.path");
  std::filesystem::create_directories(folder);
  EXPECT_TRUE(testing::Refuses<FileError>([&] { ReadPath(folder); }, {folder, "folder"}));
}

TEST(PathFile, LibrariesAreFoundFromTheFile) {
  const std::filesystem::path folder = TemporaryFile("moved");
  std::filesystem::remove_all(folder);
  Path path = MakePath();
  path.appearance.folder = (folder / "here" / "poses").string();
  WritePath((folder / "here" / "out" / "w.path").string(), path);
  EXPECT_EQ(ReadPath((folder / "here" / "out" / "w.path").string()).appearance.folder,
            path.appearance.folder);
  std::filesystem::rename(folder / "here", folder / "there");
  EXPECT_EQ(ReadPath((folder / "there" / "out" / "w.path").string()).appearance.folder,
            (folder / "there" / "poses").string());
}

TEST(PathFile, PathsAtOddsWithThemselvesAreNotWritten) {
  const std::string file = TemporaryFile("odd.path");
  std::filesystem::remove(file);
  const auto message = [&](const std::function<void(Path*)>& change) {
    Path path = MakePath();
    change(&path);
    return testing::MessageOf<MeshError>([&] { WritePath(file, path); });
  };
  using P = Path;
  EXPECT_TRUE(testing::Names(message([](P* p) { p->shapes.clear(); }), {file, "shape"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->motions.pop_back(); }), {file, "5"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->pose_names = {"one"}; }), {file, "names"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->shapes[1](2, 5) = std::nan(""); }),
                             {file, "shape 1", "vertex 5"}));
  EXPECT_EQ(message([](P* p) { p->shapes[2] = Shape::Zero(3, 7); }).find(file + ": shape 2 has 7 "),
            0u);
  EXPECT_TRUE(testing::Names(message([](P* p) { p->motions[3].translation.x() = std::nan(""); }),
                             {file, "shape 3"}));
  EXPECT_TRUE(testing::Names(message([](P* p) {
                               p->shapes[1](2, 5) = 1e200;
                               p->motions[1].rotation *= 1e200;
                             }),
                             {file, "shape 1"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->extrapolated = 5; }),
                             {file, "extrapolated", "5", "0", "4"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->extrapolated = -1; }),
                             {file, "extrapolated", "-1", "0", "4"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->extrapolated = 3; }), {file, "pose 2", "2"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->poses[1] = 5; }), {file, "pose 5", "3"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->poses[0] = -1; }), {file, "pose -1", "3"}));
  EXPECT_TRUE(
      testing::Names(message([](P* p) { std::swap(p->poses[0], p->poses[1]); }), {file, "poses"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->parameters[3] = 0.5; }), {file, "parameters"}));
  EXPECT_TRUE(testing::Names(message([](P* p) { p->appearance.corner_texture[2] = 7; }),
                             {file, "index 7", "-1", "6"}));
  EXPECT_FALSE(std::filesystem::exists(file));
}

/// The file with another header, and a checksum that fits.
void ChangeHeader(const std::string& file,
                  const std::function<void(internal::HeaderJson*)>& change) {
  const std::string bytes = Slurp(file);
  size_t begin;
  internal::HeaderJson header = internal::UnpackHeader({"SHAPPATH", 1, ".path"}, bytes, &begin);
  change(&header);
  const std::string text = header.dump();
  const uint64_t size = text.size();
  std::string changed = bytes.substr(0, 16);
  changed.append(reinterpret_cast<const char*>(&size), sizeof size);
  changed += text + bytes.substr(begin);
  const uint32_t checksum = Checksum(changed.substr(16));
  std::memcpy(&changed[12], &checksum, sizeof checksum);
  Spill(file, changed);
}

TEST(PathFile, MetricsThatAreNotKnownAreNotReadAsOthers) {
  const std::string file = TemporaryFile("later.path");
  for (const char* key : {"weights", "discretization", "stiffness_on"}) {
    for (const internal::HeaderJson& value :
         {internal::HeaderJson("cubic"), internal::HeaderJson(1)}) {
      WritePath(file, MakePath());
      ChangeHeader(file, [&](internal::HeaderJson* header) { (*header)["metric"][key] = value; });
      const std::string message = testing::MessageOf<FileError>([&] { ReadPath(file); });
      EXPECT_EQ(message.find(file + ": metric." + key + ": must be "), 0u) << message;
    }
  }
}

TEST(PathFile, SizesBeyondTheFileAreErrorsInIt) {
  const std::string file = TemporaryFile("absurd.path");
  const auto message = [&](const std::string& key, const internal::HeaderJson& value) {
    WritePath(file, MakePath());
    ChangeHeader(file, [&](internal::HeaderJson* header) { (*header)[key] = value; });
    return testing::MessageOf<FileError>([&] { ReadPath(file); });
  };
  EXPECT_TRUE(testing::Names(message("vertices", 2147483647), {file, "vertex_area"}));
  for (const char* key : {"vertices", "shapes", "extrapolated"}) {
    for (const internal::HeaderJson& value :
         {internal::HeaderJson(-1), internal::HeaderJson(2.5), internal::HeaderJson(1e35),
          internal::HeaderJson(2147483648), internal::HeaderJson("3")}) {
      EXPECT_TRUE(testing::Names(message(key, value), {file, key, "0", "2147483647"}));
    }
  }
  EXPECT_TRUE(testing::Names(message("shapes", 2147483647), {file, "parameters"}));
  WritePath(file, MakePath());
  ChangeHeader(file, [&](internal::HeaderJson* header) {
    (*header)["arrays"][0]["rows"] = 2147483647;
    (*header)["arrays"][0]["columns"] = 2147483647;
  });
  EXPECT_TRUE(testing::Refuses<FileError>([&] { ReadPath(file); }, {file, "arrays"}));
}

// The user would make a good file again, in vain.
TEST(PathFile, MemoryThatIsShortIsNoDamage) {
  const std::string file = TemporaryFile("good.path");
  WritePath(file, MakePath());
  const auto parse = [](const internal::HeaderJson&, const internal::ArrayReader&) -> int {
    throw std::bad_alloc();
  };
  EXPECT_THROW(internal::ReadArrayFile(file, {"SHAPPATH", 1, ".path"}, parse), std::bad_alloc);
}

TEST(PathFile, FilesAtOddsWithThemselvesAreNotRead) {
  const std::string file = TemporaryFile("odd_file.path");
  const auto message = [&](const std::string& entry, const std::string& other) {
    WritePath(file, MakePath());
    ReplaceEntry(file, entry, other);
    return testing::MessageOf<FileError>([&] { ReadPath(file); });
  };
  EXPECT_TRUE(
      testing::Names(message("\"extrapolated\":2", "\"extrapolated\":5"), {file, "5", "0", "4"}));
  EXPECT_TRUE(testing::Names(message("\"groups\":[\"left\",\"right\"]", "\"groups\":[\"left\"]"),
                             {file, "index 1", "-1", "0"}));
  EXPECT_TRUE(testing::Names(message("{\"name\":\"triangles\"", "{\"name\":\"trianglez\""),
                             {file, "triangles"}));
  EXPECT_NE(message("\"converged\":false,", "").find("converged"), std::string::npos);
}

// Three edges and three vertices: the numbers do not say what they belong to.
TEST(PathFile, SaysWhatItsStiffnessBelongsTo) {
  const auto triangle = Connectivity::Make(3, {0, 3}, {0, 1, 2});
  Shape shape(3, 3);
  shape << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  const std::string file = TemporaryFile("stiffness.path");
  for (const StiffnessOn on : {StiffnessOn::kVertices, StiffnessOn::kEdges}) {
    MetricOptions options;
    options.stretching_stiffness = Eigen::Vector3d(1, 2, 5);
    options.stiffness_on = on;
    WritePath(file, shapespace::MakePath(FreezeMetric(options, triangle, {shape}), {shape, shape}));
    const MetricOptions read = ReadPath(file).metric->options;
    EXPECT_EQ(read.stretching_stiffness, options.stretching_stiffness);
    EXPECT_EQ(read.stiffness_on, on);
  }
}

TEST(PathFile, NothingIsLeftBehindWhereItCannotBeWritten) {
  EXPECT_THROW(WritePath("/proc/nowhere/x.path", MakePath()), FileError);
  const auto folder = std::filesystem::path(TemporaryFile("folder_in_the_way.path"));
  std::filesystem::create_directories(folder / "inside");
  EXPECT_THROW(WritePath(folder.string(), MakePath()), FileError);
  for (const auto& entry : std::filesystem::directory_iterator(folder.parent_path())) {
    EXPECT_EQ(entry.path().string().find("in_the_way.path.part"), std::string::npos);
  }
}

}  // namespace
}  // namespace shapespace
