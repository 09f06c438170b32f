#ifndef SHAPESPACE_MATCHING_DETAIL_CANDIDATE_FIGURES_H_
#define SHAPESPACE_MATCHING_DETAIL_CANDIDATE_FIGURES_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/detail/zoomout.h>

namespace shapespace::internal {

/// Directions in which maps are known: both, or, of a target that is a part, to the template alone.
enum class Directions { kBoth, kToTemplate };

/// What tells a good map of two bodies from a bad one without fitting anything. The bodies are kept
/// by reference. A map's vertices are indices into MatchingBody::spread.
class CandidateFigures {
 public:
  CandidateFigures(const MatchingBody& on_template, const MatchingBody& on_target,
                   Directions directions = Directions::kBoth);

  /// The map with an image for every vertex of MatchingBody::spread of both bodies, which the
  /// figures need.
  SpectralMap WithAllImages(const SpectralMap& map) const;

  /// The correlation of n . (grad f x grad g) on one body, f and g the images of the other's first
  /// eigenfunctions, with the same on the other; the mean of the directions. 1 for a map that
  /// keeps the orientation, -1 for one that reverses it.
  double Orientation(const SpectralMap& map) const;

  /// The mean of the correlations, in all directions, of the smoothed mean curvature, positive
  /// where the surface is convex, with that at the images; near the border of a part it counts
  /// nothing.
  double Curvature(const SpectralMap& map) const;

  /// For each map, the mean relative change of distances,
  ///   |d(x, y) - d(Tx, Ty)| / ((d(x, y) + d(Tx, Ty)) / 2 + 0.1),
  /// in all directions, over pairs of a few samples with more of them. On all threads.
  std::vector<double> Isometry(const std::vector<SpectralMap>& maps) const;

 private:
  struct Side {
    explicit Side(const MatchingBody& body);

    // The turns of functions on this body, the images of the other's first ones by
    // `coefficients`, correlated with the other's own at the images of vertices.
    double Correlate(const Eigen::MatrixXf& coefficients, const std::vector<int>& images,
                     const Side& other) const;

    const MatchingBody& body;
    Eigen::MatrixXf between;    // distances from some samples (rows) to others
    Eigen::VectorXf curvature;  // at body.spread
    Eigen::MatrixXf functions;  // at all vertices, n x count
    Eigen::MatrixXf at_spread;  // the same at body.spread, count x vertices
    Eigen::MatrixXf turns;      // of the first functions, at body.spread
  };

  const Side template_, target_;
  const Directions directions_;
  std::vector<int> inner_;  // indices into the target's spread vertices, whose curvature counts
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_CANDIDATE_FIGURES_H_
