#ifndef SHAPESPACE_GEODESIC_DETAIL_THIN_VERTICES_H_
#define SHAPESPACE_GEODESIC_DETAIL_THIN_VERTICES_H_

#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The vertices that make triangles thin, and how they lie relative to the rest of the surface. A
/// guess that is good everywhere else may have such a vertex beside its place by many times the
/// triangle's height, from which no solve returns; placed relative to its neighbours as in the
/// poses, it costs nothing.
class ThinVertices {
 public:
  /// A vertex belongs to these if it is the tip of a cap, or an end of the short side of a needle,
  /// in one of the `poses`, and has three neighbours that are a healthy triangle in all of them.
  ThinVertices(const Connectivity& connectivity, const std::vector<Shape>& poses);

  bool Empty() const { return carried_.empty(); }

  /// A vertex that has no place of its own, because the triangles at it are too thin to be measured
  /// in any pose: it moves with three others.
  struct Tied {
    int vertex, corners[3];
    Eigen::Vector3d weights;  ///< of the corners, with sum 1
  };
  bool AnyTied() const { return any_tied_; }
  /// These, where `to` has the share t, each after those of its corners that are tied too.
  std::vector<Tied> TiedAt(const Shape& from, const Shape& to, double t) const;

  /// Moves these vertices of `shape` to where they are relative to their three neighbours: in
  /// `from` and `to`, blended by (1 - t, t).
  void Place(const Shape& from, const Shape& to, double t, Shape* shape) const;

 private:
  struct Carried {
    int vertex, corners[3];
    bool is_tied;
  };
  bool any_tied_ = false;
  std::vector<Carried> carried_;  // each after those that its corners need
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_THIN_VERTICES_H_
