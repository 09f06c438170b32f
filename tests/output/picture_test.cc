#include <shapespace/output/picture.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/mesh/triangulate.h>

#include "output/bodies.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;

struct Counts {
  int drawn = 0, blue = 0, orange = 0;
};

bool IsBackground(const unsigned char* p) { return p[0] == 250 && p[1] == 250 && p[2] == 250; }

// Counts pixels of the rows [top, bottom) and columns [left, right).
Counts Count(const RgbImage& image, int left, int right, int top, int bottom) {
  Counts counts;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const unsigned char* p = &image.pixels[3 * (y * image.width + x)];
      counts.drawn += !IsBackground(p);
      counts.blue += p[2] > p[0] + 40;
      counts.orange += p[0] > p[2] + 40;
    }
  }
  return counts;
}

Counts Count(const RgbImage& image) { return Count(image, 0, image.width, 0, image.height); }

// Share of pixels in which some channel differs by more than `by`.
double Difference(const RgbImage& a, const RgbImage& b, int by) {
  if (a.width != b.width || a.height != b.height) return 1;
  int different = 0;
  for (size_t i = 0; i < a.pixels.size(); i += 3) {
    bool differs = false;
    for (int k = 0; k < 3; ++k) differs |= std::abs(a.pixels[i + k] - b.pixels[i + k]) > by;
    different += differs;
  }
  return different / (a.pixels.size() / 3.0);
}

FilmStripOptions Small() {
  FilmStripOptions options;
  options.frame_width = 96;
  return options;
}

TEST(RenderFilmStripTest, ASphereFillsItsCellInTheFrontColour) {
  const SimpleBody sphere = Sphere(1);
  FilmStripOptions options;
  options.frame_width = 160;
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  EXPECT_NEAR(image.width, 160, 1);
  EXPECT_NEAR(image.height, 160, 1);
  // Margins are 160 / 32 on each side.
  const double disk = EIGEN_PI * 75 * 75;
  const Counts counts = Count(image);
  // A pixel that the outline only touches is drawn too: half a pixel all around.
  EXPECT_NEAR(counts.drawn, EIGEN_PI * 75.5 * 75.5, 0.02 * disk);
  EXPECT_GT(counts.blue, 0.96 * disk);
  EXPECT_EQ(counts.orange, 0);
}

TEST(RenderFilmStripTest, ReversedFacesHaveTheBackColour) {
  const SimpleBody sphere = Sphere(1);
  const auto inside_out = Reversed(*sphere.connectivity);
  const Counts counts = Count(RenderFilmStrip(*inside_out, {sphere.shape}, Small()));
  EXPECT_GT(counts.orange, 0.95 * EIGEN_PI * 45 * 45);
  EXPECT_EQ(counts.blue, 0);
}

TEST(RenderFilmStripTest, ConcavePolygonsShowNoBackAndCoverNoMoreThanThemselves) {
  // A star of five points, one polygon; seen from its front.
  constexpr int kCorners = 10;
  Shape star(3, kCorners);
  std::vector<int> corners;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * EIGEN_PI * k / kCorners, radius = k % 2 == 0 ? 1 : 0.4;
    star.col(k) << radius * std::cos(angle), radius * std::sin(angle), 0;
    corners.push_back(k);
  }
  const auto connectivity = Connectivity::Make(kCorners, {0, kCorners}, corners, {}, {},
                                               Triangulate({0, kCorners}, corners, {star}));
  FilmStripOptions options;
  options.frame_width = 400;
  options.view = Eigen::Vector3d::UnitZ();
  const RgbImage image = RenderFilmStrip(*connectivity, {star}, options);
  const Counts counts = Count(image);
  EXPECT_EQ(counts.orange, 0);
  // The star's width is 1 + cos(36 degrees), and so is that of the frame without margins. Its area
  // is less than half of that of its convex hull.
  const double degree = EIGEN_PI / 180;
  const double unit = (image.width - 2 * 400 / 32.0) / (1 + std::cos(36 * degree));
  EXPECT_NEAR(counts.drawn / (unit * unit), 5 * 0.4 * std::sin(36 * degree), 0.05);
}

