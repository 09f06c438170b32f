#include <shapespace/mesh/internal/polygons.h>

#include <algorithm>
#include <string>

#include <shapespace/base/error.h>

namespace shapespace::internal {

void CheckPolygons(int num_vertices, const std::vector<int>& polygon_begin,
                   const std::vector<int>& corners) {
  if (polygon_begin.empty() || polygon_begin.front() != 0 ||
      polygon_begin.back() != static_cast<int>(corners.size()) ||
      !std::is_sorted(polygon_begin.begin(), polygon_begin.end())) {
    throw MeshError("polygon_begin must rise from 0 to the number of corners");
  }
  for (size_t p = 0; p + 1 < polygon_begin.size(); ++p) {
    const int size = polygon_begin[p + 1] - polygon_begin[p];
    if (size < 3) {
      throw MeshError("polygon " + std::to_string(p) + " has " + std::to_string(size) +
                      " corners; a polygon needs three");
    }
  }
  for (int v : corners) {
    if (v < 0 || v >= num_vertices) {
      throw MeshError("vertex index " + std::to_string(v) + " outside 0 .. " +
                      std::to_string(num_vertices - 1));
    }
  }
}

Eigen::Matrix3Xi Fans(const std::vector<int>& polygon_begin, const std::vector<int>& corners) {
  const size_t num_polygons = polygon_begin.size() - 1;
  Eigen::Matrix3Xi triangles(3, corners.size() - 2 * num_polygons);
  int next = 0;
  for (size_t p = 0; p < num_polygons; ++p) {
    const int* const corner = corners.data() + polygon_begin[p];
    const int size = polygon_begin[p + 1] - polygon_begin[p];
    const int apex = static_cast<int>(std::min_element(corner, corner + size) - corner);
    for (int k = 2; k < size; ++k) {
      triangles.col(next++) << corner[apex], corner[(apex + k - 1) % size],
          corner[(apex + k) % size];
    }
  }
  return triangles;
}

}  // namespace shapespace::internal
