#include <shapespace/analysis/rigid_parts.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/Geometry>

#include <shapespace/analysis/detail/region_merger.h>
#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/rigid_motion.h>

namespace shapespace {
namespace {

// A region whose own deviation from rigid motion exceeds this share of the tolerance is a slice of
// a region that bends throughout. On real paths bones have 0.05 to 0.55, slices 0.6 and more.
constexpr double kOwnShare = 0.6;

// The rigid motion of a region from the first shape to another one, and its errors.
struct RegionFit {
  Eigen::Matrix3d rotation;
  double squared_residual = 0;        // integrated over the area
  double squared_edge_deviation = 0;  // area-weighted mean over the edges
};

// Fits the regions of one shape; triangles in region -1 are not counted.
std::vector<RegionFit> FitRegions(const Path& path, int i, const Eigen::VectorXd& area,
                                  const std::vector<int>& region, int count) {
  const Eigen::Matrix3Xi& triangles = path.metric->connectivity->Triangles();
  const Shape &first = path.shapes[0], &shape = path.shapes[i];
  std::vector<internal::RestSums> rest(count);
  std::vector<internal::MovedSums> moved(count);
  std::vector<double> squares(count, 0), weights(count, 0);
  const auto each_corner = [&](auto&& use) {
    for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
      if (region[f] < 0) continue;
      for (int c = 0; c < 3; ++c) {
        use(region[f], area(f) / 3, triangles(c, f), triangles((c + 1) % 3, f));
      }
    }
  };
  each_corner([&](int r, double share, int v, int next) {
    const Eigen::Vector3d p = first.col(v), q = shape.col(v);
    rest[r].area += share;
    rest[r].points += share * p;
    moved[r].points += share * q;
    moved[r].products += share * p * q.transpose();
    const double length = (first.col(next) - p).norm();
    if (length == 0) return;
    const double ratio = (shape.col(next) - q).norm() / length;
    squares[r] += share * (ratio - 1) * (ratio - 1);
    weights[r] += share;
  });
  std::vector<RegionFit> fits(count);
  for (int r = 0; r < count; ++r) {
    fits[r].rotation = ProcrustesRotation(
        moved[r].products - rest[r].points * moved[r].points.transpose() / rest[r].area);
    if (weights[r] > 0) fits[r].squared_edge_deviation = squares[r] / weights[r];
  }
  each_corner([&](int r, double share, int v, int) {
    const Eigen::Vector3d p = first.col(v) - rest[r].points / rest[r].area;
    const Eigen::Vector3d q = shape.col(v) - moved[r].points / rest[r].area;
    fits[r].squared_residual += share * (fits[r].rotation * p - q).squaredNorm();
  });
  return fits;
}

double DegreesBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(a * b.transpose())).angle() * internal::kDegrees;
}

// Per vertex the first part among those of its triangles.
Eigen::VectorXi PartsOfVertices(const Connectivity& connectivity,
                                const Eigen::VectorXi& of_triangle) {
  Eigen::VectorXi result =
      Eigen::VectorXi::Constant(connectivity.NumVertices(), RigidParts::kJoint);
  for (Eigen::Index f = 0; f < of_triangle.size(); ++f) {
    if (of_triangle(f) == RigidParts::kJoint) continue;
    for (const int v : connectivity.Triangles().col(f)) {
      if (result(v) == RigidParts::kJoint || of_triangle(f) < result(v)) {
        result(v) = of_triangle(f);
      }
    }
  }
  connectivity.CopyToTwins(&result);
  return result;
}

// Regions of triangles that are large enough, in order of descending area.
struct Regions {
  std::vector<int> of_triangle;  // -1 if the triangle's region is too small
  std::vector<double> area;
};

Regions LargeRegions(internal::RegionMerger merger, const Eigen::VectorXd& area,
                     double least_share) {
  Regions result;
  int count = 0;
  result.of_triangle = merger.Run(&count);
  std::vector<double> region_area(count, 0);
  for (size_t f = 0; f < result.of_triangle.size(); ++f) {
    region_area[result.of_triangle[f]] += area(f);
  }
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return region_area[a] > region_area[b]; });
  std::vector<int> rank(count, -1);
  for (const int region : order) {
    if (region_area[region] < least_share) break;
    rank[region] = static_cast<int>(result.area.size());
    result.area.push_back(region_area[region]);
  }
  for (int& region : result.of_triangle) region = rank[region];
  return result;
}

