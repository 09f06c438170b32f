#ifndef SHAPESPACE_OUTPUT_DETAIL_PNG_CHUNKS_H_
#define SHAPESPACE_OUTPUT_DETAIL_PNG_CHUNKS_H_

#include <string>
#include <string_view>
#include <vector>

#include <shapespace/output/detail/palette.h>

// The parts of PNG files, as in https://www.w3.org/TR/png-3.

namespace shapespace::internal {

/// Kinds of pixels, as the format numbers them.
enum class PngPixels : unsigned char { kTrueColour = 2, kIndexed = 3 };

/// The beginning of a file with such pixels, of 8 bits a channel in sRGB.
std::string PngBeginning(int width, int height, PngPixels pixels);

void AppendPngChunk(const std::string& name, std::string_view data, std::string* file);

/// The data of the chunk PLTE.
std::string PngColours(const std::vector<Rgb>& colours);

/// The data of the chunk IDAT. \throw InvalidOptions if memory is short.
std::string CompressedPngRows(const std::vector<unsigned char>& rows);

/// Rows of `row_bytes` bytes, each preceded by the number of no filter: best for numbers of
/// colours.
std::vector<unsigned char> UnfilteredPngRows(const std::vector<unsigned char>& pixels,
                                             size_t row_bytes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_PNG_CHUNKS_H_
