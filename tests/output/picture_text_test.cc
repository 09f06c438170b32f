#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/output/detail/frame.h>
#include <shapespace/output/detail/legend.h>
#include <shapespace/output/detail/ruler.h>
#include <shapespace/output/internal/colour.h>
#include <shapespace/output/internal/text.h>
#include <shapespace/output/picture.h>

#include "output/bodies.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

const unsigned char* PixelOf(const RgbImage& image, int x, int y) {
  return &image.pixels[3 * (static_cast<size_t>(y) * image.width + x)];
}

RgbImage BlankPicture(int width, int height) {
  RgbImage image{width, height,
                 std::vector<unsigned char>(3 * static_cast<size_t>(width) * height)};
  internal::Fill(&image, 0, 0, width, height, internal::Background());
  return image;
}

struct Place {
  int left, top, width;

  double Middle() const { return left + width / 2.0; }
};

// The places where this text stands in a picture, alone or, if `on_body`, in front of something.
std::vector<Place> FindText(const RgbImage& image, const std::string& text, int size,
                            bool on_body = false) {
  RgbImage wanted = BlankPicture(internal::TextWidth(text, size), internal::LineHeight(size));
  internal::DrawText(&wanted, 0, 0, text, size);
  const unsigned char dark = internal::ToByte(internal::TextColour()[0]);
  const auto is_same = [&](int left, int top) {
    for (int y = 0; y < wanted.height; ++y) {
      for (int x = 0; x < wanted.width; ++x) {
        const unsigned char* p = PixelOf(wanted, x, y);
        const unsigned char* q = PixelOf(image, left + x, top + y);
        if (on_body) {
          // Within the rim, most of what is ink is over the background.
          if (p[0] < dark + 80 && std::abs(p[0] - q[0]) > 24) return false;
        } else if (!std::equal(p, p + 3, q)) {
          return false;
        }
      }
    }
    return true;
  };
  std::vector<Place> places;
  for (int top = 0; top + wanted.height <= image.height; ++top) {
    for (int left = 0; left + wanted.width <= image.width; ++left) {
      if (is_same(left, top)) places.push_back({left, top, wanted.width});
    }
  }
  return places;
}

bool HasColour(const unsigned char* pixel, const internal::Colour& colour) {
  for (int k = 0; k < 3; ++k) {
    if (pixel[k] != internal::ToByte(colour[k])) return false;
  }
  return true;
}

TEST(LegendTextTest, ABarHasItsNumbersAtItsEndsAndItsMiddle) {
  constexpr int kSize = 20, kBar = 12 * kSize;
  const RgbImage legend = internal::DrawLegend(0.05, 0.312, "edge deviation", kSize);
  // The bar begins a margin of 3/5 of the text from the top.
  const int row = 3 * kSize / 5 + 1;
  int left = 0;
  while (HasColour(PixelOf(legend, left, row), internal::Background())) ++left;
  EXPECT_TRUE(HasColour(PixelOf(legend, left, row), internal::ValueColour(0.5f / kBar)));
  EXPECT_TRUE(
      HasColour(PixelOf(legend, left + kBar - 1, row), internal::ValueColour(1 - 0.5f / kBar)));
  EXPECT_TRUE(HasColour(PixelOf(legend, left + kBar / 4, row), internal::ValueColour(0.252f)));
  EXPECT_TRUE(HasColour(PixelOf(legend, left + kBar, row), internal::Background()));
  const std::pair<const char*, double> numbers[] = {
      {"0", 1}, {"2.5%", kBar / 2.0}, {"5%", kBar - 1}};
  for (const auto& [number, at] : numbers) {
    bool found = false;
    for (const Place& place : FindText(legend, number, kSize)) {
      found = found || std::abs(place.Middle() - left - at) <= 1;
    }
    EXPECT_TRUE(found) << number;
  }
  const std::vector<Place> title = FindText(legend, "edge deviation, up to 31.2%", kSize);
  ASSERT_EQ(title.size(), 1u);
  EXPECT_EQ(legend.width, title[0].left + title[0].width + 3 * kSize / 5);
  // It stands beside the bar, at its height, after the last number.
  EXPECT_NEAR(title[0].top + internal::LineHeight(kSize) / 2.0, 3 * kSize / 5 + 7 * kSize / 20.0,
              1);
  EXPECT_GT(title[0].left, left + kBar + internal::TextWidth("5%", kSize) / 2);
  EXPECT_EQ(FindText(internal::DrawLegend(0.05, 0.05, "", kSize), "up to", kSize).size(), 0u);
  EXPECT_EQ(FindText(internal::DrawLegend(0.05, 0.06, "", kSize), "up to 6%", kSize).size(), 1u);
}

