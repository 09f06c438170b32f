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
  /// By how much two solves that round otherwise may differ (`Off`). Those that minimise end when
  /// an iteration hardly lowers the energy, the others when an equation holds to rounding.
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
