#ifndef SHAPESPACE_MESH_INTERNAL_BOX_TREE_H_
#define SHAPESPACE_MESH_INTERNAL_BOX_TREE_H_

#include <functional>
#include <memory>

#include <Eigen/Core>

namespace shapespace::internal {

/// Boxes of elements in a hierarchy, by which those near a point and those near each other are
/// found: by Embree, or, where the library is built without it (SHAPESPACE_PORTABLE), by Eigen.
/// Queries may be made from several threads at once.
class BoxTree {
 public:
  /// Column i of `low` and of `high` (3 x elements, finite) are opposite corners of element i's
  /// box. There is at least one, and not all lie in one point.
  /// \throw Error if Embree cannot start or memory ends.
  BoxTree(const Eigen::Matrix3Xd& low, const Eigen::Matrix3Xd& high);
  ~BoxTree();

  /// Calls `visit(element)` for elements whose boxes are not farther from `point` than `within`,
  /// and maybe for others, in any order. `visit` returns the distance that counts from then on.
  void VisitNear(const Eigen::Vector3d& point, double within,
                 const std::function<double(int element)>& visit) const;

  /// Calls `visit(first, second)`, first < second, for all pairs of elements whose boxes
  /// intersect, and maybe for others; in any order, on several threads.
  void VisitPairs(const std::function<void(int first, int second)>& visit) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_BOX_TREE_H_
