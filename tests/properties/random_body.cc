#include "properties/random_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/bodies/body.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/exploration/triangulation.h>

namespace shapespace::testing {
namespace {

using Eigen::Vector3d;

// A mesh at rest, about as large as the unit ball.
struct Rest {
  std::vector<Vector3d> points;
  std::vector<std::vector<int>> polygons;
  std::vector<std::pair<int, int>> segments;

  int Add(const Vector3d& point) {
    points.push_back(point);
    return static_cast<int>(points.size()) - 1;
  }
  // A cell of a grid, as one polygon or as two triangles.
  void AddCell(const std::array<int, 4>& corners, bool whole, bool other_diagonal) {
    const auto [a, b, c, d] = corners;
    if (whole) {
      polygons.push_back({a, b, c, d});
    } else if (other_diagonal) {
      polygons.push_back({a, b, d});
      polygons.push_back({b, c, d});
    } else {
      polygons.push_back({a, b, c});
      polygons.push_back({a, c, d});
    }
  }
  // Without the points of no polygon or segment.
  void DropUnused() {
    std::vector<int> to(points.size(), -1);
    for (const auto& polygon : polygons) {
      for (const int v : polygon) to[v] = 0;
    }
    for (const auto& [a, b] : segments) to[a] = to[b] = 0;
    std::vector<Vector3d> kept;
    for (size_t v = 0; v < points.size(); ++v) {
      if (to[v] < 0) continue;
      to[v] = static_cast<int>(kept.size());
      kept.push_back(points[v]);
    }
    points = std::move(kept);
    for (auto& polygon : polygons) {
      for (int& v : polygon) v = to[v];
    }
    for (auto& [a, b] : segments) a = to[a], b = to[b];
  }
};

// Cells of nx x ny that stay when each was removed with probability 1 in `one_in`; none of those at
// the border goes, and no two that touch.
std::vector<char> CellsWithHoles(int nx, int ny, int one_in, Random* random) {
  std::vector<char> stays(static_cast<size_t>(nx) * ny, 1);
  for (int j = 1; j + 1 < ny; ++j) {
    for (int i = 1; i + 1 < nx; ++i) {
      bool free = random->OneIn(one_in);
      for (const auto& [di, dj] : {std::pair(-1, 0), {-1, -1}, {0, -1}, {1, -1}}) {
        free = free && stays[(j + dj) * nx + i + di];
      }
      if (free) stays[j * nx + i] = 0;
    }
  }
  return stays;
}

Rest Sheet(Random* random) {
  const int nx = 4 + random->Below(8), ny = 3 + random->Below(6);
  const double width = random->Between(0.5, 1.2);
  const bool whole = random->OneIn(3);
  const double jitter = random->Between(0, 0.2);
  Rest rest;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const double x = i + random->Between(-jitter, jitter),
                   y = j + random->Between(-jitter, jitter);
      rest.Add({2 * x / nx - 1, width * (2 * y / ny - 1), 0});
    }
  }
  const std::vector<char> stays = CellsWithHoles(nx, ny, 6, random);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      if (!stays[j * nx + i]) continue;
      const int v = j * (nx + 1) + i;
      rest.AddCell({v, v + 1, v + nx + 2, v + nx + 1}, whole, random->OneIn(2));
    }
  }
  rest.DropUnused();
  return rest;
}

Rest Plate(Random* random) {
  const int nx = 4 + random->Below(4), ny = 3 + random->Below(3);
  const double width = random->Between(0.5, 1), thickness = random->Between(0.1, 0.4);
  const std::vector<char> stays = CellsWithHoles(nx, ny, 3, random);
  Rest rest;
  for (const double z : {-thickness, thickness}) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        rest.Add({2. * i / nx - 1, width * (2. * j / ny - 1), z});
      }
    }
  }
  const int top = (nx + 1) * (ny + 1);
  const auto is_there = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < nx && j < ny && stays[j * nx + i];
  };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      if (!is_there(i, j)) continue;
      const int a = j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
      rest.AddCell({a, d, c, b}, false, random->OneIn(2));
      rest.AddCell({top + a, top + b, top + c, top + d}, false, random->OneIn(2));
      const auto wall = [&](int from, int to) {
        rest.AddCell({from, to, top + to, top + from}, false, random->OneIn(2));
      };
      if (!is_there(i, j - 1)) wall(a, b);
      if (!is_there(i + 1, j)) wall(b, c);
      if (!is_there(i, j + 1)) wall(c, d);
      if (!is_there(i - 1, j)) wall(d, a);
    }
  }
  rest.DropUnused();
  return rest;
}

