#include <pybind11/stl.h>

#include "bind.h"
#include "options.h"

// The compiled part of the package; shapespace/__init__.py has what people call.

PYBIND11_MODULE(_core, module) {
  namespace py = pybind11;
  using namespace shapespace::python;
  module.attr("__version__") = SHAPESPACE_VERSION;
  BindErrors(&module);
  BindProgress();
  BindSummaries(&module);
  BindMeshes(&module);
  BindPictures(&module);
  BindFeatures(&module);
  BindMetrics(&module);
  BindPaths(&module);
  BindSpaces(&module);
  BindCorrespondence(&module);
  BindSolvers(&module);
  BindModels(&module);
  BindSkinning(&module);
  module.def("options", &DescribeOptions);
}
