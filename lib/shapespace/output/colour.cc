#include <shapespace/output/colour.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <Eigen/LU>

namespace shapespace {
namespace {

constexpr unsigned kValueStops[] = {0xb9cadc, 0xdfc18f, 0xe8923f, 0xcf3f2b, 0x861426};
constexpr int kSteps = 256;

float ToLinear(float s) {
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

// Oklab (Ottosson 2020): equal steps in it look equal, which plain RGB mixing does not give.
const Eigen::Matrix3f& RgbToLms() {
  static const Eigen::Matrix3f matrix =
      (Eigen::Matrix3f() << 0.4122214708f, 0.5363325363f, 0.0514459929f,  //
       0.2119034982f, 0.6806995451f, 0.1073969566f,                       //
       0.0883024619f, 0.2817188376f, 0.6299787005f)
          .finished();
  return matrix;
}

// Oklab is linear in the cube roots of LMS, so mixing those is mixing in Oklab.
Eigen::Vector3f CubeRoots(const Colour& colour) {
  return (RgbToLms() * colour).unaryExpr([](float x) { return std::cbrt(x); });
}

std::array<Colour, kSteps> MakeValueColours() {
  constexpr int kSpans = static_cast<int>(std::size(kValueStops)) - 1;
  const Eigen::Matrix3f lms_to_rgb = RgbToLms().inverse();
  std::array<Colour, kSteps> colours;
  for (int i = 0; i < kSteps; ++i) {
    const float position = kSpans * static_cast<float>(i) / (kSteps - 1);
    const int span = std::min(static_cast<int>(position), kSpans - 1);
    const float t = position - span;
    const Eigen::Vector3f roots = (1 - t) * CubeRoots(FromHex(kValueStops[span])) +
                                  t * CubeRoots(FromHex(kValueStops[span + 1]));
    colours[i] = (lms_to_rgb * roots.array().cube().matrix()).cwiseMax(0).cwiseMin(1);
  }
  return colours;
}

}  // namespace

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

}  // namespace shapespace
