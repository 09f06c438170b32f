#include <gif_lib.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include <shapespace/base/error.h>
#include <shapespace/output/detail/indexed_film.h>
#include <shapespace/output/film.h>

namespace shapespace {
namespace {

using internal::IndexedFilm;

constexpr int kColourBits = 8;
constexpr int kColoursOfGif = 1 << kColourBits;

// giflib's functions return GIF_ERROR where memory is short, the one thing that can fail here.
void CheckGif(int outcome) {
  if (outcome == GIF_ERROR) throw Error("a GIF could not be made (out of memory?)");
}

int AppendToString(GifFileType* gif, const GifByteType* bytes, int count) {
  static_cast<std::string*>(gif->UserData)->append(reinterpret_cast<const char*>(bytes), count);
  return count;
}

class GifWriter {
 public:
  explicit GifWriter(const IndexedFilm& film)
      : film_(film), gif_(EGifOpen(&bytes_, AppendToString, nullptr), Close) {
    CheckGif(gif_ == nullptr ? GIF_ERROR : GIF_OK);
    EGifSetGifVersion(gif_.get(), true);
  }

  std::string Write(bool repeats) {
    const std::unique_ptr<ColorMapObject, void (*)(ColorMapObject*)> colours(
        GifMakeMapObject(kColoursOfGif, nullptr), GifFreeMapObject);
    CheckGif(colours == nullptr ? GIF_ERROR : GIF_OK);
    for (size_t i = 0; i < film_.colours.size(); ++i) {
      colours->Colors[i] = {film_.colours[i][0], film_.colours[i][1], film_.colours[i][2]};
    }
    CheckGif(
        EGifPutScreenDesc(gif_.get(), film_.width, film_.height, kColourBits, 0, colours.get()));
    if (repeats) PutRepeats();
    for (const IndexedFilm::Frame& frame : film_.frames) PutFrame(frame);
    GifFileType* gif = gif_.release();
    CheckGif(EGifCloseFile(gif, nullptr));
    return std::move(bytes_);
  }

 private:
  static void Close(GifFileType* gif) { EGifCloseFile(gif, nullptr); }

  // The extension with which Netscape said how often a film is shown; 0 stands for ever.
  void PutRepeats() {
    CheckGif(EGifPutExtensionLeader(gif_.get(), APPLICATION_EXT_FUNC_CODE));
    CheckGif(EGifPutExtensionBlock(gif_.get(), 11, "NETSCAPE2.0"));
    CheckGif(EGifPutExtensionBlock(gif_.get(), 3, "\x01\0\0"));
    CheckGif(EGifPutExtensionTrailer(gif_.get()));
  }

  void PutFrame(const IndexedFilm::Frame& frame) {
    const GraphicsControlBlock control = {DISPOSE_DO_NOT, false, frame.hundredths,
                                          film_.Unchanged()};
    GifByteType extension[4];
    EGifGCBToExtension(&control, extension);
    CheckGif(EGifPutExtension(gif_.get(), GRAPHICS_EXT_FUNC_CODE, sizeof extension, extension));
    CheckGif(EGifPutImageDesc(gif_.get(), frame.left, frame.top, frame.width, frame.height, false,
                              nullptr));
    std::vector<unsigned char> row(frame.width);
    for (auto pixel = frame.pixels.begin(); pixel != frame.pixels.end(); pixel += frame.width) {
      std::copy_n(pixel, frame.width, row.begin());
      CheckGif(EGifPutLine(gif_.get(), row.data(), frame.width));
    }
  }

  const IndexedFilm& film_;
  std::string bytes_;
  std::unique_ptr<GifFileType, void (*)(GifFileType*)> gif_;
};

}  // namespace

std::string EncodeGif(const Film& film) {
  const IndexedFilm indexed = internal::MakeIndexedFilm(film);
  if (std::max(indexed.width, indexed.height) > std::numeric_limits<unsigned short>::max()) {
    throw InvalidOptions("pictures", std::to_string(indexed.width) + " x " +
                                         std::to_string(indexed.height) +
                                         " pixels are more than a GIF can have");
  }
  return GifWriter(indexed).Write(film.repeats);
}

}  // namespace shapespace