// Whether a region of this area is rigid, according to its fits in all shapes.
bool IsRigid(const std::vector<std::vector<RegionFit>>& fits, int region, double area,
             const RigidPartsOptions& options) {
  double deviation = 0, residual = 0;
  for (size_t i = 1; i < fits.size(); ++i) {
    deviation = std::max(deviation, std::sqrt(fits[i][region].squared_edge_deviation));
    residual = std::max(residual, std::sqrt(fits[i][region].squared_residual));
  }
  // Square root of (residual per area) as a share of the square root of the area.
  return residual <= kOwnShare * options.tolerance * area && !(deviation > options.most_deviation);
}

// All fields except those set by `CountAndPlaceParts`; rotations are relative to the region
// `largest`.
RigidPart DescribePart(const std::vector<std::vector<RegionFit>>& fits, int region, int largest,
                       double area, double unit) {
  RigidPart part;
  part.area_share = area;
  const double moved_shapes = std::max<double>(1, static_cast<double>(fits.size()) - 1);
  double residual = 0, deviation = 0;
  for (size_t i = 1; i < fits.size(); ++i) {
    residual += fits[i][region].squared_residual / moved_shapes;
    deviation += fits[i][region].squared_edge_deviation / moved_shapes;
    part.turn =
        std::max(part.turn, DegreesBetween(fits[i][region].rotation, fits[i][largest].rotation));
  }
  const double distance = std::sqrt(residual / area);
  part.residual = distance * unit;
  part.relative_residual = distance / std::sqrt(area);
  part.edge_deviation = std::sqrt(deviation);
  return part;
}

void CountAndPlaceParts(const Path& path, const Eigen::VectorXd& area, RigidParts* result) {
  const Eigen::Matrix3Xi& triangles = path.metric->connectivity->Triangles();
  const Shape first = path.Placed(0);
  std::vector<Eigen::Vector3d> sums(result->parts.size(), Eigen::Vector3d::Zero());
  for (int f = 0; f < triangles.cols(); ++f) {
    const int part = result->of_triangle(f);
    if (part == RigidParts::kJoint) continue;
    ++result->parts[part].num_triangles;
    for (const int v : triangles.col(f)) sums[part] += area(f) / 3 * first.col(v);
  }
  for (size_t part = 0; part < sums.size(); ++part) {
    result->parts[part].centre = sums[part] / result->parts[part].area_share;
  }
  for (const int part : result->of_vertex) {
    if (part != RigidParts::kJoint) ++result->parts[part].num_vertices;
  }
}

}  // namespace

void RigidPartsOptions::Validate() const {
  if (!(tolerance > 0 && tolerance <= 1)) throw InvalidOptions("tolerance", "must be in (0, 1]");
  if (!(least_share > 0 && least_share <= 1)) {
    throw InvalidOptions("least_share", "must be in (0, 1]");
  }
  if (!(most_deviation > 0)) throw InvalidOptions("most_deviation", "must be positive");
}

RigidParts FindRigidParts(const Path& path, const RigidPartsOptions& options) {
  options.Validate();
  const Connectivity& connectivity = *path.metric->connectivity;
  const int num_triangles = connectivity.NumTriangles();
  RigidParts result;
  result.of_triangle = Eigen::VectorXi::Constant(num_triangles, RigidParts::kJoint);
  result.of_vertex = PartsOfVertices(connectivity, result.of_triangle);
  if (num_triangles == 0) return result;

  const Eigen::VectorXd area =
      internal::MeanAreas(path, internal::DecidingShapes(path.NumShapes()));
  const Regions regions =
      LargeRegions(internal::RegionMerger(path, options), area, options.least_share);
  const int large = static_cast<int>(regions.area.size());
  std::vector<std::vector<RegionFit>> fits(path.NumShapes());
  ParallelFor(path.NumShapes(), [&](int i) {
    if (i > 0) fits[i] = FitRegions(path, i, area, regions.of_triangle, large);
  });
  std::vector<int> part_of(large, RigidParts::kJoint);
  std::vector<int> region_of;
  for (int r = 0; r < large; ++r) {
    if (!IsRigid(fits, r, regions.area[r], options)) continue;
    part_of[r] = static_cast<int>(region_of.size());
    region_of.push_back(r);
  }
  for (int f = 0; f < num_triangles; ++f) {
    const int region = regions.of_triangle[f];
    if (region >= 0) result.of_triangle(f) = part_of[region];
  }
  result.of_vertex = PartsOfVertices(connectivity, result.of_triangle);
  double rigid = 0;
  for (const int r : region_of) {
    result.parts.push_back(DescribePart(fits, r, region_of[0], regions.area[r], path.metric->unit));
    rigid += regions.area[r];
  }
  result.joint_share = std::max(0.0, 1 - rigid);
  CountAndPlaceParts(path, area, &result);
  return result;
}

}  // namespace shapespace
