#include <shapespace/output/detail/png_chunks.h>

#include <zlib.h>

#include <cstdint>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>

namespace shapespace::internal {

std::string PngBeginning(int width, int height, PngPixels pixels) {
  std::string header;
  AppendBigEndian(static_cast<std::uint32_t>(width), &header);
  AppendBigEndian(static_cast<std::uint32_t>(height), &header);
  header += {8, static_cast<char>(pixels), 0, 0, 0};
  std::string file = "\x89PNG\r\n\x1a\n";
  AppendPngChunk("IHDR", header, &file);
  AppendPngChunk("sRGB", std::string(1, '\0'), &file);
  return file;
}

void AppendPngChunk(const std::string& name, std::string_view data, std::string* file) {
  AppendBigEndian(static_cast<std::uint32_t>(data.size()), file);
  const std::string content = name + std::string(data);
  *file += content;
  AppendBigEndian(static_cast<std::uint32_t>(
                      crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size())),
                  file);
}

std::string PngColours(const std::vector<Rgb>& colours) {
  std::string data;
  for (const Rgb& colour : colours) data.append(colour.begin(), colour.end());
  return data;
}

std::string CompressedPngRows(const std::vector<unsigned char>& rows) {
  uLongf size = compressBound(rows.size());
  std::string compressed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(compressed.data()), &size, rows.data(), rows.size(),
                Z_BEST_COMPRESSION) != Z_OK) {
    throw InvalidOptions("image", "could not be compressed (out of memory?)");
  }
  compressed.resize(size);
  return compressed;
}

std::vector<unsigned char> UnfilteredPngRows(const std::vector<unsigned char>& pixels,
                                             size_t row_bytes) {
  std::vector<unsigned char> rows;
  rows.reserve(pixels.size() + pixels.size() / row_bytes);
  for (auto row = pixels.begin(); row != pixels.end(); row += static_cast<ptrdiff_t>(row_bytes)) {
    rows.push_back(0);
    rows.insert(rows.end(), row, row + static_cast<ptrdiff_t>(row_bytes));
  }
  return rows;
}

}  // namespace shapespace::internal
