#ifndef SHAPESPACE_SPLINE_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_SPLINE_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/geodesic/internal/summary_fields.h>
#include <shapespace/spline/internal/option_fields.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<SplineSummary>, const Visit& visit) {
  visit("termination", [](const SplineSummary& s) { return s.geodesic.termination; });
  visit("converged", &SplineSummary::Converged);
  visit("ends", &SplineSummary::ends);
  visit("smooth", &SplineSummary::smooth);
  visit("jump_before", &SplineSummary::jump_before);
  visit("jump_after", &SplineSummary::jump_after);
  visit("uncertified_segments", &SplineSummary::uncertified_segments);
  visit("contact_distance", &SplineSummary::contact_distance);
  visit("energy", &SplineSummary::energy);
  visit("quality", &SplineSummary::quality);
  visit("geodesic", &SplineSummary::geodesic);
  visit("estimated_bytes", &SplineSummary::estimated_bytes);
  visit("spline_seconds", &SplineSummary::spline_seconds);
  visit("total_seconds", &SplineSummary::total_seconds);
  visit("warnings", &SplineSummary::warnings);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPLINE_INTERNAL_SUMMARY_FIELDS_H_