TEST(RenderFilmStripTest, OneReversedTriangleShows) {
  const SimpleBody sphere = Sphere(1, 12, 24);
  Eigen::Matrix3Xi triangles = sphere.connectivity->Triangles();
  // The triangle nearest to the eye, at +z.
  const auto height = [&](int f) {
    return sphere.shape(2, triangles(0, f)) + sphere.shape(2, triangles(1, f)) +
           sphere.shape(2, triangles(2, f));
  };
  int reversed = 0;
  for (int f = 1; f < triangles.cols(); ++f) {
    if (height(f) > height(reversed)) reversed = f;
  }
  std::swap(triangles(1, reversed), triangles(2, reversed));
  FilmStripOptions options = Small();
  options.view = Eigen::Vector3d::UnitZ();
  const auto dented = Connectivity::FromTriangles(sphere.connectivity->NumVertices(), triangles);
  EXPECT_GT(Count(RenderFilmStrip(*dented, {sphere.shape}, options)).orange, 20);
}

TEST(RenderFilmStripTest, PlaceAndUnitsDoNotMatter) {
  const SimpleBody box = Box(1, 2, 0.7);
  Shape bent = box.shape;
  bent.row(0) += 0.4 * bent.row(1).cwiseAbs2();
  const RgbImage image = RenderFilmStrip(*box.connectivity, {box.shape, bent}, Small());
  const Shape moved = box.shape.colwise() + Eigen::Vector3d(30, -7, 11);
  EXPECT_LT(Difference(image, RenderFilmStrip(*box.connectivity, {moved, bent}, Small()), 2),
            0.002);
  const RgbImage scaled =
      RenderFilmStrip(*box.connectivity, {1e-6 * box.shape, 1e-6 * bent}, Small());
  EXPECT_LT(Difference(image, scaled, 2), 0.002);
}

TEST(RenderFilmStripTest, ScaleIsTheSameForAllShapes) {
  const SimpleBody sphere = Sphere(1);
  const RgbImage image =
      RenderFilmStrip(*sphere.connectivity, {sphere.shape, 0.5 * sphere.shape}, Small());
  const Counts large = Count(image, 0, image.width / 2, 0, image.height);
  const Counts small = Count(image, image.width / 2, image.width, 0, image.height);
  EXPECT_NEAR(static_cast<double>(large.drawn) / small.drawn, 4, 0.2);
}

TEST(RenderFilmStripTest, CellsFollowTheShapes) {
  const SimpleBody tall = Box(0.5, 3, 0.5), level = Box(3, 0.5, 0.5);
  const RgbImage narrow = RenderFilmStrip(*tall.connectivity, {tall.shape}, Small());
  EXPECT_NEAR(narrow.height, 96, 1);
  EXPECT_LT(narrow.width, 40);
  FilmStripOptions options = Small();
  options.view = Eigen::Vector3d::UnitZ();
  const RgbImage low = RenderFilmStrip(*level.connectivity, {level.shape}, options);
  EXPECT_NEAR(low.width, 96, 1);
  EXPECT_LT(low.height, 40);
}

TEST(RenderFilmStripTest, WrapsIntoFullRows) {
  const SimpleBody sphere = Sphere(1, 10, 20);
  const std::vector<Shape> shapes(9, sphere.shape);
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, shapes, Small());
  const RgbImage single = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, Small());
  EXPECT_EQ(image.width, 5 * single.width);
  EXPECT_EQ(image.height, 2 * single.height);
  EXPECT_GT(Count(image, 3 * single.width, 4 * single.width, single.height, image.height).drawn,
            1000);
  EXPECT_EQ(Count(image, 4 * single.width, image.width, single.height, image.height).drawn, 0);
}

TEST(RenderFilmStripTest, SubsamplingKeepsBothEnds) {
  const SimpleBody sphere = Sphere(1, 10, 20);
  std::vector<Shape> shapes(20, sphere.shape);
  // Only the ends are flat, so that frames show which shapes were selected.
  shapes.front().row(1) *= 0.25;
  shapes.back().row(1) *= 0.25;
  FilmStripOptions options = Small();
  options.max_frames = 4;
  options.view = Eigen::Vector3d::UnitZ();
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, shapes, options);
  const int width = image.width / 4;
  EXPECT_NEAR(width, 96, 1);
  std::vector<int> drawn;
  for (int i = 0; i < 4; ++i) {
    drawn.push_back(Count(image, i * width, (i + 1) * width, 0, image.height).drawn);
  }
  EXPECT_EQ(drawn[0], drawn[3]);
  EXPECT_EQ(drawn[1], drawn[2]);
  EXPECT_NEAR(drawn[1], 4 * drawn[0], 0.3 * drawn[1]);
}

