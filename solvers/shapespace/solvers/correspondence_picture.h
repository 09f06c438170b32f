#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_PICTURE_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_PICTURE_H_

#include <vector>

#include <shapespace/output/picture.h>
#include <shapespace/solvers/correspondence.h>

namespace shapespace {

/// A picture to judge a correspondence by. In three columns the template, the target, and the
/// template as fitted; in three rows the markers, each in a colour of its own, patches of colour
/// that are carried from the template to the target, and how far each vertex comes back from itself
/// (`SurfaceMap::round_trip`): where that is much, nobody should trust the map. All are drawn in
/// one size, and turned alike by the markers. \throw MeshError if the arguments are not of each
/// other.
Image RenderCorrespondence(const Connectivity& template_connectivity, const Shape& template_shape,
                           const Connectivity& target_connectivity, const Shape& target_shape,
                           const std::vector<Marker>& markers, const CorrespondenceResult& result);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_PICTURE_H_
