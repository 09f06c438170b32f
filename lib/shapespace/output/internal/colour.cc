#include <shapespace/output/internal/colour.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <Eigen/LU>

namespace shapespace::internal {
namespace {

constexpr unsigned kValueStops[] = {0xb9cadc, 0xdfc18f, 0xe8923f, 0xcf3f2b, 0x861426};
constexpr int kSteps = 256;

// Groups, in Oklab: hues differ by the golden angle, so that consecutive ones are far from each
// other, with alternating lightness. After 21 groups hues repeat approximately, so the next 21 are
// less saturated.
constexpr float kGroupChroma = 0.13f, kFirstHue = 4.4f, kGoldenAngle = 2.39996323f;
constexpr float kDullChroma = 0.06f;
constexpr int kGroupsToRepeat = 21;
constexpr float kGroupLightness[] = {0.62f, 0.78f, 0.50f};
constexpr unsigned kNoGroupHex = 0xd8d8d4;

// Oklab (Ottosson 2020) is perceptually uniform, unlike RGB.
const Eigen::Matrix3f& RgbToLms() {
  static const Eigen::Matrix3f matrix =
      (Eigen::Matrix3f() << 0.4122214708f, 0.5363325363f, 0.0514459929f,  //
       0.2119034982f, 0.6806995451f, 0.1073969566f,                       //
       0.0883024619f, 0.2817188376f, 0.6299787005f)
          .finished();
  return matrix;
}

const Eigen::Matrix3f& LmsToRgb() {
  static const Eigen::Matrix3f matrix = RgbToLms().inverse();
  return matrix;
}

// Oklab is linear in the cube roots of LMS, so these can be mixed instead.
Eigen::Vector3f CubeRoots(const Colour& colour) {
  return (RgbToLms() * colour).unaryExpr([](float x) { return std::cbrt(x); });
}

std::array<Colour, kSteps> MakeValueColours() {
  constexpr int kSpans = static_cast<int>(std::size(kValueStops)) - 1;
  std::array<Colour, kSteps> colours;
  for (int i = 0; i < kSteps; ++i) {
    const float position = kSpans * static_cast<float>(i) / (kSteps - 1);
    const int span = std::min(static_cast<int>(position), kSpans - 1);
    const float t = position - span;
    const Eigen::Vector3f roots = (1 - t) * CubeRoots(FromHex(kValueStops[span])) +
                                  t * CubeRoots(FromHex(kValueStops[span + 1]));
    colours[i] = (LmsToRgb() * roots.array().cube().matrix()).cwiseMax(0).cwiseMin(1);
  }
  return colours;
}

}  // namespace

float ToLinear(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Colour FromHex(unsigned hex) {
  return {ToLinear(((hex >> 16) & 255) / 255.0f), ToLinear(((hex >> 8) & 255) / 255.0f),
          ToLinear((hex & 255) / 255.0f)};
}

unsigned char ToByte(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return static_cast<unsigned char>(std::lround(255 * s));
}

Colour ValueColour(float value) {
  static const std::array<Colour, kSteps> colours = MakeValueColours();
  return colours[std::lround(std::clamp(value, 0.0f, 1.0f) * (kSteps - 1))];
}

Colour GroupColour(int group) {
  if (group < 0) return FromHex(kNoGroupHex);
  const float hue = kFirstHue + kGoldenAngle * static_cast<float>(group % 1000);
  const float chroma = group / kGroupsToRepeat % 2 == 0 ? kGroupChroma : kDullChroma;
  const float a = chroma * std::cos(hue), b = chroma * std::sin(hue);
  const float lightness = kGroupLightness[group % std::size(kGroupLightness)];
  const Eigen::Vector3f roots(lightness + 0.3963377774f * a + 0.2158037573f * b,
                              lightness - 0.1055613458f * a - 0.0638541728f * b,
                              lightness - 0.0894841775f * a - 1.2914855480f * b);
  return (LmsToRgb() * roots.array().cube().matrix()).cwiseMax(0).cwiseMin(1);
}

}  // namespace shapespace::internal
