#ifndef SHAPESPACE_MATCHING_INTERNAL_MATCHING_H_
#define SHAPESPACE_MATCHING_INTERNAL_MATCHING_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

struct MatchingBody;

/// How candidates of maps are sought and chosen.
struct MatchingOptions {
  /// Assignments of extremities from which maps are made. Exchanges of left and right cost the same
  /// within 1 %, so that the true assignment was anywhere among the first 4 of people and the first
  /// 10 of dogs.
  int assignments = 24;
  /// Candidates that are returned. The right one was the eighth of two animals.
  int max_candidates = 8;
  /// Candidates with less are refused: maps that keep the outside outside have 0.4 to 0.98, those
  /// that do not -0.9.
  double least_orientation = 0.2;
  /// Candidates whose cost is greater than this many times the least are left out.
  double cost_ratio = 1.5;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Added to each figure that says how unlike bodies are. Less of it is the difference of two meshes
/// of one body, which must not tell between maps.
inline constexpr double kAlike = 0.01;

/// How unlike two bodies are where a map joins them; 0 for a body and another pose of it.
struct MapFigures {
  double isometry = kNotComputed;   ///< mean relative change of distances along the surface
  double curvature = kNotComputed;  ///< mean difference of mean curvatures, each in units of its
                                    ///< body's own and at most 1
  double heat = kNotComputed;       ///< mean difference of logarithms of heat kernels, which depend
                                    ///< on what is within a tenth of the body's size

  /// Their product, each with kAlike more.
  double Cost() const;
};

/// A map between template and target, or of a target that is a part to the template, that was found
/// from their inner geometry alone. Vertices have the numbers that they have in the two bodies.
struct MapCandidate {
  std::vector<std::pair<int, int>> extremities;  ///< which of the template is which of the target
  /// Pairs of corresponding vertices, spread over the body: first those that were given, then
  /// extremities, then others. All but the given ones are 2 to 5 % of the root of the area off, on
  /// average, those between bodies of very different proportions up to 10 %.
  std::vector<std::pair<int, int>> markers;
  double isometry = kNotComputed;     ///< mean relative change of distances along the surface
  double curvature = kNotComputed;    ///< correlation of mean curvature, at most 1
  double orientation = kNotComputed;  ///< 1 if the map keeps outsides outside, -1 if it does not
  /// The map of functions: coefficients in the target's first k eigenfunctions -> those in the
  /// template's, and the reverse, k x k; of a part, whose functions are fewer, k x l and l x k.
  Eigen::MatrixXf from_target, from_template;

  /// Less is better. It says whether a candidate is worth a fit, not which is right.
  double Cost() const;
};

struct Matching {
  /// Cheapest first; all of them keep orientation. Empty if `problem` says why.
  std::vector<MapCandidate> candidates;
  /// Why there are no candidates, as a sentence for the user that says of which body; empty if
  /// there are some.
  std::string problem;
  int template_extremities = 0, target_extremities = 0;
  int maps = 0;          ///< different ones that were made of assignments
  int maps_refused = 0;  ///< of these, because they reverse orientation or contradict pairs
  double assignment_seconds = 0, map_seconds = 0, figure_seconds = 0, marker_seconds = 0;
};

/// Finds maps between two bodies of any connectivity, in any poses, without markers, from distances
/// along the surfaces and eigenfunctions of their Laplacians, none of which changes under bending.
/// Extremities of both bodies are assigned to each other in several ways, each of which becomes a
/// map by ZoomOut; figures of the maps say which of them are worth a fit. Of bodies with several
/// components the one of the largest area is mapped.
///
/// A target with a long border is taken for a part of what the template is, if that has none: maps
/// then go from the target to the template alone, under several scales, and extremities on the
/// border are none.
///
/// Position, orientation and size of the bodies do not matter. Results are the same for any number
/// of threads. Meshes of more than some ten thousand vertices are decimated first; all else takes
/// no more time and memory for them.
class SurfaceMatcher {
 public:
  /// Prepares both bodies.
  /// \throw InvalidOptions; MeshError (no triangles, no area, a shape that is not finite or has
  ///        another number of vertices); SolverError if memory runs out; Cancelled.
  SurfaceMatcher(const Connectivity& template_connectivity, const Shape& template_shape,
                 const Connectivity& target_connectivity, const Shape& target_shape,
                 const MatchingOptions& options = {}, Progress* progress = nullptr);
  ~SurfaceMatcher();

  /// Whether the target is taken for a part of what the template is: it is open, which the template
  /// is not, and has two extremities at least.
  bool TargetIsPart() const;

  /// `given` are pairs of vertices that are known to correspond; a single one may settle what is
  /// left and right. Candidates that contradict them are refused.
  /// \throw MeshError if a body has no such vertex; Cancelled.
  Matching FindCandidates(const std::vector<std::pair<int, int>>& given = {},
                          Progress* progress = nullptr) const;

  /// Of a target that is a part: markers of a map that was fitted with those of a candidate, as
  /// there, with finer detail, and without those on whose place the fit does not agree.
  /// `to_template` has for each vertex of the target the one of the template nearest to its place
  /// in the fit.
  /// \throw MeshError if it has another number of entries, or entries out of range; Cancelled.
  std::vector<std::pair<int, int>> RefinePartMarkers(
      const MapCandidate& candidate, const std::vector<int>& to_template,
      const std::vector<std::pair<int, int>>& given = {}, Progress* progress = nullptr) const;

  /// The given pairs, and pairs of a map of the target to the template (`to_template`: a vertex of
  /// it for each of the target) up to `count` in all: vertices that are spread evenly over the
  /// target, and their images. No vertex is in two pairs that are not given.
  std::vector<std::pair<int, int>> SpreadPairs(const std::vector<int>& to_template, size_t count,
                                               const std::vector<std::pair<int, int>>& given) const;

  /// Judges a map that sends vertices of the template to such `images`, a vertex of the target for
  /// each, where both are on the largest components.
  MapFigures Compare(const std::vector<int>& vertices, const std::vector<int>& images) const;

  /// For each vertex of the template the one of these `vertices` of it that is nearest along the
  /// surface, as an index into them; -1 where there is none, as outside of the largest component.
  std::vector<int> NearestOf(const std::vector<int>& vertices) const;

  /// A candidate's map: for each vertex of the template one of the target, -1 for those that are
  /// not connected to the largest component.
  std::vector<int> MapVertices(const MapCandidate& candidate) const;

  double Seconds() const { return seconds_; }  ///< that preparing the bodies took

 private:
  const MatchingOptions options_;
  std::unique_ptr<const MatchingBody> template_, target_;
  double seconds_ = 0;
};

/// The end of a limb, and how far each vertex is from it along the surface, in the unit of the
/// shape; infinite where there is no connection.
struct LimbEnd {
  int vertex = -1;
  Eigen::VectorXf distances;
};

/// The ends of the limbs, tail and head of the component with the largest area; three at least, if
/// it has so many extremities.
/// \throw MeshError as `SurfaceMatcher`.
std::vector<LimbEnd> FindLimbEnds(const Connectivity& connectivity, const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_INTERNAL_MATCHING_H_
