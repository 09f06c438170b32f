#include <shapespace/exploration/space.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <shapespace/base/error.h>
#include <shapespace/exploration/triangulation.h>

namespace shapespace {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// The nearest point of a side to `point`, as a location; returns its distance.
double ToSide(const Eigen::Matrix2Xd& points, int a, int b, const Eigen::Vector2d& point,
              PlaneLocation* location) {
  const Eigen::Vector2d side = points.col(b) - points.col(a);
  const double square = side.squaredNorm();
  const double along = square > 0 ? (point - points.col(a)).dot(side) / square : 0;
  const double t = std::clamp(along, 0.0, 1.0);
  location->nodes = {a, b, a};
  location->weights = {1 - t, t, 0};
  location->point = points.col(a) + t * side;
  return (location->point - point).norm();
}

}  // namespace

Shape BlendNodes(const std::vector<Shape>& nodes, const PlaneLocation& location, double scale) {
  const auto& [a, b, c] = location.nodes;
  const auto& [u, v, w] = location.weights;
  return scale * u * nodes[a] + scale * v * nodes[b] + scale * w * nodes[c];
}

PlaneLocation PoseSpace::Locate(const Eigen::Vector2d& point) const {
  if (!point.allFinite()) throw InvalidOptions("point", "must be two finite numbers");
  // Tolerance for negative barycentric coordinates due to rounding.
  constexpr double kRounding = 1e-12;
  PlaneLocation best;
  double deepest = -kRounding;
  bool found = false;
  for (int t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector2d a = points.col(triangles(0, t));
    const Eigen::Vector2d b = points.col(triangles(1, t)) - a, c = points.col(triangles(2, t)) - a;
    const double area = Cross(b, c);
    std::array<double, 3> weights;
    weights[1] = Cross(point - a, c) / area;
    weights[2] = Cross(b, point - a) / area;
    weights[0] = 1 - weights[1] - weights[2];
    const double depth = *std::min_element(weights.begin(), weights.end());
    if (!(depth >= deepest)) continue;
    found = true;
    deepest = depth;
    for (double& weight : weights) weight = std::max(weight, 0.0);
    const double sum = weights[0] + weights[1] + weights[2];
    for (double& weight : weights) weight /= sum;
    best = {{triangles(0, t), triangles(1, t), triangles(2, t)}, weights, point, true};
  }
  if (found) return best;

  double nearest = std::numeric_limits<double>::infinity();
  const auto try_side = [&](int a, int b) {
    PlaneLocation location;
    const double distance = ToSide(points, a, b, point, &location);
    if (!(distance < nearest)) return;
    nearest = distance;
    best = location;
  };
  for (int t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) try_side(triangles(k, t), triangles((k + 1) % 3, t));
  }
  for (int s = 0; s < segments.cols(); ++s) try_side(segments(0, s), segments(1, s));
  // On a line, points count as inside with the same tolerance as collinear points of a
  // triangulation.
  const double extent = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
  best.inside = nearest <= (triangles.cols() > 0 ? kRounding : kFlatSpread) * extent;
  return best;
}

Shape PoseSpace::Blend(const PlaneLocation& location) const {
  Shape blend = BlendNodes(nodes, location, metric->unit).colwise() + translation;
  metric->connectivity->CopyToTwins(&blend);
  return blend;
}

void PoseSpace::Validate() const {
  const auto fail = [](const std::string& what) { throw MeshError("the space: " + what); };
  const Eigen::Index vertices = metric->connectivity->NumVertices();
  const int count = NumNodes(), poses = NumPoses();
  if (poses < 2 || poses > count) fail("must have at least two poses, and a name for each");
  if (points.cols() != count || static_cast<int>(parents.size()) != count - poses ||
      distances.rows() != poses || distances.cols() != poses) {
    fail("its nodes, points, parents and distances differ in number");
  }
  for (const Shape& node : nodes) {
    if (node.cols() != vertices || !node.allFinite()) {
      fail("a node is not finite, or has another number of vertices than the mesh");
    }
  }
  if (!points.allFinite() || !distances.allFinite() || !translation.allFinite()) {
    fail("a point or a distance is not finite");
  }
  for (int i = 0; i < count; ++i) {
    if (!Placed(i).allFinite()) fail("a node is not finite in the unit of the poses");
  }
  if (distances.minCoeff() < 0 || distances.maxCoeff() == 0 || distances != distances.transpose()) {
    fail("its distances are negative, all zero, or not symmetric");
  }
  const auto in_range = [](const auto& indices, int end) {
    return indices.size() == 0 || (indices.minCoeff() >= 0 && indices.maxCoeff() < end);
  };
  if (!in_range(triangles, count) || !in_range(segments, count)) {
    fail("a triangle or a segment has an index out of range");
  }
  if (triangles.cols() + segments.cols() == 0) fail("it has neither a triangle nor a segment");
  for (int i = 0; i < count - poses; ++i) {
    for (int parent : parents[i]) {
      if (parent < 0 || parent >= poses + i) fail("a node comes before its parents");
    }
  }
  appearance.Validate(static_cast<int>(vertices), metric->connectivity->NumPolygons(),
                      static_cast<int>(metric->connectivity->Corners().size()));
}

PlaneWalk WalkAlong(const PoseSpace& space, const std::vector<Eigen::Vector2d>& polyline,
                    int frames) {
  if (polyline.empty()) throw InvalidOptions("points", "the curve has none");
  if (frames < 1) throw InvalidOptions("frames", "must be 1 or more");
  std::vector<double> length = {0};  // cumulative, at each point
  for (size_t i = 0; i < polyline.size(); ++i) {
    if (!polyline[i].allFinite()) throw InvalidOptions("points", "one is not finite");
    if (i > 0) length.push_back(length.back() + (polyline[i] - polyline[i - 1]).stableNorm());
  }
  if (!std::isfinite(length.back()))
    throw InvalidOptions("points", "the curve has no finite length");
  PlaneWalk walk;
  walk.path.metric = space.metric;
  walk.path.appearance = space.appearance;
  size_t i = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const double t = frames > 1 ? static_cast<double>(frame) / (frames - 1) : 0;
    const double at = t * length.back();
    while (i + 2 < length.size() && length[i + 1] <= at) ++i;
    Eigen::Vector2d point = polyline.back();
    if (frame + 1 < frames && i + 1 < length.size() && length[i + 1] > length[i]) {
      const double u = (at - length[i]) / (length[i + 1] - length[i]);
      point = (1 - u) * polyline[i] + u * polyline[i + 1];
    } else if (frame == 0) {
      point = polyline.front();
    }
    const PlaneLocation location = space.Locate(point);
    const auto& [nodes, weights, place, inside] = location;
    if (!inside) ++walk.outside;
    for (int k = 0; k < 3; ++k) {
      if (weights[k] == 1 && nodes[k] < space.NumPoses()) walk.path.poses.push_back(frame);
    }
    walk.path.shapes.push_back(BlendNodes(space.nodes, location));
    walk.path.parameters.push_back(frames > 1 ? t : 0);
    walk.path.motions.push_back({Eigen::Matrix3d::Identity(), space.translation});
    walk.locations.push_back(location);
  }
  return walk;
}

}  // namespace shapespace
