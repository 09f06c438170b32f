#include <shapespace/geodesic/detail/thin_vertices.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

// The quality of a triangle, 4 sqrt(3) area / sum of squared sides, is 1 if it is equilateral.
// Below this a triangle is thin: a cap whose height is about a hundredth of its base. Of healthy
// scans one triangle in a thousand is.
constexpr double kThin = 0.03;
// Below this in all poses a triangle is too thin to be measured: where bodies turn, coordinates in
// double precision, and steps in single precision, change its angles by more than the solve does.
constexpr double kUnmeasured = 1e-5;
// Three neighbours carry a vertex only if they are a triangle at least this good in all poses,
// where a vertex far outside of it counts less.
constexpr double kHealthy = 0.1;
// Vertices with more neighbours are left alone, since every three of these are tried.
constexpr int kMostNeighbours = 16;

double Quality(const Shape& pose, int a, int b, int c) {
  const Eigen::Vector3d x = pose.col(b) - pose.col(a), y = pose.col(c) - pose.col(a);
  const double sides = x.squaredNorm() + y.squaredNorm() + (y - x).squaredNorm();
  return sides > 0 ? 2 * std::sqrt(3.0) * x.cross(y).norm() / sides : 0;
}

double LeastQuality(const std::vector<Shape>& poses, int a, int b, int c) {
  double least = 1;
  for (const Shape& pose : poses) least = std::min(least, Quality(pose, a, b, c));
  return least;
}

// Of a thin triangle the corner opposite to the longest side: the tip of a cap, or an end of a
// needle's short side.
int Tip(const Shape& pose, const Eigen::Vector3i& triangle) {
  double squared[3];  // of the side opposite to each corner
  for (int k = 0; k < 3; ++k) {
    squared[k] = (pose.col(triangle((k + 2) % 3)) - pose.col(triangle((k + 1) % 3))).squaredNorm();
  }
  return triangle(static_cast<int>(std::max_element(squared, squared + 3) - squared));
}

// Where a point is relative to a triangle: barycentric coordinates of its foot, and its height over
// the plane in units of the root of the triangle's area.
Eigen::Vector4d Coordinates(const Shape& shape, const int* corners, int vertex) {
  const Eigen::Vector3d a = shape.col(corners[0]), x = shape.col(corners[1]) - a,
                        y = shape.col(corners[2]) - a, p = shape.col(vertex) - a;
  const Eigen::Vector3d normal = x.cross(y);
  const double squared = normal.squaredNorm();
  const double second = p.cross(y).dot(normal) / squared, third = x.cross(p).dot(normal) / squared;
  return {1 - second - third, second, third, p.dot(normal) / std::pow(squared, 0.75)};
}

Eigen::Vector4d Blended(const Shape& from, const Shape& to, double t, const int* corners,
                        int vertex) {
  return (1 - t) * Coordinates(from, corners, vertex) + t * Coordinates(to, corners, vertex);
}

Eigen::Vector3d At(const Shape& shape, const int* corners, const Eigen::Vector4d& place) {
  const Eigen::Vector3d a = shape.col(corners[0]), b = shape.col(corners[1]),
                        c = shape.col(corners[2]);
  const Eigen::Vector3d normal = AreaNormal(a, b, c);
  return place(0) * a + place(1) * b + place(2) * c +
         place(3) / std::sqrt(std::max(normal.norm(), 1e-300)) * normal;
}

// How well the three corners carry the vertex in all poses, at most 1.
double Support(const std::vector<Shape>& poses, const int* corners, int vertex) {
  double support = LeastQuality(poses, corners[0], corners[1], corners[2]);
  if (support < kHealthy) return 0;
  for (const Shape& pose : poses) {
    const Eigen::Vector4d place = Coordinates(pose, corners, vertex);
    support = std::min(support, 1 / place.cwiseAbs().sum());
  }
  return support;
}

}  // namespace

ThinVertices::ThinVertices(const Connectivity& connectivity, const std::vector<Shape>& poses) {
  std::vector<char> is_carried(connectivity.NumVertices(), 0);
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const Eigen::Vector3i triangle = connectivity.Triangles().col(f);
    const Shape* worst = nullptr;
    double least = kThin, greatest = 0;
    for (const Shape& pose : poses) {
      const double quality = Quality(pose, triangle(0), triangle(1), triangle(2));
      if (quality < least) worst = &pose;
      least = std::min(least, quality);
      greatest = std::max(greatest, quality);
    }
    if (worst == nullptr || is_carried[triangle(0)] || is_carried[triangle(1)] ||
        is_carried[triangle(2)]) {
      continue;
    }
    Carried carried;
    carried.vertex = Tip(*worst, triangle);
    carried.is_tied = greatest < kUnmeasured;
    std::vector<int> ring;
    for (const int edge : connectivity.EdgesOfVertices()[carried.vertex]) {
      const int v = connectivity.OtherEnd(edge, carried.vertex);
      if (!is_carried[v]) ring.push_back(v);
    }
    if (static_cast<int>(ring.size()) > kMostNeighbours) continue;
    double best = 0;
    for (size_t i = 0; i < ring.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        for (size_t k = 0; k < j; ++k) {
          const int corners[3] = {ring[i], ring[j], ring[k]};
          const double support = Support(poses, corners, carried.vertex);
          if (support > best) std::copy_n(corners, 3, carried.corners);
          best = std::max(best, support);
        }
      }
    }
    if (best < kHealthy) continue;
    is_carried[carried.vertex] = 1;
    any_tied_ = any_tied_ || carried.is_tied;
    carried_.push_back(carried);
  }
  // A corner may have been found to be thin after the vertices that it carries.
  std::reverse(carried_.begin(), carried_.end());
}

std::vector<ThinVertices::Tied> ThinVertices::TiedAt(const Shape& from, const Shape& to,
                                                     double t) const {
  std::vector<Tied> result;
  for (const Carried& carried : carried_) {
    if (!carried.is_tied) continue;
    Tied tied;
    tied.vertex = carried.vertex;
    std::copy_n(carried.corners, 3, tied.corners);
    tied.weights = Blended(from, to, t, carried.corners, carried.vertex).head<3>();
    result.push_back(tied);
  }
  return result;
}

void ThinVertices::Place(const Shape& from, const Shape& to, double t, Shape* shape) const {
  for (const Carried& carried : carried_) {
    shape->col(carried.vertex) =
        At(*shape, carried.corners, Blended(from, to, t, carried.corners, carried.vertex));
  }
}

}  // namespace shapespace::internal
