#include <shapespace/output/internal/view.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

// Height of the part of a shape that touches the floor, as a share of its bounding box's diagonal.
constexpr double kFloorSlab = 0.04;

// Rays per axis for the evaluation of a candidate view.
constexpr int kGrid = 64;

// Weight of back faces relative to front faces, so that a sheet is seen from its front.
constexpr double kBackWorth = 0.6;

// Directions nearer to each other than this (sine of the angle) do not define a picture plane.
constexpr double kParallel = 1e-6;

// A surface is open if the sum of its triangles' areas, as vectors, has at least this share of
// their sum as numbers: 0 for closed surfaces, 1 for a plane.
constexpr double kOpen = 0.1;

// An open surface faces down if its mean direction does so by this much, as a cosine.
constexpr double kDown = 0.5;

// Weight of views in which an open surface shows its inside.
constexpr double kInside = 0.1;

struct Candidate {
  double azimuth, elevation;  // degrees; from the front, positive to the right
  double weight;              // preference
};

// With `from_below`, there are views from below the horizon too.
std::vector<Candidate> Candidates(bool are_horizontal, bool from_below) {
  struct Elevation {
    double degrees, weight;
  };
  // Low views look natural; high ones are for flat shapes.
  const std::vector<Elevation> elevations =
      are_horizontal ? std::vector<Elevation>{{0, 1}}
                     : std::vector<Elevation>{{15, 1}, {35, 0.8}, {60, 0.7}};
  // Seen from the left and the front, a body that faces the front faces right, the direction of
  // reading.
  constexpr struct {
    double degrees, weight;
  } kAzimuths[] = {{-30, 1},    {-60, 1},    {30, 0.88}, {60, 0.88},
                   {-120, 0.8}, {-150, 0.8}, {120, 0.7}, {150, 0.7}};
  std::vector<Candidate> candidates;
  for (const Elevation& elevation : elevations) {
    for (const auto& azimuth : kAzimuths) {
      const double weight = azimuth.weight * elevation.weight;
      candidates.push_back({azimuth.degrees, elevation.degrees, weight});
      if (from_below && !are_horizontal) {
        candidates.push_back({azimuth.degrees, -elevation.degrees, weight});
      }
    }
  }
  return candidates;
}

Eigen::Vector3d CentreOfArea(const Connectivity& connectivity, const Shape& shape) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0;
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
    const Eigen::Vector3d a = shape.col(triangles(0, f)), b = shape.col(triangles(1, f)),
                          c = shape.col(triangles(2, f));
    const double area = TriangleArea(a, b, c);
    sum += area / 3 * (a + b + c);
    total += area;
  }
  return total > 0 ? Eigen::Vector3d(sum / total) : Eigen::Vector3d(shape.rowwise().mean());
}

// The unit vector towards which open surfaces face in the mean; zero if they are closed.
Eigen::Vector3d Outward(const Connectivity& connectivity, const std::vector<Shape>& shapes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0;
  for (const Shape& shape : shapes) {
    for (const auto& corners : connectivity.Triangles().colwise()) {
      const Eigen::Vector3d normal =
          AreaNormal(shape.col(corners[0]), shape.col(corners[1]), shape.col(corners[2]));
      sum += normal;
      total += normal.norm();
    }
  }
  return sum.norm() > kOpen * total ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d::Zero();
}

// Whether the centre of area is above the part that touches a floor perpendicular to `axis`.
bool Stands(const Connectivity& connectivity, const Shape& shape, int axis) {
  const Eigen::Vector3d low = shape.rowwise().minCoeff();
  const double slab = kFloorSlab * (shape.rowwise().maxCoeff() - low).norm();
  Eigen::AlignedBox3d support;
  for (Eigen::Index v = 0; v < shape.cols(); ++v) {
    if (shape(axis, v) <= low[axis] + slab) support.extend(Eigen::Vector3d(shape.col(v)));
  }
  Eigen::Vector3d centre = CentreOfArea(connectivity, shape);
  centre[axis] = low[axis];
  return support.squaredExteriorDistance(centre) <= slab * slab;
}