TEST(RenderFilmStripTest, SubsamplingKeepsPoses) {
  const SimpleBody sphere = Sphere(1, 10, 20);
  std::vector<Shape> shapes(20, sphere.shape);
  FilmStripOptions options = Small();
  options.max_frames = 4;
  options.roles.assign(20, ShapeRole::kInserted);
  options.roles[0] = options.roles[16] = ShapeRole::kPose;
  std::fill(options.roles.begin() + 17, options.roles.end(), ShapeRole::kExtrapolated);
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, shapes, options);
  const int cell = image.width / 4;
  const auto blue = [&](int i) {
    const unsigned char* p =
        &image.pixels[3 * (image.height / 2 * image.width + i * cell + cell / 2)];
    return p[2] > p[1] + 20 && p[1] > p[0];
  };
  EXPECT_TRUE(blue(0));
  EXPECT_FALSE(blue(1));
  EXPECT_TRUE(blue(2));  // shape 16, which even steps of 19 / 3 would miss
  EXPECT_FALSE(blue(3));
}

TEST(RenderFilmStripTest, FollowsTheGivenViewAndUp) {
  const SimpleBody box = Box(1, 2, 4);
  FilmStripOptions options = Small();
  const auto aspect = [&](const Eigen::Vector3d& view, const Eigen::Vector3d& up) {
    options.view = view;
    options.up = up;
    const RgbImage image = RenderFilmStrip(*box.connectivity, {box.shape}, options);
    // Without the margins of three pixels.
    return (image.width - 6.0) / (image.height - 6.0);
  };
  EXPECT_NEAR(aspect({0, 0, 1}, {0, 1, 0}), 0.5, 0.02);
  EXPECT_NEAR(aspect({0, 0, 1}, {1, 0, 0}), 2, 0.05);
  EXPECT_NEAR(aspect({1, 0, 0}, {0, 0, 1}), 0.5, 0.02);
  // From above, without an up vector, the other of y and z points up.
  EXPECT_NEAR(aspect({0, 1, 0}, {0, 0, 0}), 0.25, 0.02);
}

TEST(RenderFilmStripTest, ValuesAreShownAsColourWithALegend) {
  const SimpleBody sphere = Sphere(1);
  FilmStripOptions options;
  options.frame_width = 160;
  options.view = Eigen::Vector3d::UnitZ();
  const RgbImage plain = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  // Hot on the right, cold on the left.
  options.values = {(sphere.shape.row(0).array() > 0)
                        .select(Eigen::ArrayXXd::Constant(1, 3200, 0.1), 0.0)
                        .matrix()
                        .transpose()};
  options.legend = "edge deviation";
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  EXPECT_GT(image.height, plain.height + 20);
  EXPECT_GT(image.width, plain.width);
  const Counts cold = Count(image, 0, plain.width / 2 - 4, 0, plain.height);
  const Counts hot = Count(image, plain.width / 2 + 4, plain.width, 0, plain.height);
  EXPECT_EQ(cold.orange, 0);
  EXPECT_GT(hot.orange, 0.9 * hot.drawn);
  EXPECT_GT(Count(image, 0, image.width, plain.height, image.height).orange, 500);
}

TEST(RenderFilmStripTest, GroupsAreShownAsColoursWithALegend) {
  const SimpleBody sphere = Sphere(1);
  FilmStripOptions options;
  options.frame_width = 160;
  options.view = Eigen::Vector3d::UnitZ();
  const RgbImage plain = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  // The first group, which is blue, on the right, and no group, which is grey, on the left.
  options.groups = (sphere.shape.row(0).array() > 0)
                       .select(Eigen::ArrayXXi::Zero(1, 3200), -1)
                       .matrix()
                       .transpose();
  options.legend = "parts";
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  EXPECT_GT(image.height, plain.height + 20);
  const Counts none = Count(image, 0, plain.width / 2 - 4, 0, plain.height);
  const Counts first = Count(image, plain.width / 2 + 4, plain.width, 0, plain.height);
  EXPECT_GT(none.drawn, 1000);
  EXPECT_EQ(none.blue, 0);
  EXPECT_GT(first.blue, 0.9 * first.drawn);
  EXPECT_GT(Count(image, 0, image.width, plain.height, image.height).blue, 100);

  // Groups that have their numbers beside them need no list of colours.
  options.numbers = Eigen::VectorXi::Zero(sphere.shape.cols());
  const RgbImage numbered = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  ASSERT_EQ(numbered.height, image.height);
  EXPECT_EQ(Count(numbered, 0, numbered.width, plain.height, numbered.height).blue, 0);
}

