#include <shapespace/analysis/quality.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <shapespace/analysis/detail/straight_lengths.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/path/energy.h>

namespace shapespace {
namespace {

using internal::kDegrees;

// Pieces slower than this, in the metric's pure numbers, are at rest up to rounding.
constexpr double kNoSpeed = 1e-9;

// Deviations of one shape's edges, to be combined with those of others.
struct Deviations {
  double weighted_squares = 0, weight = 0;
  std::vector<float> magnitudes;

  void Add(double ratio, double area) {
    weighted_squares += area * (ratio - 1) * (ratio - 1);
    weight += area;
    magnitudes.push_back(static_cast<float>(std::abs(ratio - 1)));
  }
};

void Pool(const std::vector<Deviations>& shapes, double* rms, double* p99, double* max) {
  Deviations all;
  for (const Deviations& d : shapes) {
    all.weighted_squares += d.weighted_squares;
    all.weight += d.weight;
    all.magnitudes.insert(all.magnitudes.end(), d.magnitudes.begin(), d.magnitudes.end());
  }
  if (all.magnitudes.empty()) return;
  *rms = std::sqrt(all.weighted_squares / all.weight);
  const auto rank = all.magnitudes.begin() + (all.magnitudes.size() - 1) * 99 / 100;
  std::nth_element(all.magnitudes.begin(), rank, all.magnitudes.end());
  *p99 = *rank;
  *max = *std::max_element(rank, all.magnitudes.end());
}

// Squared lengths of edges in the first shape, and the square of the length below which edges are
// not counted.
struct FirstLengths {
  explicit FirstLengths(const Path& path)
      : squared(internal::SquaredLengths(*path.metric->connectivity, path.shapes[0])),
        shortest(internal::SquaredShortest(squared)) {}

  Eigen::VectorXd squared;
  double shortest;
};

// Deviations from the first shape, of edges of these squared lengths.
Deviations AgainstFirst(const Path& path, const FirstLengths& first,
                        const Eigen::VectorXd& squared_lengths) {
  Deviations deviations;
  deviations.magnitudes.reserve(squared_lengths.size());
  for (int e = 0; e < squared_lengths.size(); ++e) {
    if (first.squared(e) > first.shortest) {
      deviations.Add(std::sqrt(squared_lengths(e) / first.squared(e)), path.metric->edge_area(e));
    }
  }
  return deviations;
}

// What an inner shape adds to the figures of its path.
struct InnerFigures {
  Deviations edges;
  double roughness = 0;  // squared deviations of dihedral angles, weighted by area
  int folds = 0;
};

// Compares shapes between two poses with what lies between these: edge lengths on the straight line
// in the metric's values, and dihedral angles between those of the poses.
class BetweenPoses {
 public:
  explicit BetweenPoses(const Path& path) : path_(path), angles_(path.poses.size()) {
    ParallelFor(static_cast<int>(path.poses.size()), [&](int i) {
      angles_[i] = DihedralAngles(*path.metric->connectivity, path.shapes[path.poses[i]]);
    });
    for (size_t piece = 0; piece + 1 < path.poses.size(); ++piece) {
      straight_.emplace_back(path.metric, path.shapes[path.poses[piece]],
                             path.shapes[path.poses[piece + 1]]);
    }
  }

  // Nothing for poses, and for shapes before the first or after the last pose. Edges have these
  // squared lengths in the shape; they are counted if it should be above `shortest`.
  InnerFigures Of(int i, const Eigen::VectorXd& lengths, double shortest) const {
    InnerFigures figures;
    const auto next = std::lower_bound(path_.poses.begin(), path_.poses.end(), i);
    if (next == path_.poses.begin() || next == path_.poses.end() || *next == i) return figures;
    const size_t piece = next - 1 - path_.poses.begin();
    const double begin = path_.parameters[*(next - 1)], end = path_.parameters[*next];
    const double t = (path_.parameters[i] - begin) / (end - begin);
    const Metric& metric = *path_.metric;
    const Eigen::VectorXd expected = straight_[piece].SquaredAt(t);
    figures.edges.magnitudes.reserve(lengths.size());
    for (int e = 0; e < lengths.size(); ++e) {
      if (expected(e) > shortest) {
        figures.edges.Add(std::sqrt(lengths(e) / expected(e)), metric.edge_area(e));
      }
    }
    const Eigen::VectorXd angles = DihedralAngles(*metric.connectivity, path_.shapes[i]);
    for (int h = 0; h < angles.size(); ++h) {
      const double angle_m = angles_[piece](h), angle_n = angles_[piece + 1](h);
      const double off = WrapAngle(angles(h) - (angle_m + t * WrapAngle(angle_n - angle_m)));
      figures.roughness += metric.hinge_area(h) * off * off;
      const double beyond = std::abs(angles(h)) - std::max(std::abs(angle_m), std::abs(angle_n));
      if (std::abs(angles(h)) * kDegrees > 120 && beyond * kDegrees > 40) ++figures.folds;
    }
    return figures;
  }

