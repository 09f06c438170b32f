#include <shapespace/files/point_cache.h>

#include <cstdint>
#include <cstring>
#include <limits>

#include <shapespace/base/error.h>
#include <shapespace/files/write.h>

#include "mesh/bodies.h"
#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::ExpectError;

// Reads numbers one after the other, as a program on a little-endian machine does.
class Reader {
 public:
  Reader(std::string bytes, bool big_endian) : bytes_(std::move(bytes)), big_endian_(big_endian) {}

  std::string Text(size_t size) {
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

  template <typename Number>
  Number Next() {
    std::string four = Text(4);
    if (big_endian_) four = {four.rbegin(), four.rend()};
    Number number;
    std::memcpy(&number, four.data(), 4);
    return number;
  }

  bool Done() const { return at_ == bytes_.size(); }

 private:
  const std::string bytes_;
  const bool big_endian_;
  size_t at_ = 0;
};

class PointCacheTest : public testing::FilesTest {
 protected:
  PointCacheTest() {
    const Shape cube = testing::Cube().vertices;
    shapes_ = {cube, 2 * cube, (cube.array() - 0.3).matrix()};
  }

  void ExpectShapes(Reader* reader) {
    for (const Shape& shape : shapes_) {
      for (const double x : shape.reshaped())
        EXPECT_EQ(reader->Next<float>(), static_cast<float>(x));
    }
    EXPECT_TRUE(reader->Done());
  }

