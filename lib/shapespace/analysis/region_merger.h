#ifndef SHAPESPACE_ANALYSIS_REGION_MERGER_H_
#define SHAPESPACE_ANALYSIS_REGION_MERGER_H_

// Private. The first stage of FindRigidParts: regions of triangles that share one rigid motion.

#include <vector>

#include <Eigen/Core>

#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/path/path.h>

namespace shapespace::internal {

/// Sums over the points of a region in the first shape, each weighted by its area. With those of
/// `MovedSums` they determine the best rigid motion of the region; adding the sums of two regions
/// gives those of both together.
struct RestSums {
  double area = 0, squares = 0;
  Eigen::Vector3d points = Eigen::Vector3d::Zero();

  void Add(const RestSums& other) {
    area += other.area;
    squares += other.squares;
    points += other.points;
  }
};

/// The same in another shape, with the products of corresponding points p q^T.
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

/// The shapes of a path of `num_shapes`, besides the first, by which regions are joined.
std::vector<int> DecidingShapes(int num_shapes);

/// Per triangle its mean area in the first and the given shapes, of sum 1. All are positive.
Eigen::VectorXd MeanAreas(const Path& path, const std::vector<int>& shapes);

/// Two regions with a border.
struct RegionPair {
  int first, second;  // first < second
  double loss;        // negative: not known
};

/// Joins neighbouring regions, which begin as single triangles, as long as the rigid motion common
/// to two of them is nearly as good as one for each (`FindRigidParts`).
class RegionMerger {
 public:
  RegionMerger(const Path& path, const RigidPartsOptions& options);

  /// Joins regions until no two fit. Returns per triangle its region, in 0 .. count - 1.
  std::vector<int> Run(int* count);

 private:
  double Loss(const RegionPair& pair) const;
  bool Fits(const RegionPair& pair) const;
  bool Pass();

  const RigidPartsOptions options_;
  int shapes_ = 0;
  std::vector<int> region_;  // of each triangle
  std::vector<RestSums> rest_;
  std::vector<MovedSums> moved_;  // region by region
  std::vector<double> residual_;  // likewise
  std::vector<RegionPair> pairs_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_ANALYSIS_REGION_MERGER_H_
