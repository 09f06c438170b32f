#ifndef SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_PICTURE_H_
#define SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_PICTURE_H_

#include <vector>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/output/picture.h>

namespace shapespace {

/// A picture for judging a correspondence. Its columns show the template, the target and the fitted
/// template. Its rows show the markers, numbered from 1 and each in a colour of its own, from one
/// side and from the opposite one; coloured patches mapped from the template to the target; and the
/// round-trip error of each vertex (`SurfaceMap::round_trip`), which is large where the map is
/// unreliable. All bodies are drawn in one size and orientation; the markers determine the
/// template's. \throw MeshError if the arguments do not belong together.
RgbImage RenderCorrespondence(const Connectivity& template_connectivity,
                              const Shape& template_shape, const Connectivity& target_connectivity,
                              const Shape& target_shape,
                              const std::vector<CorrespondenceMarker>& markers,
                              const CorrespondenceResult& result);

}  // namespace shapespace

#endif  // SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_PICTURE_H_