  std::vector<Shape> shapes_;
};

TEST_F(PointCacheTest, Pc2) {
  WritePointCache(Path("a.PC2"), shapes_);
  Reader reader(testing::Content(Path("a.PC2")), false);
  EXPECT_EQ(reader.Text(12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(reader.Next<std::int32_t>(), 1);  // version
  EXPECT_EQ(reader.Next<std::int32_t>(), 8);  // points
  EXPECT_EQ(reader.Next<float>(), 0);         // first frame
  EXPECT_EQ(reader.Next<float>(), 1);         // frames per sample
  EXPECT_EQ(reader.Next<std::int32_t>(), 3);  // samples
  ExpectShapes(&reader);
}

TEST_F(PointCacheTest, Mdd) {
  WritePointCache(Path("a.mdd"), shapes_, 25);
  Reader reader(testing::Content(Path("a.mdd")), true);
  EXPECT_EQ(reader.Next<std::int32_t>(), 3);  // frames
  EXPECT_EQ(reader.Next<std::int32_t>(), 8);  // points
  for (const float time : {0.0f, 0.04f, 0.08f}) EXPECT_EQ(reader.Next<float>(), time);
  ExpectShapes(&reader);
}

TEST_F(PointCacheTest, RefusesAndLeavesTheOldFileAlone) {
  const std::string old = File("old.pc2", "old");
  const auto refuse = [&](const std::vector<Shape>& shapes, const std::string& message) {
    ExpectError<MeshError>([&] { WritePointCache(old, shapes); }, {"old.pc2: ", message});
  };
  refuse({}, "there is no shape");
  refuse({shapes_[0], shapes_[0].leftCols(7)}, "shapes of 8 and of 7 vertices");
  Shape broken = shapes_[0];
  broken(2, 3) = std::nan("");
  refuse({shapes_[0], broken}, "vertex 4: a coordinate is not a finite number");
  const Shape far = shapes_[2].array() + 1e6;
  refuse({far}, "nearer to the origin");
  refuse({shapes_[0], shapes_[1], far}, "nearer to the origin");
  EXPECT_EQ(testing::Content(old), "old");
  ExpectError<FileError>([&] { WritePointCache(Path("a.abc"), shapes_); }, {".pc2 or .mdd"});
  ExpectError<InvalidOptions>([&] { WritePointCache(Path("a.mdd"), shapes_, 0); }, {"fps: "});
}

TEST_F(PointCacheTest, IsReadAsItWasWritten) {
  for (const char* name : {"a.pc2", "a.MDD"}) {
    WritePointCache(Path(name), shapes_, 30);
    const PointCache cache = ReadPointCache(Path(name));
    EXPECT_TRUE(cache.even) << name;
    ASSERT_EQ(cache.shapes.size(), 3u) << name;
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(cache.shapes[i], shapes_[i].cast<float>().cast<double>()) << name;
    }
  }
}

// The mesh itself may be in any pose, or in none of the motion.
TEST_F(PointCacheTest, FramesArePosesOfTheMeshBefore) {
  Soup cube = testing::Cube();
  cube.vertices *= 5;
  WriteMesh(Path("cube.ply"), cube.vertices, cube);
  WritePointCache(Path("walk.mdd"), shapes_);
  WritePointCache(Path("on.pc2"), {shapes_[1]});
  const Poses poses = ReadPoses({Path("cube.ply"), Path("walk.mdd"), Path("on.pc2")});
  ASSERT_EQ(poses.shapes.size(), 4u);
  EXPECT_EQ(poses.shapes[1], shapes_[1]);
  EXPECT_EQ(poses.shapes[3], shapes_[1]);
  EXPECT_EQ(poses.soup.corners, cube.corners);
  EXPECT_TRUE(poses.soup.dropped.empty());
  // Of several meshes only the one before the cache lends its faces.
  EXPECT_EQ(ReadPoses({Path("cube.ply"), Path("cube.ply"), Path("walk.mdd")}).shapes[0],
            cube.vertices);
}

TEST_F(PointCacheTest, OfAnotherMeshOrNoneNamesTheRemedy) {
  WritePointCache(Path("walk.pc2"), shapes_);
  File("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ExpectError<FileError>(
      [&] {
        ReadPoses({Path("triangle.obj"), Path("walk.pc2")});
      },
      {"walk.pc2: ", "8 vertices", "triangle.obj has 3"});
  ExpectError<FileError>([&] { ReadPoses({Path("walk.pc2")}); }, {"walk.pc2: ", "mesh"});
  ExpectError<FileError>([&] { ReadSoup(Path("walk.pc2")); }, {"walk.pc2: ", "mesh"});
}

TEST_F(PointCacheTest, FramesAtUnevenTimesAreSaid) {
  WriteMesh(Path("cube.obj"), shapes_[0], testing::Cube());
  WritePointCache(Path("walk.mdd"), shapes_);
  std::string bytes = testing::Content(Path("walk.mdd"));
  bytes[8 + 4] = 0;  // the second frame is now hardly later than the first
  const std::string file = File("walk.mdd", bytes);
  EXPECT_FALSE(ReadPointCache(file).even);
  const Poses poses = ReadPoses({Path("cube.obj"), file});
  ASSERT_EQ(poses.soup.dropped.size(), 1u);
  EXPECT_NE(poses.soup.dropped[0].find("walk.mdd"), std::string::npos);
}

TEST_F(PointCacheTest, DamagedFilesAreRefused) {
  for (const std::string name : {"a.pc2", "a.mdd"}) {
    WritePointCache(Path(name), shapes_);
    const std::string whole = testing::Content(Path(name));
    for (size_t size = 1; size < whole.size(); ++size) {
      ExpectError<FileError>([&] { ReadPointCache(File(name, whole.substr(0, size))); }, {name});
    }
    ExpectError<FileError>([&] { ReadPointCache(File(name, whole + "1234")); }, {name});
    const size_t counts = name == "a.pc2" ? 16 : 0, end = name == "a.pc2" ? 32 : 8;
    for (const int byte : {0, 0x7f, 0xff}) {
      for (size_t at = counts; at < end; ++at) {
        if (name == "a.pc2" && at >= 20 && at < 28) continue;  // the rate of frames
        std::string damaged = whole;
        damaged[at] = static_cast<char>(byte);
        if (damaged == whole) continue;
        ExpectError<FileError>([&] { ReadPointCache(File(name, damaged)); }, {name});
      }
    }
  }
  shapes_[1](2, 4) = 1;
  WritePointCache(Path("a.pc2"), shapes_);
  std::string bytes = testing::Content(Path("a.pc2"));
  const float none = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&bytes[32 + 4 * (24 + 3 * 4 + 2)], &none, sizeof none);
  ExpectError<FileError>([&] { ReadPointCache(File("a.pc2", bytes)); }, {"frame 2, vertex 5: "});
}

}  // namespace
}  // namespace shapespace
