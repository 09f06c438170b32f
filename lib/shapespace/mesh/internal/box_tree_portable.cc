#include <shapespace/mesh/internal/box_tree.h>

#include <algorithm>
#include <limits>
#include <vector>

#include <unsupported/Eigen/BVH>

namespace shapespace::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Box = Eigen::AlignedBox<double, 3>;

struct Element {
  int index;
  Box box;
};

Box bounding_box(const Element& element) { return element.box; }  // as Eigen calls it

// Eigen asks for lower bounds of boxes, and opens those first that have the smallest.
struct NearQuery {
  using Scalar = double;
  const Eigen::Vector3d& point;
  double within;
  const std::function<double(int)>& visit;

  // Just below the squared distance, so that also what is equally near is visited.
  double minimumOnVolume(const Box& box) const {
    const double square = box.squaredExteriorDistance(point);
    if (square == 0) return -1;
    return square <= within * within ? square * (1 - 1e-12) : kInfinity;
  }
  double minimumOnObject(const Element& element) {
    if (minimumOnVolume(element.box) == kInfinity) return kInfinity;
    within = std::min(within, visit(element.index));
    return within * within;
  }
};

struct PairsQuery {
  const std::function<void(int, int)>& visit;

  bool intersectVolumeVolume(const Box& a, const Box& b) const { return a.intersects(b); }
  bool intersectVolumeObject(const Box& a, const Element& b) const { return a.intersects(b.box); }
  bool intersectObjectVolume(const Element& a, const Box& b) const { return a.box.intersects(b); }
  bool intersectObjectObject(const Element& a, const Element& b) const {
    if (a.index < b.index && a.box.intersects(b.box)) visit(a.index, b.index);
    return false;
  }
};

}  // namespace

struct BoxTree::Tree {
  Eigen::KdBVH<double, 3, Element> boxes;
};

BoxTree::BoxTree(const Eigen::Matrix3Xd& low, const Eigen::Matrix3Xd& high) {
  // Distances to boxes round; they are smaller by more than that.
  const double margin = 1e-15 * std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  std::vector<Element> elements;
  elements.reserve(low.cols());
  for (int i = 0; i < low.cols(); ++i)
    elements.push_back({i, Box(low.col(i).array() - margin, high.col(i).array() + margin)});
  tree_ = std::make_unique<const Tree>(Tree{{elements.begin(), elements.end()}});
}

BoxTree::~BoxTree() = default;

void BoxTree::VisitNear(const Eigen::Vector3d& point, double within,
                        const std::function<double(int element)>& visit) const {
  NearQuery query{point, within, visit};
  Eigen::BVMinimize(tree_->boxes, query);
}

void BoxTree::VisitPairs(const std::function<void(int first, int second)>& visit) const {
  PairsQuery query{visit};
  Eigen::BVIntersect(tree_->boxes, tree_->boxes, query);
}

}  // namespace shapespace::internal
