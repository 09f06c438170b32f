#include <shapespace/output/film.h>

#include <ostream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/internal/extension.h>

namespace shapespace {

void Film::Validate() const {
  if (pictures.empty()) throw InvalidOptions("pictures", "there is none");
  for (const RgbImage& picture : pictures) {
    if (picture.width < 1 || picture.height < 1 || picture.width != pictures[0].width ||
        picture.height != pictures[0].height ||
        picture.pixels.size() != 3 * static_cast<size_t>(picture.width) * picture.height) {
      throw InvalidOptions("pictures",
                           "number " + std::to_string(&picture - pictures.data()) +
                               " is empty, or its size is not that of its pixels, or of the first");
    }
  }
  if (order.empty()) throw InvalidOptions("order", "names no picture");
  for (const int number : order) {
    internal::CheckRange("order", number, 0, static_cast<int>(pictures.size()) - 1);
  }
  if (seconds.size() != order.size()) {
    throw InvalidOptions("seconds", std::to_string(seconds.size()) + " times for " +
                                        std::to_string(order.size()) + " pictures");
  }
  for (const double time : seconds) internal::CheckRange("seconds", time, 0.01, 600.0);
}

void WriteFilm(const std::string& file, const Film& film) {
  const std::string extension = internal::FileExtension(file);
  if (extension != ".gif" && extension != ".apng") {
    throw FileError(file + ": a film must end in .gif or .apng");
  }
  const std::string bytes = extension == ".gif" ? EncodeGif(film) : EncodeApng(film);
  internal::WriteFileAtomically(file, [&](std::ostream& stream) { stream << bytes; });
}

}  // namespace shapespace
