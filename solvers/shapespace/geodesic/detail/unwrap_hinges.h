#ifndef SHAPESPACE_GEODESIC_DETAIL_UNWRAP_HINGES_H_
#define SHAPESPACE_GEODESIC_DETAIL_UNWRAP_HINGES_H_

#include <utility>
#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// Which of the metric's features, and which of its elements.
using FeatureElement = std::pair<int, int>;

/// The share of an element, of a feature that is no sum, in half the energy of a path. `shapes` are
/// in the metric's unit.
double ElementEnergy(const Metric& metric, const FeatureElement& element,
                     const std::vector<Shape>& shapes);

/// Corrects single hinges of a path that turn the wrong way. Between two poses in which a hinge has
/// nearly the same angle it may turn by nearly 360 degrees, or rest and then jump, if the initial
/// guess (lifted, or refined in time) put a vertex on the wrong side of its neighbours. Descent
/// cannot correct this, because the energy is periodic in the angle; it is the main difference
/// between local minima for real poses. The vertices of such a hinge, first together and then each
/// alone, are placed as in the first pose, as in the last, or between the two, moved rigidly with
/// their neighbours, at all times at once; the alternative with the least energy is used.
///
/// `shapes` are in the metric's unit, including the ends, which stay. O(elements) if no hinge needs
/// correction. Does nothing if the metric has no dihedral angles.
void UnwrapHinges(const Metric& metric, std::vector<Shape>* shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_UNWRAP_HINGES_H_
