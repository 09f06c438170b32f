#include <shapespace/files/point_cache.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <string_view>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/detail/read_formats.h>
#include <shapespace/files/internal/storable.h>

namespace shapespace {
namespace {

using internal::AppendBigEndian;
using internal::AppendLittleEndian;

// What a .pc2 begins with.
constexpr std::string_view kPc2("POINTCACHE2\0", 12);

bool IsPc2(const std::string& file) {
  if (!IsPointCache(file)) {
    throw FileError(file + ": a point cache must end in .pc2 or .mdd; rename it");
  }
  return internal::FileExtension(file) == ".pc2";
}

std::string Pc2Header(std::int32_t shapes, std::int32_t vertices) {
  std::string bytes(kPc2);
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

// Where in a cache its frames are, and how many.
struct Layout {
  std::int64_t header, frames, vertices;
};

constexpr int kPc2Header = 32;

Layout LayoutOfPc2(const std::string& file, const std::string& bytes) {
  if (bytes.compare(0, kPc2.size(), kPc2) != 0 || bytes.size() < kPc2Header) {
    throw FileError(file + ": does not begin as a .pc2 does" + internal::kReexport);
  }
  const auto number = [&](size_t at) {
    return internal::ReadLittleEndian<std::int32_t>(bytes.data() + at);
  };
  return {kPc2Header, number(28), number(16)};
}

Layout LayoutOfMdd(const std::string& file, const std::string& bytes) {
  if (bytes.size() < 8) {
    throw FileError(file + ": ends before its first frame" + internal::kReexport);
  }
  const auto number = [&](size_t at) {
    return std::int64_t{internal::ReadBigEndian<std::int32_t>(bytes.data() + at)};
  };
  const std::int64_t frames = number(0);
  return {8 + 4 * frames, frames, number(4)};
}

// Other programs may have rounded times, to milliseconds for example.
bool AreEven(const std::string& mdd, std::int64_t frames) {
  const auto time = [&](std::int64_t i) {
    return double{internal::ReadBigEndian<float>(mdd.data() + 8 + 4 * i)};
  };
  const double step =
      (time(frames - 1) - time(0)) / static_cast<double>(std::max<std::int64_t>(frames - 1, 1));
  for (std::int64_t i = 0; i < frames; ++i) {
    if (!(std::abs(time(i) - time(0) - static_cast<double>(i) * step) <= 0.1 * step)) return false;
  }
  return true;
}

}  // namespace

bool IsPointCache(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  return extension == ".pc2" || extension == ".mdd";
}

void WritePointCache(const std::string& file, const std::vector<Shape>& shapes, double fps) {
  if (!(fps >= 0.01 && fps <= 1000)) throw InvalidOptions("fps", "must be from 0.01 to 1000");
  const bool is_pc2 = IsPc2(file);
  if (shapes.empty()) throw MeshError(file + ": there is no shape to write");
  for (const Shape& shape : shapes) {
    if (shape.cols() != shapes[0].cols()) {
      throw MeshError(file + ": shapes of " + std::to_string(shapes[0].cols()) + " and of " +
                      std::to_string(shape.cols()) + " vertices; a point cache has one number");
    }
    internal::CheckFinite(file, shape);
    internal::CheckSinglePrecision(file, shape);
  }
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

PointCache ReadPointCache(const std::string& file) {
  const bool is_pc2 = IsPc2(file);
  const std::string bytes = internal::ReadFile(file, internal::kMaxMeshBytes);
  const auto [header, frames, vertices] =
      is_pc2 ? LayoutOfPc2(file, bytes) : LayoutOfMdd(file, bytes);
  const std::string says = file + ": says that it has " + std::to_string(frames) + " frames of " +
                           std::to_string(vertices) + " vertices";
  if (frames < 1 || vertices < 1) throw FileError(says + internal::kReexport);
  // Divided, because the product of counts in a damaged file may be more than 64 bits hold.
  const std::int64_t held = static_cast<std::int64_t>(bytes.size()) - header;
  const std::int64_t frame = 3 * vertices * static_cast<std::int64_t>(sizeof(float));
  if (held < 0 || held % frame != 0 || held / frame != frames) {
    throw FileError(says + ", and has bytes for more or fewer" + internal::kReexport);
  }
  PointCache cache;
  cache.even = is_pc2 || AreEven(bytes, frames);
  cache.shapes.reserve(static_cast<size_t>(frames));
  const char* at = bytes.data() + header;
  for (std::int64_t i = 0; i < frames; ++i) {
    Shape shape(3, vertices);
    for (double& x : shape.reshaped()) {
      x = is_pc2 ? internal::ReadLittleEndian<float>(at) : internal::ReadBigEndian<float>(at);
      at += sizeof(float);
    }
    for (Eigen::Index v = 0; v < vertices; ++v) {
      if (shape.col(v).allFinite()) continue;
      throw FileError(file + ": frame " + std::to_string(i + 1) + ", vertex " +
                      std::to_string(v + 1) + ": a coordinate is not a finite number" +
                      internal::kReexport);
    }
    cache.shapes.push_back(std::move(shape));
  }
  return cache;
}

}  // namespace shapespace
