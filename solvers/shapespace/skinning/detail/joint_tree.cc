#include <shapespace/skinning/detail/joint_tree.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

namespace shapespace::internal {
namespace {

// As a share of the trace of the equations for a pivot: makes them regular where motions are exact
// hinges. Far above rounding errors, and far below what a motion by any other axis adds.
constexpr double kHinge = 1e-9;

// What two bones have in common: sums over points of products of their weights.
struct Shared {
  double weight = 0;
  Eigen::Vector3d positions = Eigen::Vector3d::Zero();
  double squares = 0;  // of the positions' norms

  void Add(double product, const Eigen::Vector3d& position) {
    weight += product;
    positions += product * position;
    squares += product * position.squaredNorm();
  }
};

// For each two bones, at b * count + c and c * count + b.
std::vector<Shared> SharedByBones(const MovingPoints& points, const VertexWeights& weights,
                                  int count) {
  std::vector<Shared> shared(static_cast<size_t>(count) * count);
  const Eigen::Index most = weights.weights.rows();
  for (int p = 0; p < points.NumPoints(); ++p) {
    for (Eigen::Index k = 0; k < most; ++k) {
      for (Eigen::Index l = 0; l < most; ++l) {
        const double product = weights.weights(k, p) * weights.weights(l, p);
        if (k == l || !(product > 0)) continue;
        shared[weights.bones(k, p) * count + weights.bones(l, p)].Add(product, points.Rest(p));
      }
    }
  }
  return shared;
}

// A spanning tree from its root on: bones in the order in which they joined it, and the parent of
// each.
struct BoneTree {
  std::vector<int> order, parent;
};

// The tree with the greatest `closeness` of neighbours, grown from `root` (R. C. Prim 1957).
template <typename Closeness>
BoneTree SpanningTree(int count, int root, const Closeness& closeness) {
  BoneTree tree{{root}, std::vector<int>(count, -1)};
  std::vector<char> is_in(count, 0);
  is_in[root] = 1;
  while (static_cast<int>(tree.order.size()) < count) {
    int best = -1, parent = -1;
    for (int b = 0; b < count; ++b) {
      if (is_in[b]) continue;
      for (const int c : tree.order) {
        if (best >= 0 && !(closeness(b, c) > closeness(best, parent))) continue;
        best = b;
        parent = c;
      }
    }
    is_in[best] = 1;
    tree.parent[best] = parent;
    tree.order.push_back(best);
  }
  return tree;
}

// The bone without which the tree falls into the smallest parts: in the middle of the body, however
// finely the mesh resolves its head or hands.
int MiddleOfTree(const BoneTree& tree) {
  const int count = static_cast<int>(tree.order.size());
  // Bones behind each, itself included, and the most of them behind one child.
  std::vector<int> behind(count, 1), most(count, 0);
  for (int i = count - 1; i > 0; --i) {
    const int bone = tree.order[i], parent = tree.parent[bone];
    behind[parent] += behind[bone];
    most[parent] = std::max(most[parent], behind[bone]);
  }
  int middle = tree.order[0];
  const auto greatest_part = [&](int bone) { return std::max(most[bone], count - behind[bone]); };
  for (const int bone : tree.order) {
    if (greatest_part(bone) < greatest_part(middle)) middle = bone;
  }
  return middle;
}

// The pivot of a joint; `shared` is what its bone has in common with the parent's.
Eigen::Vector3d PivotBetween(const Bones& bones, const Shared& shared, int bone, int parent,
                             double error) {
  Eigen::Vector3d expected = (bones.joints[bone].pivot + bones.joints[parent].pivot) / 2;
  double spread = (bones.joints[bone].pivot - expected).squaredNorm();
  if (shared.weight > 0) {
    expected = shared.positions / shared.weight;
    spread = std::max(0.0, shared.squares / shared.weight - expected.squaredNorm());
  }
  // Of the point at `expected` + x, the sum of squared distances between its two places is
  // x^T matrix x - 2 right^T x + square.
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double square = 0;
  for (int i = 0; i < bones.shapes; ++i) {
    const Eigen::Matrix<double, 3, 4> relative =
        bones.matrices.block<3, 4>(3 * i, 4 * bone) - bones.matrices.block<3, 4>(3 * i, 4 * parent);
    const Eigen::Vector3d apart = relative * expected.homogeneous();
    matrix += relative.leftCols<3>().transpose() * relative.leftCols<3>();
    right -= relative.leftCols<3>().transpose() * apart;
    square += apart.squaredNorm();
  }
  const double hinge = kHinge * matrix.trace();
  if (!(hinge > 0)) return expected;
  matrix.diagonal().array() += hinge;
  // How far the best point is from being at rest, and the accuracy of vertices, say how much the
  // motions can be trusted.
  const double left = std::max(0.0, square - right.dot(matrix.ldlt().solve(right)));
  if (spread > 0) {
    matrix.diagonal().array() += (left + bones.shapes * error * error) / spread;
  }
  return expected + matrix.ldlt().solve(right);
}

void OrderWeights(const std::vector<int>& number, VertexWeights* weights) {
  const Eigen::Index most = weights->weights.rows();
  std::vector<std::pair<double, int>> entries(most);
  for (Eigen::Index p = 0; p < weights->weights.cols(); ++p) {
    for (Eigen::Index k = 0; k < most; ++k) {
      const double weight = weights->weights(k, p);
      entries[k] = {-weight, weight > 0 ? number[weights->bones(k, p)] : 0};
    }
    std::sort(entries.begin(), entries.end());
    for (Eigen::Index k = 0; k < most; ++k) {
      weights->weights(k, p) = -entries[k].first;
      weights->bones(k, p) = entries[k].second;
    }
  }
}

}  // namespace

void MakeSkeleton(const MovingPoints& points, double error, Bones* bones, VertexWeights* weights) {
  const int count = bones->Count();
  const std::vector<Shared> shared = SharedByBones(points, *weights, count);
  // Shared weight counts first, then nearness.
  const auto closeness = [&](int b, int c) {
    return std::make_pair(shared[b * count + c].weight,
                          -(bones->joints[b].pivot - bones->joints[c].pivot).squaredNorm());
  };
  const BoneTree tree =
      SpanningTree(count, MiddleOfTree(SpanningTree(count, 0, closeness)), closeness);
  std::vector<Eigen::Vector3d> pivots;
  for (const int bone : tree.order) {
    const int parent = tree.parent[bone];
    pivots.push_back(
        parent < 0 ? bones->joints[bone].pivot
                   : PivotBetween(*bones, shared[bone * count + parent], bone, parent, error));
  }
  std::vector<int> number(count);
  for (int i = 0; i < count; ++i) number[tree.order[i]] = i;
  bones->Select(tree.order);
  for (int i = 0; i < count; ++i) {
    const int parent = tree.parent[tree.order[i]];
    bones->joints[i].parent = parent < 0 ? -1 : number[parent];
    MovePivot(pivots[i], i, points.rest, bones);
  }
  OrderWeights(number, weights);
}

}  // namespace shapespace::internal
