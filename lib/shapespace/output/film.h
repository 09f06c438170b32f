#ifndef SHAPESPACE_OUTPUT_FILM_H_
#define SHAPESPACE_OUTPUT_FILM_H_

#include <string>
#include <vector>

#include <shapespace/output/picture.h>

namespace shapespace {

/// Pictures that are shown one after another.
struct Film {
  std::vector<RgbImage> pictures;  ///< all of one size; each may be shown several times

  std::vector<int> order;       ///< which picture is shown, in turn
  std::vector<double> seconds;  ///< how long, for each of `order`: .01 .. 600
  bool repeats = true;          ///< whether it begins again after its end

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// The bytes of an animated GIF, which all programs show that show pictures. It has at most 255
/// colours, chosen for the whole film. Times are rounded to hundredths of a second, such that their
/// sum is right. What does not change from one picture to the next is not stored again.
/// \throw InvalidOptions as Validate, or if the pictures are larger than the format allows.
std::string EncodeGif(const Film& film);

/// The same as an animated PNG, which browsers show, and which is smaller. Programs that do not
/// know the animation show the first picture. \throw InvalidOptions as Validate.
std::string EncodeApng(const Film& film);

/// Writes a file that ends in .gif or .apng, completely or not at all.
/// \throw FileError, also for another extension; InvalidOptions as above.
void WriteFilm(const std::string& file, const Film& film);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_FILM_H_
