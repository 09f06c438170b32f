#ifndef SHAPESPACE_EXPLORATION_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_EXPLORATION_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/summary/internal/report.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<ExploreSummary::Level>, const Visit& visit) {
  visit("cells", &ExploreSummary::Level::cells);
  visit("edges", &ExploreSummary::Level::edges);
  visit("marked", &ExploreSummary::Level::marked);
  visit("greatest_excess", &ExploreSummary::Level::greatest_excess);
  visit("new_nodes", &ExploreSummary::Level::new_nodes);
  visit("seconds", &ExploreSummary::Level::seconds);
}

template <typename Visit>
void ForFields(Of<ExploreSummary>, const Visit& visit) {
  visit("termination", [](const ExploreSummary& s) { return EndingKey(s.Converged(), false); });
  visit("converged", &ExploreSummary::Converged);
  visit("vertices", &ExploreSummary::vertices);
  visit("triangles", &ExploreSummary::triangles);
  visit("distance_vertices", &ExploreSummary::distance_vertices);
  visit("poses", &ExploreSummary::poses);
  visit("nodes", &ExploreSummary::nodes);
  visit("cells", &ExploreSummary::cells);
  visit("metric", &ExploreSummary::metric);
  visit("unit", &ExploreSummary::unit);
  visit("threshold", &ExploreSummary::threshold);
  visit("solved", &ExploreSummary::solved);
  visit("found", &ExploreSummary::found);
  visit("damaged", &ExploreSummary::damaged);
  visit("not_converged", &ExploreSummary::not_converged);
  visit("stress", &ExploreSummary::stress);
  visit("stress_iterations", &ExploreSummary::stress_iterations);
  visit("embedded", &ExploreSummary::embedded);
  visit("levels", &ExploreSummary::levels);
  visit("edges_not_measured", &ExploreSummary::edges_not_measured);
  visit("distance_seconds", &ExploreSummary::distance_seconds);
  visit("embedding_seconds", &ExploreSummary::embedding_seconds);
  visit("refinement_seconds", &ExploreSummary::refinement_seconds);
  visit("total_seconds", &ExploreSummary::total_seconds);
  visit("threads", &ExploreSummary::threads);
  visit("processes", &ExploreSummary::processes);
  visit("warnings", &ExploreSummary::warnings);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPLORATION_INTERNAL_SUMMARY_FIELDS_H_
