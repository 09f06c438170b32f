#include <shapespace/output/point_cache.h>

#include <cstdint>
#include <ostream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/files/internal/storable.h>

namespace shapespace {
namespace {

using internal::AppendBigEndian;
using internal::AppendLittleEndian;

std::string Pc2Header(std::int32_t shapes, std::int32_t vertices) {
  std::string bytes("POINTCACHE2\0", 12);
  AppendLittleEndian(std::int32_t{1}, &bytes);  // version
  AppendLittleEndian(vertices, &bytes);
  AppendLittleEndian(0.0f, &bytes);  // the first frame
  AppendLittleEndian(1.0f, &bytes);  // frames from one sample to the next
  AppendLittleEndian(shapes, &bytes);
  return bytes;
}

std::string MddHeader(std::int32_t shapes, std::int32_t vertices, double fps) {
  std::string bytes;
  AppendBigEndian(shapes, &bytes);
  AppendBigEndian(vertices, &bytes);
  for (int i = 0; i < shapes; ++i) AppendBigEndian(static_cast<float>(i / fps), &bytes);
  return bytes;
}

}  // namespace

bool IsPointCache(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  return extension == ".pc2" || extension == ".mdd";
}

void WritePointCache(const std::string& file, const std::vector<Shape>& shapes, double fps) {
  if (!(fps >= 0.01 && fps <= 1000)) throw InvalidOptions("fps", "must be from 0.01 to 1000");
  if (!IsPointCache(file)) {
    throw FileError(file + ": a point cache must end in .pc2 or .mdd; rename it");
  }
  if (shapes.empty()) throw MeshError(file + ": there is no shape to write");
  for (const Shape& shape : shapes) {
    if (shape.cols() != shapes[0].cols()) {
      throw MeshError(file + ": shapes of " + std::to_string(shapes[0].cols()) + " and of " +
                      std::to_string(shape.cols()) + " vertices; a point cache has one number");
    }
    internal::CheckFinite(file, shape);
    internal::CheckSinglePrecision(file, shape);
  }
  const bool is_pc2 = internal::FileExtension(file) == ".pc2";
  const auto count = static_cast<std::int32_t>(shapes.size());
  const auto vertices = static_cast<std::int32_t>(shapes[0].cols());
  internal::WriteFileAtomically(file, [&](std::ostream& stream) {
    stream << (is_pc2 ? Pc2Header(count, vertices) : MddHeader(count, vertices, fps));
    std::string bytes;
    for (const Shape& shape : shapes) {
      bytes.clear();
      for (const double x : shape.reshaped()) {
        const auto single = static_cast<float>(x);
        is_pc2 ? AppendLittleEndian(single, &bytes) : AppendBigEndian(single, &bytes);
      }
      stream << bytes;
    }
  });
}

}  // namespace shapespace