Rest OfFamily(const ShapeFamily& family, double at) {
  Rest rest;
  const Shape shape = family.pose(at);
  const Vector3d centre = shape.rowwise().mean();
  const double size = (shape.colwise() - centre).colwise().norm().maxCoeff();
  for (int v = 0; v < shape.cols(); ++v) rest.Add((shape.col(v) - centre) / size);
  const auto& begin = family.connectivity->PolygonBegin();
  const auto& corners = family.connectivity->Corners();
  for (int p = 0; p < family.connectivity->NumPolygons(); ++p) {
    rest.polygons.emplace_back(corners.begin() + begin[p], corners.begin() + begin[p + 1]);
  }
  rest.segments = family.connectivity->Segments();
  return rest;
}

Rest Tube(Random* random) {
  TubeForm form;
  form.length = random->Between(2, 8);
  form.base_radius = random->Between(0.4, 0.8);
  form.tip_radius = random->Between(0.3, 0.6);
  form.knuckle = random->Between(0, 0.1);
  const ShapeFamily tube = MakeTube(60 + random->Below(240), form);
  return OfFamily(tube, random->Between(0, 0.4 * tube.end));
}

Rest Ball(Random* random) {
  Rest rest;
  for (const int axis : {0, 1, 2}) {
    rest.Add(Vector3d::Unit(axis));
    rest.Add(-Vector3d::Unit(axis));
  }
  rest.polygons = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                   {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < 2; ++round) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), 0);
      if (is_new) at->second = rest.Add((rest.points[a] + rest.points[b]).normalized());
      return at->second;
    };
    std::vector<std::vector<int>> finer;
    for (const auto& polygon : rest.polygons) {
      const int a = polygon[0], b = polygon[1], c = polygon[2];
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& part : {std::vector{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
        finer.push_back(part);
      }
    }
    rest.polygons = finer;
  }
  const Vector3d axes(1, random->Between(0.4, 1), random->Between(0.4, 1));
  for (Vector3d& point : rest.points) {
    point += 0.05 * random->Between(0, 1) * random->Direction();
    point = point.cwiseProduct(axes);
  }
  return rest;
}

Rest Torus(Random* random) {
  const int nu = 6 + random->Below(8), nv = 4 + random->Below(4);
  const double thin = random->Between(0.2, 0.4);
  const bool whole = random->OneIn(2);
  Rest rest;
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      const double u = 2 * M_PI * i / nu, v = 2 * M_PI * (j + 0.3 * (i % 2)) / nv;
      const double radius = 1 - thin + thin * std::cos(v);
      rest.Add({radius * std::cos(u), radius * std::sin(u), thin * std::sin(v)});
    }
  }
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      const auto at = [&](int di, int dj) { return (j + dj) % nv * nu + (i + di) % nu; };
      rest.AddCell({at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, whole, random->OneIn(2));
    }
  }
  return rest;
}

Rest Delaunay(Random* random) {
  Eigen::Matrix2Xd points(2, 20 + random->Below(60));
  for (double& x : points.reshaped()) x = random->Between(-1, 1);
  const Eigen::Matrix3Xi triangles = DelaunayTriangulation(points).triangles;
  Rest rest;
  for (int v = 0; v < points.cols(); ++v) rest.Add({points(0, v), points(1, v), 0});
  for (int t = 0; t < triangles.cols(); ++t) {
    // Needles at the border of the convex hull have hardly any area.
    const int a = triangles(0, t), b = triangles(1, t), c = triangles(2, t);
    const Eigen::Vector2d ab = points.col(b) - points.col(a), ac = points.col(c) - points.col(a);
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    if (ab.x() * ac.y() - ab.y() * ac.x() > 0.2 * longest * longest) {
      rest.polygons.push_back({a, b, c});
    }
  }
  rest.DropUnused();
  return rest;
}

