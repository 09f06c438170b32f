#include <shapespace/path/rigid_parts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/sides.h>
#include <shapespace/path/quality.h>

namespace shapespace {
namespace {

// Number of shapes, besides the first, that determine the parts: motion along a path is smooth, and
// memory is proportional to triangles times shapes.
constexpr int kMostShapes = 8;

// Displacements below this, as a share of a region's size, count as no motion; in regions without
// motion, small regions are merged first, so that all grow at the same rate.
constexpr double kNoMotion = 1e-4;

// Deviations below this are rounding.
constexpr double kNoise = 1e-9;

// A region whose own deviation from rigid motion exceeds this share of the tolerance is a slice of
// a region that bends throughout. On real paths bones have 0.05 to 0.55, slices 0.6 and more.
constexpr double kOwnShare = 0.6;

constexpr int kBatch = 512;  // pairs per task: about 100 microseconds

// Area-weighted sums over a region's points. They are sufficient for the best rigid motion of the
// region and, added, for that of two regions together.
struct RestSums {
  double area = 0, squares = 0;
  Eigen::Vector3d points = Eigen::Vector3d::Zero();

  void Add(const RestSums& other) {
    area += other.area;
    squares += other.squares;
    points += other.points;
  }
};
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

// The squared distance from the best rigid motion, integrated over the area. It is G - 2 x, where x
// is the largest root of a quartic whose coefficients are invariants of the covariance; x <= G / 2,
// from where Newton's method decreases monotonically. D. L. Theobald, "Rapid calculation of RMSDs
// using a quaternion-based characteristic polynomial", Acta Cryst. A61, 2005.
double SquaredResidual(const RestSums& rest, const MovedSums& moved) {
  const double both = (rest.squares - rest.points.squaredNorm() / rest.area) +
                      (moved.squares - moved.points.squaredNorm() / rest.area);
  if (!(both > 0)) return 0;
  const Eigen::Matrix3d h =
      (moved.products - rest.points * moved.points.transpose() / rest.area) * (2 / both);
  const Eigen::Matrix3d hh = h * h.transpose();
  const double trace = hh.trace();
  const double c2 = -2 * trace, c1 = -8 * h.determinant();
  const double c0 = 2 * hh.squaredNorm() - trace * trace;
  double x = 1;
  for (int i = 0; i < 50; ++i) {
    const double slope = (4 * x * x + 2 * c2) * x + c1;
    if (!(slope > 0)) break;  // a double root, reached up to rounding
    const double step = (((x * x + c2) * x + c1) * x + c0) / slope;
    if (!(step > 1e-15)) break;
    x -= step;
  }
  return std::max(0.0, (1 - x) * both);
}

// Two adjacent regions.
struct Pair {
  int first, second;  // first < second
  double loss;        // negative: not computed yet
};

class Merger {
 public:
  Merger(const Path& path, const RigidPartsOptions& options);

  // Merges regions until no pair fits; returns the region of each triangle, in 0 .. count - 1.
  std::vector<int> Run(int* count);

 private:
  double Loss(const Pair& pair) const;
  bool Fits(const Pair& pair) const;
  bool Pass();

