#include <shapespace/base/error.h>

#include "viewer/page.h"

namespace shapespace::tools {

void CheckHasViewer() {
  if (!ViewerPage().empty()) return;
  throw Error(
      "this program was built without the viewer page. In the source folder, run ./dev viewer, "
      "which needs npm, and then ./dev build");
}

void CheckHasSolver() {
  if (!SolverPage().empty()) return;
  throw Error(
      "this program was built without the page that computes motions. In the source folder, run "
      "./dev wasm, which needs npm and network, and then ./dev build");
}

}  // namespace shapespace::tools
