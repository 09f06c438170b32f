#ifndef SHAPESPACE_SKINNING_SKINNING_H_
#define SHAPESPACE_SKINNING_SKINNING_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/output/skinned_path.h>
#include <shapespace/path/path.h>
#include <shapespace/summary/termination.h>

namespace shapespace {

/// Options of a skinning.
struct SkinningOptions {
  /// Number of bones, 1 to 500; 0: as few as are found with which the error is at most `error`.
  int bones = 20;

  /// For `bones` = 0: the permitted root mean square distance of vertices from their places, over
  /// all vertices and shapes, as a share of half the diagonal of the rest pose's bounding box; in
  /// (0, 1). Half of it needs about twice as many bones.
  double error = 0.005;

  /// For `bones` = 0: no more bones than these, 1 to 500. Many engines take 128 at most.
  int most_bones = 128;

  /// Bones that may move a vertex, 1 to 8. Engines read 4; 8 lower the error a little.
  int weights_per_vertex = 4;

  /// Whether bones may also be stretched along their own three axes, which stay perpendicular.
  /// That lowers the error where a body bulges or shears; not every engine plays it.
  bool scale = false;

  /// The shape of the path that is the rest pose, counted from 0. A shape in which no parts touch
  /// is a good choice.
  int rest = 0;

  /// Weights and motions are fitted in turn until an iteration lowers the error by less than this
  /// share of it; in (0, 1).
  double tolerance = 0.002;

  /// 1 or more.
  int max_iterations = 100;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Outcome of a skinning. Distances are those of vertices (without twins) from their places on the
/// path, in the user's unit.
struct SkinningSummary {
  Termination termination = Termination::kCancelled;
  int vertices = 0;
  int shapes = 0;
  int bones = 0;
  int iterations = 0;
  double error = kNotComputed;           ///< root mean square over vertices and shapes
  double relative_error = kNotComputed;  ///< the same as a share of half the diagonal of the rest
                                         ///< pose's bounding box
  double max_error = kNotComputed;       ///< the greatest
  int max_error_vertex = -1;             ///< where that is, counted from 0
  int max_error_shape = -1;              ///< and in which shape
  std::vector<double> errors;     ///< root mean square: at the start, and after each iteration
  Eigen::VectorXd vertex_errors;  ///< root mean square over shapes, of each vertex
  Eigen::VectorXd shape_errors;   ///< root mean square over vertices, of each shape
  std::vector<std::string> warnings;
  double total_seconds = 0;

  bool Converged() const { return termination == Termination::kConverged; }

  /// E_RMS of the literature (L. Kavan, P.-P. Sloan, C. O'Sullivan 2010, and Le and Deng): 1000
  /// times the root mean square of the coordinates of distances, as a share of half the diagonal.
  double LiteratureError() const;

  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct SkinningResult {
  SkinnedPath path;
  SkinningSummary summary;
};

/// Bones whose motion reproduces a path: joints in a tree, their motion in every shape, and weights
/// of vertices, as engines and animators have them. After B. H. Le, Z. Deng, "Smooth Skinning
/// Decomposition with Rigid Bones" (SIGGRAPH Asia 2012); docs/mathematics.md, section 19, says
/// where this differs.
///
/// Vertices are divided into as many clusters as there are to be bones, which move nearly rigidly.
/// Then weights (for motions as they are) and motions (for weights as they are) are fitted in turn,
/// for as long as that lowers the error. Weights are smooth along the surface, and a bone moves
/// what is near. Joints are where neighbouring bones move least relative to each other.
///
/// The result does not depend on threads, and up to rounding not on unit or place: the path scaled
/// and moved rigidly has the scaled and moved bones. Bones without use are left out, with a warning
/// that says why there are fewer than were asked for.
///
/// If `progress` asks to stop, the best result so far is returned.
/// \throw InvalidOptions; MeshError (the path has one shape only, is not valid, or its rest pose
///        has no extent); Cancelled (stopped before there were bones).
SkinningResult Skin(const Path& path, const SkinningOptions& options = {},
                    Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SKINNING_SKINNING_H_
