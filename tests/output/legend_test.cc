#include <shapespace/output/detail/legend.h>

#include <gtest/gtest.h>

#include <shapespace/output/internal/colour.h>

namespace shapespace {
namespace {

TEST(EndOfScaleTest, IsTheNextRoundNumberAboveThePercentile) {
  for (const auto& [value, end] :
       {std::pair{0.03, 0.05}, std::pair{0.05, 0.05}, std::pair{0.051, 0.1}, std::pair{1.2, 2.0},
        std::pair{7e-5, 1e-4}}) {
    EXPECT_DOUBLE_EQ(internal::EndOfScale({Eigen::VectorXd::Constant(10, value)}), end);
  }
}

TEST(EndOfScaleTest, IgnoresOneOutlierInAThousandOfAllShapesTogether) {
  std::vector<Eigen::VectorXd> values(2, Eigen::VectorXd::Constant(500, 0.04));
  values[1][7] = 30;
  EXPECT_DOUBLE_EQ(internal::EndOfScale(values), 0.05);
}

TEST(EndOfScaleTest, ShowsTheOutlierWhereThereIsNothingElse) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(1000);
  values[3] = 0.15;
  EXPECT_DOUBLE_EQ(internal::EndOfScale({values}), 0.2);
}

TEST(EndOfScaleTest, IsOnePerCentWhereAllIsZeroOrRounding) {
  EXPECT_DOUBLE_EQ(internal::EndOfScale({Eigen::VectorXd::Zero(5)}), 0.01);
  EXPECT_DOUBLE_EQ(internal::EndOfScale({Eigen::VectorXd::Constant(5, 1e-15)}), 0.01);
}

TEST(DrawLegendTest, GrowsWithItsTitle) {
  const RgbImage shorter = internal::DrawLegend(0.05, 0.05, "edge deviation", 20);
  const RgbImage longer = internal::DrawLegend(0.05, 0.05, "edge deviation of the second pose", 20);
  EXPECT_GT(longer.width, shorter.width);
  EXPECT_EQ(longer.height, shorter.height);
}

TEST(DrawLegendTest, NamesTheLargestValueOnlyBeyondTheScale) {
  const RgbImage within = internal::DrawLegend(0.05, 0.05, "edge deviation", 20);
  const RgbImage beyond = internal::DrawLegend(0.05, 0.31, "edge deviation", 20);
  EXPECT_GT(beyond.width, within.width);
}

TEST(DrawGroupLegendTest, HasAColourForEachGroupUpTo24) {
  const RgbImage two = internal::DrawGroupLegend(2, "parts", 20),
                 five = internal::DrawGroupLegend(5, "parts", 20);
  EXPECT_GT(five.width, two.width);
  EXPECT_EQ(internal::DrawGroupLegend(24, "parts", 20).width,
            internal::DrawGroupLegend(5000, "parts", 20).width);
  for (int group = 0; group < 5; ++group) {
    const internal::Colour colour = internal::GroupColour(group);
    int found = 0;
    for (size_t i = 0; i < five.pixels.size(); i += 3) {
      bool same = true;
      for (int k = 0; k < 3; ++k) same = same && five.pixels[i + k] == internal::ToByte(colour[k]);
      found += same;
    }
    EXPECT_GT(found, 100) << group;
  }
}

TEST(DrawLegendTest, DrawsDarkTextOnALightGround) {
  const RgbImage blank = internal::DrawLegend(0.05, 0.05, "", 20),
                 titled = internal::DrawLegend(0.05, 0.05, "lilies", 20);
  int ink = 0;
  for (int y = 0; y < titled.height; ++y) {
    for (int x = blank.width; x < titled.width; ++x) {
      ink += titled.pixels[3 * (y * titled.width + x)] < 180;
    }
  }
  // Six letters, each with at least one stem two pixels wide and ten high.
  EXPECT_GT(ink, 6 * 20);
  EXPECT_GT(titled.pixels[0], 240);
}

}  // namespace
}  // namespace shapespace
