#ifndef SHAPESPACE_ANALYSIS_DISTANCE_H_
#define SHAPESPACE_ANALYSIS_DISTANCE_H_

#include <limits>

#include <Eigen/Core>

namespace shapespace {

/// The two kinds of pairs that surfaces touch with first. The four vertices of a pair are those of
/// its two elements, one after the other.
enum class PairKind {
  kVertexTriangle,  ///< vertex 0; triangle 1, 2, 3
  kEdgeEdge,        ///< edge 0, 1; edge 2, 3
};

/// Four points, one per column, or their velocities.
using FourPoints = Eigen::Matrix<double, 3, 4>;

/// The nearest points of the two elements of a pair.
struct Separation {
  /// From the nearest point of the second element to that of the first.
  Eigen::Vector3d difference;
  /// difference = points * coefficients. The derivative of the distance with respect to point i is
  /// coefficients(i) * difference / distance, because moving the nearest points on their elements
  /// does not change the distance to first order.
  Eigen::Vector4d coefficients;

  double Distance() const { return difference.norm(); }
};

/// Elements without length or area count as the points or segments that they are.
Separation NearestPoints(PairKind kind, const FourPoints& points);

/// The number of vertices of the first element.
constexpr int FirstElementSize(PairKind kind) { return kind == PairKind::kVertexTriangle ? 1 : 2; }

/// How fast the two elements can come nearer to each other, at most: the greatest relative speed of
/// their points.
double RelativeSpeed(PairKind kind, FourPoints velocities);

/// A step in (0, 1] during which all points move with constant velocity and the distance stays at
/// least `kept` times what it is at the beginning, `kept` in (0, 1), or at least `enough`,
/// whichever is less. 1 if it does so for all of it. The step is never too long, and shorter than
/// necessary by a small part only, unless the elements slide along each other at less than about a
/// thousandth of their way. Elements that touch already have the step 0, unless nothing moves.
///
/// Additive continuous collision detection (Li, Kaufman and Jiang, Codimensional Incremental
/// Potential Contact, 2021, section 5.1): the distance decreases no faster than the greatest
/// relative speed of the elements' points, which gives a safe step; from its end there is another
/// one.
double SafeStep(PairKind kind, const FourPoints& points, const FourPoints& velocities, double kept,
                double enough = std::numeric_limits<double>::infinity());

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_DISTANCE_H_
