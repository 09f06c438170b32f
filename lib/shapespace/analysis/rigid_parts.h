#ifndef SHAPESPACE_ANALYSIS_RIGID_PARTS_H_
#define SHAPESPACE_ANALYSIS_RIGID_PARTS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/path/path.h>

namespace shapespace {

struct RigidPartsOptions {
  /// How far the triangles of a part may be, root mean square and in any shape, from where the
  /// part's rigid motion takes them: as a share of the smaller of two regions that are to become
  /// one (the root of its area). 0.05 is a bend by some 10 degrees in the middle of a limb, or by 5
  /// where a small part joins a large one. In (0, 1].
  double tolerance = 0.05;
  /// Regions with less of the surface are no parts; in (0, 1].
  double least_share = 0.003;
  /// Regions of which edges deviate by more from the first shape (root mean square, in the worst
  /// shape; .01 is one per cent) are no parts either. Positive.
  double most_deviation = 0.1;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// A connected region of the surface that moves nearly rigidly over the whole path.
struct RigidPart {
  int num_triangles = 0;
  int num_vertices = 0;  ///< those that `RigidParts::of_vertex` gives to it
  double area_share = 0;
  /// Its centroid in the first shape, where the user's is.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  /// Distance of the part from its best rigid motion from the first shape, root mean square over
  /// vertices and shapes: in the user's unit, and as a share of the root of the part's area.
  double residual = 0, relative_residual = 0;
  /// | |e| / |e_first| - 1 |, root mean square weighted by A_e, over its edges and all shapes.
  double edge_deviation = 0;
  /// The largest angle by which it turns against the first part, in degrees.
  double turn = 0;
};

struct RigidParts {
  static constexpr int kJoint = -1;  ///< of triangles and vertices in no part

  std::vector<RigidPart> parts;  ///< the largest first
  Eigen::VectorXi of_triangle;   ///< index of the part that has it, or kJoint
  Eigen::VectorXi of_vertex;     ///< of vertices at several parts the largest of these
  double joint_share = 0;        ///< of the surface
};

/// The near-rigid parts of a body, and the joints between them, from how it moves on a path: M.
/// Kilian, N. J. Mitra, H. Pottmann, "Geometric Modeling in Shape Space", section 6 and Figure 5.
///
/// That edges keep their lengths says little: on a good path nearly all do. So this asks for rigid
/// motion, which needs dihedral angles as well: starting from single triangles, neighbouring
/// regions become one, first those that lose least by having one rigid motion between them instead
/// of two (J. H. Ward, "Hierarchical grouping to optimize an objective function", JASA 1963, in
/// the displacement squared and summed over the area, in the worst shape), until the smaller would
/// lose more than the tolerance. What then is too small or too strained for a part, or bends
/// throughout, is joint.
///
/// The result does not depend on units, numbering (but where a choice is down to rounding), on
/// rigid motion of shapes or on threads. Of more than 9 shapes 9 decide, evenly spread; all are in
/// the figures. Time grows in proportion to the triangles, up to a logarithm. A graph has no parts.
/// \throw InvalidOptions.
RigidParts FindRigidParts(const Path& path, const RigidPartsOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_RIGID_PARTS_H_