Rest Moebius(Random* random) {
  const int around = 12 + random->Below(10), across = 2 + random->Below(2);
  const double width = random->Between(0.2, 0.35);
  Rest rest;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j <= across; ++j) {
      const double u = 2 * M_PI * i / around, s = width * (2. * j / across - 1);
      const double radius = 0.7 + s * std::cos(u / 2);
      rest.Add({radius * std::cos(u), radius * std::sin(u), s * std::sin(u / 2)});
    }
  }
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const auto at = [&](int di, int dj) {
        return i + di < around ? (i + di) * (across + 1) + j + dj : across - j - dj;
      };
      rest.AddCell({at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, false, random->OneIn(2));
    }
  }
  return rest;
}

Rest Whiskered(Random* random) {
  Rest rest = Sheet(random);
  const int roots = static_cast<int>(rest.points.size());
  for (int whisker = 0; whisker < 4; ++whisker) {
    int from = random->Below(roots);
    for (int piece = 0; piece < 3; ++piece) {
      const Vector3d step = 0.15 * (Vector3d::UnitZ() + 0.5 * random->Direction());
      const int to = rest.Add(rest.points[from] + step);
      rest.segments.emplace_back(from, to);
      from = to;
    }
  }
  return rest;
}

Rest Book(Random* random) {
  const int length = 4 + random->Below(5), depth = 2 + random->Below(3);
  Rest rest;
  for (int i = 0; i <= length; ++i) rest.Add({2. * i / length - 1, 0, 0});
  for (int page = 0; page < 3; ++page) {
    const double angle = 2 * M_PI / 3 * (page + random->Between(-0.2, 0.2));
    std::vector<int> before(length + 1);
    std::iota(before.begin(), before.end(), 0);
    for (int j = 1; j <= depth; ++j) {
      std::vector<int> row;
      for (int i = 0; i <= length; ++i) {
        const double r = 0.8 * j / depth;
        row.push_back(rest.Add({2. * i / length - 1, r * std::cos(angle), r * std::sin(angle)}));
      }
      for (int i = 0; i < length; ++i) {
        rest.AddCell({before[i], before[i + 1], row[i + 1], row[i]}, false, random->OneIn(2));
      }
      before = row;
    }
  }
  return rest;
}

Rest Two(Random* random) {
  Rest rest = Ball(random);
  const Rest other = Sheet(random);
  const int first = static_cast<int>(rest.points.size());
  for (const Vector3d& point : other.points) rest.Add(point + Vector3d(0.5, 0.3, 2));
  for (std::vector<int> polygon : other.polygons) {
    for (int& v : polygon) v += first;
    rest.polygons.push_back(polygon);
  }
  return rest;
}

Rest Flexible(Random* random) {
  static const std::array<const char*, 6> kNames = {"strip", "steffen",  "miura",
                                                    "bar",   "catenoid", "quadruped"};
  const char* const name = kNames[random->Below(static_cast<int>(kNames.size()))];
  const ShapeFamily family = MakeBody(name, 20 + random->Below(200));
  const double middle = (family.begin + family.end) / 2;
  return OfFamily(family, middle + random->Between(-0.1, 0.1) * (family.end - family.begin));
}

Rest Graph(Random* random) {
  Rest rest = Delaunay(random);
  for (Vector3d& point : rest.points) point.z() += random->Between(-0.3, 0.3);
  std::map<std::pair<int, int>, int> edges;
  for (const auto& polygon : rest.polygons) {
    for (int k = 0; k < 3; ++k) ++edges[std::minmax(polygon[k], polygon[(k + 1) % 3])];
  }
  rest.polygons.clear();
  for (const auto& edge : edges) rest.segments.push_back(edge.first);
  return rest;
}

Rest MakeRest(BodyKind kind, Random* random) {
  switch (kind) {
    case BodyKind::kSheet:
      return Sheet(random);
    case BodyKind::kPlate:
      return Plate(random);
    case BodyKind::kTube:
      return Tube(random);
    case BodyKind::kBall:
      return Ball(random);
    case BodyKind::kTorus:
      return Torus(random);
    case BodyKind::kDelaunay:
      return Delaunay(random);
    case BodyKind::kMoebius:
      return Moebius(random);
    case BodyKind::kWhiskered:
      return Whiskered(random);
    case BodyKind::kBook:
      return Book(random);
    case BodyKind::kTwo:
      return Two(random);
    case BodyKind::kFlexible:
      return Flexible(random);
    case BodyKind::kGraph:
      return Graph(random);
  }
  return {};
}

