#ifndef SHAPESPACE_MATCHING_DETAIL_COMPARE_BODIES_H_
#define SHAPESPACE_MATCHING_DETAIL_COMPARE_BODIES_H_

#include <cmath>

#include <Eigen/Core>

#include <shapespace/matching/detail/markers.h>
#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/internal/matching.h>

namespace shapespace::internal {

/// The integral of the mean curvature around each vertex, positive where the surface is convex:
/// half of the Laplacian of the position, along the normal.
Eigen::VectorXd MeanCurvature(const MatchingBody& body);

/// The change of a distance along the surface relative to it, such that short ones do not decide.
template <typename T>
T RelativeChange(T before, T after) {
  return std::abs(before - after) / (T(0.5) * (before + after) + T(0.1));
}

/// Compares two bodies at pairs of vertices of their working surfaces. The curvature is smoothed by
/// all eigenfunctions, and saturates. The heat kernel signature (J. Sun, M. Ovsjanikov and
/// L. Guibas, "A concise and provably informative multi-scale signature based on heat diffusion",
/// SGP 2009) is that of one short time.
MapFigures CompareBodies(const MatchingBody& on_template, const MatchingBody& on_target,
                         const VertexPairs& pairs);

/// The same for a target that is a part of what the template is, in units of the template's
/// lengths. Curvature and heat near the target's border count nothing.
MapFigures ComparePart(const MatchingBody& on_template, const MatchingBody& on_target,
                       const VertexPairs& pairs);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_COMPARE_BODIES_H_