TEST(LegendTextTest, GroupsAreNumberedFromOneUnderTheirColours) {
  constexpr int kSize = 20;
  const RgbImage legend = internal::DrawGroupLegend(3, "parts", kSize);
  const int row = 3 * kSize / 5 + 1;
  for (int group = 0; group < 3; ++group) {
    int first = 0;
    while (!HasColour(PixelOf(legend, first, row), internal::GroupColour(group))) ++first;
    int end = first;
    while (HasColour(PixelOf(legend, end, row), internal::GroupColour(group))) ++end;
    EXPECT_EQ(end - first, 17 * kSize / 10 - kSize / 5);
    const std::vector<Place> places = FindText(legend, std::to_string(group + 1), kSize);
    ASSERT_EQ(places.size(), 1u) << group;
    EXPECT_NEAR(places[0].Middle(), (first + end) / 2.0, 1) << group;
  }
  EXPECT_TRUE(FindText(legend, "4", kSize).empty());
  EXPECT_TRUE(FindText(legend, "0", kSize).empty());
  ASSERT_EQ(FindText(legend, "parts", kSize).size(), 1u);
}

TEST(RulerTest, StepsAreRoundAndThereAreThreeAtLeast) {
  for (const auto& [length, step] : {std::pair{10.0, 2.0},
                                     {3.0, 1.0},
                                     {2.99, 0.5},
                                     {30.0, 10.0},
                                     {14.9, 2.0},
                                     {15.0, 5.0},
                                     {6.1, 2.0},
                                     {5.9, 1.0},
                                     {0.0, 1.0},
                                     {4e-3, 1e-3}}) {
    EXPECT_NEAR(internal::RulerStep(length), step, 1e-12 * step) << length;
  }
}

TEST(RulerTest, TellsHeightAndStep) {
  internal::Ruler ruler;
  ruler.height = -0.25;
  ruler.step = 0.05;
  EXPECT_EQ(internal::DescribeRuler(ruler), "ground at -0.25, ticks 0.05 apart");
}

TEST(RulerTest, DrawsTheLineTicksBelowAndGuidesAbove) {
  constexpr int kSize = 20, kThick = 2, kDepth = kThick + 6;
  EXPECT_EQ(internal::RulerDepth(kSize), kDepth);
  internal::Ruler ruler;
  ruler.pixels = 30;
  ruler.first_tick = 75;  // and therefore 15, 45 and 75
  ruler.row = 40;
  ruler.cell_width = 90;
  RgbImage image = BlankPicture(120, 70);
  internal::DrawRuler(ruler, kSize, 12, 7, &image);
  const internal::Colour guide = internal::FromHex(0xe6e6e4), ground = internal::FromHex(0x70706c);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int column = x - 12, row = y - 7;
      bool is_tick = false;
      for (const int tick : {15, 45, 75}) {
        is_tick = is_tick || column == tick - 1 || column == tick;
      }
      const bool in_cell = column >= 0 && column < 90;
      const bool is_line = in_cell && row >= 40 && row < 40 + kThick;
      const internal::Colour expected = is_line || (is_tick && row >= 40 && row < 40 + kDepth)
                                            ? ground
                                        : is_tick && row >= 0 && row < 40 ? guide
                                                                          : internal::Background();
      ASSERT_TRUE(HasColour(PixelOf(image, x, y), expected)) << column << " " << row;
    }
  }
}

TEST(FilmStripTextTest, TextsStandWhereTheyBelong) {
  const SimpleBody box = Box(1, 1, 1);
  const std::vector<Shape> shapes(5, box.shape);
  FilmStripOptions options;
  options.frame_width = 160;
  options.columns = 2;
  options.max_frames = 3;
  options.view = Eigen::Vector3d::UnitZ();
  options.up = Eigen::Vector3d::UnitY();
  options.ground_line = -0.75;
  options.labels = {"first", "second", "third", "fourth", "fifth"};
  options.title = "The title";
  options.values.assign(5, Eigen::VectorXd::Constant(8, 0.02));
  options.values[2](3) = 0.4;  // drawn
  options.values[1](3) = 0.9;  // not drawn
  options.legend = "deviation";
  const RgbImage image = RenderFilmStrip(*box.connectivity, shapes, options);
  const int size = internal::TextSize(160);
  const auto find = [&](const std::string& text) {
    const std::vector<Place> places = FindText(image, text, size);
    EXPECT_EQ(places.size(), 1u) << text;
    return places.empty() ? Place{0, 0, 0} : places[0];
  };
  const Place first = find("first"), third = find("third"), fifth = find("fifth");
  EXPECT_TRUE(FindText(image, "second", size).empty());
  EXPECT_TRUE(FindText(image, "fourth", size).empty());
  EXPECT_EQ(first.top, third.top);
  EXPECT_GT(fifth.top, first.top);
  EXPECT_NEAR(first.Middle(), fifth.Middle(), 1);
  const double cell = third.Middle() - first.Middle();
  EXPECT_NEAR(first.Middle(), cell / 2, 1.5);
  const Place title = find("The title"), note = find("ground at -0.75, ticks 0.2 apart"),
              legend = find("deviation, up to 40%");
  EXPECT_LT(title.top, first.top);
  EXPECT_EQ(title.left, note.left);
  EXPECT_GT(note.top, fifth.top);
  EXPECT_GT(legend.top, note.top);
  EXPECT_EQ(note.top - fifth.top, internal::LineHeight(size) + size / 2);
}

