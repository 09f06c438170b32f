#include <cstdint>
#include <string>

#include <shapespace/base/internal/bytes.h>
#include <shapespace/output/detail/indexed_film.h>
#include <shapespace/output/detail/png_chunks.h>
#include <shapespace/output/film.h>

// Animated PNG, as in https://www.w3.org/TR/png-3/#apng-frame-based-animation.

namespace shapespace {
namespace {

using internal::AppendBigEndian;
using internal::AppendPngChunk;
using internal::IndexedFilm;

constexpr int kHundredths = 100;  // parts of a second
constexpr char kLeave = 0;        // what becomes of a frame after its time
constexpr char kOver = 1;         // where the next frame is transparent, it stays

std::string FrameControl(std::uint32_t number, const IndexedFilm::Frame& frame) {
  std::string data;
  AppendBigEndian(number, &data);
  for (const int value : {frame.width, frame.height, frame.left, frame.top}) {
    AppendBigEndian(static_cast<std::uint32_t>(value), &data);
  }
  AppendBigEndian(static_cast<std::uint16_t>(frame.hundredths), &data);
  AppendBigEndian(static_cast<std::uint16_t>(kHundredths), &data);
  return data + kLeave + kOver;
}

}  // namespace

std::string EncodeApng(const Film& film) {
  const IndexedFilm indexed = internal::MakeIndexedFilm(film);
  std::string file =
      internal::PngBeginning(indexed.width, indexed.height, internal::PngPixels::kIndexed);
  std::string control;
  AppendBigEndian(static_cast<std::uint32_t>(indexed.frames.size()), &control);
  AppendBigEndian(static_cast<std::uint32_t>(film.repeats ? 0 : 1), &control);
  AppendPngChunk("acTL", control, &file);
  // After the colours, one that is transparent.
  AppendPngChunk("PLTE", internal::PngColours(indexed.colours) + std::string(3, '\0'), &file);
  AppendPngChunk("tRNS", std::string(indexed.colours.size(), '\xff') + '\0', &file);
  std::uint32_t number = 0;  // of the chunks of the animation
  for (const IndexedFilm::Frame& frame : indexed.frames) {
    AppendPngChunk("fcTL", FrameControl(number++, frame), &file);
    const std::string rows = internal::CompressedPngRows(
        internal::UnfilteredPngRows(frame.pixels, static_cast<size_t>(frame.width)));
    if (&frame == &indexed.frames.front()) {
      AppendPngChunk("IDAT", rows, &file);
    } else {
      std::string data;
      AppendBigEndian(number++, &data);
      AppendPngChunk("fdAT", data + rows, &file);
    }
  }
  AppendPngChunk("IEND", "", &file);
  return file;
}

}  // namespace shapespace
