// Maps between bodies that are found without markers, judged by known answers: prints a table in
// Markdown. Errors are distances along the target's surface in per cent of the root of its area,
// means over the known vertices: of the map of the candidate that costs least before any fit, of
// the best of all candidates, and of the fit, with its 95th percentile. Seconds depend on the
// machine.
//
//   matching_table FOLDER...
//
// Every folder has a file pairs.txt, a line for each pair: the names of two meshes,
// FOLDER/NAME.obj, and of the file with their known answer, lines with a vertex of each, from 1.
//
// A line for each candidate is printed with --candidates. With --fit=false nothing is fitted.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/detail/nearest_corners.h>
#include <shapespace/files/read.h>
#include <shapespace/matching/detail/surface_graph.h>
#include <shapespace/matching/internal/matching.h>
#include <shapespace/mesh/internal/geometry.h>

DEFINE_bool(candidates, false, "print a line for each candidate");
DEFINE_bool(fit, true, "fit the template");
DEFINE_string(name, "", "only the pairs whose names contain this");

namespace shapespace {
namespace {

using VertexPairs = std::vector<std::pair<int, int>>;

VertexPairs ReadPairs(const std::string& file) {
  std::ifstream stream(file);
  VertexPairs pairs;
  for (int from, to; stream >> from >> to;) pairs.emplace_back(from - 1, to - 1);
  if (pairs.empty()) throw FileError(file + ": no pairs of vertices at its beginning");
  return pairs;
}

// Measures maps to a target.
class Judge {
 public:
  Judge(const Connectivity& connectivity, const Shape& shape, VertexPairs truth)
      : graph_(connectivity, shape), truth_(std::move(truth)) {
    double area = 0;
    for (const auto& triangle : connectivity.Triangles().colwise()) {
      area += internal::TriangleArea(shape, triangle);
    }
    unit_ = std::sqrt(area) / 100;
  }

  struct Errors {
    double mean, p95;
  };

  // `map` has for each vertex one of the target, or -1.
  Errors Of(const std::vector<int>& map) const {
    std::vector<int> images, answers;
    // Enough for the mean; a search along the surface for each takes time.
    const size_t step = truth_.size() / 500 + 1;
    for (size_t i = 0; i < truth_.size(); i += step) {
      if (map[truth_[i].first] < 0) continue;
      images.push_back(map[truth_[i].first]);
      answers.push_back(truth_[i].second);
    }
    const Eigen::MatrixXf distances = graph_.FromEach(answers);
    std::vector<double> errors;
    double sum = 0;
    for (size_t i = 0; i < images.size(); ++i) {
      errors.push_back(distances(images[i], i) / unit_);
      sum += errors.back();
    }
    std::sort(errors.begin(), errors.end());
    return {sum / static_cast<double>(errors.size()), errors[errors.size() * 95 / 100]};
  }