TEST(FilmStripTextTest, ColumnsAndTheWidestTextDecideTheWidth) {
  const SimpleBody box = Box(1, 1, 1);
  const std::vector<Shape> shapes(5, box.shape);
  FilmStripOptions options;
  options.frame_width = 64;
  options.samples = 1;
  options.view = Eigen::Vector3d::UnitZ();
  const auto draw = [&] { return RenderFilmStrip(*box.connectivity, shapes, options); };
  options.columns = 1;
  const RgbImage one = draw();
  options.columns = 2;
  const RgbImage two = draw();
  EXPECT_EQ(two.width, 2 * one.width);
  EXPECT_EQ(two.height, 3 * one.height / 5);
  options.columns = 9;  // more than there are
  EXPECT_EQ(draw().width, 5 * one.width);
  options.columns = 1;
  options.title = "A title that is wider than the cell";
  const int size = internal::TextSize(64);
  EXPECT_EQ(draw().width, internal::TextWidth(options.title, size) + 2 * (size / 2));
}

TEST(VertexNumbersTest, TheyStandAboveOnTheRightAndDoNotCoverEachOther) {
  const int circles = 41, around = 80;
  const SimpleBody sphere = Sphere(1, circles, around);
  FilmStripOptions options;
  options.frame_width = 320;
  options.samples = 1;
  options.view = Eigen::Vector3d::UnitZ();
  options.numbers = Eigen::VectorXi::Zero(circles * around);
  const int front = circles / 2 * around;  // at (0, 0, 1)
  options.numbers(front) = 58;
  const int size = 3 * internal::TextSize(320) / 4, height = internal::LineHeight(size);
  const RgbImage one = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  const std::vector<Place> places = FindText(one, "58", size, true);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_NEAR(places[0].left, one.width / 2 + size / 3, 1);
  EXPECT_NEAR(places[0].top, one.height / 2 - height, 1);
  // A neighbour, whose number would cover it there, has it on the other side.
  options.numbers(front + 1) = 64;
  options.numbers(front + around) = 93;
  const RgbImage three = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  std::vector<Place> all;
  for (const char* number : {"58", "64", "93"}) {
    const std::vector<Place> found = FindText(three, number, size, true);
    ASSERT_EQ(found.size(), 1u) << number;
    all.push_back(found[0]);
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      EXPECT_TRUE(std::abs(all[i].left - all[j].left) >= all[i].width ||
                  std::abs(all[i].top - all[j].top) >= height)
          << i << " " << j;
    }
  }
}

TEST(VertexNumbersTest, AtTheEdgeOfTheFrameTheyStayInIt) {
  const SimpleBody box = Box(2, 2, 0.1);
  FilmStripOptions options;
  options.frame_width = 320;
  options.view = Eigen::Vector3d::UnitZ();
  options.up = Eigen::Vector3d::UnitY();
  options.numbers = Eigen::VectorXi::Zero(8);
  for (const int v : {4, 5, 6, 7}) options.numbers(v) = 1000 + v;  // the front
  const RgbImage image = RenderFilmStrip(*box.connectivity, {box.shape}, options);
  const int size = 3 * internal::TextSize(320) / 4;
  for (const int v : {4, 5, 6, 7}) {
    const std::vector<Place> found = FindText(image, std::to_string(1000 + v), size, true);
    ASSERT_FALSE(found.empty()) << v;
    // At the corner, but inside.
    EXPECT_EQ(found[0].Middle() > image.width / 2.0, (v & 1) != 0) << v;
    EXPECT_EQ(found[0].top < image.height / 2, (v & 2) != 0) << v;
  }
}

