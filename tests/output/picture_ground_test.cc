#include <shapespace/output/picture.h>

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "output/bodies.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

const unsigned char* At(const RgbImage& image, int x, int y) {
  return &image.pixels[3 * (static_cast<size_t>(y) * image.width + x)];
}

bool IsBody(const unsigned char* p) { return p[2] > p[0] + 40; }
bool IsRuler(const unsigned char* p) { return p[0] == 0x70 && p[1] == 0x70 && p[2] == 0x6c; }

// A box with corners at (0, 0, 0) and (1, 1, 1), of which the upper face leans by `lean` along x,
// all of it moved by `by`.
Shape Leaning(double lean, const Eigen::Vector3d& by = Eigen::Vector3d::Zero()) {
  Shape shape = Box(1, 1, 1).shape;
  const Eigen::Vector3d low = shape.rowwise().minCoeff();
  shape.colwise() -= low;
  shape.row(0) += lean * shape.row(1);
  return shape.colwise() + by;
}

// A strip of two boxes over a ground at height 0, seen from +z.
struct Strip {
  RgbImage image;
  int cell = 0, ground = 0;  // width of a cell; row of the line

  Strip(const Shape& first, const Shape& second) {
    FilmStripOptions options;
    options.view = Eigen::Vector3d::UnitZ();
    options.up = Eigen::Vector3d::UnitY();
    options.ground_line = 0;
    image = RenderFilmStrip(*Box(1, 1, 1).connectivity, {first, second}, options);
    cell = image.width / 2;
    int most = 0;
    for (int y = image.height - 1; y >= 0; --y) {
      int count = 0;
      for (int x = 0; x < image.width; ++x) count += IsRuler(At(image, x, y));
      if (count >= most) {
        most = count;
        ground = y;
      }
    }
  }

  // Columns, in its cell, of the body in a row; half-open.
  std::pair<int, int> Body(int i, int row) const {
    std::pair<int, int> body = {cell, 0};
    for (int x = 0; x < cell; ++x) {
      if (!IsBody(At(image, i * cell + x, row))) continue;
      body = {std::min(body.first, x), x + 1};
    }
    return body;
  }

  // Lowest row of the body.
  int Bottom(int i) const {
    for (int y = image.height - 1; y >= 0; --y) {
      if (Body(i, y).second > 0) return y;
    }
    return 0;
  }

  // Columns of the ticks below the line, in their cell.
  std::vector<int> Ticks(int i) const {
    std::vector<int> ticks;
    for (int x = 0; x < cell; ++x) {
      if (IsRuler(At(image, i * cell + x, ground + 4))) ticks.push_back(x);
    }
    return ticks;
  }
};

TEST(GroundLineTest, AFootThatStandsIsAtTheSameColumnsOfEveryCell) {
  // The upper part moves far to the right, so that the box around the body does too.
  const Strip strip(Leaning(0), Leaning(1.3));
  // In the lowest row, in which it leans by one pixel at the most.
  const auto [left, right] = strip.Body(0, strip.ground - 1);
  EXPECT_GT(right - left, 80);
  EXPECT_NEAR(strip.Body(1, strip.ground - 1).first, left, 2);
  EXPECT_NEAR(strip.Body(1, strip.ground - 1).second, right, 2);
  EXPECT_EQ(strip.Ticks(0), strip.Ticks(1));
  EXPECT_GT(strip.Ticks(0).size(), 3u);
  // It stands on the line.
  EXPECT_EQ(strip.Bottom(0), strip.ground - 1);
  EXPECT_EQ(strip.Bottom(1), strip.ground - 1);
}

TEST(GroundLineTest, WhatSlidesSinksOrJumpsIsSeenToScale) {
  const Strip slid(Leaning(0), Leaning(0, {0.25, 0, 0}));
  const auto [left, right] = slid.Body(0, slid.ground - 5);
  EXPECT_NEAR(slid.Body(1, slid.ground - 5).first - left, 0.25 * (right - left), 1.5);
  const Strip sunk(Leaning(0), Leaning(0, {0, -0.1, 0}));
  const auto [begin, end] = sunk.Body(0, sunk.ground - 5);
  EXPECT_EQ(sunk.Bottom(0), sunk.ground - 1);
  EXPECT_NEAR(sunk.Bottom(1) - sunk.Bottom(0), 0.1 * (end - begin), 1.5);
  const Strip jumped(Leaning(0), Leaning(0, {0, 0.4, 0}));
  const auto [from, to] = jumped.Body(0, jumped.ground - 5);
  EXPECT_NEAR(jumped.Bottom(0) - jumped.Bottom(1), 0.4 * (to - from), 1.5);
}

TEST(GroundLineTest, TicksAreAtRoundPlacesOfTheWorld) {
  // Edges of the body at 3 and 4 are multiples of every step that fits.
  const Strip strip(Leaning(0, {3, 0, 0}), Leaning(0, {3, 0, 0}));
  const std::vector<int> all = strip.Ticks(0);
  const std::set<int> ticks(all.begin(), all.end());
  const auto [left, right] = strip.Body(0, strip.ground - 5);
  for (const int edge : {left, right}) {
    EXPECT_EQ(ticks.count(edge - 1) + ticks.count(edge) + ticks.count(edge + 1) > 0, true) << edge;
  }
}

TEST(GroundLineTest, ItsHeightAndTheUnitMayBeAnything) {
  const SimpleBody box = Box(1, 1, 1);
  FilmStripOptions options;
  options.frame_width = 96;
  const auto draw = [&](double scale, double height) {
    options.ground_line = scale * height;
    const Shape low = Leaning(0, {0, height, 0}), high = Leaning(0.5, {0, height, 0});
    return RenderFilmStrip(*box.connectivity, {scale * low, scale * high}, options);
  };
  const RgbImage image = draw(1, 0), other = draw(1000, 0), moved = draw(1, 64);
  ASSERT_EQ(image.width, other.width);
  // Only the line that says where ground and ticks are is another.
  const int line = 30;
  for (const RgbImage& same : {other, moved}) {
    int different = 0;
    for (size_t i = 0; i < 3 * static_cast<size_t>(image.width) * (image.height - line); ++i) {
      different += std::abs(image.pixels[i] - same.pixels[i]) > 8;
    }
    EXPECT_LT(different, 0.01 * static_cast<double>(image.pixels.size()));
  }
}

TEST(GroundLineTest, LooksFromTheSide) {
  const SimpleBody box = Box(1, 2, 4);
  FilmStripOptions options;
  options.ground_line = 0;
  options.up = Eigen::Vector3d::UnitY();
  EXPECT_NEAR(FilmStripView(*box.connectivity, {box.shape}, options).y(), 0, 1e-12);
  options.up = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(FilmStripView(*box.connectivity, {box.shape}, options).z(), 0, 1e-12);
  options.view = {1, 0, 0.1};
  EXPECT_TRUE(testing::Names(testing::MessageOf<InvalidOptions>([&] {
                               RenderFilmStrip(*box.connectivity, {box.shape}, options);
                             }).substr(0, 5),
                             {"view:"}));
}

TEST(GroundLineTest, ShapesTooFarApartAreRefused) {
  const SimpleBody box = Box(1, 1, 1);
  FilmStripOptions options;
  options.ground_line = 0;
  const Shape far = box.shape.colwise() + Eigen::Vector3d(1e300, 0, 0);
  EXPECT_THROW(RenderFilmStrip(*box.connectivity, {1e-300 * box.shape, 1e-300 * far}, options),
               InvalidOptions);
}

}  // namespace
}  // namespace shapespace
