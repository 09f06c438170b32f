#ifndef SHAPESPACE_OUTPUT_DETAIL_PLAYBACK_H_
#define SHAPESPACE_OUTPUT_DETAIL_PLAYBACK_H_

#include <utility>
#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/output/gltf.h>

namespace shapespace::internal {

/// Decides what `kAutomatic` stands for in a motion of so many shapes, of which `first` and `last`
/// are placed as they are shown: `kLoop` if they are the same but for rounding errors, and there
/// are others between them. Returns other values as they are.
GltfPlayback DecidePlayback(GltfPlayback playback, int shapes, const Shape& first,
                            const Shape& last);

/// Pairs of a time in seconds, ascending from 0, and the parameter of the path that is shown then.
/// Between them the parameter changes linearly. `parameters` ascend from 0 to 1 and are among those
/// of the result; `shapes` is the number of shapes of the whole path, to which `fps` refers.
/// `options.playback` has been decided.
std::vector<std::pair<double, double>> PlaybackMoments(const std::vector<double>& parameters,
                                                       int shapes, const GltfOptions& options);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_PLAYBACK_H_
