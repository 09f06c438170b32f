#include <shapespace/matching/detail/matching_body.h>

#include <algorithm>
#include <iterator>

namespace shapespace::internal {
namespace {

// As many as the finest maps of parts have. The bodies' heat is compared with all of them.
constexpr int kFunctions = 100;
constexpr int kSpread = 1500;
// Functions by which vertices are spread: enough to tell all parts of a body from each other.
constexpr int kSpreadFunctions = 40;
// Functions that remain of what is smoothed.
constexpr int kSmooth = 60;
// An extremity nearer to the border may be the far corner of a cut, not the end of a limb.
constexpr float kCutOff = 0.04F;
// Heat of the time by which bodies are compared spreads over 0.05 (`CompareBodies`).
constexpr float kBesideBorder = 0.06F;

// The embedding of Rustamov, "Laplace-Beltrami eigenfunctions for deformation invariant shape
// representation" (SGP 2007), in whose distances vertices are spread about as evenly as along the
// surface.
std::vector<int> SpreadVertices(const Spectrum& spectrum, int first) {
  const int count = std::min(kSpreadFunctions, spectrum.Count()) - 1;
  const Eigen::VectorXd roots = spectrum.values.segment(1, count).cwiseSqrt();
  const Eigen::MatrixXf points =
      (roots.cwiseInverse().asDiagonal() * spectrum.functions.middleCols(1, count).transpose())
          .cast<float>();
  return FarthestColumns(points, first, kSpread);
}

}  // namespace

MatchingBody::MatchingBody(const std::string& name, const Connectivity& connectivity,
                           const Shape& shape, Progress* progress)
    : surface(MakeWorkingSurface(name, connectivity, shape, progress)),
      graph(*surface.connectivity, surface.shape),
      laplacian(MakeLaplacian(*surface.connectivity, surface.shape)),
      border(*surface.connectivity, surface.shape) {
  ReportProgress(progress, "eigenfunctions of the " + name, 0, 0);
  spectrum = ComputeSpectrum(laplacian, kFunctions);
  ReportProgress(progress, "distances on the " + name, 0, 0);
  even = SampleEvenly(graph, surface.shape, laplacian.areas, kEvenSamples, surface.num_own);
  ReportProgress(progress, "extremities of the " + name, 0, 0);
  spread = SpreadVertices(spectrum, even.vertices.front());
  std::vector<Extremity> all = FindExtremities(graph, even, laplacian.areas, kLeastPersistence);
  for (Extremity& end : all) end.vertex = surface.Own(end.vertex);
  extremities = PrincipalExtremities(all);
  all_extremities = extremities;
  for (const int v : MinorExtremities(all)) all_extremities.push_back(v);
  from_border = graph.FromAny(border.vertices);
  const auto on_border = [&](int v) { return from_border(v) <= kCutOff; };
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const Extremity& end) { return on_border(end.vertex); }),
            all.end());
  inner_extremities = PrincipalExtremities(all);
  part_extremities = inner_extremities;
  std::copy_if(extremities.begin(), extremities.end(), std::back_inserter(part_extremities),
               on_border);
}

Eigen::MatrixXf MatchingBody::Smooth(const Eigen::MatrixXf& field,
                                     const std::vector<int>& rows) const {
  const auto functions = spectrum.functions.leftCols(std::min(kSmooth, spectrum.Count()));
  const Eigen::MatrixXf shares =
      (functions.transpose() * laplacian.areas.asDiagonal()).cast<float>() * field;
  Eigen::MatrixXf at_rows(rows.size(), functions.cols());
  for (size_t i = 0; i < rows.size(); ++i) at_rows.row(i) = functions.row(rows[i]).cast<float>();
  return at_rows * shares;
}

bool MatchingBody::IsInner(int vertex) const { return from_border(vertex) > kBesideBorder; }

}  // namespace shapespace::internal
