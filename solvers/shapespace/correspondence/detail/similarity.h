#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_SIMILARITY_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_SIMILARITY_H_

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Whether `points` are nearly collinear: their spread across a line is less than a hundredth of
/// that along it. Collinear points do not determine a rotation.
bool AreCollinear(const Shape& points);

/// Root mean square errors of the best similarity (rotation, scale, translation) from `from` to
/// `to`, without and with a reflection, as shares of the spread of `to`. S. Umeyama, "Least-squares
/// estimation of transformation parameters between two point patterns", PAMI 1991.
struct SimilarityErrors {
  double proper = 0, reflected = 0;
};
SimilarityErrors CompareReflection(const Shape& from, const Shape& to);

/// Applies to `shape` the rotation and translation that map `from` closest to `to` in the least
/// squares sense.
Shape MovedOnto(const Shape& from, const Shape& to, const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_SIMILARITY_H_
