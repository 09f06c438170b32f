#ifndef SHAPESPACE_DEFORMATION_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_DEFORMATION_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/analysis/internal/summary_fields.h>
#include <shapespace/base/internal/fields.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/summary/internal/report.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<DeformationSummary::HandleResult>, const Visit& visit) {
  visit("name", &DeformationSummary::HandleResult::name);
  visit("vertices", &DeformationSummary::HandleResult::vertices);
  visit("hard", &DeformationSummary::HandleResult::hard);
  visit("residual_rms", &DeformationSummary::HandleResult::residual_rms);
  visit("residual_max", &DeformationSummary::HandleResult::residual_max);
}

template <typename Visit>
void ForFields(Of<DeformationSummary::Level>, const Visit& visit) {
  visit("termination", &DeformationSummary::Level::termination);
  visit("vertices", &DeformationSummary::Level::vertices);
  visit("shapes", &DeformationSummary::Level::shapes);
  visit("start", &DeformationSummary::Level::start);
  visit("iterations", &DeformationSummary::Level::iterations);
  visit("evaluations", &DeformationSummary::Level::evaluations);
  visit("initial_value", &DeformationSummary::Level::initial_value);
  visit("value", &DeformationSummary::Level::value);
  visit("seconds", &DeformationSummary::Level::seconds);
}

template <typename Visit>
void ForFields(Of<DeformationSummary>, const Visit& visit) {
  visit("termination", &DeformationSummary::termination);
  visit("converged", &DeformationSummary::Converged);
  visit("vertices", &DeformationSummary::vertices);
  visit("triangles", &DeformationSummary::triangles);
  visit("shapes", &DeformationSummary::shapes);
  visit("metric", &DeformationSummary::metric);
  visit("unit", &DeformationSummary::unit);
  visit("balance", &DeformationSummary::balance);
  visit("energy", &DeformationSummary::energy);
  visit("error", &DeformationSummary::error);
  visit("handles", &DeformationSummary::handles);
  visit("free_components", &DeformationSummary::free_components);
  visit("levels", &DeformationSummary::levels);
  visit("hierarchy", &DeformationSummary::hierarchy);
  visit("uncertified_segments", &DeformationSummary::uncertified_segments);
  visit("contact_distance", &DeformationSummary::contact_distance);
  visit("intersections", &DeformationSummary::intersections);
  visit("warm", &DeformationSummary::warm);
  visit("estimated_bytes", &DeformationSummary::estimated_bytes);
  visit("hierarchy_seconds", &DeformationSummary::hierarchy_seconds);
  visit("factor_seconds", &DeformationSummary::factor_seconds);
  visit("solve_seconds", &DeformationSummary::solve_seconds);
  visit("contact_seconds", &DeformationSummary::contact_seconds);
  visit("total_seconds", &DeformationSummary::total_seconds);
  visit("threads", &DeformationSummary::threads);
  visit("warnings", &DeformationSummary::warnings);
}

template <typename Visit>
void ForFields(Of<RepairSummary>, const Visit& visit) {
  visit("termination", [](const RepairSummary& s) { return s.deformation.termination; });
  visit("converged", &RepairSummary::Converged);
  visit("deformation", &RepairSummary::deformation);
  visit("before", &RepairSummary::before);
  visit("after", &RepairSummary::after);
  visit("moved", &RepairSummary::moved);
}

template <typename Visit>
void ForFields(Of<StandingSummary>, const Visit& visit) {
  visit("termination", &StandingSummary::termination);
  visit("converged", &StandingSummary::Converged);
  visit("parts", &StandingSummary::parts);
  visit("shapes", &StandingSummary::shapes);
  visit("slide_before", &StandingSummary::slide_before);
  visit("slide", &StandingSummary::slide);
  visit("drift", &StandingSummary::drift);
  visit("edge_rms", &StandingSummary::edge_rms);
  visit("warnings", &StandingSummary::warnings);
  visit("seconds", &StandingSummary::seconds);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_INTERNAL_SUMMARY_FIELDS_H_