TEST(FilmStripMessagesTest, NameShapeVertexAndNumber) {
  const SimpleBody box = Box(1, 1, 1);
  const auto message = [&](const std::function<void(FilmStripOptions*)>& change) {
    FilmStripOptions options;
    change(&options);
    return testing::MessageOf<InvalidOptions>([&] {
      RenderFilmStrip(*box.connectivity, {box.shape, box.shape}, options);
    });
  };
  using O = FilmStripOptions;
  EXPECT_TRUE(testing::Names(message([](O* o) {
                               o->values = {Eigen::VectorXd::Zero(8), Eigen::VectorXd::Zero(7)};
                             }),
                             {"values:", "7", "shape 1", "8"}));
  EXPECT_TRUE(testing::Names(message([](O* o) {
                               o->values.assign(2, Eigen::VectorXd::Zero(8));
                               o->values[1](5) = INFINITY;
                             }),
                             {"values:", "shape 1", "vertex 5"}));
  EXPECT_TRUE(testing::Names(message([](O* o) { o->marks = Eigen::VectorXi::Constant(8, 3); }),
                             {"marks:", "0", "1", "2"}));
  EXPECT_EQ(message([](O* o) { o->roles.assign(3, ShapeRole::kPose); }).rfind("roles: ", 0), 0u);
  EXPECT_EQ(message([](O* o) { o->labels.assign(1, ""); }).rfind("labels: ", 0), 0u);
  EXPECT_EQ(message([](O* o) { o->columns = 1001; }).rfind("columns: ", 0), 0u);
  EXPECT_EQ(message([](O* o) { o->columns = -1; }).rfind("columns: ", 0), 0u);
  EXPECT_EQ(message([](O* o) { o->samples = 17; }).rfind("samples: ", 0), 0u);
  EXPECT_EQ(message([](O* o) { o->max_frames = 1001; }).rfind("max_frames: ", 0), 0u);
  EXPECT_EQ(message([](O* o) { o->frame_width = 2049; }).rfind("frame_width: ", 0), 0u);
  EXPECT_TRUE(testing::Names(message([](O* o) { o->title.assign(121, 'x'); }), {"title:", "120"}));
  EXPECT_TRUE(testing::Names(message([](O* o) { o->view = o->up = {0, 2, 0}; }), {"up:"}));
  EXPECT_TRUE(testing::Names(message([](O* o) { o->ground_line = INFINITY; }), {"ground_line:"}));
  EXPECT_TRUE(testing::Names(message([](O* o) {
                               o->ground_line = 0;
                               o->up = {0, 1, 0};
                               o->view = {0, 1, 1};
                             }),
                             {"view:"}));
  EXPECT_TRUE(testing::Names(message([](O* o) { o->ground_line = 1e4; }), {"ground_line:"}));
}

// A graph of long edges has tubes of a hundredth of its radius; one of short edges has thinner
// ones.
TEST(FilmStripGraphTest, TubesAreThinnerWhereEdgesAreShort) {
  const auto thickness = [](int edges) {
    std::vector<std::pair<int, int>> segments;
    Shape line(3, edges + 1);
    for (int i = 0; i <= edges; ++i) {
      line.col(i) << 2.0 * i / edges, 0, 0;
      if (i > 0) segments.emplace_back(i - 1, i);
    }
    FilmStripOptions options;
    options.frame_width = 1000;
    options.samples = 1;
    options.view = Eigen::Vector3d::UnitZ();
    options.up = Eigen::Vector3d::UnitY();
    const RgbImage image =
        RenderFilmStrip(*Connectivity::Make(edges + 1, {0}, {}, segments), {line}, options);
    int rows = 0;
    for (int y = 0; y < image.height; ++y) {
      rows += !HasColour(PixelOf(image, image.width / 3, y), internal::Background());
    }
    return rows;
  };
  // Of a frame of 938 pixels inside its margins, which shows a radius of 1.01.
  EXPECT_NEAR(thickness(4), 0.02 * 938 / 2.02, 1.1);
  // An edge is a hundredth of the radius, and 0.15 of it a third of a pixel at either side.
  EXPECT_LE(thickness(100), 0.3 * 0.02 * 938 / 2 + 1.1);
}

TEST(ShortenedTest, NoBlankStandsBeforeTheDots) {
  const std::string text = "ab cdefghijk";
  const int size = 20;
  // There is room for "ab ", but not for "ab c".
  const int width = internal::TextWidth("ab \u2026", size);
  EXPECT_EQ(internal::Shortened(text, width, size), "ab\u2026");
  EXPECT_EQ(internal::Shortened(text, internal::TextWidth("ab c\u2026", size) + 1, size),
            "ab c\u2026");
  EXPECT_EQ(internal::Shortened(text, 1, size), "\u2026");
  EXPECT_EQ(internal::LineHeight(20), 19 + 5);
  EXPECT_EQ(internal::TextSize(320), 20);
  EXPECT_EQ(internal::TextSize(100), 12);
}

}  // namespace
}  // namespace shapespace