const char* NameOf(BodyKind kind) {
  static const std::array<const char*, kNumBodyKinds> kNames = {
      "sheet",   "plate",     "tube", "ball", "torus",    "Delaunay",
      "Moebius", "whiskered", "book", "two",  "flexible", "graph"};
  return kNames[static_cast<int>(kind)];
}

// A smooth random map of space, which is near the identity or bends what is of the size of the unit
// ball by up to about 80 degrees. It takes points to others one to one.
class Deformation {
 public:
  explicit Deformation(Random* random)
      : frame_(random->Rotation()),
        bend_(random->Between(-0.7, 0.7)),
        twist_(random->Between(-0.5, 0.5)),
        bulge_(random->Between(-0.2, 0.2)),
        centre_(random->Between(0.2, 0.8) * random->Direction()),
        dent_(random->Between(0, 0.15) * random->Direction()),
        stretch_(random->Between(0.9, 1.1)) {}

  Vector3d operator()(const Vector3d& point) const {
    Vector3d x = frame_ * point;
    x += dent_ * std::exp(-3 * (x - centre_).squaredNorm());
    x.tail<2>() *= 1 + bulge_ * std::cos(2 * x[0]);
    x[0] *= stretch_;
    x = Eigen::AngleAxisd(twist_ * x[0], Vector3d::UnitX()) * x;
    // The x axis becomes an arc, and what is beside it stays beside it.
    const double angle = bend_ * x[0];
    const double along = std::abs(bend_) > 1e-9 ? std::sin(angle) / bend_ : x[0];
    const double aside = std::abs(bend_) > 1e-9 ? (1 - std::cos(angle)) / bend_ : 0;
    const double height = 0.9 * x[1];
    return {along - height * std::sin(angle), aside + height * std::cos(angle), x[2]};
  }

 private:
  Eigen::Matrix3d frame_;
  double bend_, twist_, bulge_;
  Vector3d centre_, dent_;
  double stretch_;
};

MetricOptions RandomMetric(BodyKind kind, int vertices, Random* random) {
  // A graph has total edge length 1, and so is small in its own unit.
  const double swings = kind == BodyKind::kWhiskered || kind == BodyKind::kBook ? 100
                        : kind == BodyKind::kGraph                              ? 1000
                                                                                : 1;
  MetricOptions metric;
  metric.isometric = random->OneIn(3) ? 1 : 0;
  metric.strain = metric.isometric == 0 || random->OneIn(2) ? 1 : 0;
  metric.bending = std::pow(10, random->Between(-4.5, -2));
  // The angle by which a curve turns has no sign. Where curves straighten on the way, that makes
  // solves converge slowly if bending costs much.
  if (kind == BodyKind::kGraph) metric.bending *= 1e-3;
  metric.lambda = swings * (random->OneIn(2) ? 1e-4 : 1e-3);
  if (random->OneIn(3)) {
    metric.stretching_stiffness.resize(vertices);
    metric.bending_stiffness.resize(vertices);
    for (double& stiffness : metric.stretching_stiffness) stiffness = random->Between(0.3, 3);
    for (double& stiffness : metric.bending_stiffness) stiffness = random->Between(0.3, 3);
  }
  return metric;
}

}  // namespace

Vector3d Random::Direction() {
  while (true) {
    const double x = Between(-1, 1), y = Between(-1, 1), z = Between(-1, 1);
    const Vector3d point(x, y, z);
    if (point.norm() > 0.1 && point.norm() < 1) return point.normalized();
  }
}

Eigen::Matrix3d Random::Rotation() {
  const Vector3d axis = Direction();
  return Eigen::AngleAxisd(Between(-M_PI, M_PI), axis).toRotationMatrix();
}

std::vector<int> Random::Order(int count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  for (int i = count - 1; i > 0; --i) std::swap(order[i], order[Below(i + 1)]);
  return order;
}