double VisibleArea(const RayScene& scene, const Axes& axes) {
  const Eigen::Matrix3f a = axes.cast<float>();
  double area = 0;
  RayScene::Hit hit;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const int column = i % kGrid, row = i / kGrid;
    const Eigen::Vector3f position((column + 0.5f) * 2 / kGrid - 1, (row + 0.5f) * 2 / kGrid - 1,
                                   2);
    if (scene.Trace(a * position, -a.col(2), &hit)) area += hit.back ? kBackWorth : 1;
  }
  return area;
}

// Area of the ellipse, up to a constant, of the vertices' projection.
double ProjectedArea(const Eigen::Matrix3d& covariance, const Axes& axes) {
  const Eigen::Matrix2d flat = axes.leftCols<2>().transpose() * covariance * axes.leftCols<2>();
  // A straight line has no area, but should still be judged by what is visible.
  constexpr double kLine = 1e-6;
  return kLine + std::sqrt(std::max(0.0, flat.determinant()));
}

// The horizontal direction that faces the viewer in a front view: +z if y is up (as in glTF), -y if
// z is.
Eigen::Vector3d Front(const Eigen::Vector3d& up) {
  const bool z_up = std::abs(up.z()) > std::abs(up.y());
  const Eigen::Vector3d front(0, z_up ? -1 : 0, z_up ? 0 : 1);
  return (front - front.dot(up) * up).normalized();
}

}  // namespace

bool Parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.stableNormalized().cross(b.stableNormalized()).norm() < kParallel;
}

Eigen::Vector3d ChooseUp(const Connectivity& connectivity, const std::vector<Shape>& shapes) {
  int balance = 0;
  for (const Shape& shape : shapes) {
    balance += Stands(connectivity, shape, 2) - Stands(connectivity, shape, 1);
  }
  Eigen::Vector3d up = Eigen::Vector3d::UnitY(), other = Eigen::Vector3d::UnitZ();
  if (balance > 0) std::swap(up, other);
  const Eigen::Vector3d outward = Outward(connectivity, shapes);
  if (outward.dot(up) < -kDown && std::abs(outward.dot(other)) < kDown) return other;
  return up;
}

Eigen::Vector3d UpBeside(const Eigen::Vector3d& eye, const Eigen::Vector3d& up) {
  return Parallel(eye, up) ? Eigen::Vector3d(0, up.z(), up.y()) : up;
}

Axes LookFrom(const Eigen::Vector3d& eye, const Eigen::Vector3d& up) {
  Axes axes;
  axes.col(2) = eye.stableNormalized();
  axes.col(0) = up.stableNormalized().cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Axes ChooseView(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                const std::vector<RayScene>& scenes, const Eigen::Vector3d& up,
                bool must_be_horizontal) {
  const Eigen::Vector3d pole = up.stableNormalized();
  const Eigen::Vector3d outward = Outward(connectivity, shapes);
  const Axes front = LookFrom(Front(pole), pole);
  const std::vector<Candidate> candidates = Candidates(must_be_horizontal, outward.dot(pole) < 0);
  std::vector<Axes> views(candidates.size());
  std::vector<double> scores(candidates.size(), 0);
  std::vector<Eigen::Matrix3d> covariances;
  for (const Shape& shape : shapes) {
    const Shape centred = shape.colwise() - shape.rowwise().mean();
    covariances.push_back(centred * centred.transpose() / shape.cols());
  }
  ParallelFor(static_cast<int>(candidates.size()), [&](int i) {
    const double azimuth = candidates[i].azimuth * EIGEN_PI / 180;
    const double elevation = candidates[i].elevation * EIGEN_PI / 180;
    views[i] = LookFrom(
        front * Eigen::Vector3d(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                std::cos(elevation) * std::cos(azimuth)),
        pole);
    const double side = views[i].col(2).dot(outward) < 0 ? kInside : 1;
    for (size_t k = 0; k < scenes.size(); ++k) {
      scores[i] += side * candidates[i].weight * VisibleArea(scenes[k], views[i]) *
                   ProjectedArea(covariances[k], views[i]);
    }
  });
  size_t best = 0;
  for (size_t i = 1; i < scores.size(); ++i) {
    if (scores[i] > scores[best]) best = i;
  }
  return views[best];
}

}  // namespace shapespace::internal
