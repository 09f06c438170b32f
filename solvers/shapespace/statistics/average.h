#ifndef SHAPESPACE_STATISTICS_AVERAGE_H_
#define SHAPESPACE_STATISTICS_AVERAGE_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

struct AverageOptions {
  /// One per pose, not negative, not all zero; any sum. Poses of weight zero are left out. Empty:
  /// all equal.
  std::vector<double> weights;

  /// Whether the mean is compared with a lower bound, which takes a geodesic from it to each pose.
  bool certify = true;

  /// Whether the mean of the features is only the start, from which the sum of squared lengths of
  /// geodesics is lowered: the Frechet mean. Implies `certify`, and takes several times its time.
  bool refine = false;

  /// Converged when an iteration lowers the squared distance from the mean features by less than
  /// this share of the poses' variance.
  double tolerance = 1e-10;

  int max_iterations = 200;

  /// The metric, and how geodesics of the certificate are solved. The default of their number of
  /// shapes is 7.
  GeodesicOptions geodesic = Defaults();

  static GeodesicOptions Defaults() {
    GeodesicOptions options;
    options.shapes = 7;
    return options;
  }

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Outcome of an average.
struct AverageSummary {
  Termination termination = Termination::kCancelled;
  int vertices = 0, triangles = 0, poses = 0;
  std::string metric;
  double unit = kNotComputed;  ///< length in the user's unit that has length 1 in the metric
  /// Weighted mean of the squared distances of the poses' features from their mean, in the metric.
  double variance = kNotComputed;
  /// Squared distance of the average's features from that mean, as a share of the variance: 0 if
  /// there is a shape whose lengths and angles are exactly the means. NaN if the poses are copies.
  double residual = kNotComputed;
  /// The weighted mean of the squared lengths of the geodesics from the average to the poses, and a
  /// lower bound of it for any shape in place of the average. NaN without `certify`.
  double energy = kNotComputed, lower_bound = kNotComputed;
  /// Of the logarithms of edge lengths, the rms of their difference from the weighted means over
  /// the poses, weighted by area.
  double edge_rms = kNotComputed;
  /// Hinges that are bent in so different ways that their mean angle is not determined: no half
  /// circle contains their angles in all poses.
  int ambiguous_hinges = -1;
  int iterations = 0;
  int refinements = 0;               ///< rounds of `refine`
  double refined_by = kNotComputed;  ///< by which share these lowered `energy`; NaN without
  std::vector<std::string> warnings;
  double estimated_bytes = 0;  ///< of memory, before the solve
  double certificate_seconds = 0, total_seconds = 0;

  bool Converged() const { return termination == Termination::kConverged; }
  /// energy / lower_bound: 1 is a proof that no shape is a better mean. Of copies of one shape both
  /// are zero, and the ratio is defined as 1; NaN without `certify`.
  double Ratio() const { return energy == 0 && lower_bound == 0 ? 1 : energy / lower_bound; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct AverageResult {
  Shape shape;  ///< in the user's unit and frame, at the mean of the poses' places
  AverageSummary summary;
};

/// The weighted mean of poses of a mesh: the shape whose features (strains, dihedral angles,
/// positions) are nearest to the means of the poses' features. In a pull-back metric this is the
/// shape with the least sum of squared one-segment distances to the poses; it is near to their
/// Frechet mean, and `AverageSummary::Ratio` says how near (docs/mathematics.md, section 16).
/// Angles are averaged on the circle. Poses are aligned to each other first (generalised
/// Procrustes).
/// \throw InvalidOptions (options; a metric with a rigid part or in trapezoid form; weights
///        that are not one for each pose), MeshError (no pose; see FreezeMetric), SolverError
///        (memory limit), Cancelled (stopped by `progress` before there was an average; if stopped
///        while it is certified, the summary has no bound and says kCancelled).
AverageResult Average(const std::shared_ptr<const Connectivity>& connectivity,
                      const std::vector<Shape>& poses, const AverageOptions& options = {},
                      Progress* progress = nullptr);
AverageResult Average(const Poses& poses, const AverageOptions& options = {},
                      Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_STATISTICS_AVERAGE_H_