  const RigidPartsOptions options_;
  int shapes_ = 0;
  std::vector<int> region_;  // per triangle
  std::vector<RestSums> rest_;
  std::vector<MovedSums> moved_;  // by region
  std::vector<double> residual_;  // by region
  std::vector<Pair> pairs_;
};

std::vector<int> DecidingShapes(int num_shapes) {
  const int count = std::min(kMostShapes, num_shapes - 1);
  std::vector<int> chosen;
  for (int k = 1; k <= count; ++k) {
    chosen.push_back(static_cast<int>(static_cast<std::int64_t>(num_shapes - 1) * k / count));
  }
  return chosen;
}

// Per triangle its mean area in the first and the given shapes, with sum 1.
Eigen::VectorXd MeanAreas(const Path& path, const std::vector<int>& shapes) {
  const Eigen::Matrix3Xi& triangles = path.metric->connectivity->Triangles();
  Eigen::VectorXd area = Eigen::VectorXd::Zero(triangles.cols());
  const auto add = [&](const Shape& shape) {
    for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
      const Eigen::Vector3d a = shape.col(triangles(0, f));
      area(f) += (shape.col(triangles(1, f)) - a).cross(shape.col(triangles(2, f)) - a).norm();
    }
  };
  add(path.shapes[0]);
  for (const int i : shapes) add(path.shapes[i]);
  area /= area.sum();
  // Degenerate triangles can be merged at no cost, but must not cause a division by zero.
  area = area.cwiseMax(std::numeric_limits<double>::epsilon() / area.size());
  return area / area.sum();
}

Merger::Merger(const Path& path, const RigidPartsOptions& options) : options_(options) {
  const Connectivity& connectivity = *path.metric->connectivity;
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  const int count = connectivity.NumTriangles();
  const std::vector<int> chosen = DecidingShapes(path.NumShapes());
  shapes_ = static_cast<int>(chosen.size());
  const Eigen::VectorXd area = MeanAreas(path, chosen);
  region_.resize(count);
  std::iota(region_.begin(), region_.end(), 0);
  rest_.resize(count);
  moved_.resize(static_cast<size_t>(count) * shapes_);
  residual_.resize(moved_.size());
  for (int f = 0; f < count; ++f) {
    const double share = area(f) / 3;
    rest_[f].area = area(f);
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d p = path.shapes[0].col(triangles(c, f));
      rest_[f].points += share * p;
      rest_[f].squares += share * p.squaredNorm();
      for (int k = 0; k < shapes_; ++k) {
        const Eigen::Vector3d q = path.shapes[chosen[k]].col(triangles(c, f));
        MovedSums& moved = moved_[static_cast<size_t>(f) * shapes_ + k];
        moved.points += share * q;
        moved.squares += share * q.squaredNorm();
        moved.products += share * p * q.transpose();
      }
    }
    for (int k = 0; k < shapes_; ++k) {
      const size_t at = static_cast<size_t>(f) * shapes_ + k;
      residual_[at] = SquaredResidual(rest_[f], moved_[at]);
    }
  }
  std::vector<int> begin(count + 1);
  for (int f = 0; f <= count; ++f) begin[f] = 3 * f;
  const std::vector<int> corners(triangles.data(), triangles.data() + triangles.size());
  const internal::Sides sides = internal::MakeSides(connectivity.NumVertices(), begin, corners);
  for (int e = 0; e < sides.NumEdges(); ++e) {
    for (int s = sides.begin[e] + 1; s < sides.begin[e + 1]; ++s) {
      const auto [low, high] = std::minmax(sides.sides[s - 1].polygon, sides.sides[s].polygon);
      if (low != high) pairs_.push_back({low, high, -1});
    }
  }
}

// The increase of the error by merging the two, integrated over the area, in the worst shape.
double Merger::Loss(const Pair& pair) const {
  RestSums rest = rest_[pair.first];
  rest.Add(rest_[pair.second]);
  double loss = 0;
  for (int k = 0; k < shapes_; ++k) {
    const size_t first = static_cast<size_t>(pair.first) * shapes_ + k;
    const size_t second = static_cast<size_t>(pair.second) * shapes_ + k;
    MovedSums moved = moved_[first];
    moved.Add(moved_[second]);
    loss = std::max(loss, SquaredResidual(rest, moved) - residual_[first] - residual_[second]);
  }
  return loss;
}

// The increase is attributed to the smaller region, because the common motion follows the larger
// one. Regions too small to be parts are compared with the size of the smallest part.
bool Merger::Fits(const Pair& pair) const {
  const double area = std::min(rest_[pair.first].area, rest_[pair.second].area);
  const double size_squared = std::max(area, options_.least_share);
  return pair.loss <= options_.tolerance * options_.tolerance * size_squared * area;
}

