#ifndef SHAPESPACE_PATH_ANCHOR_H_
#define SHAPESPACE_PATH_ANCHOR_H_

#include <vector>

#include <shapespace/path/path.h>

namespace shapespace {

/// Moves each shape of a path rigidly so that the part made up of `vertices` (at least one, no
/// repetitions) moves rigidly from its position in one pose to that in the next: its centroid on a
/// straight line, with a rotation at constant speed about it. Where two poses have the part in the
/// same position, it stands still between them. If the path is smooth, the part goes on cubics
/// instead, with the path's own velocities at the poses, of which each is at most three times the
/// slower mean velocity beside it, so that it also stands still between two poses that have it in
/// the same position. If the part is not rigid, this holds in the
/// area-weighted L2 sense (Procrustes). Motion that the part does not determine, such as the
/// rotation about a single vertex, is unchanged. The poses do not move. Beyond the last of several
/// poses the part continues its previous motion; with one pose it stays as in that pose, without
/// poses as in the first shape.
/// \throw InvalidOptions if `vertices` is empty or contains an invalid index.
void Anchor(Path* path, const std::vector<int>& vertices);

/// The same for a path that consists of shapes of `whole` at other times (`Resample`) and need not
/// contain its poses: the part moves between the poses of `whole`.
void Anchor(const Path& whole, const std::vector<int>& vertices, Path* path);

/// Moves each shape of a path, including poses, along an axis (0, 1 or 2, for x, y or z) so that
/// its lowest vertex that belongs to a polygon or an edge lies at `height`, in the user's unit and
/// frame.
/// \throw InvalidOptions naming the argument, MeshError if there is no such vertex.
void Ground(Path* path, int axis, double height);

}  // namespace shapespace

#endif  // SHAPESPACE_PATH_ANCHOR_H_
