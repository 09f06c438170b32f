#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_FIT_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_FIT_H_

#include <memory>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/detail/own_frame.h>
#include <shapespace/correspondence/detail/template_fit.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// A body without its stiffeners: components that these connect are components all the same.
struct FitBody {
  FitBody(const std::shared_ptr<const Connectivity>& mesh, const Shape& the_shape);

  const std::shared_ptr<const Connectivity> connectivity;
  const Shape shape;  ///< in the user's frame
  const OwnFrame frame;
  const Shape own;  ///< the shape in its own frame
};

/// Fits a template onto a target with these markers, which are on vertices that have elements; the
/// first `num_given` are the user's, who is told which of them are doubtful. `summary` is what is
/// known of both bodies, and is completed.
/// \throw as `Correspond`.
CorrespondenceResult FitWithMarkers(const FitBody& from, const FitBody& target,
                                    const std::vector<CorrespondenceMarker>& markers,
                                    size_t num_given, const CorrespondenceOptions& options,
                                    const CorrespondenceSummary& summary, Effort effort,
                                    Progress* progress);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_FIT_H_
