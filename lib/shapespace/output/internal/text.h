#ifndef SHAPESPACE_OUTPUT_INTERNAL_TEXT_H_
#define SHAPESPACE_OUTPUT_INTERNAL_TEXT_H_

#include <string>

#include <shapespace/output/internal/colour.h>
#include <shapespace/output/picture.h>

namespace shapespace::internal {

// Texts are in UTF-8 and drawn in DejaVu Sans. A byte that is not UTF-8 shows as the replacement
// character, and a character that fonts/subset.sh leaves out, a control character too, as a box.

/// Size of the text of a strip with such frames: the height of an em in pixels. It grows with the
/// frames, so that it is legible where a large picture is shown small.
int TextSize(int frame_width);

/// Height of a line of text of this size, descenders and accents included, in pixels.
int LineHeight(int size);

Colour TextColour();

/// \throw InvalidOptions, beginning with `field`, if `text` is longer than 120 characters.
void CheckText(const char* field, const std::string& text);

/// Width of `text` in pixels.
int TextWidth(const std::string& text, int size);

/// `text` where it is at most `width` pixels wide, else as much of it as fits together with three
/// dots at its end.
std::string Shortened(const std::string& text, int width, int size);

/// Fills the part of [x0, x1) x [y0, y1) that lies in the image.
void Fill(RgbImage* image, int x0, int y0, int x1, int y1, const Colour& colour);

/// Draws `text` over the image in the rectangle whose upper left corner is (left, top), of the size
/// that TextWidth and LineHeight say; what lies outside of the image is cut off.
void DrawText(RgbImage* image, int left, int top, const std::string& text, int size);

/// The same with a light rim of this width in pixels, for texts on coloured surfaces. The rim may
/// exceed the rectangle by its width.
void DrawRimmedText(RgbImage* image, int left, int top, const std::string& text, int size, int rim);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_INTERNAL_TEXT_H_
