#ifndef SHAPESPACE_OUTPUT_INTERNAL_TEXT_H_
#define SHAPESPACE_OUTPUT_INTERNAL_TEXT_H_

#include <string>

#include <shapespace/output/internal/colour.h>
#include <shapespace/output/picture.h>

namespace shapespace::internal {

/// Height of a line of text in pixels, without descenders.
inline constexpr int kTextHeight = 20;

Colour TextColour();

/// \throw InvalidOptions, beginning with `field`, if `text` is longer than 120 characters or
///        contains a character that is not printable ASCII.
void CheckText(const char* field, const std::string& text);

/// Width of `text` in pixels.
int TextWidth(std::string text);

/// Fills the part of [x0, x1) x [y0, y1) that lies in the image.
void Fill(RgbImage* image, int x0, int y0, int x1, int y1, const Colour& colour);

/// Draws `text` with its upper left corner at (left, top).
void DrawText(RgbImage* image, int left, int top, const std::string& text);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_INTERNAL_TEXT_H_
