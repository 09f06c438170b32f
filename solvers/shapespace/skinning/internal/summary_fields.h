#ifndef SHAPESPACE_SKINNING_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_SKINNING_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/skinning/skinning.h>
#include <shapespace/summary/internal/report.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<SkinningSummary>, const Visit& visit) {
  visit("termination", &SkinningSummary::termination);
  visit("converged", &SkinningSummary::Converged);
  visit("vertices", &SkinningSummary::vertices);
  visit("shapes", &SkinningSummary::shapes);
  visit("bones", &SkinningSummary::bones);
  visit("iterations", &SkinningSummary::iterations);
  visit("error", &SkinningSummary::error);
  visit("relative_error", &SkinningSummary::relative_error);
  visit("literature_error", &SkinningSummary::LiteratureError);
  visit("max_error", &SkinningSummary::max_error);
  visit("max_error_vertex", &SkinningSummary::max_error_vertex);
  visit("max_error_shape", &SkinningSummary::max_error_shape);
  visit("errors", &SkinningSummary::errors);
  visit("total_seconds", &SkinningSummary::total_seconds);
  visit("warnings", &SkinningSummary::warnings);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_INTERNAL_SUMMARY_FIELDS_H_
