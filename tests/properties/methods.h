#ifndef SHAPESPACE_TESTS_PROPERTIES_METHODS_H_
#define SHAPESPACE_TESTS_PROPERTIES_METHODS_H_

#include <ostream>
#include <vector>

#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/shape.h>

#include "properties/random_body.h"

namespace shapespace::testing {

/// A function of the library, as one of a body and its poses that gives shapes in the user's frame
/// and unit. All solve as accurately as is possible.
struct Method {
  const char* name;
  int poses;  ///< that it needs
  /// By which share of its diameter a shape may be off between two solves that round otherwise.
  /// Solvers end when an iteration hardly lowers the energy, by a share of 1e-10 to 1e-12. Motions
  /// that cost least are determined least: the error is the root of that share over the one that
  /// such a motion has in the metric, which is 1e-4 where only positions have a cost.
  double accuracy;
  /// Whether it determines graphs. Their triangles turn over freely; where handles or other poses
  /// pull at them with far more force than the cost of position, that hardly decides how they do.
  bool takes_graphs;
  std::vector<Shape> (*run)(const RandomBody& body);
};
std::ostream& operator<<(std::ostream& out, const Method& method);

/// Interpolate, Extrapolate (from a shape and a velocity), Transport, Deform, Repair, Transfer,
/// Average and Spline.
const std::vector<Method>& AllMethods();

/// Options of geodesics for this body: so accurate that two solves which round otherwise agree.
GeodesicOptions AccurateGeodesic(const RandomBody& body, int shapes);

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_PROPERTIES_METHODS_H_
