#ifndef SHAPESPACE_TESTS_SUPPORT_STIFFENED_H_
#define SHAPESPACE_TESTS_SUPPORT_STIFFENED_H_

#include <utility>
#include <vector>

#include <shapespace/bodies/body.h>

namespace shapespace::testing {

/// The body with a few inner edges that are not sides of triangles.
inline ShapeFamily Stiffened(ShapeFamily body) {
  const Connectivity& surface = *body.connectivity;
  std::vector<int> begin, corners;
  for (const auto& triangle : surface.Triangles().colwise()) {
    begin.push_back(static_cast<int>(corners.size()));
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  begin.push_back(static_cast<int>(corners.size()));
  std::vector<std::pair<int, int>> stiffeners;
  for (int v = 0; v < 5; ++v) stiffeners.emplace_back(v, surface.NumVertices() - 1 - v);
  body.connectivity = Connectivity::Make(surface.NumVertices(), begin, corners, {}, stiffeners);
  return body;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_STIFFENED_H_
