#include <cmath>
#include <sstream>

#include <shapespace/statistics/average.h>
#include <shapespace/statistics/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {

std::string AverageSummary::BriefReport() const {
  const std::string bound =
      std::isfinite(lower_bound) ? internal::Format("%.4f of the lower bound, ", Ratio()) : "";
  return internal::Format("%s: %d vertices, average of %d poses; ", internal::Name(termination),
                          vertices, poses) +
         bound +
         internal::Format("edges off their means by %.3g%% rms; %.2f s", 100 * edge_rms,
                          total_seconds);
}

std::string AverageSummary::FullReport() const {
  std::ostringstream out;
  out << "Average           " << internal::Name(termination) << " after " << iterations
      << " iterations\n"
      << internal::Format("Mesh              %d vertices, %d triangles; %d poses\n", vertices,
                          triangles, poses)
      << "Metric            " << metric << internal::Format("; unit of length %.6g\n", unit)
      << internal::Format("Variance          %.6g of the poses' features\n", variance)
      << "Residual          "
      << internal::IfComputed(
             residual,
             internal::Format("%.3g of it: no shape has exactly the mean features", residual))
      << '\n';
  if (std::isfinite(lower_bound)) {
    out << internal::Format(
        "Distances         %.6g, the mean of their squares to the poses\n"
        "Lower bound       %.6g for any shape; ratio %.4f\n",
        energy, lower_bound, Ratio());
  }
  if (refinements > 0) {
    out << internal::Format("Refined           in %d rounds, by %.3g%% of the squared distances\n",
                            refinements, 100 * refined_by);
  }
  out << internal::Format("Edges             %.4g%% rms off the poses' means\n", 100 * edge_rms)
      << internal::Format("Hinges            %d without a mean angle\n", ambiguous_hinges)
      << internal::Format("Seconds           %.3f for the lower bound, %.3f in all\n",
                          certificate_seconds, total_seconds);
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string AverageSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
