#ifndef SHAPESPACE_OUTPUT_INTERNAL_COLOUR_H_
#define SHAPESPACE_OUTPUT_INTERNAL_COLOUR_H_

#include <Eigen/Core>

namespace shapespace::internal {

/// Linear light: red, green and blue in 0 .. 1. All sums over lights and samples are computed in
/// it; sRGB is used only for input and output.
using Colour = Eigen::Vector3f;

/// The colour of poses, a blue, in sRGB.
inline constexpr unsigned kPoseHex = 0x4a86c8;

/// From `0xrrggbb` in sRGB.
Colour FromHex(unsigned hex);

/// One channel of sRGB, 0 .. 1, as linear light.
float ToLinear(float srgb);

/// One channel of linear light (clamped to 0 .. 1) as an sRGB byte.
unsigned char ToByte(float linear);

/// Colour of a value in 0 .. 1 (clamped): from light grey-blue through sand and orange to a deep
/// red, with decreasing lightness, so that it is readable in grey scale.
Colour ValueColour(float value);

/// Colour of group 0, 1, ...; the first few differ most. Light grey for negative numbers, which
/// stand for no group.
Colour GroupColour(int group);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_INTERNAL_COLOUR_H_