RandomBody MakeRandomBody(BodyKind kind, int seed, int poses) {
  Random random(1000 * seed + static_cast<int>(kind));
  const Rest rest = MakeRest(kind, &random);
  const int vertices = static_cast<int>(rest.points.size());
  RandomBody body;
  body.name = std::string(NameOf(kind)) + " of seed " + std::to_string(seed);
  std::vector<int> begin = {0}, corners;
  for (const auto& polygon : rest.polygons) {
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    begin.push_back(static_cast<int>(corners.size()));
  }
  body.connectivity = Connectivity::Make(vertices, begin, corners, rest.segments);
  body.metric = RandomMetric(kind, vertices, &random);

  const Vector3d direction = random.Direction();
  std::vector<int> order(vertices);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return rest.points[a].dot(direction) < rest.points[b].dot(direction);
  });
  const int handle = std::max(2, vertices / 8);
  body.held.assign(order.begin(), order.begin() + handle);
  body.moved.assign(order.end() - handle, order.end());

  for (int i = 0; i < poses; ++i) {
    const Deformation deformation(&random);
    const Eigen::Matrix3d rotation = random.Rotation();
    const Vector3d translation = random.Between(0, 3) * random.Direction();
    Shape pose(3, vertices);
    for (int v = 0; v < vertices; ++v) {
      pose.col(v) = rotation * deformation(rest.points[v]) + translation;
    }
    body.poses.push_back(pose);
  }
  return body;
}

RandomBody Moved(const RandomBody& body, double scale, const Eigen::Matrix3d& rotation,
                 const Vector3d& translation) {
  RandomBody moved = body;
  for (Shape& pose : moved.poses) pose = (scale * rotation * pose).colwise() + translation;
  return moved;
}

Shape Renumbered::operator()(const Shape& shape) const {
  Shape other(3, shape.cols());
  for (int v = 0; v < shape.cols(); ++v) other.col(to[v]) = shape.col(v);
  return other;
}

Shape Renumbered::Back(const Shape& shape) const { return shape(Eigen::all, to); }

Renumbered Renumber(const RandomBody& body, int seed) {
  Random random(seed);
  const Connectivity& connectivity = *body.connectivity;
  Renumbered renumbered = {body, random.Order(connectivity.NumVertices())};
  const std::vector<int>& to = renumbered.to;

  // Polygons keep their triangles, which otherwise depend on their first corners.
  const auto& old_begin = connectivity.PolygonBegin();
  std::vector<int> first_triangle = {0};
  for (int p = 0; p < connectivity.NumPolygons(); ++p) {
    first_triangle.push_back(first_triangle.back() + old_begin[p + 1] - old_begin[p] - 2);
  }
  std::vector<int> begin = {0}, corners;
  Eigen::Matrix3Xi triangles(3, connectivity.NumTriangles());
  int triangle = 0;
  for (const int p : random.Order(connectivity.NumPolygons())) {
    const int size = old_begin[p + 1] - old_begin[p], start = random.Below(size);
    for (int k = 0; k < size; ++k) {
      corners.push_back(to[connectivity.Corners()[old_begin[p] + (start + k) % size]]);
    }
    begin.push_back(static_cast<int>(corners.size()));
    for (int t = first_triangle[p]; t < first_triangle[p + 1]; ++t, ++triangle) {
      const int turn = random.Below(3);
      for (int k = 0; k < 3; ++k) {
        triangles(k, triangle) = to[connectivity.Triangles()((k + turn) % 3, t)];
      }
    }
  }
  std::vector<std::pair<int, int>> segments;
  for (const int s : random.Order(static_cast<int>(connectivity.Segments().size()))) {
    const auto [a, b] = connectivity.Segments()[s];
    segments.emplace_back(to[b], to[a]);
  }
  RandomBody& other = renumbered.body;
  other.connectivity =
      Connectivity::Make(connectivity.NumVertices(), begin, corners, segments, {}, triangles);
  for (Shape& pose : other.poses) pose = renumbered(pose);
  for (int& v : other.held) v = to[v];
  for (int& v : other.moved) v = to[v];
  for (Eigen::VectorXd MetricOptions::*stiffness :
       {&MetricOptions::stretching_stiffness, &MetricOptions::bending_stiffness}) {
    const Eigen::VectorXd old = body.metric.*stiffness;
    for (int v = 0; v < old.size(); ++v) (other.metric.*stiffness)[to[v]] = old[v];
  }
  return renumbered;
}

}  // namespace shapespace::testing
