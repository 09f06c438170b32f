#ifndef SHAPESPACE_BODIES_BODY_H_
#define SHAPESPACE_BODIES_BODY_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A one-parameter family of shapes of one connectivity, given by formulas, as reference for tests,
/// benchmarks and demonstrations. Lengths have the unit of the arguments from which the body was
/// made.
struct ShapeFamily {
  std::string name;
  std::shared_ptr<const Connectivity> connectivity;

  /// The shape at a parameter value; may be called from several threads at once.
  /// \throw InvalidOptions if the value is not in [begin, end].
  std::function<Shape(double)> pose;

  double begin = 0;  ///< the rest shape
  double end = 0;
  std::string parameter;   ///< meaning and unit of the parameter, e.g. "bend angle, degrees"
  bool isometric = false;  ///< every edge keeps its length along the family
};

/// A body that `MakeBody` can make.
struct BodyInfo {
  std::string name;
  std::string description;    ///< one line
  int default_triangles = 0;  ///< number used by `MakeBody` if none is given
};

/// All bodies by name, in the order for display.
std::vector<BodyInfo> ListBodies();

/// The body `name` in default proportions, with about `triangles` triangles; 0 stands for its
/// default number. A number below a body's smallest mesh gives that mesh; `bricard` always has 8,
/// `steffen` 14, and `quadruped` at most a million. The functions of the other headers of this
/// folder make bodies of any proportions.
/// \throw InvalidOptions if the name is unknown (the message lists the known ones), or the number
///        is negative or above 10 million.
ShapeFamily MakeBody(const std::string& name, int triangles = 0);

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_BODY_H_
