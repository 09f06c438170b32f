#ifndef SHAPESPACE_MESH_DETAIL_ELEMENT_TREE_H_
#define SHAPESPACE_MESH_DETAIL_ELEMENT_TREE_H_

#include <array>
#include <functional>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The triangles of a shape, and its edges that belong to none, in a hierarchy of boxes: finds the
/// nearest of them that is of certain components. Boxes that hold elements of one component only
/// are skipped as a whole, so that a query which leaves out the component that it comes from takes
/// no longer than others. Find() may be called from several threads at once.
class ElementTree {
 public:
  /// `component` is a number per vertex, the same for all corners of an element. `shape` must be
  /// finite and outlive the tree.
  ElementTree(const Connectivity& connectivity, const Shape& shape,
              const std::vector<int>& component);

  struct Nearest {
    std::array<int, 3> corners = {-1, -1, -1};  ///< of the element; an edge's second end twice
    int component = -1;                         ///< -1: none was found
    double distance = std::numeric_limits<double>::infinity();
  };
  /// The nearest element of a component that is admitted, if it is not farther than `within`.
  Nearest Find(const Eigen::Vector3d& point, double within,
               const std::function<bool(int component)>& admits) const;

 private:
  struct Element {
    std::array<int, 3> corners;
    int component;
  };
  struct Node {
    Eigen::Vector3d low, high;
    int begin, end;  // of elements
    int right;       // the second child, behind the first with all that is below that; -1: a leaf
    int component;   // of all elements; -1 if there are several
  };
  void Build(int begin, int end, std::vector<Eigen::Vector3d>* centres, std::vector<int>* order);

  const Shape& shape_;
  std::vector<Element> elements_;
  std::vector<Node> nodes_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_DETAIL_ELEMENT_TREE_H_
