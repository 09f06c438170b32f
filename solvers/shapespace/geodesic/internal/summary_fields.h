#ifndef SHAPESPACE_GEODESIC_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_GEODESIC_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/analysis/internal/summary_fields.h>
#include <shapespace/base/internal/fields.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/summary/internal/report.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<GeodesicSummary::Level>, const Visit& visit) {
  visit("termination", &GeodesicSummary::Level::termination);
  visit("piece", &GeodesicSummary::Level::piece);
  visit("vertices", &GeodesicSummary::Level::vertices);
  visit("shapes", &GeodesicSummary::Level::shapes);
  visit("start", &GeodesicSummary::Level::start);
  visit("solver", &GeodesicSummary::Level::solver);
  visit("iterations", &GeodesicSummary::Level::iterations);
  visit("evaluations", &GeodesicSummary::Level::evaluations);
  visit("initial_energy", &GeodesicSummary::Level::initial_energy);
  visit("energy", &GeodesicSummary::Level::energy);
  visit("remaining", &GeodesicSummary::Level::remaining);
  visit("kept", &GeodesicSummary::Level::kept);
  visit("seconds", &GeodesicSummary::Level::seconds);
}

template <typename Visit>
void ForFields(Of<GeodesicSummary>, const Visit& visit) {
  visit("termination", &GeodesicSummary::termination);
  visit("converged",
        [](const GeodesicSummary& s) { return s.termination == Termination::kConverged; });
  visit("vertices", &GeodesicSummary::vertices);
  visit("triangles", &GeodesicSummary::triangles);
  visit("edges", &GeodesicSummary::edges);
  visit("hinges", &GeodesicSummary::hinges);
  visit("poses", &GeodesicSummary::poses);
  visit("shapes", &GeodesicSummary::shapes);
  visit("metric", &GeodesicSummary::metric);
  visit("unit", &GeodesicSummary::unit);
  visit("energy", &GeodesicSummary::energy);
  visit("lower_bound", &GeodesicSummary::lower_bound);
  visit("quality", &GeodesicSummary::quality);
  visit("intersections", &GeodesicSummary::intersections);
  visit("crossings_between", &GeodesicSummary::crossings_between);
  visit("uncertified_segments", &GeodesicSummary::uncertified_segments);
  visit("contact_distance", &GeodesicSummary::contact_distance);
  visit("hierarchy", &GeodesicSummary::hierarchy);
  visit("hierarchy_stopped_early", &GeodesicSummary::hierarchy_stopped_early);
  visit("levels", &GeodesicSummary::levels);
  visit("estimated_bytes", &GeodesicSummary::estimated_bytes);
  visit("freeze_seconds", &GeodesicSummary::freeze_seconds);
  visit("hierarchy_seconds", &GeodesicSummary::hierarchy_seconds);
  visit("factor_seconds", &GeodesicSummary::factor_seconds);
  visit("solve_seconds", &GeodesicSummary::solve_seconds);
  visit("contact_seconds", &GeodesicSummary::contact_seconds);
  visit("total_seconds", &GeodesicSummary::total_seconds);
  visit("factor_nonzeros", &GeodesicSummary::factor_nonzeros);
  visit("threads", &GeodesicSummary::threads);
  visit("ratio", &GeodesicSummary::Ratio);
  visit("parts", &GeodesicSummary::parts);
  visit("warnings", &GeodesicSummary::warnings);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_INTERNAL_SUMMARY_FIELDS_H_
