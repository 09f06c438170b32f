#ifndef SHAPESPACE_PATH_ANCHOR_H_
#define SHAPESPACE_PATH_ANCHOR_H_

#include <vector>

#include <shapespace/path/path.h>

namespace shapespace {

/// Moves each shape of a path rigidly so that the part which `vertices` make up (at least one, each
/// once) goes rigidly from where one pose has it to where the next has it: its centroid along a
/// straight line, turning at constant speed about it. Where two poses have the part in the same
/// place, it stands still between them. As far as the part is not rigid, this holds in the
/// area-weighted L2 sense (Procrustes); what the part leaves open, such as the turn about a single
/// vertex, stays as it was. The poses stay where they are. Beyond the last of several poses the
/// part goes on as it moved before it; with one pose it stays as in that one, without any as in the
/// first shape. \throw InvalidOptions if `vertices` is empty or names one that is not there.
void Anchor(Path* path, const std::vector<int>& vertices);

/// The same for a path that shows `whole` at other times (`Resample`) and need not have its poses:
/// the part moves between the poses of `whole`.
void Anchor(const Path& whole, const std::vector<int>& vertices, Path* path);

/// Moves each shape of a path, poses too, along an axis (0, 1 or 2, for x, y or z) so that its
/// lowest vertex that a polygon or an edge has lies at `height`, in the user's unit and frame.
/// \throw InvalidOptions naming the argument, MeshError if there is no such vertex.
void Ground(Path* path, int axis, double height);

}  // namespace shapespace

#endif  // SHAPESPACE_PATH_ANCHOR_H_
