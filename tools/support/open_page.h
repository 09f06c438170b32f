#ifndef SHAPESPACE_TOOLS_SUPPORT_OPEN_PAGE_H_
#define SHAPESPACE_TOOLS_SUPPORT_OPEN_PAGE_H_

#include <string>

namespace shapespace::tools {

/// Shows a page in the user's browser, by the program xdg-open. If that is not possible, a note
/// says so.
void OpenPage(const std::string& file);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_OPEN_PAGE_H_