 private:
  const Path& path_;
  std::vector<Eigen::VectorXd> angles_;              // of each pose
  std::vector<internal::StraightLengths> straight_;  // of each pair of them
};

}  // namespace

RmsAndMax DeviationFromFirst(const Path& path, int i) {
  RmsAndMax figures;
  double p99 = 0;
  if (i == 0) return figures;
  const FirstLengths first(path);
  Pool({AgainstFirst(path, first,
                     internal::SquaredLengths(*path.metric->connectivity, path.shapes[i]))},
       &figures.rms, &p99, &figures.max);
  return figures;
}

PathQuality MeasureQuality(const Path& path) {
  const Metric& metric = *path.metric;
  const int num_shapes = path.NumShapes();
  const FirstLengths first(path);
  const BetweenPoses poses(path);
  std::vector<Deviations> between(num_shapes), against_first(num_shapes);
  std::vector<double> roughness(num_shapes, 0), folds(num_shapes, 0);
  ParallelFor(num_shapes, [&](int i) {
    const Eigen::VectorXd lengths = internal::SquaredLengths(*metric.connectivity, path.shapes[i]);
    if (i > 0) against_first[i] = AgainstFirst(path, first, lengths);
    InnerFigures figures = poses.Of(i, lengths, first.shortest);
    between[i] = std::move(figures.edges);
    roughness[i] = figures.roughness;
    folds[i] = figures.folds;
  });

  PathQuality quality;
  for (size_t piece = 0; piece + 1 < path.poses.size(); ++piece) {
    const int begin = path.poses[piece], end = path.poses[piece + 1] + 1;
    quality.inner_shapes += end - begin - 2;
    const double speed =
        GreatestSpeed(metric, {path.shapes.begin() + begin, path.shapes.begin() + end},
                      {path.parameters.begin() + begin, path.parameters.begin() + end});
    if (!(speed <= quality.speed_max)) quality.speed_max = speed;
  }
  ParallelFor(2, [&](int which) {
    if (which == 0) {
      Pool(between, &quality.edge_rms, &quality.edge_p99, &quality.edge_max);
    } else {
      Pool(against_first, &quality.first_rms, &quality.first_p99, &quality.first_max);
    }
  });
  const double hinge_area = metric.hinge_area.sum();
  double squares = 0, all_folds = 0;
  for (int i = 0; i < num_shapes; ++i) {
    squares += roughness[i];
    all_folds += folds[i];
  }
  const int inner = quality.inner_shapes;
  if (inner > 0) quality.folds = all_folds / inner;
  if (inner > 0 && hinge_area > 0) {
    quality.roughness = kDegrees * std::sqrt(squares / (hinge_area * inner));
  }
  return quality;
}

Eigen::VectorXd DihedralAngles(const Connectivity& connectivity, const Shape& shape) {
  Dihedral dihedral;
  dihedral.stencils = connectivity.Hinges();
  dihedral.normal_epsilon_squared = dihedral.edge_epsilon_squared = 1e-30;  // below rounding
  Eigen::VectorXd angles(connectivity.NumHinges());
  for (int h = 0; h < angles.size(); ++h) {
    double x[3 * Dihedral::kVertices];
    GatherCoordinates(dihedral, h, shape, x);
    angles(h) = dihedral.Angle(x);
  }
  return angles;
}

double GreatestSpeed(const Metric& metric, const std::vector<Shape>& shapes,
                     const std::vector<double>& times) {
  const int segments = static_cast<int>(shapes.size()) - 1;
  const std::vector<double> length = ChordLengths(metric, shapes);
  double sum = 0, greatest = 0;
  for (int i = 0; i < segments; ++i) {
    sum += length[i];
    greatest = std::max(greatest, length[i] / (times[i + 1] - times[i]));
  }
  if (std::isnan(sum)) return sum;
  const double mean = sum / (times.back() - times.front());
  return mean > kNoSpeed ? greatest / mean : 1;  // a rigid copy stands still
}

Eigen::VectorXd EdgeDeviation(const Metric& metric, const Shape& reference, const Shape& shape) {
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  const int num_vertices = metric.connectivity->NumVertices();
  Eigen::VectorXd deviation = Eigen::VectorXd::Zero(num_vertices);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(num_vertices);
  const Eigen::VectorXd first = internal::SquaredLengths(*metric.connectivity, reference);
  const Eigen::VectorXd lengths = internal::SquaredLengths(*metric.connectivity, shape);
  for (int e = 0; e < edges.cols(); ++e) {
    if (first(e) == 0) continue;
    const double value = std::abs(std::sqrt(lengths(e) / first(e)) - 1);
    for (int k = 0; k < 2; ++k) {
      deviation(edges(k, e)) += metric.edge_area(e) * value;
      weight(edges(k, e)) += metric.edge_area(e);
    }
  }
  deviation = (weight.array() > 0).select(deviation.cwiseQuotient(weight), 0);
  metric.connectivity->CopyToTwins(&deviation);
  return deviation;
}

}  // namespace shapespace
