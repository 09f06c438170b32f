#ifndef SHAPESPACE_FILES_INTERNAL_STORABLE_H_
#define SHAPESPACE_FILES_INTERNAL_STORABLE_H_

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include <shapespace/base/error.h>
#include <shapespace/mesh/shape.h>

// Whether files can store the coordinates of a shape.

namespace shapespace::internal {

/// Share of a shape's diagonal by which its coordinates may change when they are rounded: less than
/// the thirtieth part of an edge in a mesh of 200,000 triangles.
inline constexpr double kMaxRounding = 1e-4;

/// \throw MeshError naming `file` and vertex if a coordinate is not finite.
inline void CheckFinite(const std::string& file, const Shape& shape) {
  for (Eigen::Index v = 0; v < shape.cols(); ++v) {
    if (!shape.col(v).allFinite()) {
      throw MeshError(file + ": vertex " + std::to_string(v + 1) +
                      ": a coordinate is not a finite number; nothing was written");
    }
  }
}

/// \throw MeshError naming `file` if rounding to single precision would change a coordinate, which
///        must be finite, by more than that.
inline void CheckSinglePrecision(const std::string& file, const Shape& shape) {
  if (shape.cols() == 0) return;
  double rounding = 0;
  for (const double x : shape.reshaped()) {
    const bool fits = std::abs(x) <= std::numeric_limits<float>::max();
    rounding = std::max(rounding, fits ? std::abs(x - static_cast<float>(x)) : std::abs(x));
  }
  const double diagonal = (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).stableNorm();
  if (rounding <= kMaxRounding * diagonal) return;
  std::ostringstream message;
  message << file << ": the format has single precision, in which coordinates of this mesh, which "
          << "is " << diagonal << " across, would change by " << rounding
          << "; move it nearer to the origin, choose another unit of length, or write .obj or .ply";
  throw MeshError(message.str());
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_INTERNAL_STORABLE_H_
