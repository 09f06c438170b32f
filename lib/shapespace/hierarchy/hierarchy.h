#ifndef SHAPESPACE_HIERARCHY_HIERARCHY_H_
#define SHAPESPACE_HIERARCHY_HIERARCHY_H_

#include <memory>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

struct HierarchyOptions {
  /// Triangles of the coarsest level, roughly; it has more where the topology, a boundary or the
  /// poses allow no fewer. A mesh of less than twice as many has one level.
  int coarsest = 200;
  /// Vertices that every level keeps: handles, markers.
  std::vector<int> pinned;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// The same mesh at several resolutions, for several poses at once (Kilian et al. 2007, section 3):
/// each level has about a quarter of the next finer one's triangles, and its vertices are some of
/// that level's, so that going down is leaving out. Going up puts what was left out back as it sits
/// in a shape that is known. Immutable.
class Hierarchy {
 public:
  /// Built once for all `poses` (3 x m each) that take part. Edges that are no sides of triangles
  /// go where their ends go. A graph has one level. O(m log m).
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
  /// Of each vertex of `level`, its index in the mesh itself.
  const std::vector<int>& Vertices(int level) const { return levels_[level].vertices; }
  /// True if no legal collapse was left before the coarsest level had as few triangles as asked.
  bool StoppedEarly() const { return stopped_early_; }

  /// A shape of the mesh itself as `level` sees it.
  Shape Restrict(const Shape& shape, int level) const;
  /// A shape of `level` as the next coarser level sees it.
  Shape RestrictOnce(const Shape& shape, int level) const;

  /// A field of positive numbers, one a vertex of the mesh itself, as `level` sees it: the
  /// geometric mean over the vertices that each vertex of `level` stands for.
  Eigen::VectorXd RestrictField(const Eigen::VectorXd& field, int level) const;

  /// A shape of `level` + 1 that sits on `coarse`, a shape of `level`, as `from` sits on
  /// `from_base` and `to` on `to_base`, blended by (1 - t, t): each neighbourhood moves with the
  /// rotation of the vertices that carry it. Exact where `coarse` is `from_base` and t is 0, or
  /// `to_base` and t is 1.
  Shape Lift(const Shape& coarse, int level, const Shape& from_base, const Shape& from,
             const Shape& to_base, const Shape& to, double t) const;
  /// The same for `from` and `to` that sit on their own restrictions: vertices that `level` has are
  /// those of `coarse`.
  Shape Lift(const Shape& coarse, int level, const Shape& from, const Shape& to, double t) const {
    return Lift(coarse, level, RestrictOnce(from, level + 1), from, RestrictOnce(to, level + 1), to,
                t);
  }

  /// Of each vertex of `level` + 1, the linear part of the motion of the neighbourhood that carries
  /// it, from `base` to `coarse`, shapes of `level`: rotation and stretch.
  std::vector<Eigen::Matrix3d> LiftGradients(const Shape& coarse, int level,
                                             const Shape& base) const;

 private:
  struct Level {
    std::shared_ptr<const Connectivity> connectivity;
    std::vector<int> vertices;  // in the mesh itself
    std::vector<int> kept;      // of each vertex, its index in the next finer level
    // Of each vertex of the next finer level, the triangle of this one that carries it, and its
    // place there.
    Eigen::Matrix3Xi carrier;
    Eigen::Matrix3Xd place;
  };
  std::vector<Level> levels_;
  bool stopped_early_ = false;
};

}  // namespace shapespace

#endif  // SHAPESPACE_HIERARCHY_HIERARCHY_H_
