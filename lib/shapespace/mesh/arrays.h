#ifndef SHAPESPACE_MESH_ARRAYS_H_
#define SHAPESPACE_MESH_ARRAYS_H_

#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include <Eigen/Core>

#include <shapespace/base/error.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// Whether each vertex, and each polygon, is a row or a column of its matrix. The storage order of
/// the matrix may be any.
enum class Layout {
  kRows,     ///< a vertex is a row of n x 3, a polygon a row of p x k: libigl, NumPy
  kColumns,  ///< a vertex is a column of 3 x n, a polygon a column of k x p: as in `Shape`
};

/// A mesh from two Eigen matrices of any storage order, including blocks, `Eigen::Ref`, and
/// `Eigen::Map`, which makes a matrix of any array in memory. `vertices` are floating-point
/// numbers; `polygons` are indices of vertices, counted from 0, with k >= 3 corners each. `name` is
/// the name of the mesh in messages. The content is checked when poses are made of it
/// (`MakePoses`).
/// \throw MeshError if a matrix has the wrong size, or an index or a count is outside of the range
///        of int.
template <typename Vertices, typename Polygons>
Soup MakeSoup(const Eigen::DenseBase<Vertices>& vertices,
              const Eigen::DenseBase<Polygons>& polygons, Layout layout,
              const std::string& name = "mesh") {
  static_assert(std::is_floating_point_v<typename Vertices::Scalar>,
                "coordinates are floating-point numbers");
  static_assert(std::is_integral_v<typename Polygons::Scalar>, "indices are integers");
  constexpr int kMax = std::numeric_limits<int>::max();
  const bool rows = layout == Layout::kRows;
  const Eigen::Index num_vertices = rows ? vertices.rows() : vertices.cols();
  const Eigen::Index num_polygons = rows ? polygons.rows() : polygons.cols();
  const Eigen::Index corners = rows ? polygons.cols() : polygons.rows();
  const auto size = [](const auto& matrix) {
    return std::to_string(matrix.rows()) + " x " + std::to_string(matrix.cols());
  };
  if ((rows ? vertices.cols() : vertices.rows()) != 3) {
    throw MeshError(name + ": vertices are a matrix of " + size(vertices) + " numbers, not of " +
                    (rows ? "n x 3" : "3 x n") + "; the other layout?");
  }
  if (num_polygons > 0 && corners < 3) {
    throw MeshError(name + ": polygons are a matrix of " + size(polygons) +
                    " indices, a polygon needs three; the other layout?");
  }
  if (num_vertices > kMax || num_polygons * corners > kMax) {
    throw MeshError(name + ": has more vertices or corners than an int counts");
  }
  Soup soup;
  soup.file = name;
  soup.vertices.resize(3, num_vertices);
  for (Eigen::Index v = 0; v < num_vertices; ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = rows ? vertices.derived()(v, axis) : vertices.derived()(axis, v);
      soup.vertices(axis, v) = static_cast<double>(value);
    }
  }
  soup.corners.reserve(num_polygons * corners);
  for (Eigen::Index p = 0; p < num_polygons; ++p) {
    for (Eigen::Index k = 0; k < corners; ++k) {
      const auto index = rows ? polygons.derived()(p, k) : polygons.derived()(k, p);
      const auto wide = static_cast<std::int64_t>(index);
      if (wide < 0 || wide >= kMax) {
        throw MeshError(name + ": polygon " + std::to_string(p + 1) + " has the index " +
                        std::to_string(index) + " at a corner; it must be from 0 to " +
                        std::to_string(num_vertices - 1));
      }
      soup.corners.push_back(static_cast<int>(wide));
    }
    soup.polygon_begin.push_back(static_cast<int>(soup.corners.size()));
  }
  return soup;
}

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_ARRAYS_H_
