#include <shapespace/output/detail/film_times.h>

#include <algorithm>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>

#include "support/path_of.h"

namespace shapespace {
namespace {

class FilmTimesTest : public ::testing::Test {
 protected:
  FilmTimesTest() {
    const ShapeFamily bar = MakeBar(4, 1, 1, 3, 1, 1);
    path_ = testing::PathOf(bar.connectivity, {bar.pose(0), bar.pose(20), bar.pose(50)});
    path_.parameters = {2, 2.5, 4};
  }

  /// The parameter that each picture of the film shows.
  std::vector<double> Shown(const GltfOptions& options) const {
    const internal::FilmTimes times = internal::ChooseFilmTimes(path_, options);
    EXPECT_TRUE(std::is_sorted(times.parameters.begin(), times.parameters.end()));
    std::vector<double> shown;
    for (const int number : times.order) shown.push_back(times.parameters.at(number));
    return shown;
  }

  Path path_;
};

TEST_F(FilmTimesTest, ThereAndBackPassesTheSamePicturesTwice) {
  GltfOptions options;
  options.duration = 4;
  const internal::FilmTimes times = internal::ChooseFilmTimes(path_, options);
  EXPECT_EQ(times.order.size(), 100u);
  EXPECT_DOUBLE_EQ(times.seconds, 0.04);
  EXPECT_LE(times.parameters.size(), 51u);
  const std::vector<double> shown = Shown(options);
  for (int i = 1; i < 100; ++i) EXPECT_EQ(shown[i], shown[100 - i]) << i;
  EXPECT_EQ(shown[0], 2);
  EXPECT_EQ(shown[50], 4);
  // Between the rests of a tenth, the way has a constant speed.
  EXPECT_EQ(shown[5], 2);
  EXPECT_EQ(shown[45], 4);
  for (int i = 5; i <= 45; ++i) EXPECT_NEAR(shown[i], 2 + 2.0 * (i - 5) / 40, 1e-5) << i;
}

// The end is where it begins, and is not shown twice.
TEST_F(FilmTimesTest, ACycleEndsBeforeItsBeginning) {
  GltfOptions options;
  options.playback = GltfPlayback::kLoop;
  options.duration = 1;
  const std::vector<double> shown = Shown(options);
  ASSERT_EQ(shown.size(), 25u);
  for (int i = 0; i < 25; ++i) EXPECT_NEAR(shown[i], 2 + 2.0 * i / 25, 1e-5) << i;
}

// Which of the two it is does not depend on rounding.
TEST_F(FilmTimesTest, AMotionThatEndsWhereItBeginsIsPlayedAround) {
  GltfOptions around, back;
  around.playback = GltfPlayback::kLoop;
  back.playback = GltfPlayback::kThereAndBack;
  EXPECT_EQ(Shown({}), Shown(back));
  path_.shapes[2] = path_.shapes[0] * (1 + 1e-9);
  path_.motions[2] = path_.motions[0];
  EXPECT_EQ(Shown({}), Shown(around));
  EXPECT_NE(Shown(back), Shown(around));
  // In another place it is no cycle.
  path_.motions[2].translation.x() += 1;
  EXPECT_EQ(Shown({}), Shown(back));
}

TEST_F(FilmTimesTest, OnceEndsWithTheLastShape) {
  GltfOptions options;
  options.playback = GltfPlayback::kOnce;
  options.duration = 2;
  const std::vector<double> shown = Shown(options);
  ASSERT_EQ(shown.size(), 50u);
  EXPECT_EQ(shown[0], 2);
  EXPECT_LT(shown[44], 4);
  for (int i = 45; i < 50; ++i) EXPECT_EQ(shown[i], 4) << i;
}

TEST_F(FilmTimesTest, ShapesASecondSayHowLongItIs) {
  GltfOptions options;
  options.playback = GltfPlayback::kLoop;
  options.fps = 4;  // two steps from shape to shape
  EXPECT_EQ(Shown(options).size(), 13u);
  EXPECT_NEAR(internal::ChooseFilmTimes(path_, options).seconds, 0.5 / 13, 1e-12);
}

TEST_F(FilmTimesTest, LongFilmsHaveFewerPicturesASecond) {
  GltfOptions options;
  options.duration = 3600;
  const internal::FilmTimes times = internal::ChooseFilmTimes(path_, options);
  EXPECT_EQ(times.order.size(), 600u);
  EXPECT_DOUBLE_EQ(times.seconds, 6);
}

TEST_F(FilmTimesTest, OneShapeIsOnePicture) {
  path_.shapes.resize(1);
  path_.motions.resize(1);
  path_.parameters = {0};
  path_.poses = {0};
  const internal::FilmTimes times = internal::ChooseFilmTimes(path_, {});
  EXPECT_EQ(times.parameters, std::vector<double>{0});
  EXPECT_EQ(times.order, std::vector<int>{0});
}

TEST(NearestParameterTest, IsTheNearerOfTheNeighbours) {
  const std::vector<double> parameters = {0, 1, 4};
  for (const auto& [parameter, number] : {std::make_pair(-1.0, 0),
                                          {0.0, 0},
                                          {0.4, 0},
                                          {0.6, 1},
                                          {1.0, 1},
                                          {2.4, 1},
                                          {2.6, 2},
                                          {4.0, 2},
                                          {5.0, 2}}) {
    EXPECT_EQ(internal::NearestParameter(parameters, parameter), number) << parameter;
  }
}

}  // namespace
}  // namespace shapespace
