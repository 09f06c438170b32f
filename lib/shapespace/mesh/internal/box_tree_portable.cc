#include <shapespace/mesh/internal/box_tree.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <unsupported/Eigen/BVH>

namespace shapespace::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Box = Eigen::AlignedBox<double, 3>;

// Eigen asks for lower bounds of boxes, and opens those first that have the smallest.
struct NearQuery {
  using Scalar = double;
  const std::vector<Box>& boxes;
  const Eigen::Vector3d& point;
  double within;
  const std::function<double(int)>& visit;

  // Just below the squared distance, which is rounded, so that also what is equally near, or
  // exactly as far as `within`, is visited.
  double minimumOnVolume(const Box& box) const {
    const double square = box.squaredExteriorDistance(point) * (1 - 1e-12);
    if (square == 0) return -1;
    return square <= within * within ? square : kInfinity;
  }
  double minimumOnObject(int element) {
    if (minimumOnVolume(boxes[element]) == kInfinity) return kInfinity;
    within = std::min(within, visit(element));
    return within * within;
  }
};

struct PairsQuery {
  const std::vector<Box>& boxes;
  const std::function<void(int, int)>& visit;

  bool intersectVolumeVolume(const Box& a, const Box& b) const { return a.intersects(b); }
  bool intersectVolumeObject(const Box& a, int b) const { return a.intersects(boxes[b]); }
  bool intersectObjectVolume(int a, const Box& b) const { return b.intersects(boxes[a]); }
  bool intersectObjectObject(int a, int b) const {
    if (a < b && boxes[a].intersects(boxes[b])) visit(a, b);
    return false;
  }
};

}  // namespace

struct BoxTree::Tree {
  std::vector<Box> boxes;  // of the elements
  Eigen::KdBVH<double, 3, int> hierarchy;
};

BoxTree::BoxTree(const Eigen::Matrix3Xd& low, const Eigen::Matrix3Xd& high) {
  // Distances to boxes round; they are smaller by more than that.
  const double margin = 1e-15 * std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  auto tree = std::make_unique<Tree>();
  for (int i = 0; i < low.cols(); ++i) {
    tree->boxes.emplace_back(low.col(i).array() - margin, high.col(i).array() + margin);
  }
  std::vector<int> elements(tree->boxes.size());
  std::iota(elements.begin(), elements.end(), 0);
  tree->hierarchy.init(elements.begin(), elements.end(), tree->boxes.begin(), tree->boxes.end());
  tree_ = std::move(tree);
}

BoxTree::~BoxTree() = default;

void BoxTree::VisitNear(const Eigen::Vector3d& point, double within,
                        const std::function<double(int element)>& visit) const {
  NearQuery query{tree_->boxes, point, within, visit};
  Eigen::BVMinimize(tree_->hierarchy, query);
}

void BoxTree::VisitPairs(const std::function<void(int first, int second)>& visit) const {
  PairsQuery query{tree_->boxes, visit};
  Eigen::BVIntersect(tree_->hierarchy, tree_->hierarchy, query);
}

}  // namespace shapespace::internal
