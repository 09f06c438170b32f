#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/output/picture.h>

#include "output/bodies.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

class RenderFilmTest : public ::testing::Test {
 protected:
  RenderFilmTest() {
    options_.frame_width = 100;
    options_.view = Eigen::Vector3d::UnitZ();
    options_.up = Eigen::Vector3d::UnitY();
  }

  std::vector<RgbImage> Film(const std::vector<Shape>& shapes) const {
    return RenderFilm(*box_.connectivity, shapes, options_);
  }

  Shape Moved(double x, double y) const { return box_.shape.colwise() + Eigen::Vector3d(x, y, 0); }

  /// Columns and rows of the body, which is blue, half-open: left, right, top, bottom.
  static Eigen::Vector4i Extent(const RgbImage& image) {
    Eigen::Vector4i extent(image.width, 0, image.height, 0);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const unsigned char* p = &image.pixels[3 * (static_cast<size_t>(y) * image.width + x)];
        if (p[2] <= p[0] + 40) continue;
        extent = {std::min(extent[0], x), std::max(extent[1], x + 1), std::min(extent[2], y),
                  std::max(extent[3], y + 1)};
      }
    }
    return extent;
  }

  const SimpleBody box_ = Box(1, 1, 1);
  FilmStripOptions options_;
};

// All pictures have one camera: a body that moves by its own size moves by that in the picture, and
// is as large as before; one that does not move looks the same.
TEST_F(RenderFilmTest, ShapesAreWhereTheyAre) {
  const std::vector<RgbImage> film = Film({Moved(0, 0), Moved(1, 0), Moved(3, 1), Moved(0, 0)});
  ASSERT_EQ(film.size(), 4u);
  const Eigen::Vector4i first = Extent(film[0]), second = Extent(film[1]), third = Extent(film[2]);
  const int size = first[1] - first[0];
  EXPECT_NEAR(size, 94 / 4, 1);
  EXPECT_LE((second - first - Eigen::Vector4i(size, size, 0, 0)).cwiseAbs().maxCoeff(), 1);
  EXPECT_LE(
      (third - first - Eigen::Vector4i(3 * size, 3 * size, -size, -size)).cwiseAbs().maxCoeff(), 2);
  EXPECT_EQ(film[0].pixels, film[3].pixels);
  for (const RgbImage& picture : film) {
    EXPECT_EQ(picture.width, 100);
    EXPECT_EQ(picture.height, film[0].height);
  }
}

TEST_F(RenderFilmTest, AllShapesAreDrawn) {
  options_.max_frames = 2;
  options_.frame_width = 16;
  EXPECT_EQ(Film(std::vector<Shape>(30, box_.shape)).size(), 30u);
}

TEST_F(RenderFilmTest, TitleAndLabelsAreRoomInEveryPicture) {
  const int plain = Film({box_.shape, box_.shape})[0].height;
  options_.labels = {"", "later"};
  std::vector<RgbImage> film = Film({box_.shape, box_.shape});
  EXPECT_GT(film[0].height, plain);
  EXPECT_EQ(film[0].height, film[1].height);
  EXPECT_NE(film[0].pixels, film[1].pixels);
  options_.labels.clear();
  options_.title = "box";
  film = Film({box_.shape, box_.shape});
  EXPECT_GT(film[0].height, plain);
  EXPECT_EQ(film[0].pixels, film[1].pixels);
}

TEST_F(RenderFilmTest, ShapesThatWouldBeTooSmallAreRefused) {
  EXPECT_NO_THROW(Film({Moved(0, 0), Moved(500, 0)}));
  EXPECT_THROW(Film({Moved(0, 0), Moved(5000, 0)}), InvalidOptions);
}

TEST_F(RenderFilmTest, MorePixelsThanFitTheMemoryAreRefused) {
  options_.frame_width = 2048;
  const std::string message =
      testing::MessageOf<InvalidOptions>([&] { Film(std::vector<Shape>(80, box_.shape)); });
  EXPECT_NE(message.find("frame_width"), std::string::npos) << message;
}

TEST_F(RenderFilmTest, ShapesOfOtherMeshesAreRefused) {
  EXPECT_THROW(Film({}), MeshError);
  EXPECT_THROW(Film({box_.shape, Shape::Zero(3, 3)}), MeshError);
}

}  // namespace
}  // namespace shapespace
