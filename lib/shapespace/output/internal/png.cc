#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <limits>
#include <ostream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/output/picture.h>

namespace shapespace {

std::string EncodePng(const RgbImage& image) {
  // The encoder stores sizes in an int.
  if (image.pixels.size() >= static_cast<size_t>(std::numeric_limits<int>::max())) {
    throw InvalidOptions("image", "too large for a PNG");
  }
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() != 3 * static_cast<size_t>(image.width) * image.height) {
    throw InvalidOptions("image", std::to_string(image.pixels.size()) + " bytes are not " +
                                      std::to_string(image.width) + " x " +
                                      std::to_string(image.height) + " pixels of three");
  }
  std::string bytes;
  const auto append = [](void* out, void* data, int size) {
    static_cast<std::string*>(out)->append(static_cast<const char*>(data), size);
  };
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.pixels.data(),
                             3 * image.width) == 0) {
    throw InvalidOptions("image", "could not be encoded (out of memory?)");
  }
  return bytes;
}

void WritePng(const std::string& file, const RgbImage& image) {
  const std::string bytes = EncodePng(image);
  internal::WriteFileAtomically(file, [&](std::ostream& stream) { stream << bytes; });
}

}  // namespace shapespace