// Hashes a pair, for an order that is independent of the position on the mesh.
std::uint64_t Mix(const Pair& pair) {
  std::uint64_t x =
      (static_cast<std::uint64_t>(pair.first) << 32) | static_cast<std::uint32_t>(pair.second);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

// Merges all pairs that are mutual nearest neighbours. This gives the same result as always merging
// the pair with the least loss, because the loss of a merged region with another one is not less
// than the lesser of the two regions' losses (reducibility).
bool Merger::Pass() {
  const int batches = (static_cast<int>(pairs_.size()) + kBatch - 1) / kBatch;
  ParallelFor(batches, [&](int batch) {
    const size_t end = std::min(pairs_.size(), static_cast<size_t>(batch + 1) * kBatch);
    for (size_t i = static_cast<size_t>(batch) * kBatch; i < end; ++i) {
      if (pairs_[i].loss < 0) pairs_[i].loss = Loss(pairs_[i]);
    }
  });
  const auto cost = [&](const Pair& pair) {
    const double area = rest_[pair.first].area + rest_[pair.second].area;
    return std::make_pair(pair.loss + kNoMotion * kNoMotion * area * area, Mix(pair));
  };
  const int count = static_cast<int>(rest_.size());
  constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::pair<double, std::uint64_t>> best(
      count, {std::numeric_limits<double>::infinity(), kLast});
  std::vector<int> partner(count, -1);
  for (const Pair& pair : pairs_) {
    if (!Fits(pair)) continue;
    const auto value = cost(pair);
    for (const auto& [self, other] :
         {std::pair(pair.first, pair.second), std::pair(pair.second, pair.first)}) {
      if (value < best[self]) {
        best[self] = value;
        partner[self] = other;
      }
    }
  }
  bool joined = false;
  std::vector<int> target(count);
  std::vector<bool> changed(count, false);
  for (int r = 0; r < count; ++r) {
    target[r] = r;
    const int other = partner[r];
    if (other < 0 || other > r || partner[other] != r) continue;
    target[r] = other;
    changed[other] = joined = true;
    rest_[other].Add(rest_[r]);
    for (int k = 0; k < shapes_; ++k) {
      const size_t at = static_cast<size_t>(other) * shapes_ + k;
      moved_[at].Add(moved_[static_cast<size_t>(r) * shapes_ + k]);
      residual_[at] = SquaredResidual(rest_[other], moved_[at]);
    }
  }
  if (!joined) return false;
  std::vector<int> renumbered(count);
  int next = 0;
  for (int r = 0; r < count; ++r) {
    if (target[r] != r) {
      renumbered[r] = renumbered[target[r]];
      continue;
    }
    rest_[next] = rest_[r];
    for (int k = 0; k < shapes_; ++k) {
      const size_t to = static_cast<size_t>(next) * shapes_ + k;
      const size_t from = static_cast<size_t>(r) * shapes_ + k;
      moved_[to] = moved_[from];
      residual_[to] = residual_[from];
    }
    changed[next] = changed[r];
    renumbered[r] = next++;
  }
  rest_.resize(next);
  moved_.resize(static_cast<size_t>(next) * shapes_);
  residual_.resize(moved_.size());
  for (int& r : region_) r = renumbered[r];
  size_t kept = 0;
  for (const Pair& pair : pairs_) {
    const auto [low, high] = std::minmax(renumbered[pair.first], renumbered[pair.second]);
    if (low == high) continue;
    pairs_[kept++] = {low, high, changed[low] || changed[high] ? -1 : pair.loss};
  }
  pairs_.resize(kept);
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::pair(a.first, a.second) < std::pair(b.first, b.second);
  });
  const auto same = [](const Pair& a, const Pair& b) {
    return a.first == b.first && a.second == b.second;
  };
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end(), same), pairs_.end());
  return true;
}

std::vector<int> Merger::Run(int* count) {
  while (Pass()) {
  }
  *count = static_cast<int>(rest_.size());
  return region_;
}

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
  std::vector<RestSums> rest(count);
  std::vector<MovedSums> moved(count);
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
  return Eigen::AngleAxisd(Eigen::Matrix3d(a * b.transpose())).angle() * 180 / M_PI;
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
  return result;
}

// Regions of triangles that are large enough, in order of descending area.
struct Regions {
  std::vector<int> of_triangle;  // -1 if the triangle's region is too small
  std::vector<double> area;
};

