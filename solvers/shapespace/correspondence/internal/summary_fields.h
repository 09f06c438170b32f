#ifndef SHAPESPACE_CORRESPONDENCE_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_CORRESPONDENCE_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/summary/internal/report.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<CorrespondenceSummary::Stage>, const Visit& visit) {
  visit("vertices", &CorrespondenceSummary::Stage::vertices);
  visit("name", &CorrespondenceSummary::Stage::name);
  visit("weight", &CorrespondenceSummary::Stage::weight);
  visit("rounds", &CorrespondenceSummary::Stage::rounds);
  visit("distance", &CorrespondenceSummary::Stage::distance);
  visit("motion", &CorrespondenceSummary::Stage::motion);
  visit("seconds", &CorrespondenceSummary::Stage::seconds);
}

template <typename Visit>
void ForFields(Of<CorrespondenceSummary::Doubt>, const Visit& visit) {
  visit("marker", &CorrespondenceSummary::Doubt::marker);
  visit("off", &CorrespondenceSummary::Doubt::off);
  visit("expected", &CorrespondenceSummary::Doubt::expected);
  visit("swapped", &CorrespondenceSummary::Doubt::swapped);
}

template <typename Visit>
void ForFields(Of<CorrespondenceSummary::Candidate>, const Visit& visit) {
  visit("orientation", &CorrespondenceSummary::Candidate::orientation);
  visit("markers", &CorrespondenceSummary::Candidate::markers);
  visit("deformation", &CorrespondenceSummary::Candidate::deformation);
  visit("isometry", &CorrespondenceSummary::Candidate::isometry);
  visit("curvature", &CorrespondenceSummary::Candidate::curvature);
  visit("heat", &CorrespondenceSummary::Candidate::heat);
  visit("reverse", &CorrespondenceSummary::Candidate::reverse);
  visit("cost", &CorrespondenceSummary::Candidate::cost);
  visit("rough_cost", &CorrespondenceSummary::Candidate::rough_cost);
  visit("chosen", &CorrespondenceSummary::Candidate::chosen);
}

template <typename Visit>
void ForFields(Of<CorrespondenceSummary::PartInDoubt>, const Visit& visit) {
  visit("share", &CorrespondenceSummary::PartInDoubt::share);
  visit("cost", &CorrespondenceSummary::PartInDoubt::cost);
  visit("vertex", &CorrespondenceSummary::PartInDoubt::vertex);
  visit("target_vertex", &CorrespondenceSummary::PartInDoubt::target_vertex);
  visit("other_vertex", &CorrespondenceSummary::PartInDoubt::other_vertex);
}

template <typename Visit>
void ForFields(Of<CorrespondenceSummary>, const Visit& visit) {
  visit("termination",
        [](const CorrespondenceSummary& s) { return EndingKey(s.converged, s.cancelled); });
  visit("converged", &CorrespondenceSummary::converged);
  visit("cancelled", &CorrespondenceSummary::cancelled);
  visit("template_vertices", &CorrespondenceSummary::template_vertices);
  visit("template_triangles", &CorrespondenceSummary::template_triangles);
  visit("target_vertices", &CorrespondenceSummary::target_vertices);
  visit("target_triangles", &CorrespondenceSummary::target_triangles);
  visit("markers", &CorrespondenceSummary::markers);
  visit("doubtful", &CorrespondenceSummary::doubtful);
  visit("candidates", &CorrespondenceSummary::candidates);
  visit("template_extremities", &CorrespondenceSummary::template_extremities);
  visit("target_extremities", &CorrespondenceSummary::target_extremities);
  visit("certainty", &CorrespondenceSummary::certainty);
  visit("parts_in_doubt", &CorrespondenceSummary::parts_in_doubt);
  visit("scale", &CorrespondenceSummary::scale);
  visit("stages", &CorrespondenceSummary::stages);
  visit("distance_rms", &CorrespondenceSummary::distance_rms);
  visit("distance_max", &CorrespondenceSummary::distance_max);
  visit("round_trip_mean", &CorrespondenceSummary::round_trip_mean);
  visit("round_trip_p95", &CorrespondenceSummary::round_trip_p95);
  visit("turned", &CorrespondenceSummary::turned);
  visit("uncovered", &CorrespondenceSummary::uncovered);
  visit("estimated_bytes", &CorrespondenceSummary::estimated_bytes);
  visit("total_seconds", &CorrespondenceSummary::total_seconds);
  visit("matching_seconds", &CorrespondenceSummary::matching_seconds);
  visit("marker_seconds", &CorrespondenceSummary::marker_seconds);
  visit("hierarchy_seconds", &CorrespondenceSummary::hierarchy_seconds);
  visit("fit_seconds", &CorrespondenceSummary::fit_seconds);
  visit("unfold_seconds", &CorrespondenceSummary::unfold_seconds);
  visit("map_seconds", &CorrespondenceSummary::map_seconds);
  visit("warnings", &CorrespondenceSummary::warnings);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_INTERNAL_SUMMARY_FIELDS_H_
