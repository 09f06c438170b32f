#ifndef SHAPESPACE_TESTS_SUPPORT_WHISKERED_H_
#define SHAPESPACE_TESTS_SUPPORT_WHISKERED_H_

#include <memory>
#include <utility>
#include <vector>

#include <shapespace/bodies/bar.h>

namespace shapespace::testing {

/// A bar along x with a whisker: a chain of segments that begins at a vertex of the bar's end x > 0
/// and has no triangle.
struct WhiskeredBar {
  static constexpr int kSegments = 5;
  static constexpr double kLength = 0.3;  ///< of a segment

  /// In nx x ny x ny cells.
  WhiskeredBar(int nx, int ny) : body(MakeBar(4, 1, 1, nx, ny, ny)) {
    const Connectivity& surface = *body.connectivity;
    first = surface.NumVertices();
    body.pose(0).row(0).maxCoeff(&root);
    std::vector<int> begin, corners;
    for (const auto& triangle : surface.Triangles().colwise()) {
      begin.push_back(static_cast<int>(corners.size()));
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    begin.push_back(static_cast<int>(corners.size()));
    std::vector<std::pair<int, int>> segments = {{root, first}};
    for (int k = 1; k < kSegments; ++k) segments.emplace_back(first + k - 1, first + k);
    connectivity = Connectivity::Make(first + kSegments, begin, corners, segments);
  }

  /// The bar bent by `bend` degrees, with the whisker straight along `direction`, of length 1.
  Shape Pose(double bend, const Eigen::Vector3d& direction) const {
    Shape pose(3, first + kSegments);
    pose.leftCols(first) = body.pose(bend);
    for (int k = 0; k < kSegments; ++k) {
      pose.col(first + k) = pose.col(root) + (k + 1) * kLength * direction;
    }
    return pose;
  }

  /// Lengths of the whisker's segments in a shape.
  Eigen::VectorXd Lengths(const Shape& shape) const {
    Eigen::VectorXd lengths(kSegments);
    for (int k = 0; k < kSegments; ++k) {
      lengths(k) = (shape.col(first + k) - shape.col(k > 0 ? first + k - 1 : root)).norm();
    }
    return lengths;
  }

  ShapeFamily body;
  Eigen::Index root = 0;  ///< the bar's vertex at which the whisker begins
  int first = 0;          ///< the whisker's first vertex; the others follow it
  std::shared_ptr<const Connectivity> connectivity;
};

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_WHISKERED_H_
