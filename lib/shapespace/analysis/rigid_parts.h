#ifndef SHAPESPACE_ANALYSIS_RIGID_PARTS_H_
#define SHAPESPACE_ANALYSIS_RIGID_PARTS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/path/path.h>

namespace shapespace {

struct RigidPartsOptions {
  /// Greatest root mean square distance, in any shape, of a part's triangles from their positions
  /// under the part's rigid motion, as a share of the square root of the area of the smaller of two
  /// regions that are to be merged. 0.05 is a bend by about 10 degrees in the middle of a limb, or
  /// by 5 between a small part and a large one. In (0, 1].
  double tolerance = 0.05;
  /// Smaller regions, as a share of the surface, are not parts; in (0, 1].
  double least_share = 0.003;
  /// Nor are regions whose edges deviate by more from the first shape (root mean square, in the
  /// worst shape; .01 is one per cent). Positive.
  double most_deviation = 0.1;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// A connected region of the surface that moves nearly rigidly over the whole path.
struct RigidPart {
  int num_triangles = 0;
  int num_vertices = 0;  ///< assigned to it in `RigidParts::of_vertex`
  double area_share = 0;
  /// Its centroid in the first shape, in the user's frame.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  /// Distance of the part from its best rigid motion since the first shape, root mean square over
  /// vertices and shapes: in the user's unit, and as a share of the square root of the part's area.
  double residual = 0, relative_residual = 0;
  /// Root mean square of | |e| / |e_first| - 1 |, weighted by A_e, over its edges and all shapes.
  double edge_deviation = 0;
  /// The largest angle of rotation relative to the first part, in degrees.
  double turn = 0;
};

struct RigidParts {
  static constexpr int kJoint = -1;  ///< of triangles and vertices that belong to no part

  std::vector<RigidPart> parts;  ///< in order of descending size
  Eigen::VectorXi of_triangle;   ///< index of its part, or kJoint
  Eigen::VectorXi of_vertex;     ///< likewise; for vertices at several parts the largest part
  double joint_share = 0;        ///< of the surface
};

/// The nearly rigid parts of a body and the joints between them, from its motion on a path: M.
/// Kilian, N. J. Mitra, H. Pottmann, "Geometric Modeling in Shape Space", section 6 and Figure 5.
///
/// Constant edge lengths are not a sufficient criterion, because on a good path nearly all edges
/// have them. Parts are therefore defined by rigid motion, which also keeps dihedral angles.
/// Starting from single triangles, neighbouring regions are merged in the order of the increase of
/// the error when one rigid motion replaces two (J. H. Ward, "Hierarchical grouping to optimize an
/// objective function", JASA 1963; the error is the squared displacement, integrated over the area,
/// in the worst shape), until the smaller region's error would exceed the tolerance. Regions that
/// are then too small or too strained for a part, or that bend throughout, are joints.
///
/// The result does not depend on units, rigid motions of shapes, threads or, up to rounding, the
/// numbering. If there are more than 9 shapes, 9 evenly spaced ones determine the parts; the
/// figures include all. Time is proportional to the number of triangles, up to a logarithm. A graph
/// has no parts.
/// \throw InvalidOptions.
RigidParts FindRigidParts(const Path& path, const RigidPartsOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_RIGID_PARTS_H_
