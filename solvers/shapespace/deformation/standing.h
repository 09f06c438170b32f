#ifndef SHAPESPACE_DEFORMATION_STANDING_H_
#define SHAPESPACE_DEFORMATION_STANDING_H_

#include <string>
#include <utility>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/mesh/appearance.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// A part of a body that stands for some time, such as a foot.
struct StandingPart {
  std::string name;           ///< for messages; may be empty
  std::vector<int> vertices;  ///< counted from 0; at least one, no repetitions

  /// From which pose to which it stands, counted from 0; one or more intervals, in ascending order.
  std::vector<std::pair<int, int>> poses;
};

/// Options of the deformations, with the defaults for this task.
DeformationOptions StandingDefaults();

/// Outcome of `HoldStandingParts`.
struct StandingSummary {
  Termination termination = Termination::kCancelled;  ///< the worst of all shapes
  int parts = 0, shapes = 0;                          ///< shapes that were deformed
  /// The greatest distance of a standing vertex from its place in any shape, before and after, as a
  /// share of the first shape's diagonal. NaN if no shape was deformed.
  double slide_before = kNotComputed, slide = kNotComputed;
  /// How far a standing vertex is from its place in the next pose in which it stands, the greatest
  /// such distance, as a share of the diagonal. It goes there on a straight line.
  double drift = kNotComputed;
  double edge_rms = kNotComputed;  ///< ShapeError of the shape that was deformed most
  std::vector<std::string> warnings;
  double seconds = 0;

  bool Converged() const { return termination == Termination::kConverged; }
  std::string BriefReport() const;  ///< one line
  std::string ToJson() const;
};

/// \throw InvalidOptions naming the part: no vertex, an invalid or repeated one, one in two parts;
///        intervals that are no poses of a path with `num_poses` of them, or do not ascend.
void CheckStandingParts(const std::vector<StandingPart>& parts, int num_vertices, int num_poses);

/// Deforms the shapes of `path` between its poses such that parts of the body stand where the poses
/// have them, also if several stand at once and a rigid motion (`Anchor`) cannot hold them. In
/// every shape each connected component that has a part is moved rigidly and then deformed by hard
/// handles on all parts (`Deform`); the others move as on the path, and a warning says so. While a
/// part stands, its vertices are in their places; if the path is smooth, it arrives there and
/// leaves with velocity zero. A part that does not stand stays on its own course, changed by the
/// least cubic that has this effect. (Kovar, Schreiner and Gleicher, "Footskate Cleanup for Motion
/// Capture Editing", SCA 2002, treat skeletons.) Poses do not move. Shapes beyond the last pose,
/// and in intervals at neither end of which a part stands, are unchanged. If `progress` asks to
/// stop, `path` is unchanged and the summary says so.
///
/// `path` consists of shapes of `whole`, possibly at other times (`Resample`), and may be `whole`.
/// \throw as CheckStandingParts and Deform.
StandingSummary HoldStandingParts(const Path& whole, const std::vector<StandingPart>& parts,
                                  const DeformationOptions& options, Path* path,
                                  Progress* progress = nullptr);

/// Reads parts from JSON, a list such as
///   [{"name": "left foot", "select": {"ball": {...}}, "poses": [2, 4]}, ...],
/// in which poses and vertices are counted from 1, and vertices are selected (`ReadSelection`) in
/// `shape`. "poses" may be a list of intervals.
/// \throw InvalidOptions naming the part and the field.
std::vector<StandingPart> ReadStandingParts(const std::string& text, const Shape& shape,
                                            const Connectivity& connectivity,
                                            const Appearance& appearance);

}  // namespace shapespace

#endif  // SHAPESPACE_DEFORMATION_STANDING_H_
