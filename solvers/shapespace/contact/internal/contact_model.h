#ifndef SHAPESPACE_CONTACT_INTERNAL_CONTACT_MODEL_H_
#define SHAPESPACE_CONTACT_INTERNAL_CONTACT_MODEL_H_

#include <memory>
#include <vector>

#include <shapespace/analysis/near_pairs.h>
#include <shapespace/contact/detail/pair_potential.h>
#include <shapespace/contact/obstacle.h>
#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// Which elements of a surface repel each other on the way between some poses, and those of an
/// obstacle, and how. The vertices of the obstacle have numbers after those of the body. Immutable.
class ContactModel {
 public:
  /// Elements round an intersection of a pose with itself or with the obstacle: whether they do not
  /// repel each other, because on which side of each other they are to be is not known. It takes
  /// time to find them.
  enum class Intersections { kExempt, kNotExempt };

  /// `poses` are in the metric's unit; aligned, or in the frame of `obstacle`, which is null if
  /// there is none, in the same unit. No pair repels in them.
  ContactModel(std::shared_ptr<const Metric> metric, std::vector<Shape> poses,
               Intersections intersections, const Obstacle* obstacle = nullptr);

  /// The number of pairs of triangles, or segments, that intersect in one of the poses, if they are
  /// exempt.
  int NumIntersections() const { return num_intersections_; }

  const std::shared_ptr<const Metric>& GetMetric() const { return metric_; }
  bool HasObstacle() const { return obstacle_.connectivity != nullptr; }
  bool IsOfBody(int vertex) const { return vertex < metric_->connectivity->NumVertices(); }

  /// As NearPairs::Find and Length, for shapes of the body.
  std::vector<NearPair> Find(const Shape& from, const Shape& to, double share, double margin) const;
  double Length(const NearPair& pair) const { return pairs_.Length(pair); }

  /// The points of a pair, some of which may be the obstacle's.
  FourPoints At(const NearPair& pair, const Shape& shape) const {
    return Points(pair, shape, obstacle_.shape);
  }
  /// Their velocities.
  FourPoints ChangeAt(const NearPair& pair, const Tangent& tangent) const {
    return Points(pair, tangent, at_rest_);
  }

  /// The reach is at most `kReach` times the pair's length, and less than the pair's distance in
  /// each pose.
  static constexpr double kReach = 0.4;
  PairPotential PotentialOf(const NearPair& pair) const;

  /// The mean of the lengths at the vertices.
  double MeanLength() const { return mean_length_; }

  /// Whether nothing touches during the straight motion from one shape to another. A motion during
  /// which something comes very near may be taken for one that is not free, but not the other way
  /// round.
  bool IsFree(const Shape& from, const Shape& to) const;

 private:
  FourPoints Points(const NearPair& pair, const Shape& body, const Shape& obstacle) const {
    FourPoints points;
    for (int k = 0; k < 4; ++k) {
      const int v = pair.vertices[k];
      points.col(k) =
          IsOfBody(v) ? body.col(v) : obstacle.col(v - metric_->connectivity->NumVertices());
    }
    return points;
  }
  std::shared_ptr<const Metric> metric_;
  std::vector<Shape> poses_;
  Obstacle obstacle_;            // empty if there is none
  Tangent at_rest_;              // zero, of its size
  Eigen::VectorXd vertex_area_;  // of the body and the obstacle
  int num_intersections_ = 0;
  NearPairs pairs_;
  double mean_length_ = 0;
};

/// Whether a pair touches nothing while its points move on straight lines. Parts that come nearer
/// to each other than a thousandth of the pair's length count as touching, unless they are not much
/// farther away at the beginning.
inline bool IsFree(PairKind kind, const FourPoints& from, const FourPoints& to, double length) {
  constexpr double kKept = 0.05, kTouching = 1e-3;
  return SafeStep(kind, from, to - from, kKept, kTouching * length) == 1;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_INTERNAL_CONTACT_MODEL_H_
