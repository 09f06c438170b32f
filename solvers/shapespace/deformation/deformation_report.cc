#include <algorithm>
#include <cmath>
#include <sstream>

#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/detail/volume_text.h>
#include <shapespace/deformation/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
using internal::Format;
using internal::VolumeText;

std::string DeformationSummary::BriefReport() const {
  double greatest = kNotComputed;
  for (const HandleResult& handle : handles) greatest = std::fmax(greatest, handle.residual_max);
  return Format(
      "%s: %d vertices, %d shape%s, %zu handle%s; off by at most %.3g; edges off by %.3g%% rms, "
      "%s; energy %.6g; %.2f s",
      internal::Name(termination), vertices, shapes, shapes == 1 ? "" : "s", handles.size(),
      handles.size() == 1 ? "" : "s", greatest, 100 * error.edge_rms, VolumeText(error).c_str(),
      energy, total_seconds);
}

std::string DeformationSummary::FullReport() const {
  std::ostringstream out;
  out << "Termination       " << internal::Name(termination) << '\n'
      << Format("Mesh              %d vertices, %d triangles\n", vertices, triangles)
      << Format("Path              %d shape%s after the first%s\n", shapes, shapes == 1 ? "" : "s",
                warm ? ", from the last solution" : "")
      << "Metric            " << metric << Format("; unit of length %.6g\n", unit)
      << Format("Balance           %.6g\n", balance) << Format("Energy            %.8g\n", energy)
      << Format("Edges             rms %.4g%%, 99th percentile %.4g%%, max %.4g%%\n",
                100 * error.edge_rms, 100 * error.edge_p99, 100 * error.edge_max)
      << Format("Turned over       %d hinges; %s\n", error.inverted_hinges,
                VolumeText(error).c_str())
      << (std::isnan(intersections)
              ? std::string()
              : Format("Intersections     %.3g pairs of triangles more than in the mesh\n",
                       intersections))
      << internal::ContactText(uncertified_segments, contact_distance) << "Hierarchy        ";
  for (size_t i = 0; i < hierarchy.size(); ++i) out << (i > 0 ? ", " : " ") << hierarchy[i];
  out << " vertices\n\nhandle                   vertices         off, rms         off, max\n";
  for (size_t i = 0; i < handles.size(); ++i) {
    const HandleResult& handle = handles[i];
    out << Format("%-24.24s %8d %16.6g %16.6g  %s\n",
                  handle.name.empty() ? std::to_string(i + 1).c_str() : handle.name.c_str(),
                  handle.vertices, handle.residual_rms, handle.residual_max,
                  handle.hard ? "hard" : "soft");
  }
  out << "\nvertices shapes start    iterations  evaluations  value before   value after  "
         "seconds\n";
  for (const Level& level : levels) {
    out << Format("%8d %6d %-8s %10d %12d %13.6g %13.6g %8.3f%s\n", level.vertices, level.shapes,
                  level.start.c_str(), level.iterations, level.evaluations, level.initial_value,
                  level.value, level.seconds,
                  level.termination == Termination::kConverged ? "" : "  (not converged)");
  }
  out << Format(
      "\nTime              %.3f s: hierarchy %.3f, factors %.3f, solves %.3f; %d thread%s\n",
      total_seconds, hierarchy_seconds, factor_seconds, solve_seconds, threads,
      threads == 1 ? "" : "s");
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string DeformationSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
