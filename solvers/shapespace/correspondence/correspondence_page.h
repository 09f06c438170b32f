#ifndef SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_PAGE_H_
#define SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_PAGE_H_

#include <array>
#include <memory>
#include <string>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/output/page.h>

namespace shapespace {

/// A correspondence on a page: the template and the target in their own shapes, side by side. Each
/// place of the template has a colour of its own, which the target has where the map takes that
/// place to. The markers that constrained the fit are picked already, so that a person can mend
/// them and save them. The template is turned and scaled like the target; the names are those of
/// the files, for the command line on the page.
/// \throw MeshError if the arguments do not belong together.
std::array<PageMesh, 2> PageOf(const std::shared_ptr<const Connectivity>& template_connectivity,
                               const Shape& template_shape, const std::string& template_name,
                               const std::shared_ptr<const Connectivity>& target_connectivity,
                               const Shape& target_shape, const std::string& target_name,
                               const CorrespondenceResult& result);

}  // namespace shapespace

#endif  // SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_PAGE_H_
