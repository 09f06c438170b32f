#include <shapespace/output/internal/colour.h>

#include <gtest/gtest.h>

namespace shapespace {
namespace {

TEST(ColourTest, BytesSurviveLinearLight) {
  for (unsigned byte = 0; byte < 256; ++byte) {
    const internal::Colour colour = internal::FromHex(byte << 16 | byte << 8 | byte);
    EXPECT_EQ(internal::ToByte(colour[0]), byte);
    EXPECT_EQ(internal::ToByte(colour[2]), byte);
  }
  const internal::Colour mixed = internal::FromHex(0x804020);
  EXPECT_EQ(internal::ToByte(mixed[0]), 0x80);
  EXPECT_EQ(internal::ToByte(mixed[1]), 0x40);
  EXPECT_EQ(internal::ToByte(mixed[2]), 0x20);
}

TEST(ColourTest, HalfTheLightIsByte188) { EXPECT_EQ(internal::ToByte(0.5f), 188); }

TEST(ColourTest, ValuesRunFromCoolToWarmAndGetDarker) {
  const internal::Colour cool = internal::ValueColour(0), warm = internal::ValueColour(1);
  EXPECT_GT(cool.z(), cool.x());
  EXPECT_GT(warm.x(), 3 * warm.z());
  float previous = 1;
  for (int i = 0; i <= 20; ++i) {
    const float luminance =
        internal::ValueColour(i / 20.0f).dot(internal::Colour(0.2126f, 0.7152f, 0.0722f));
    EXPECT_LT(luminance, previous) << i;
    previous = luminance;
  }
}

TEST(ColourTest, GroupsCanBeToldApart) {
  const internal::Colour none = internal::GroupColour(-1);
  EXPECT_LT(none.maxCoeff() - none.minCoeff(), 0.05);
  for (int i = 0; i < 40; ++i) {
    const internal::Colour colour = internal::GroupColour(i);
    EXPECT_GE(colour.minCoeff(), 0);
    EXPECT_LE(colour.maxCoeff(), 1);
    EXPECT_GT((colour - none).norm(), 0.1) << i;
    for (int j = 0; j < i; ++j)
      EXPECT_GT((colour - internal::GroupColour(j)).norm(), 0.03) << i << ' ' << j;
  }
}

TEST(ColourTest, ValuesOutsideTheScaleGetItsEnds) {
  EXPECT_EQ(internal::ValueColour(-3), internal::ValueColour(0));
  EXPECT_EQ(internal::ValueColour(1e6f), internal::ValueColour(1));
}

// IEC 61966-2-1: linear near black.
TEST(ColourTest, LinearLightIsThatOfTheStandard) {
  EXPECT_FLOAT_EQ(internal::ToLinear(0.04f), 0.04f / 12.92f);
  EXPECT_NEAR(internal::ToLinear(0.5f), 0.21404f, 1e-5);
  EXPECT_NEAR(internal::ToLinear(1), 1, 1e-6);
  EXPECT_EQ(internal::ToByte(-1), 0);
  EXPECT_EQ(internal::ToByte(2), 255);
  EXPECT_EQ(internal::ToByte(0.003f), 10);
}

TEST(ColourTest, TheScaleGoesThroughItsColours) {
  const std::pair<float, unsigned> stops[] = {
      {0.0f, 0xb9cadc}, {0.25f, 0xdfc18f}, {0.5f, 0xe8923f}, {0.75f, 0xcf3f2b}, {1.0f, 0x861426}};
  for (const auto& [value, hex] : stops) {
    const internal::Colour expected = internal::FromHex(hex);
    EXPECT_LT((internal::ValueColour(value) - expected).cwiseAbs().maxCoeff(), 0.01) << value;
  }
}

}  // namespace
}  // namespace shapespace
