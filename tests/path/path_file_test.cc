#include <shapespace/path/path_file.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/path/energy.h>

#include "support/message_of.h"
#include "support/paths.h"

namespace shapespace {
namespace {

std::string TemporaryFile(const std::string& name) {
  return (std::filesystem::path(::testing::TempDir()) / name).string();
}

std::string Slurp(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void Spill(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

// A path with every kind of feature, a quadrilateral and a stiffener.
Path MakePath() {
  const Body bar = MakeBar(4, 1, 1, 3, 1, 1);
  MetricOptions options;
  options.log_length = 0.1;
  options.volume = 0.3;
  options.rigid = 0.2;
  const auto connectivity =
      Connectivity::Make(bar.connectivity->NumVertices(), bar.connectivity->PolygonBegin(),
                         bar.connectivity->Corners(), {}, {{0, 7}});
  Path path;
  path.metric = std::make_shared<const Metric>(
      FreezeMetric(options, connectivity, {bar.pose(0), bar.pose(70)}));
  path.shapes = testing::NoisyBlend(bar.pose(0), bar.pose(70), 3, 0.1);
  path.parameters = {0, 0.2, 0.5, 0.9, 1};
  path.motions.resize(5);
  path.motions[2].translation = {1, 2, 3};
  path.motions[4].rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  path.poses = {0, 2};
  path.extrapolated = 2;
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

double Energy(const Path& path) {
  PathEnergy energy(*path.metric, path.NumShapes() - 2);
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
  EXPECT_EQ(read.provenance, path.provenance);
  EXPECT_EQ(read.metric->connectivity->Corners(), path.metric->connectivity->Corners());
  EXPECT_TRUE(read.metric->connectivity->Edges() == path.metric->connectivity->Edges());
  EXPECT_EQ(Describe(read.metric->options), Describe(path.metric->options));
  // The frozen metric means the same: the very energy, to the last bit.
  EXPECT_EQ(Energy(read), Energy(path));
  // Writing what was read gives the very file.
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
  EXPECT_NE(message(file).find("no .path file"), std::string::npos) << message(file);
  WritePath(file, MakePath());
  std::string later = Slurp(file);
  later[8] = 9;
  Spill(file, later);
  EXPECT_NE(message(file).find("version 9"), std::string::npos) << message(file);
}

TEST(PathFile, FilesFromBeforeExtrapolationHaveNone) {
  const std::string file = TemporaryFile("early.path");
  WritePath(file, MakePath());
  std::string bytes = Slurp(file);
  const std::string entry = "\"extrapolated\":2,";
  ASSERT_NE(bytes.find(entry), std::string::npos);
  bytes.replace(bytes.find(entry), entry.size(), std::string(entry.size(), ' '));
  const uint32_t checksum = Checksum(bytes.substr(16));
  std::memcpy(&bytes[12], &checksum, sizeof checksum);
  Spill(file, bytes);
  EXPECT_EQ(ReadPath(file).extrapolated, 0);
  EXPECT_EQ(ReadPath(file).NumShapes(), 5);
}

TEST(PathFile, PathsAtOddsWithThemselvesAreRefused) {
  const std::string file = TemporaryFile("odd.path");
  const auto message = [&](const std::function<void(Path*)>& change) {
    Path path = MakePath();
    change(&path);
    WritePath(file, path);
    return testing::MessageOf<FileError>([&] { ReadPath(file); });
  };
  const std::string extrapolated = file + ": its number of extrapolated shapes is out of range";
  EXPECT_EQ(message([](Path* path) { path->extrapolated = 5; }), extrapolated);
  EXPECT_EQ(message([](Path* path) { path->extrapolated = -1; }), extrapolated);
  const std::string pose = file + ": a pose's index is out of range";
  EXPECT_EQ(message([](Path* path) { path->extrapolated = 3; }), pose);  // a pose among them
  EXPECT_EQ(message([](Path* path) { path->poses = {0, 5}; }), pose);
  EXPECT_EQ(message([](Path* path) { path->poses = {-1, 2}; }), pose);
  EXPECT_EQ(message([](Path* path) {
              path->poses = {2, 0};
            }),
            file + ": its poses' indices do not rise");
  EXPECT_EQ(message([](Path* path) { path->parameters[3] = 0.5; }),
            file + ": its parameters do not rise");
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
