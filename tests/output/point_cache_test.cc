#include <shapespace/output/point_cache.h>

#include <cstdint>
#include <cstring>

#include <shapespace/base/error.h>

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

}  // namespace
}  // namespace shapespace
