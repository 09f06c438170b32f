#include <sstream>

#include <shapespace/exploration/explore.h>
#include <shapespace/exploration/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
using internal::Format;

std::string ExploreSummary::BriefReport() const {
  return Format(
      "%s: %d poses, %d nodes, %d cells; stress %.3g; %d geodesics, %d of them found; "
      "%.1f s",
      Converged() ? "converged" : "not converged", poses, nodes, cells, stress, solved + found,
      found, total_seconds);
}

std::string ExploreSummary::FullReport() const {
  std::ostringstream out;
  out << "Termination       " << (Converged() ? "converged" : "not converged") << '\n'
      << Format("Mesh              %d vertices, %d triangles\n", vertices, triangles)
      << "Metric            " << metric << Format("; unit of length %.6g\n", unit)
      << Format("Space             %d poses, %d nodes, %d cells\n", poses, nodes, cells)
      << Format("Distances         on %d vertices\n", distance_vertices)
      << Format("Stress            %.6g after %d iterations\n", stress, stress_iterations)
      << Format(
             "Geodesics         %d solved, %d left by an earlier run, %d damaged, %d not "
             "converged\n",
             solved, found, damaged, not_converged)
      << Format("Threshold         %.4g%%; edges not measured: %d\n", 100 * threshold,
                edges_not_measured)
      << "\n  cells  new edges  too long  by at most  new nodes  seconds\n";
  for (const Level& level : levels) {
    out << Format("%7d %10d %9d %10.3g%% %10d %8.2f\n", level.cells, level.edges, level.marked,
                  100 * level.greatest_excess, level.new_nodes, level.seconds);
  }
  out << Format(
      "\nTime              %.3f s: distances %.3f, embedding %.3f, refinement %.3f; %d process%s "
      "of %d thread%s\n",
      total_seconds, distance_seconds, embedding_seconds, refinement_seconds, processes,
      processes == 1 ? "" : "es", threads, threads == 1 ? "" : "s");
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string ExploreSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