TEST(RenderFilmStripTest, RolesDecideTheColour) {
  const SimpleBody sphere = Sphere(1);
  FilmStripOptions options = Small();
  options.roles = {ShapeRole::kPose, ShapeRole::kInserted, ShapeRole::kExtrapolated};
  const RgbImage image =
      RenderFilmStrip(*sphere.connectivity, {sphere.shape, sphere.shape, sphere.shape}, options);
  const int cell = image.width / 3;
  const auto centre = [&](int i) {
    return &image.pixels[3 * (image.height / 2 * image.width + i * cell + cell / 2)];
  };
  const unsigned char *pose = centre(0), *inserted = centre(1), *extrapolated = centre(2);
  EXPECT_GT(pose[2], pose[1] + 20);  // blue
  EXPECT_GT(inserted[1], inserted[0] + 20);
  EXPECT_GT(inserted[1], inserted[2] + 20);  // green
  EXPECT_GT(extrapolated[0], extrapolated[1] + 20);
  EXPECT_GT(extrapolated[2], extrapolated[1] + 20);  // purple
}

TEST(RenderFilmStripTest, MarkedVerticesChangeColourAndNothingElse) {
  const SimpleBody sphere = Sphere(1);
  FilmStripOptions options;
  options.frame_width = 160;
  options.view = Eigen::Vector3d::UnitZ();
  const RgbImage plain = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  // Red on the right, dark on the left, and a band between them without marks.
  options.marks.resize(sphere.shape.cols());
  for (int v = 0; v < options.marks.size(); ++v) {
    const double x = sphere.shape(0, v);
    options.marks(v) = x > 0.3 ? 2 : x < -0.3 ? 1 : 0;
  }
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  ASSERT_EQ(image.width, plain.width);
  ASSERT_EQ(image.height, plain.height);
  // The radius is 75 pixels; marks extend to the middle between vertices, plus a spot.
  const int middle = image.width / 2, inner = 15, outer = 30;
  const Counts red = Count(image, middle + outer, image.width, 0, image.height);
  EXPECT_GT(red.orange, 0.95 * red.drawn);
  const Counts dark = Count(image, 0, middle - outer, 0, image.height);
  EXPECT_EQ(dark.blue + dark.orange, 0);
  for (int y = 0; y < image.height; ++y) {
    const int begin = 3 * (y * image.width + middle - inner);
    EXPECT_TRUE(
        std::equal(&image.pixels[begin], &image.pixels[begin + 6 * inner], &plain.pixels[begin]))
        << y;
  }
  // Inverted surfaces have the colour of back faces, with or without marks.
  const auto inside_out = Reversed(*sphere.connectivity);
  const RgbImage marked_back = RenderFilmStrip(*inside_out, {sphere.shape}, options);
  options.marks.resize(0);
  EXPECT_EQ(Difference(marked_back, RenderFilmStrip(*inside_out, {sphere.shape}, options), 0), 0);
}

TEST(RenderFilmStripTest, ASingleMarkedVertexOfAFineMeshIsSeen) {
  const int circles = 201, around = 400;
  const SimpleBody sphere = Sphere(1, circles, around);
  FilmStripOptions options;
  options.view = Eigen::Vector3d::UnitZ();
  const RgbImage plain = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  options.marks = Eigen::VectorXi::Zero(circles * around);
  options.marks(circles / 2 * around) = 2;  // at (0, 0, 1)
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  const int x = image.width / 2, y = image.height / 2, near = 8;
  EXPECT_GT(Count(image, x - near, x + near, y - near, y + near).orange, 12);
  EXPECT_EQ(Count(image).orange, Count(image, x - near, x + near, y - near, y + near).orange);
  EXPECT_LT(Difference(image, plain, 0), 4.0 * near * near / (image.width * image.height));
  // Values replace the colours of marks.
  options.values = {Eigen::VectorXd::Constant(circles * around, 0.1)};
  const RgbImage values = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  options.marks.resize(0);
  EXPECT_EQ(Difference(values, RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options), 0),
            0);
}

