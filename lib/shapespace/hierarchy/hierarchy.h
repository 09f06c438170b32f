#ifndef SHAPESPACE_HIERARCHY_HIERARCHY_H_
#define SHAPESPACE_HIERARCHY_HIERARCHY_H_

#include <memory>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

struct HierarchyOptions {
  /// Approximate number of triangles of the coarsest level; it has more if the topology, a boundary
  /// or the poses do not permit so few. A mesh with less than twice this number has one level.
  int coarsest = 200;
  /// Vertices that every level keeps, such as handles and markers.
  std::vector<int> pinned;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// One mesh at several resolutions, for several poses at once (Kilian et al. 2007, section 3). Each
/// level has about a quarter of the next finer one's triangles, and its vertices are a subset of
/// that level's. Restriction therefore selects vertices, and lifting adds the others with the
/// detail of a known shape. Immutable.
class Hierarchy {
 public:
  /// Built once for all `poses` (3 x m each) that are used. Edges that are not sides of triangles
  /// follow their end vertices. Twins (Connectivity) are on the finest level only. A graph has one
  /// level. O(m log m).
  /// \throw InvalidOptions, MeshError (no pose, or one with the wrong number of vertices),
  ///        Cancelled.
  Hierarchy(const std::shared_ptr<const Connectivity>& connectivity,
            const std::vector<Shape>& poses, const HierarchyOptions& options = {},
            Progress* progress = nullptr);

  /// Level 0 is the coarsest, NumLevels() - 1 the mesh itself.
  int NumLevels() const { return static_cast<int>(levels_.size()); }
  const std::shared_ptr<const Connectivity>& LevelConnectivity(int level) const {
    return levels_[level].connectivity;
  }
  /// For each vertex of `level`, its index in the mesh itself.
  const std::vector<int>& Vertices(int level) const { return levels_[level].vertices; }
  /// True if no collapse was possible before the coarsest level had the requested number of
  /// triangles.
  bool StoppedEarly() const { return stopped_early_; }

  /// Restricts a shape of the mesh itself to `level`.
  Shape Restrict(const Shape& shape, int level) const;
  /// Restricts a shape of `level` to the next coarser level.
  Shape RestrictOnce(const Shape& shape, int level) const;

  /// Restricts a field of positive numbers, one per vertex of the mesh itself, to `level`: the
  /// geometric mean over the vertices that have collapsed to each vertex of `level`.
  Eigen::VectorXd RestrictField(const Eigen::VectorXd& field, int level) const;

  /// Lifts `coarse`, a shape of `level`, to `level` + 1. The detail is that of `from` relative to
  /// `from_base` and of `to` relative to `to_base`, blended by (1 - t, t), rotated with the
  /// neighbourhoods that carry it. Exact if `coarse` is `from_base` and t is 0, or `to_base` and t
  /// is 1.
  Shape Lift(const Shape& coarse, int level, const Shape& from_base, const Shape& from,
             const Shape& to_base, const Shape& to, double t) const;
  /// The same with the restrictions of `from` and `to` as bases: vertices of `level` are those of
  /// `coarse`.
  Shape Lift(const Shape& coarse, int level, const Shape& from, const Shape& to, double t) const {
    return Lift(coarse, level, RestrictOnce(from, level + 1), from, RestrictOnce(to, level + 1), to,
                t);
  }

  /// For each vertex of `level` + 1, the deformation gradient (rotation and stretch) of the
  /// neighbourhood that carries it, from `base` to `coarse`, which are shapes of `level`.
  std::vector<Eigen::Matrix3d> LiftGradients(const Shape& coarse, int level,
                                             const Shape& base) const;

 private:
  struct Level {
    std::shared_ptr<const Connectivity> connectivity;
    std::vector<int> vertices;  // indices in the mesh itself
    std::vector<int> kept;      // per vertex, its index in the next finer level
    // Per vertex of the next finer level, the triangle of this one that carries it, and its
    // barycentric coordinates there.
    Eigen::Matrix3Xi carrier;
    Eigen::Matrix3Xd weights;
  };
  std::vector<Level> levels_;
  bool stopped_early_ = false;
};

}  // namespace shapespace

#endif  // SHAPESPACE_HIERARCHY_HIERARCHY_H_
