#include <cmath>
#include <sstream>

#include <shapespace/skinning/internal/summary_fields.h>
#include <shapespace/skinning/skinning.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {

double SkinningSummary::LiteratureError() const { return 1000 * relative_error / std::sqrt(3.0); }

std::string SkinningSummary::BriefReport() const {
  return internal::Format(
      "%s: %d bones for %d vertices and %d shapes; error %.3g%% of half the diagonal, at most "
      "%.4g; %d iterations, %.2f s",
      internal::Name(termination), bones, vertices, shapes, 100 * relative_error, max_error,
      iterations, total_seconds);
}

std::string SkinningSummary::FullReport() const {
  std::ostringstream out;
  out << "Ending            " << internal::Name(termination)
      << internal::Format("\nBones             %d\nMesh              %d vertices, %d shapes\n",
                          bones, vertices, shapes)
      << internal::Format("Error             %.4g rms, %.4g%% of half the diagonal (E %.4g)\n",
                          error, 100 * relative_error, LiteratureError())
      << internal::Format("Greatest error    %.4g, at vertex %d in shape %d\n", max_error,
                          max_error_vertex, max_error_shape)
      << "\niteration  error, rms\n";
  for (size_t i = 0; i < errors.size(); ++i) {
    out << internal::Format("%9zu  %.4g\n", i, errors[i]);
  }
  out << "\nshape  error, rms\n";
  for (Eigen::Index i = 0; i < shape_errors.size(); ++i) {
    out << internal::Format("%5td  %.4g\n", i, shape_errors(i));
  }
  out << internal::Format("\nTime              %.3f s\n", total_seconds);
  for (const std::string& warning : warnings) out << "Warning: " << warning << '\n';
  return out.str();
}

std::string SkinningSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
