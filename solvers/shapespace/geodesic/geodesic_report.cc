#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include <shapespace/geodesic/geodesic.h>
#include <shapespace/numerics/internal/report.h>

namespace shapespace {
using internal::Format;
using internal::JsonNumber;
using internal::Name;

std::string GeodesicSummary::BriefReport() const {
  std::string ratio = std::isfinite(Ratio()) ? Format("%.4f", Ratio()) : "n/a";
  return Format(
      "%s: %d vertices, %d poses, %d shapes inserted; energy %.6g, %s of its lower bound; "
      "edges off by %.3g%% rms, roughness %.3g degrees, %.3g folds; %.2f s",
      Name(termination), vertices, poses, shapes, energy, ratio.c_str(), 100 * quality.edge_rms,
      quality.roughness, quality.folds, total_seconds);
}

std::string GeodesicSummary::FullReport() const {
  std::ostringstream out;
  out << "Termination       " << Name(termination) << '\n'
      << Format("Mesh              %d vertices, %d triangles, %d edges, %d hinges; %d poses\n",
                vertices, triangles, edges, hinges, poses)
      << Format("Path              %d shapes inserted between poses\n", shapes)
      << "Metric            " << metric << Format("; unit of length %.6g\n", unit)
      << Format("Energy            %.8g", energy);
  for (const auto& [name, value] : parts) out << Format("  %s %.3g", name.c_str(), value);
  out << '\n';
  if (std::isfinite(lower_bound)) {
    out << Format("Lower bound       %.8g; energy / bound %.5f\n", lower_bound, Ratio());
  } else {
    out << "Lower bound       n/a (the rigid metric has none)\n";
  }
  out << Format("Edges, expected   rms %.4g%%, 99th percentile %.4g%%, max %.4g%%\n",
                100 * quality.edge_rms, 100 * quality.edge_p99, 100 * quality.edge_max)
      << Format("Edges, first pose rms %.4g%%, 99th percentile %.4g%%, max %.4g%%\n",
                100 * quality.first_rms, 100 * quality.first_p99, 100 * quality.first_max)
      << Format("Roughness         %.4g degrees; folds %.4g per inner shape\n", quality.roughness,
                quality.folds)
      << "Speed             "
      << (std::isfinite(quality.speed_max)
              ? Format("at most %.4g times the mean of the piece\n", quality.speed_max)
              : "n/a (the rigid metric)\n")
      << Format("Intersections     %.3g pairs of triangles more than in the poses\n", intersections)
      << "Hierarchy        ";
  for (size_t i = 0; i < hierarchy.size(); ++i) out << (i > 0 ? ", " : " ") << hierarchy[i];
  out << " vertices" << (hierarchy_stopped_early ? " (no further edge could be collapsed)\n" : "\n")
      << "\npiece vertices shapes start     solver        iterations  evaluations  energy before  "
         "energy "
         "after"
         "   remaining  seconds\n";
  for (const Level& level : levels) {
    out << Format("%5d %8d %6d %-9s %-13s %10d %12d %14.6g %13.6g %11.2g %8.3f%s%s\n", level.piece,
                  level.vertices, level.shapes, level.start.c_str(), level.solver.c_str(),
                  level.iterations, level.evaluations, level.initial_energy, level.energy,
                  level.remaining, level.seconds, level.kept ? "" : "  (not kept)",
                  level.termination == Termination::kConverged ? "" : "  (not converged)");
  }
  out << Format(
             "\nTime              %.3f s: metric %.3f, hierarchy %.3f, solves %.3f; of which "
             "factorisation %.3f (%zu numbers); %d thread%s\n",
             total_seconds, freeze_seconds, hierarchy_seconds, solve_seconds, factor_seconds,
             factor_nonzeros, threads, threads == 1 ? "" : "s")
      << Format("Memory            about %.0f MB estimated\n", estimated_bytes / 1e6);
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string GeodesicSummary::ToJson() const {
  nlohmann::ordered_json json;
  json["termination"] = internal::Key(termination);
  json["converged"] = termination == Termination::kConverged;
  json["vertices"] = vertices;
  json["triangles"] = triangles;
  json["edges"] = edges;
  json["hinges"] = hinges;
  json["poses"] = poses;
  json["shapes"] = shapes;
  json["metric"] = metric;
  json["unit"] = unit;
  json["energy"] = JsonNumber(energy);
  json["lower_bound"] = JsonNumber(lower_bound);
  json["energy_over_bound"] = JsonNumber(Ratio());
  for (const auto& [name, value] : parts) json["energy_parts"][name] = JsonNumber(value);
  json["edge_deviation"] = {
      {"rms", quality.edge_rms}, {"p99", quality.edge_p99}, {"max", quality.edge_max}};
  json["first_pose_deviation"] = {
      {"rms", quality.first_rms}, {"p99", quality.first_p99}, {"max", quality.first_max}};
  json["roughness_degrees"] = quality.roughness;
  json["folds_per_shape"] = quality.folds;
  json["greatest_speed"] = JsonNumber(quality.speed_max);
  json["intersections_per_shape"] = intersections;
  json["hierarchy_vertices"] = hierarchy;
  json["hierarchy_stopped_early"] = hierarchy_stopped_early;
  json["levels"] = nlohmann::ordered_json::array();
  for (const Level& level : levels) {
    json["levels"].push_back({{"piece", level.piece},
                              {"vertices", level.vertices},
                              {"shapes", level.shapes},
                              {"start", level.start},
                              {"solver", level.solver},
                              {"termination", internal::Key(level.termination)},
                              {"iterations", level.iterations},
                              {"evaluations", level.evaluations},
                              {"initial_energy", JsonNumber(level.initial_energy)},
                              {"energy", JsonNumber(level.energy)},
                              {"remaining", JsonNumber(level.remaining)},
                              {"kept", level.kept},
                              {"seconds", level.seconds}});
  }
  json["seconds"] = {{"total", total_seconds},
                     {"metric", freeze_seconds},
                     {"hierarchy", hierarchy_seconds},
                     {"solves", solve_seconds},
                     {"factorisation", factor_seconds}};
  json["factor_nonzeros"] = factor_nonzeros;
  json["estimated_bytes"] = estimated_bytes;
  json["threads"] = threads;
  json["warnings"] = warnings;
  return json.dump(2) + "\n";
}

}  // namespace shapespace
