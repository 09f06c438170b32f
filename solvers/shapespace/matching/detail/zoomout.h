#ifndef SHAPESPACE_MATCHING_DETAIL_ZOOMOUT_H_
#define SHAPESPACE_MATCHING_DETAIL_ZOOMOUT_H_

#include <map>
#include <vector>

#include <Eigen/Core>

#include <shapespace/matching/detail/spectrum.h>

namespace shapespace::internal {

/// Eigenfunctions of a body at chosen vertices. The first `samples` of them determine a map, all of
/// them are candidates for images.
class SpectralPoints {
 public:
  /// Prepared for each number of functions in `counts`.
  SpectralPoints(const Spectrum& spectrum, const std::vector<int>& vertices, int samples,
                 const std::vector<int>& counts);

  int NumSamples() const { return samples_; }
  /// The functions at the vertices, as many as the greatest count x vertices.
  const Eigen::MatrixXf& Functions() const { return functions_; }
  /// The coefficients of the first `count` functions with which they are nearest to `values`
  /// (functions x samples), which are known at the samples: count x functions.
  Eigen::MatrixXf Coefficients(int count, const Eigen::MatrixXf& values) const;

 private:
  int samples_;
  Eigen::MatrixXf functions_;
  std::map<int, Eigen::MatrixXf> inverses_;  // per count, count x samples
};

/// A map between two bodies in both directions: of vertices, as indices into the vertices of the
/// other body's SpectralPoints, for the samples of each; and of functions.
struct SpectralMap {
  std::vector<int> to_target, to_template;
  /// Coefficients of a function on the target -> of that function on the template, and the
  /// reverse: k x k. Empty before the first step.
  Eigen::MatrixXf from_target, from_template;
  /// Of a map of a part: lengths on the target, times this, are those on the template.
  double scale = 1;
};

/// One step of ZoomOut in both directions (S. Melzi, J. Ren, E. Rodola, A. Sharma, P. Wonka and M.
/// Ovsjanikov, "ZoomOut: spectral upsampling for efficient shape correspondence", 2019; J. Ren, S.
/// Melzi, M. Ovsjanikov and P. Wonka, "MapTree: recovering multiple solutions in the space of
/// maps", 2020): the maps of `count` functions that are nearest to those of vertices, and then the
/// maps of vertices that are nearest to those of functions.
void ZoomOut(const SpectralPoints& on_template, const SpectralPoints& on_target, int count,
             SpectralMap* map);

/// One step for a target that is a part of what the template is, enlarged by map->scale: from the
/// target to the template alone, with `count` functions of the template and, of the target,
/// `target_count`, those that vary no faster (E. Rodola, L. Cosmo, M. Bronstein, A. Torsello and D.
/// Cremers, "Partial functional correspondence", 2017). Of map->to_target nothing is known.
void ZoomOutFromPart(const SpectralPoints& on_template, const SpectralPoints& on_target, int count,
                     int target_count, SpectralMap* map);

/// Points of both bodies in the space in which ZoomOut searches the nearest ones, a column for each
/// column of the given functions, of which those of the map are used.
struct AlignedPoints {
  Eigen::MatrixXf on_template, on_target;
};
AlignedPoints Align(const Eigen::MatrixXf& template_functions,
                    const Eigen::MatrixXf& target_functions, const SpectralMap& map);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_ZOOMOUT_H_
