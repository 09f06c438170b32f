#include <sstream>

#include <shapespace/spline/internal/summary_fields.h>
#include <shapespace/spline/spline.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {

std::string SplineSummary::BriefReport() const {
  return internal::Format(
      "%s: %d vertices, %d poses, %d shapes inserted; %s; velocity jumps at poses by %.3g times "
      "the mean speed (before: %.3g); edges off by %s; %.2f s",
      internal::Name(geodesic.termination), geodesic.vertices, geodesic.poses, geodesic.shapes,
      smooth ? (std::string("spline, ") + internal::WordOf(ends)).c_str() : "chain of geodesics",
      jump_after, jump_before,
      internal::IfComputed(quality.edge_rms, internal::Format("%.3g%% rms", 100 * quality.edge_rms))
          .c_str(),
      total_seconds);
}

std::string SplineSummary::FullReport() const {
  std::ostringstream out;
  out << geodesic.FullReport() << "\nSpline            "
      << (smooth ? internal::WordOf(ends) : "none: the path is the chain of geodesics") << '\n'
      << internal::Format("Velocity jumps    at most %.4g times the mean speed (chain: %.4g)\n",
                          jump_after, jump_before)
      << internal::ContactText(uncertified_segments, contact_distance)
      << internal::Format("Energy            %.6g, that of the chain is %.6g\n", energy,
                          geodesic.energy)
      << internal::Format("Seconds           %.3f for the spline, %.3f in all\n", spline_seconds,
                          total_seconds);
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string SplineSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
