#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_CHECK_INPUT_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_CHECK_INPUT_H_

#include <string>
#include <vector>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// \throw MeshError if a marker is on a vertex that a body does not have, that no triangle uses or
///        that has another marker, naming the marker, from 1, and what to do about it.
void CheckMarkerVertices(const std::vector<CorrespondenceMarker>& markers,
                         const Connectivity& template_connectivity,
                         const Connectivity& target_connectivity);

/// \throw as CheckMarkerVertices, and if there are fewer than three.
void CheckMarkers(const std::vector<CorrespondenceMarker>& markers,
                  const Connectivity& template_connectivity,
                  const Connectivity& target_connectivity);

/// `on_template` and `on_target` are the markers' positions.
/// \throw MeshError if they lie on one line, or if they fit a mirror image much better than the
///        body.
void CheckPlacement(const Shape& on_template, const Shape& on_target);

/// The shapes are scaled to area 1; `distances` are the template's of `MarkerDistances`.
/// \throw MeshError if one of two closed bodies is inside out, or if the cyclic order of markers
///        around each other, seen from outside, is reversed on the target. Bending changes neither,
///        so this detects mirror images also in other poses.
void CheckHandedness(const Connectivity& template_connectivity, const Shape& template_shape,
                     const Connectivity& target_connectivity, const Shape& target_shape,
                     const std::vector<CorrespondenceMarker>& markers,
                     const Eigen::MatrixXf& distances);

/// The markers that are not doubtful.
std::vector<CorrespondenceMarker> Without(
    const std::vector<CorrespondenceMarker>& markers,
    const std::vector<CorrespondenceSummary::Doubt>& doubtful);

/// Warns of differences in topology that no fit can remove: components, genus, borders.
void WarnOfTopology(const Connectivity& template_connectivity,
                    const Connectivity& target_connectivity,
                    const std::vector<CorrespondenceMarker>& markers,
                    std::vector<std::string>* warnings);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_CHECK_INPUT_H_