TEST(RenderFilmStripTest, LabelsStandUnderTheShapesAndTheTitleAboveAll) {
  const SimpleBody sphere = Sphere(1);
  const std::vector<Shape> shapes = {sphere.shape, sphere.shape};
  FilmStripOptions options = Small();
  const RgbImage plain = RenderFilmStrip(*sphere.connectivity, shapes, options);
  options.labels = {"", "t = 1"};
  const RgbImage labelled = RenderFilmStrip(*sphere.connectivity, shapes, options);
  ASSERT_GT(labelled.height, plain.height);
  EXPECT_EQ(labelled.width, plain.width);
  const int half = plain.width / 2;
  EXPECT_EQ(Count(labelled, 0, half, plain.height, labelled.height).drawn, 0);
  EXPECT_GT(Count(labelled, half, plain.width, plain.height, labelled.height).drawn, 20);
  options.title = "title";
  const RgbImage titled = RenderFilmStrip(*sphere.connectivity, shapes, options);
  const int line = titled.height - labelled.height;
  EXPECT_GT(Count(titled, 0, titled.width, 0, line).drawn, 20);
  // Below the title the picture is unchanged.
  const RgbImage below = {labelled.width,
                          labelled.height,
                          {titled.pixels.begin() + 3 * line * titled.width, titled.pixels.end()}};
  EXPECT_EQ(Difference(below, labelled, 0), 0);
}

TEST(RenderFilmStripTest, ShapesThatAreLeftOutTakeTheirLabelsWithThem) {
  const SimpleBody sphere = Sphere(1, 10, 20);
  const std::vector<Shape> shapes(9, sphere.shape);
  FilmStripOptions options = Small();
  options.max_frames = 3;
  options.labels = {"a", "b", "c", "d", "e", "f", "g", "h", "i"};
  const RgbImage some = RenderFilmStrip(*sphere.connectivity, shapes, options);
  options.labels = {"a", "e", "i"};
  const std::vector<Shape> three(3, sphere.shape);
  EXPECT_EQ(Difference(some, RenderFilmStrip(*sphere.connectivity, three, options), 0), 0);
}

TEST(RenderFilmStripTest, CellsAreAsWideAsLabelsUpToTheFramesWidth) {
  const SimpleBody tall = Box(0.5, 3, 0.5);
  FilmStripOptions options;
  options.labels = {"x"};
  const auto width = [&] {
    return RenderFilmStrip(*tall.connectivity, {tall.shape}, options).width;
  };
  const int narrow = width();
  EXPECT_LT(narrow, 150);
  options.labels = {"a label of some letters"};
  const int wide = width();
  EXPECT_GT(wide, 200);
  EXPECT_LT(wide, 320);
  options.labels = {std::string(1000, 'x')};
  EXPECT_EQ(width(), 320);
  // No label has no room.
  options.labels = {""};
  const RgbImage blank = RenderFilmStrip(*tall.connectivity, {tall.shape}, options);
  options.labels.clear();
  EXPECT_EQ(Difference(blank, RenderFilmStrip(*tall.connectivity, {tall.shape}, options), 0), 0);
}

TEST(RenderFilmStripTest, TextIsInProportionToTheFrames) {
  const SimpleBody sphere = Sphere(1, 10, 20);
  const auto title = [&](int width) {
    FilmStripOptions options;
    options.frame_width = width;
    const int without = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options).height;
    options.title = "B\u00E4r";
    return RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options).height - without;
  };
  EXPECT_NEAR(title(640), 2 * title(320), 3);
  EXPECT_EQ(title(64), title(32));  // still legible
}

