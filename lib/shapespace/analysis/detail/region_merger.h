#ifndef SHAPESPACE_ANALYSIS_DETAIL_REGION_MERGER_H_
#define SHAPESPACE_ANALYSIS_DETAIL_REGION_MERGER_H_

// Private. The first stage of FindRigidParts: regions of triangles that share one rigid motion.

#include <vector>

#include <Eigen/Core>

#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/path/path.h>

namespace shapespace::internal {

/// Area-weighted sums over a region's points in the first shape. Together with `MovedSums` they
/// determine the best rigid motion of the region; the sums of two regions, added, determine that of
/// both together.
struct RestSums {
  double area = 0, squares = 0;
  Eigen::Vector3d points = Eigen::Vector3d::Zero();

  void Add(const RestSums& other) {
    area += other.area;
    squares += other.squares;
    points += other.points;
  }
};

/// The same in another shape, with the products p q^T of corresponding points.
struct MovedSums {
  double squares = 0;
  Eigen::Vector3d points = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  void Add(const MovedSums& other) {
    squares += other.squares;
    points += other.points;
    products += other.products;
  }
};

/// The shapes of a path of `num_shapes`, besides the first, that determine which regions are
/// merged.
std::vector<int> DecidingShapes(int num_shapes);

/// Per triangle its mean area in the first and the given shapes, with sum 1. All are positive.
Eigen::VectorXd MeanAreas(const Path& path, const std::vector<int>& shapes);

/// Two adjacent regions.
struct RegionPair {
  int first, second;  // first < second
  double loss;        // negative: not computed yet
};

/// Merges neighbouring regions, beginning with single triangles, as long as a common rigid motion
/// of two is nearly as good as one for each (`FindRigidParts`).
class RegionMerger {
 public:
  RegionMerger(const Path& path, const RigidPartsOptions& options);

  /// Merges regions until no pair fits. Returns the region of each triangle, in 0 .. count - 1.
  std::vector<int> Run(int* count);

 private:
  double Loss(const RegionPair& pair) const;
  bool Fits(const RegionPair& pair) const;
  void MeasureLosses();
  std::vector<int> NearestNeighbours() const;
  void Join(int region, int other);
  std::vector<int> Renumber(const std::vector<int>& target);
  void UpdatePairs(const std::vector<int>& renumbered, const std::vector<bool>& changed);
  bool Pass();

  const RigidPartsOptions options_;
  int shapes_ = 0;
  std::vector<int> region_;  // per triangle
  std::vector<RestSums> rest_;
  std::vector<MovedSums> moved_;  // by region
  std::vector<double> residual_;  // by region
  std::vector<RegionPair> pairs_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_ANALYSIS_DETAIL_REGION_MERGER_H_
