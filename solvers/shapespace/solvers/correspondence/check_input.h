#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_CHECK_INPUT_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_CHECK_INPUT_H_

#include <string>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/solvers/correspondence.h>

// Private.

namespace shapespace::internal {

/// `name` is the "template" or the "target". \throw MeshError unless it has triangles, and a finite
/// shape of as many vertices, with an area.
void CheckBody(const std::string& name, const Connectivity& connectivity, const Shape& shape);

/// \throw MeshError naming the marker, from 1, and what to do about it.
void CheckMarkers(const std::vector<Marker>& markers, const Connectivity& template_connectivity,
                  const Connectivity& target_connectivity);

/// The markers' places on both bodies. \throw MeshError if they lie on one line, or if they fit a
/// mirror image much better than the body.
void CheckPlacement(const Shape& on_template, const Shape& on_target);

/// \throw MeshError if one of two closed bodies is inside out, or if markers run around each other
/// the other way on the one surface, seen from outside, than on the other. Bends change neither, so
/// that this finds mirror images in other poses. Shapes are such that the areas are 1; `distances`
/// are the template's of `MarkerDistances`.
void CheckHandedness(const Connectivity& template_connectivity, const Shape& template_shape,
                     const Connectivity& target_connectivity, const Shape& target_shape,
                     const std::vector<Marker>& markers, const Eigen::MatrixXf& distances);

/// The markers that are not doubtful.
std::vector<Marker> Without(const std::vector<Marker>& markers,
                            const std::vector<CorrespondenceSummary::Doubt>& doubtful);

/// Where the two surfaces differ as no fit can mend: components, genus, borders.
void WarnOfTopology(const Connectivity& template_connectivity,
                    const Connectivity& target_connectivity, const std::vector<Marker>& markers,
                    std::vector<std::string>* warnings);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_CHECK_INPUT_H_
