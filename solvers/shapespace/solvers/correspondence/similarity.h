#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_SIMILARITY_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_SIMILARITY_H_

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

// Private.

namespace shapespace::internal {

/// Whether `points` lie on one line, or nearly so: their spread across it is less than a hundredth
/// of that along it. A line leaves open how a body is turned about it.
bool AreCollinear(const Shape& points);

/// How far `from` fits onto `to` by a proper similarity (rotation, one scale, translation), and by
/// one with a reflection: root mean square distances as shares of the spread of `to`. S. Umeyama,
/// "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991.
struct SimilarityErrors {
  double proper = 0, reflected = 0;
};
SimilarityErrors CompareReflection(const Shape& from, const Shape& to);

/// The rotation and translation that carry `from` closest to `to` in the least squares sense,
/// applied to `shape`.
Shape MovedOnto(const Shape& from, const Shape& to, const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_SIMILARITY_H_