Regions LargeRegions(Merger merger, const Eigen::VectorXd& area, double least_share) {
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
  if (!(tolerance > 0 && tolerance <= 1)) throw InvalidOptions("tolerance: must be in (0, 1]");
  if (!(least_share > 0 && least_share <= 1)) {
    throw InvalidOptions("least_share: must be in (0, 1]");
  }
  if (!(most_deviation > 0)) throw InvalidOptions("most_deviation: must be positive");
}

RigidParts FindRigidParts(const Path& path, const RigidPartsOptions& options) {
  options.Validate();
  const Connectivity& connectivity = *path.metric->connectivity;
  const int num_triangles = connectivity.NumTriangles();
  RigidParts result;
  result.of_triangle = Eigen::VectorXi::Constant(num_triangles, RigidParts::kJoint);
  result.of_vertex = PartsOfVertices(connectivity, result.of_triangle);
  if (num_triangles == 0) return result;

  const Eigen::VectorXd area = MeanAreas(path, DecidingShapes(path.NumShapes()));
  const Regions regions = LargeRegions(Merger(path, options), area, options.least_share);
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

std::vector<DeviationSite> FindDeviationSites(const Path& path, const RigidParts& parts) {
  const Metric& metric = *path.metric;
  const Connectivity& connectivity = *metric.connectivity;
  const int num_vertices = connectivity.NumVertices();
  std::vector<Eigen::VectorXd> by_shape(path.NumShapes());
  ParallelFor(path.NumShapes(), [&](int i) { by_shape[i] = EdgeDeviation(path, i); });
  Eigen::VectorXd deviation = Eigen::VectorXd::Zero(num_vertices);
  for (const Eigen::VectorXd& one : by_shape) deviation = deviation.cwiseMax(one);
  const Eigen::VectorXd weight = metric.vertex_area / metric.vertex_area.sum();
  const double total = deviation.cwiseAbs2().dot(weight);
  const double threshold = std::max(std::sqrt(total), kNoise);

  internal::UnionFind sites(num_vertices);
  const auto inside = [&](int v) { return deviation(v) > threshold; };
  const Eigen::Matrix2Xi& edges = connectivity.Edges();
  for (int e = 0; e < edges.cols(); ++e) {
    if (inside(edges(0, e)) && inside(edges(1, e))) sites.Join(edges(0, e), edges(1, e));
  }
  std::vector<DeviationSite> result;
  std::vector<int> index(num_vertices, -1);
  for (int v = 0; v < num_vertices; ++v) {
    if (!inside(v)) continue;
    int& at = index[sites.Find(v)];
    if (at < 0) {
      at = static_cast<int>(result.size());
      result.emplace_back();
    }
    index[v] = at;
    DeviationSite& site = result[at];
    site.share += weight(v) * deviation(v) * deviation(v) / total;
    site.area_share += weight(v);
    if (deviation(v) > site.largest) {
      site.largest = deviation(v);
      site.vertex = v;
    }
  }
  // Numbers of ends of edges at the site, by part.
  std::vector<std::vector<std::pair<int, int>>> touched(result.size());
  for (int e = 0; e < edges.cols(); ++e) {
    const int at = std::max(index[edges(0, e)], index[edges(1, e)]);
    if (at < 0) continue;
    for (int k = 0; k < 2; ++k) {
      const int part = parts.of_vertex(edges(k, e));
      if (part == RigidParts::kJoint) continue;
      auto entry = std::find_if(touched[at].begin(), touched[at].end(),
                                [&](const auto& known) { return known.second == part; });
      if (entry == touched[at].end()) entry = touched[at].insert(entry, {0, part});
      --entry->first;
    }
  }
  const Shape first = path.Placed(0);
  for (size_t at = 0; at < result.size(); ++at) {
    std::sort(touched[at].begin(), touched[at].end());
    for (const auto& known : touched[at]) result[at].parts.push_back(known.second);
    result[at].position = first.col(result[at].vertex);
  }
  std::stable_sort(
      result.begin(), result.end(),
      [](const DeviationSite& a, const DeviationSite& b) { return a.share > b.share; });
  return result;
}

}  // namespace shapespace
