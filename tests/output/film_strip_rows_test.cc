#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/output/picture.h>

#include "output/bodies.h"

namespace shapespace {
namespace {

// Without a number of columns, a strip has as few rows as possible of at most six times the width
// of a frame, and as few columns as these rows permit.
TEST(FilmStripRowsTest, AreAsFewAsFitTheWidth) {
  const SimpleBody box = Box(1, 3, 1);
  FilmStripOptions options;
  options.frame_width = 48;
  options.max_frames = 40;
  options.view = Eigen::Vector3d::UnitZ();
  options.up = Eigen::Vector3d::UnitY();
  const auto strip = [&](int frames) {
    return RenderFilmStrip(*box.connectivity, std::vector<Shape>(frames, box.shape), options);
  };
  const RgbImage one = strip(1);
  for (const int frames : {2, 5, 6, 7, 8, 11, 12, 13, 14, 19, 25}) {
    int rows = 1;
    while (rows * 6 * options.frame_width < frames * one.width) ++rows;
    int columns = 1;
    while (columns * rows < frames) ++columns;
    int rows_used = 1;
    while (columns * rows_used < frames) ++rows_used;
    const RgbImage image = strip(frames);
    EXPECT_EQ(image.width, columns * one.width) << frames;
    EXPECT_EQ(image.height, rows_used * one.height) << frames;
  }
}

}  // namespace
}  // namespace shapespace