TEST(RenderFilmStripTest, NumbersAreWrittenBesideVerticesThatAreSeen) {
  const int circles = 41, around = 80;
  const SimpleBody sphere = Sphere(1, circles, around);
  FilmStripOptions options;
  options.view = Eigen::Vector3d::UnitZ();
  const RgbImage plain = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  const int front = circles / 2 * around, back = front + around / 2;  // at (0, 0, 1), (0, 0, -1)
  options.numbers = Eigen::VectorXi::Zero(circles * around);
  options.numbers(back) = 7;
  EXPECT_EQ(Difference(plain, RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options), 0),
            0);
  options.numbers(front) = 12;
  const RgbImage image = RenderFilmStrip(*sphere.connectivity, {sphere.shape}, options);
  int changed = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const size_t at = 3 * (static_cast<size_t>(y) * image.width + x);
      if (std::equal(&image.pixels[at], &image.pixels[at] + 3, &plain.pixels[at])) continue;
      ++changed;
      EXPECT_LT(std::hypot(x - image.width / 2, y - image.height / 2), 40) << x << " " << y;
    }
  }
  EXPECT_GT(changed, 50);
}

TEST(FilmStripViewTest, IsWhereTheStripLooksFrom) {
  const SimpleBody box = Box(1, 2, 0.7);
  Shape bent = box.shape;
  bent.row(0) += 0.4 * bent.row(1).cwiseAbs2();
  FilmStripOptions options = Small();
  const RgbImage image = RenderFilmStrip(*box.connectivity, {box.shape, bent}, options);
  const Eigen::Vector3d view = FilmStripView(*box.connectivity, {box.shape, bent}, options);
  EXPECT_NEAR(view.norm(), 1, 1e-12);
  options.view = view;
  EXPECT_LT(Difference(image, RenderFilmStrip(*box.connectivity, {box.shape, bent}, options), 2),
            0.002);
  options.view = {0, 0, 3};
  EXPECT_LT(
      (FilmStripView(*box.connectivity, {box.shape}, options) - Eigen::Vector3d::UnitZ()).norm(),
      1e-12);
}

TEST(RenderFilmStripTest, DrawsAGraph) {
  const SimpleBody box = Box(1, 1, 1);
  std::vector<std::pair<int, int>> frame;
  for (int v = 0; v < 8; ++v) {
    for (int bit : {1, 2, 4}) {
      if (!(v & bit)) frame.emplace_back(v, v | bit);
    }
  }
  const auto graph = Connectivity::Make(8, {0}, {}, frame);
  FilmStripOptions options;
  options.frame_width = 160;
  const RgbImage solid = RenderFilmStrip(*box.connectivity, {box.shape}, options);
  const RgbImage image = RenderFilmStrip(*graph, {box.shape}, options);
  const Counts counts = Count(image);
  // Twelve tubes of at least about 30 x 2 pixels each, and visible background.
  EXPECT_GT(counts.blue, 12 * 60);
  EXPECT_LT(counts.drawn, 0.4 * Count(solid).drawn);
  EXPECT_EQ(counts.orange, 0);
}

TEST(RenderFilmStripTest, AStrayVertexDoesNotShrinkTheMesh) {
  const SimpleBody box = Box(1, 1, 1);
  const auto with_stray = Connectivity::FromTriangles(9, box.connectivity->Triangles());
  Shape shape(3, 9);
  shape << box.shape, Eigen::Vector3d(1000, 0, 0);
  const RgbImage expected = RenderFilmStrip(
      *Connectivity::FromTriangles(8, box.connectivity->Triangles()), {box.shape}, Small());
  EXPECT_LT(Difference(RenderFilmStrip(*with_stray, {shape}, Small()), expected, 2), 0.002);
}

TEST(RenderFilmStripTest, DrawsWhatIsDegenerate) {
  const SimpleBody sphere = Sphere(1, 10, 20);
  const RgbImage nothing =
      RenderFilmStrip(*sphere.connectivity, {0 * sphere.shape, 0 * sphere.shape}, Small());
  EXPECT_EQ(Count(nothing).drawn, 0);
  Shape line = sphere.shape;
  line.topRows(2).setZero();
  EXPECT_GT(RenderFilmStrip(*sphere.connectivity, {line}, Small()).width, 0);
  const Shape huge = 1e300 * sphere.shape, tiny = 1e-300 * sphere.shape;
  EXPECT_GT(Count(RenderFilmStrip(*sphere.connectivity, {huge}, Small())).blue, 3000);
  EXPECT_GT(Count(RenderFilmStrip(*sphere.connectivity, {tiny}, Small())).blue, 3000);
  const auto vertex = Connectivity::Make(1, {0}, {});
  EXPECT_GT(Count(RenderFilmStrip(*vertex, {Shape::Ones(3, 1)}, Small())).blue, 100);
}

