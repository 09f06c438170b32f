#include <initializer_list>
#include <sstream>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {

using internal::Format;

std::string CorrespondenceSummary::BriefReport() const {
  return Format(
      "%s: %d vertices on %d, %d markers, %.3g%% off the target (rms), %.3g%% turned over, "
      "%.2f s",
      cancelled   ? "cancelled"
      : converged ? "converged"
                  : "not converged",
      template_vertices, target_vertices, markers, 100 * distance_rms, 100 * turned, total_seconds);
}

std::string CorrespondenceSummary::FullReport() const {
  std::ostringstream out;
  out << "Termination       "
      << (cancelled   ? "cancelled"
          : converged ? "converged"
                      : "not converged")
      << '\n'
      << Format("Template          %d vertices, %d triangles\n", template_vertices,
                template_triangles)
      << Format("Target            %d vertices, %d triangles; %.6g times as large\n",
                target_vertices, target_triangles, scale)
      << Format("Markers           %d held, %d doubtful\n", markers,
                static_cast<int>(doubtful.size()))
      << "\nIn per cent of the square root of the target's area:\n"
      << Format("From the target   rms %.4g%%, max %.4g%%\n", 100 * distance_rms,
                100 * distance_max)
      << Format("Round trip        mean %.4g%%, 95th percentile %.4g%%\n", 100 * round_trip_mean,
                100 * round_trip_p95)
      << Format("\nTurned over       %.4g%% of triangles\n", 100 * turned)
      << Format("Not covered       %.4g%% of the target's area\n", 100 * uncovered)
      << "\nvertices stage         weight  rounds  distance %  last motion %  seconds\n";
  for (const Stage& stage : stages) {
    const auto percent = [](double share) {
      return internal::IfComputed(share, Format("%.4g", 100 * share));
    };
    out << Format("%8d %-10s %9.4g %7d %11s %14s %8.3f\n", stage.vertices, stage.name.c_str(),
                  stage.weight, stage.rounds, percent(stage.distance).c_str(),
                  percent(stage.motion).c_str(), stage.seconds);
  }
  if (!candidates.empty()) {
    out << Format("\nFound without markers: extremities %d and %d; certainty %s\n",
                  template_extremities, target_extremities,
                  internal::IfComputed(certainty, Format("%.3g", certainty)).c_str())
        << "orientation  markers  deformation  isometry  curvature      heat  reverse       cost  "
           "rough cost\n";
  }
  for (const Candidate& map : candidates) {
    out << Format("%11.3f %8d", map.orientation, map.markers);
    const auto figure = [&](int width, double value, int digits) {
      const std::string text = internal::IfComputed(value, Format("%.*f", digits, value));
      out << Format(" %*s", width, text.c_str());
    };
    figure(12, map.deformation, 3);
    figure(9, map.isometry, 3);
    figure(10, map.curvature, 3);
    figure(9, map.heat, 3);
    figure(8, map.reverse, 3);
    for (const double cost : {map.cost, map.rough_cost}) {
      out << Format(" %10s", internal::IfComputed(cost, Format("%.3g", cost)).c_str());
    }
    out << (map.chosen ? "  (chosen)\n" : "\n");
  }
  for (const PartInDoubt& part : parts_in_doubt) {
    out << Format(
        "in doubt: %.2g%% of the template around vertex %d, at the target's %d, in a map that "
        "costs %.3g times as much at %d\n",
        100 * part.share, part.vertex + 1, part.target_vertex + 1, part.cost,
        part.other_vertex + 1);
  }
  for (const Doubt& doubt : doubtful) {
    out << Format(
        "\nmarker %d is %.3g%% from the position that the others predict: vertex %d of the target",
        doubt.marker + 1, 100 * doubt.off, doubt.expected + 1);
    if (doubt.swapped >= 0) out << Format(" (swapped with marker %d?)", doubt.swapped + 1);
  }
  out << Format(
      "%s\nTime              %.3f s: matching %.3f, markers %.3f, hierarchy %.3f, fit %.3f "
      "(unfolding %.3f), "
      "map %.3f\n",
      doubtful.empty() ? "" : "\n", total_seconds, matching_seconds, marker_seconds,
      hierarchy_seconds, fit_seconds, unfold_seconds, map_seconds);
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string CorrespondenceSummary::ToJson() const {
  auto json = internal::JsonOf(*this);
  // Files count from 1; markers that have not changed places with another have 0.
  const auto count_from_one = [&](const char* list, std::initializer_list<const char*> keys) {
    for (auto& row : json[list]) {
      for (const char* key : keys) row[key] = row[key].get<int>() + 1;
    }
  };
  count_from_one("doubtful", {"marker", "expected", "swapped"});
  count_from_one("parts_in_doubt", {"vertex", "target_vertex", "other_vertex"});
  return internal::TextOf(json);
}

}  // namespace shapespace
