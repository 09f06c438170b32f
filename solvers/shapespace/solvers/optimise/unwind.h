#ifndef SHAPESPACE_SOLVERS_OPTIMISE_UNWIND_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_UNWIND_H_

#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// Takes single hinges of a path out of the long way round. Between two poses in which a hinge has
/// nearly the same angle it may still turn by nearly 360 degrees, or wait and then jump, where a
/// guess (lifted, refined in time) put a vertex on the wrong side of its neighbours. No descent
/// leads back from there, since the energy is periodic in the angle: this is what valleys of real
/// poses differ by. The vertices of such a hinge, together and then each on its own, are put where
/// they sit in the first pose, in the last, or between the two, moved rigidly with their
/// neighbours, at all times at once; what costs least is kept.
///
/// `shapes` are in the metric's unit, the ends included, which stay. O(elements) where nothing is
/// wound. Does nothing if the metric does not see hinges.
void Unwind(const Metric& metric, std::vector<Shape>* shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_UNWIND_H_
