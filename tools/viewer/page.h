#ifndef SHAPESPACE_TOOLS_VIEWER_PAGE_H_
#define SHAPESPACE_TOOLS_VIEWER_PAGE_H_

#include <string_view>

namespace shapespace::tools {

/// The viewer that `./dev viewer` has built, as it was when this program was; empty if there was
/// none.
std::string_view ViewerPage();

/// The page that computes motions itself, as `./dev wasm` has built it, likewise.
std::string_view SolverPage();

/// \throw Error, which says what to do, if there was none.
void CheckHasViewer();
void CheckHasSolver();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_VIEWER_PAGE_H_
