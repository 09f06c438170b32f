#include <cmath>
#include <sstream>

#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
using internal::Format;
using internal::IfComputed;
using internal::Name;

namespace {

std::string EdgesText(double rms, double p99, double max) {
  return IfComputed(rms, Format("rms %.4g%%, 99th percentile %.4g%%, max %.4g%%", 100 * rms,
                                100 * p99, 100 * max)) +
         '\n';
}

}  // namespace

std::string GeodesicSummary::BriefReport() const {
  // The bound of poses that are nearly rigid copies says nothing of a way past an obstacle.
  constexpr double kLargest = 1e6;
  const std::string ratio =
      Ratio() < kLargest ? Format("%.4f of its lower bound", Ratio()) : "without a lower bound";
  return Format("%s: %d vertices, %d poses, %d %s inserted; energy %.6g, %s; ", Name(termination),
                vertices, poses, shapes, shapes == 1 ? "shape" : "shapes", energy, ratio.c_str()) +
         "edges off by " +
         IfComputed(quality.edge_rms, Format("%.3g%% rms", 100 * quality.edge_rms)) +
         ", roughness " + IfComputed(quality.roughness, Format("%.3g degrees", quality.roughness)) +
         ", " + IfComputed(quality.folds, Format("%.3g", quality.folds)) +
         Format(" folds a shape; %.2f s", total_seconds);
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
  out << "Edges, expected   " << EdgesText(quality.edge_rms, quality.edge_p99, quality.edge_max)
      << "Edges, first pose " << EdgesText(quality.first_rms, quality.first_p99, quality.first_max)
      << "Roughness         "
      << IfComputed(quality.roughness, Format("%.4g degrees", quality.roughness)) << "; folds "
      << IfComputed(quality.folds, Format("%.4g per inner shape", quality.folds))
      << "\nSpeed             "
      << IfComputed(quality.speed_max,
                    Format("at most %.4g times the mean of the piece", quality.speed_max))
      << "\nIntersections     "
      << IfComputed(intersections,
                    Format("%.3g pairs of triangles more than in the poses", intersections))
      << '\n'
      << (uncertified_segments < 0
              ? std::string()
              : Format("Contact           %d segments not shown to be free of it; %.3g crossings "
                       "at most between shapes; least distance %.4g; %.3f s\n",
                       uncertified_segments, crossings_between, contact_distance, contact_seconds))
      << "Hierarchy        ";
  for (size_t i = 0; i < hierarchy.size(); ++i) out << (i > 0 ? ", " : " ") << hierarchy[i];
  out << " vertices" << (hierarchy_stopped_early ? " (no further edge could be collapsed)\n" : "\n")
      << "\npiece vertices shapes start     solver        iterations  evaluations  energy before  "
         "energy after   remaining  seconds\n";
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

std::string GeodesicSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
