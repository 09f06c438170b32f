#ifndef SHAPESPACE_BENCHMARKS_QUADRUPED_H_
#define SHAPESPACE_BENCHMARKS_QUADRUPED_H_

#include <map>

#include <shapespace/bodies/quadruped.h>

namespace shapespace {

/// MakeQuadruped, called once per number of triangles: google-benchmark calls a function several
/// times, and making a body may take longer than the measured operation.
inline const SkinnedBody& Quadruped(int triangles) {
  static std::map<int, SkinnedBody> bodies;
  const auto found = bodies.find(triangles);
  if (found != bodies.end()) return found->second;
  return bodies.emplace(triangles, MakeQuadruped(triangles)).first->second;
}

}  // namespace shapespace

#endif  // SHAPESPACE_BENCHMARKS_QUADRUPED_H_
