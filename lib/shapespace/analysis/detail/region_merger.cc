#include <shapespace/analysis/detail/region_merger.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/LU>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

// Number of shapes, besides the first, that determine the parts: motion along a path is smooth, and
// memory is proportional to triangles times shapes.
constexpr int kMaxShapes = 8;

// Displacements below this, as a share of a region's size, count as no motion; in regions without
// motion, small regions are merged first, so that all grow at the same rate.
constexpr double kNoMotion = 1e-4;

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

// Hashes a pair, for an order that is independent of the position on the mesh.
std::uint64_t Mix(const RegionPair& pair) {
  std::uint64_t x =
      (static_cast<std::uint64_t>(pair.first) << 32) | static_cast<std::uint32_t>(pair.second);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace

std::vector<int> DecidingShapes(int num_shapes) {
  const int count = std::min(kMaxShapes, num_shapes - 1);
  std::vector<int> chosen;
  for (int k = 1; k <= count; ++k) {
    chosen.push_back(static_cast<int>(static_cast<std::int64_t>(num_shapes - 1) * k / count));
  }
  return chosen;
}

Eigen::VectorXd MeanAreas(const Path& path, const std::vector<int>& shapes) {
  const Eigen::Matrix3Xi& triangles = path.metric->connectivity->Triangles();
  Eigen::VectorXd area = Eigen::VectorXd::Zero(triangles.cols());
  const auto add = [&](const Shape& shape) {
    for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
      area(f) += TriangleArea(shape, triangles.col(f));
    }
  };
  add(path.shapes[0]);
  for (const int i : shapes) add(path.shapes[i]);
  area /= area.sum();
  // Degenerate triangles can be merged at no cost, but must not cause a division by zero.
  area = area.cwiseMax(std::numeric_limits<double>::epsilon() / area.size());
  return area / area.sum();
}

RegionMerger::RegionMerger(const Path& path, const RigidPartsOptions& options) : options_(options) {
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
  for (int e = 0; e < connectivity.NumTriangleEdges(); ++e) {
    const IndexLists::Row around = connectivity.TrianglesOfEdges()[e];
    for (int i = 1; i < around.size(); ++i) {
      if (around[i - 1] != around[i]) pairs_.push_back({around[i - 1], around[i], -1});
    }
  }
}

// The increase of the error by merging the two, integrated over the area, in the worst shape.
double RegionMerger::Loss(const RegionPair& pair) const {
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
bool RegionMerger::Fits(const RegionPair& pair) const {
  const double area = std::min(rest_[pair.first].area, rest_[pair.second].area);
  const double size_squared = std::max(area, options_.least_share);
  return pair.loss <= options_.tolerance * options_.tolerance * size_squared * area;
}

void RegionMerger::MeasureLosses() {
  ForIndices(static_cast<int>(pairs_.size()), [&](int i) {
    if (pairs_[i].loss < 0) pairs_[i].loss = Loss(pairs_[i]);
  });
}

// The nearest neighbour of each region, by the loss as distance; -1 if none fits.
std::vector<int> RegionMerger::NearestNeighbours() const {
  const auto cost = [&](const RegionPair& pair) {
    const double area = rest_[pair.first].area + rest_[pair.second].area;
    return std::make_pair(pair.loss + kNoMotion * kNoMotion * area * area, Mix(pair));
  };
  constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::pair<double, std::uint64_t>> best(
      rest_.size(), {std::numeric_limits<double>::infinity(), kLast});
  std::vector<int> nearest(rest_.size(), -1);
  for (const RegionPair& pair : pairs_) {
    if (!Fits(pair)) continue;
    const auto value = cost(pair);
    for (const auto& [self, other] :
         {std::pair(pair.first, pair.second), std::pair(pair.second, pair.first)}) {
      if (value < best[self]) {
        best[self] = value;
        nearest[self] = other;
      }
    }
  }
  return nearest;
}

// Adds the sums of `region` to those of `other`.
void RegionMerger::Join(int region, int other) {
  rest_[other].Add(rest_[region]);
  for (int k = 0; k < shapes_; ++k) {
    const size_t at = static_cast<size_t>(other) * shapes_ + k;
    moved_[at].Add(moved_[static_cast<size_t>(region) * shapes_ + k]);
    residual_[at] = SquaredResidual(rest_[other], moved_[at]);
  }
}

// Leaves out the regions that were joined to others, of smaller numbers: `target` is what each
// belongs to. Returns the new numbers.
std::vector<int> RegionMerger::Renumber(const std::vector<int>& target) {
  std::vector<int> renumbered(target.size());
  int next = 0;
  for (int r = 0; r < static_cast<int>(target.size()); ++r) {
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
    renumbered[r] = next++;
  }
  rest_.resize(next);
  moved_.resize(static_cast<size_t>(next) * shapes_);
  residual_.resize(moved_.size());
  for (int& r : region_) r = renumbered[r];
  return renumbered;
}

// Lists the pairs of regions under their new numbers, each once. The losses of those that `changed`
// (by old numbers) have to be computed again.
void RegionMerger::UpdatePairs(const std::vector<int>& renumbered,
                               const std::vector<bool>& changed) {
  size_t kept = 0;
  for (const RegionPair& pair : pairs_) {
    const auto [low, high] = std::minmax(renumbered[pair.first], renumbered[pair.second]);
    if (low == high) continue;
    const bool again = changed[pair.first] || changed[pair.second];
    pairs_[kept++] = {low, high, again ? -1 : pair.loss};
  }
  pairs_.resize(kept);
  std::sort(pairs_.begin(), pairs_.end(), [](const RegionPair& a, const RegionPair& b) {
    return std::pair(a.first, a.second) < std::pair(b.first, b.second);
  });
  const auto same = [](const RegionPair& a, const RegionPair& b) {
    return a.first == b.first && a.second == b.second;
  };
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end(), same), pairs_.end());
}

// Merges all pairs of regions that are mutual nearest neighbours, by the loss as distance. As long
// as merging two regions does not reduce the distance to a third one, the result is the same as
// that of always merging the pair with the least loss.
bool RegionMerger::Pass() {
  MeasureLosses();
  const std::vector<int> nearest = NearestNeighbours();
  bool joined = false;
  std::vector<int> target(nearest.size());
  std::iota(target.begin(), target.end(), 0);
  std::vector<bool> changed(nearest.size(), false);
  for (int r = 0; r < static_cast<int>(nearest.size()); ++r) {
    const int other = nearest[r];
    if (other < 0 || other > r || nearest[other] != r) continue;
    Join(r, other);
    target[r] = other;
    changed[r] = changed[other] = joined = true;
  }
  if (joined) UpdatePairs(Renumber(target), changed);
  return joined;
}

std::vector<int> RegionMerger::Run(int* count) {
  while (Pass()) {
  }
  *count = static_cast<int>(rest_.size());
  return region_;
}

}  // namespace shapespace::internal
