#ifndef SHAPESPACE_OUTPUT_DETAIL_INDEXED_FILM_H_
#define SHAPESPACE_OUTPUT_DETAIL_INDEXED_FILM_H_

#include <vector>

#include <shapespace/output/detail/palette.h>
#include <shapespace/output/film.h>

namespace shapespace::internal {

/// A film as files store it: the colours of all pictures in one palette, and of each picture the
/// part that differs from the one before.
struct IndexedFilm {
  struct Frame {
    int left = 0, top = 0, width = 0, height = 0;  ///< of the part, in pixels
    /// Row after row from the top: numbers of colours, or `Unchanged`.
    std::vector<unsigned char> pixels;
    int hundredths = 0;  ///< of a second, for which it is shown
  };

  int width = 0, height = 0;
  std::vector<Rgb> colours;   ///< 1 to 255
  std::vector<Frame> frames;  ///< the first is the whole picture; no two in a row are alike

  /// The number that stands for a pixel of the frame before.
  unsigned char Unchanged() const { return static_cast<unsigned char>(colours.size()); }
};

/// Colours are those of the film if there are at most 255, otherwise such that the sum of the
/// squared differences is small. \throw InvalidOptions if the film is not valid.
IndexedFilm MakeIndexedFilm(const Film& film);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_INDEXED_FILM_H_
