#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/output/detail/font.h>
#include <shapespace/output/detail/frame.h>
#include <shapespace/output/detail/utf8.h>
#include <shapespace/output/internal/text.h>

namespace shapespace::internal {
namespace {

constexpr size_t kLongestText = 120;
constexpr int kFramesPerEm = 16, kSmallestText = 12;

// Above and below the base line, in ems; capitals with accents are the highest letters.
constexpr double kAscent = 0.95, kDescent = 0.25;

const stbtt_fontinfo& Font() {
  static const stbtt_fontinfo font = [] {
    stbtt_fontinfo info;
    stbtt_InitFont(&info, kFont, 0);
    return info;
  }();
  return font;
}

float Scale(int size) { return stbtt_ScaleForMappingEmToPixels(&Font(), static_cast<float>(size)); }

float Advance(char32_t character, int size) {
  int advance = 0, bearing = 0;
  stbtt_GetCodepointHMetrics(&Font(), static_cast<int>(character), &advance, &bearing);
  return Scale(size) * static_cast<float>(advance);
}

float Width(const std::u32string& text, int size) {
  float width = 0;
  for (const char32_t character : text) width += Advance(character, size);
  return width;
}

std::string Encode(const std::u32string& text) {
  std::string bytes;
  for (const char32_t c : text) {
    if (c < 0x80) {
      bytes += static_cast<char>(c);
      continue;
    }
    const int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    bytes += static_cast<char>((0xFF << (7 - more) & 0xFF) | c >> 6 * more);
    for (int i = more - 1; i >= 0; --i) bytes += static_cast<char>(0x80 | (c >> 6 * i & 0x3F));
  }
  return bytes;
}

// How much of each pixel of a rectangle is ink, 0 .. 255.
struct Ink {
  int width = 0, height = 0;
  std::vector<unsigned char> share;

  // Adds the glyph of `character`, whose origin is `x` pixels to the right in the line.
  void Add(char32_t character, float x, int base, int size);
};

void Ink::Add(char32_t character, float x, int base, int size) {
  const float scale = Scale(size), whole = std::floor(x);
  const int glyph = stbtt_FindGlyphIndex(&Font(), static_cast<int>(character));
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  stbtt_GetGlyphBitmapBoxSubpixel(&Font(), glyph, scale, scale, x - whole, 0, &x0, &y0, &x1, &y1);
  const int columns = x1 - x0, rows = y1 - y0;
  if (columns <= 0 || rows <= 0) return;
  std::vector<unsigned char> bitmap(static_cast<size_t>(columns) * rows);
  stbtt_MakeGlyphBitmapSubpixel(&Font(), bitmap.data(), columns, rows, columns, scale, scale,
                                x - whole, 0, glyph);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int to_x = static_cast<int>(whole) + x0 + column, to_y = base + y0 + row;
      if (to_x < 0 || to_x >= width || to_y < 0 || to_y >= height) continue;
      unsigned char& out = share[static_cast<size_t>(to_y) * width + to_x];
      // Accents that are characters of their own lie over the letter before them.
      out = std::max(out, bitmap[static_cast<size_t>(row) * columns + column]);
    }
  }
}

Ink InkOf(const std::string& text, int size) {
  Ink ink;
  ink.width = TextWidth(text, size);
  ink.height = LineHeight(size);
  ink.share.resize(static_cast<size_t>(ink.width) * ink.height);
  float x = 0;
  for (const char32_t character : DecodeUtf8(text)) {
    ink.Add(character, x, static_cast<int>(std::lround(kAscent * size)), size);
    x += Advance(character, size);
  }
  return ink;
}

// Mixes bytes and not light: thin dark strokes would look pale otherwise.
void Blend(const Ink& ink, int left, int top, const Colour& colour, RgbImage* image) {
  for (int row = std::max(0, -top); row < std::min(ink.height, image->height - top); ++row) {
    for (int column = std::max(0, -left); column < std::min(ink.width, image->width - left);
         ++column) {
      const int share = ink.share[static_cast<size_t>(row) * ink.width + column];
      if (share == 0) continue;
      unsigned char* pixel =
          &image->pixels[3 * (static_cast<size_t>(top + row) * image->width + left + column)];
      for (int k = 0; k < 3; ++k) {
        pixel[k] = static_cast<unsigned char>(
            (share * ToByte(colour[k]) + (255 - share) * pixel[k] + 127) / 255);
      }
    }
  }
}

}  // namespace

int TextSize(int frame_width) { return std::max(kSmallestText, frame_width / kFramesPerEm); }

int LineHeight(int size) {
  return static_cast<int>(std::lround(kAscent * size) + std::ceil(kDescent * size));
}

Colour TextColour() {
  static const Colour colour = FromHex(0x404448);
  return colour;
}

void CheckText(const char* field, const std::string& text) {
  if (DecodeUtf8(text).size() > kLongestText) {
    throw InvalidOptions(field, "longer than " + std::to_string(kLongestText) + " characters");
  }
}

int TextWidth(const std::string& text, int size) {
  return static_cast<int>(std::ceil(Width(DecodeUtf8(text), size)));
}

std::string Shortened(const std::string& text, int width, int size) {
  std::u32string characters = DecodeUtf8(text);
  if (TextWidth(text, size) <= width) return text;
  constexpr char32_t kDots = 0x2026;
  float rest = static_cast<float>(width) - Advance(kDots, size);
  size_t fits = 0;
  while (fits < characters.size() && (rest -= Advance(characters[fits], size)) >= 0) ++fits;
  characters.resize(fits);
  while (!characters.empty() && characters.back() == ' ') characters.pop_back();
  return Encode(characters + kDots);
}

void Fill(RgbImage* image, int x0, int y0, int x1, int y1, const Colour& colour) {
  for (int y = std::max(0, y0); y < std::min(image->height, y1); ++y) {
    for (int x = std::max(0, x0); x < std::min(image->width, x1); ++x) {
      for (int k = 0; k < 3; ++k) {
        image->pixels[3 * (static_cast<size_t>(y) * image->width + x) + k] = ToByte(colour[k]);
      }
    }
  }
}

void DrawText(RgbImage* image, int left, int top, const std::string& text, int size) {
  Blend(InkOf(text, size), left, top, TextColour(), image);
}

void DrawRimmedText(RgbImage* image, int left, int top, const std::string& text, int size,
                    int rim) {
  const Ink ink = InkOf(text, size);
  for (int y = -rim; y <= rim; ++y) {
    for (int x = -rim; x <= rim; ++x) {
      if (x * x + y * y <= rim * rim) Blend(ink, left + x, top + y, Background(), image);
    }
  }
  Blend(ink, left, top, TextColour(), image);
}

}  // namespace shapespace::internal
