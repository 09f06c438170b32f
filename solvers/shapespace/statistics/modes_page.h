#ifndef SHAPESPACE_STATISTICS_MODES_PAGE_H_
#define SHAPESPACE_STATISTICS_MODES_PAGE_H_

#include <string>

#include <shapespace/base/progress.h>
#include <shapespace/output/page.h>
#include <shapespace/statistics/regression.h>
#include <shapespace/statistics/shape_model.h>

namespace shapespace {

/// A page with a slider for each mode and, with `regression`, for each scalar. The shapes of single
/// modes are exact, those of pairs are previews, and `PageModes::error` says how far the page's
/// shapes are from exact ones, on the mean of some random ones. `file` is the `.modes` file, for
/// the command line of exact shapes.
/// \throw InvalidOptions if the model has no modes, Cancelled.
PageModes PageOf(const ShapeModel& model, const std::string& file,
                 const Regression* regression = nullptr, Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_STATISTICS_MODES_PAGE_H_
