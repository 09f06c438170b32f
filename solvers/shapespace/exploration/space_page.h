#ifndef SHAPESPACE_EXPLORATION_SPACE_PAGE_H_
#define SHAPESPACE_EXPLORATION_SPACE_PAGE_H_

#include <string>

#include <shapespace/exploration/space.h>
#include <shapespace/output/page.h>

namespace shapespace {

/// A space on a page, with a name there, such as its file's.
PageSpace PageOf(const PoseSpace& space, const std::string& name);

}  // namespace shapespace

#endif  // SHAPESPACE_EXPLORATION_SPACE_PAGE_H_
