#ifndef SHAPESPACE_MESH_MIRRORED_H_
#define SHAPESPACE_MESH_MIRRORED_H_

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Whether `pose` (3 x m, any unit) is a mirror image of `reference` (3 x m), each possibly moved
/// and in a posture of its own. `triangles` (3 x T, vertices of each in its orientation) may be
/// open. Hinges tell: a mirror image has the same edge lengths and the opposite dihedral angles, so
/// that what bulges to one side of the surface in the reference bulges to the other.
///
/// What bending alone can turn over is no mirror image: flat and rolled sheets, folded paper, and
/// dents that are shallower than a few per cent of their width. Nor is a body only a part of which
/// is turned inside out. A dome that has been pushed through cannot be told from a mirror image.
/// docs/checks.md has the figures that decide.
bool IsMirrored(const Eigen::Matrix3Xi& triangles, const Shape& reference, const Shape& pose);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_MIRRORED_H_