 private:
  const internal::SurfaceGraph graph_;
  const VertexPairs truth_;
  double unit_;
};

struct Sum {
  int pairs = 0, none = 0, gross = 0, silent = 0;
  double first = 0, best = 0, fit = 0, p95 = 0, seconds = 0;
};

// Errors above this are of maps that have a limb at a wrong place.
constexpr double kGross = 10;

// The fit, judged and printed.
void PrintFit(const Poses& from, const Poses& to, const Judge& judge, Sum* sum) {
  const CorrespondenceResult result =
      Correspond(from.connectivity, from.shapes[0], to.connectivity, to.shapes[0], {}, {});
  const CorrespondenceSummary& summary = result.summary;
  const Judge::Errors errors =
      judge.Of(internal::NearestCorners(result.map.to_target, *to.connectivity));
  std::printf("%.2f | %.2f | %.2f, %s | %.2g %% | %.1f |\n", errors.mean, errors.p95,
              summary.certainty, summary.converged ? "converged" : "not converged",
              100 * summary.turned, summary.total_seconds);
  sum->fit += errors.mean;
  sum->p95 += errors.p95;
  sum->seconds += summary.total_seconds;
  if (errors.mean > kGross) {
    ++sum->gross;
    if (summary.converged && summary.warnings.empty()) ++sum->silent;
  }
  for (size_t i = 0; FLAGS_candidates && i < summary.candidates.size(); ++i) {
    const CorrespondenceSummary::Candidate& candidate = summary.candidates[i];
    std::printf("  fit of %d: deformation %.3f cost %.4f%s\n", static_cast<int>(i + 1),
                candidate.deformation, candidate.cost, candidate.chosen ? " (chosen)" : "");
  }
  for (const std::string& warning : summary.warnings) {
    if (FLAGS_candidates) std::printf("  %s\n", warning.c_str());
  }
}

void PrintPair(const std::string& folder, const std::string& source, const std::string& target,
               const std::string& truth, Sum* sum) {
  const Poses from = ReadPoses({folder + "/" + source + ".obj"});
  const Poses to = ReadPoses({folder + "/" + target + ".obj"});
  const internal::SurfaceMatcher matcher(*from.connectivity, from.shapes[0], *to.connectivity,
                                         to.shapes[0]);
  const internal::Matching matching = matcher.FindCandidates();
  ++sum->pairs;
  std::printf("| %s %s | %d, %d | %d, %d | %.2f = %.2f + %.2f + %.2f + %.2f + %.2f | ",
              source.c_str(), target.c_str(), matching.template_extremities,
              matching.target_extremities, matching.maps, matching.maps_refused,
              matcher.Seconds() + matching.assignment_seconds + matching.map_seconds +
                  matching.figure_seconds + matching.marker_seconds,
              matcher.Seconds(), matching.assignment_seconds, matching.map_seconds,
              matching.figure_seconds, matching.marker_seconds);
  if (matching.candidates.empty()) {
    ++sum->none;
    std::printf("none: %s |\n", matching.problem.c_str());
    return;
  }
  const Judge judge(*to.connectivity, to.shapes[0], ReadPairs(folder + "/" + truth));
  std::vector<double> errors;
  for (const internal::MapCandidate& candidate : matching.candidates) {
    errors.push_back(judge.Of(matcher.MapVertices(candidate)).mean);
  }
  const double best = *std::min_element(errors.begin(), errors.end());
  sum->first += errors[0];
  sum->best += best;
  std::printf("%.2f | %.2f | ", errors[0], best);
  if (FLAGS_fit) {
    PrintFit(from, to, judge, sum);
  } else {
    std::printf("|\n");
  }
  for (size_t i = 0; FLAGS_candidates && i < errors.size(); ++i) {
    const internal::MapCandidate& candidate = matching.candidates[i];
    std::printf("  map %d: error %.2f cost %.3f isometry %.3f curvature %.3f orientation %.3f\n",
                static_cast<int>(i + 1), errors[i], candidate.Cost(), candidate.isometry,
                candidate.curvature, candidate.orientation);
  }
  std::fflush(stdout);
}

void PrintFolder(const std::string& folder) {
  std::printf(
      "\n| %s | extremities | maps, refused | seconds: bodies, assignments, maps, figures, "
      "markers | first map | best | fit | 95 %% | certainty | turned | seconds |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n",
      folder.c_str());
  std::ifstream stream(folder + "/pairs.txt");
  Sum sum;
  for (std::string source, target, truth; stream >> source >> target >> truth;) {
    if ((source + " " + target).find(FLAGS_name) == std::string::npos) continue;
    PrintPair(folder, source, target, truth, &sum);
  }
  if (sum.pairs == 0) {
    std::fprintf(stderr, "%s/pairs.txt is missing, or names no such pair\n", folder.c_str());
    std::exit(1);
  }
  const double found = sum.pairs - sum.none;
  std::printf(
      "| mean of %d, %d without a map, %d gross, %d of them without a warning | | | | %.2f | "
      "%.2f | %.2f | %.2f | | | %.1f |\n",
      sum.pairs, sum.none, sum.gross, sum.silent, sum.first / found, sum.best / found,
      sum.fit / found, sum.p95 / found, sum.seconds / found);
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) {
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  for (int i = 1; i < argc; ++i) shapespace::PrintFolder(argv[i]);
}