TEST(RenderFilmStripTest, NamesShapesThatCannotBeDrawn) {
  const SimpleBody box = Box(1, 1, 1);
  const auto draw = [&](const std::vector<Shape>& shapes) {
    return MessageOf<MeshError>([&] { RenderFilmStrip(*box.connectivity, shapes); });
  };
  EXPECT_TRUE(Names(draw({}), {"picture:"}));
  EXPECT_TRUE(Names(draw({box.shape, Shape::Zero(3, 7)}), {"picture:", "shape 1", "7", "8"}));
  Shape broken = box.shape;
  broken(2, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(Names(draw({box.shape, broken}), {"picture:", "shape 1", "vertex 5"}));
  EXPECT_TRUE(Names(draw({1.7e308 * box.shape.cwiseSign()}), {"shape 0"}));
}

TEST(RenderFilmStripTest, NamesTheOptionThatIsWrong) {
  const SimpleBody box = Box(1, 1, 1);
  const auto field = [&](const std::function<void(FilmStripOptions*)>& change) {
    FilmStripOptions options;
    change(&options);
    const std::string message = MessageOf<InvalidOptions>(
        [&] { RenderFilmStrip(*box.connectivity, {box.shape}, options); });
    return message.substr(0, message.find(':'));
  };
  using O = FilmStripOptions;
  EXPECT_EQ(field([](O* o) { o->frame_width = 15; }), "frame_width");
  EXPECT_EQ(field([](O* o) { o->max_frames = 1; }), "max_frames");
  EXPECT_EQ(field([](O* o) { o->samples = 0; }), "samples");
  EXPECT_EQ(field([](O* o) { o->view.x() = std::nan(""); }), "view");
  EXPECT_EQ(field([](O* o) { o->up.x() = std::nan(""); }), "up");
  EXPECT_EQ(field([](O* o) { o->up = -2 * (o->view = {1, 2, 3}); }), "up");
  EXPECT_EQ(field([](O* o) { o->legend.assign(121, 'x'); }), "legend");
  EXPECT_EQ(field([](O* o) { o->values.assign(2, Eigen::VectorXd::Zero(8)); }), "values");
  EXPECT_EQ(field([](O* o) { o->values = {Eigen::VectorXd::Zero(7)}; }), "values");
  EXPECT_EQ(field([](O* o) { o->values = {Eigen::VectorXd::Constant(8, INFINITY)}; }), "values");
  EXPECT_EQ(field([](O* o) { o->groups = Eigen::VectorXi::Zero(7); }), "groups");
  EXPECT_EQ(field([](O* o) { o->numbers = Eigen::VectorXi::Zero(7); }), "numbers");
  EXPECT_EQ(field([](O* o) { o->ground_line = std::nan(""); }), "ground_line");
  EXPECT_EQ(field([](O* o) { o->ground_line = 1e300; }), "ground_line");
  EXPECT_EQ(field([](O* o) {
              o->groups = Eigen::VectorXi::Zero(8);
              o->values = {Eigen::VectorXd::Zero(8)};
            }),
            "groups");
  EXPECT_EQ(field([](O* o) { o->marks = Eigen::VectorXi::Zero(7); }), "marks");
  EXPECT_EQ(field([](O* o) { o->marks = Eigen::VectorXi::Constant(8, 3); }), "marks");
  EXPECT_EQ(field([](O* o) { o->marks = Eigen::VectorXi::Constant(8, -1); }), "marks");
}

TEST(RenderFilmStripTest, RefusesAPictureTooLargeToOpen) {
  const SimpleBody box = Box(1, 1, 1);
  FilmStripOptions options;
  options.frame_width = 2048;
  options.max_frames = 1000;
  const std::vector<Shape> shapes(200, box.shape);
  const std::string message =
      MessageOf<InvalidOptions>([&] { RenderFilmStrip(*box.connectivity, shapes, options); });
  EXPECT_TRUE(Names(message, {"frame_width:", "200", "2048"}));
}

}  // namespace
}  // namespace shapespace
