#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_UNFOLD_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_UNFOLD_H_

#include <vector>

#include <shapespace/solvers/correspondence/closest.h>

// Private.

namespace shapespace::internal {

/// Which triangles point against the target: their normal against the sum of those of the target's
/// triangles on which their corners lie.
std::vector<bool> TurnedTriangles(const Level& level, const Shape& shape, const Target& target,
                                  const std::vector<Foot>& feet);

/// The points of the target that belong to the vertices of `shape`: by normal and by distance from
/// the markers where there is one, else by distance alone, else just the nearest.
std::vector<Foot> MapVertices(const Level& level, const Shape& shape, const Target& target);

/// Takes out folds: around triangles that point against the target, vertices (but `held` ones) move
/// to a mean of their neighbours, as in W. Tutte's embedding ("How to draw a graph", 1963), and
/// back onto the target. Patches grow ring by ring until that helps, a few times over; one that it
/// does not help is left as it was. What a template has and the target has not, as the inside of a
/// mouth, ends flat.
void Unfold(const Level& level, const Shape& rest, const Target& target,
            const std::vector<int>& held, Shape* shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_UNFOLD_H_
