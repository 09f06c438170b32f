// Maps between bodies that are found without markers, judged by known answers: prints a table in
// Markdown. Errors are distances along the target's surface in per cent of the root of its area,
// means over the known vertices: of the map of the candidate that costs least, of the best of all
// candidates, and of the first one's markers. Seconds depend on the machine.
//
//   matching_table FOLDER...   every folder has a file pairs.txt: a line for each pair with the
//   names
//                              of two meshes, FOLDER/NAME.obj, and of the file with their known
//                              answer, lines with a vertex of each, from 1
//
// A line for each candidate is printed with --candidates.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gflags/gflags.h>

#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/files/read.h>
#include <shapespace/matching/detail/surface_graph.h>
#include <shapespace/matching/internal/matching.h>
#include <shapespace/mesh/internal/geometry.h>

DEFINE_bool(candidates, false, "print a line for each candidate");
DEFINE_string(name, "", "only the pairs whose names contain this");

namespace shapespace {
namespace {

using VertexPairs = std::vector<std::pair<int, int>>;

VertexPairs ReadPairs(const std::string& file) {
  std::ifstream stream(file);
  VertexPairs pairs;
  for (int from, to; stream >> from >> to;) pairs.emplace_back(from - 1, to - 1);
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

  double OfMap(const std::vector<int>& map) const {
    VertexPairs pairs;
    // Enough for the mean; a search along the surface for each takes time.
    const size_t step = truth_.size() / 500 + 1;
    for (size_t i = 0; i < truth_.size(); i += step) {
      pairs.emplace_back(map[truth_[i].first], truth_[i].second);
    }
    return Mean(pairs);
  }

  double OfMarkers(const VertexPairs& markers) const {
    VertexPairs pairs;
    for (const auto& [from, to] : markers) {
      for (const auto& [known, answer] : truth_) {
        if (known == from) pairs.emplace_back(to, answer);
      }
    }
    return Mean(pairs);
  }

 private:
  double Mean(const VertexPairs& pairs) const {
    std::vector<int> sources;
    for (const auto& pair : pairs) sources.push_back(pair.second);
    const Eigen::MatrixXf distances = graph_.FromEach(sources);
    double sum = 0;
    for (size_t i = 0; i < pairs.size(); ++i) sum += distances(pairs[i].first, i);
    return sum / static_cast<double>(pairs.size()) / unit_;
  }

  const internal::SurfaceGraph graph_;
  const VertexPairs truth_;
  double unit_;
};

struct Sum {
  int pairs = 0, none = 0, gross = 0;
  double first = 0, best = 0, markers = 0, seconds = 0;
};

void PrintPair(const std::string& folder, const std::string& source, const std::string& target,
               const std::string& truth, Sum* sum) {
  const Poses from = ReadPoses({folder + "/" + source + ".obj"});
  const Poses to = ReadPoses({folder + "/" + target + ".obj"});
  const internal::Stopwatch stopwatch;
  const internal::SurfaceMatcher matcher(*from.connectivity, from.shapes[0], *to.connectivity,
                                         to.shapes[0]);
  const internal::Matching matching = matcher.FindCandidates();
  const double seconds = stopwatch.Seconds();
  ++sum->pairs;
  sum->seconds += seconds;
  std::printf("| %s %s | %d, %d | %d | %d, %d | ", source.c_str(), target.c_str(),
              matching.template_extremities, matching.target_extremities,
              matching.assignments_tried, matching.maps, matching.maps_refused);
  const std::string times = [&] {
    std::ostringstream text;
    text.precision(2);
    text << seconds << " = " << matcher.Seconds() << " + " << matching.assignment_seconds << " + "
         << matching.map_seconds << " + " << matching.figure_seconds << " + "
         << matching.marker_seconds;
    return text.str();
  }();
  if (matching.candidates.empty()) {
    ++sum->none;
    std::printf("none: %s | | | %s |\n", matching.problem.c_str(), times.c_str());
    return;
  }
  const Judge judge(*to.connectivity, to.shapes[0], ReadPairs(folder + "/" + truth));
  std::vector<double> errors;
  for (const internal::MapCandidate& candidate : matching.candidates) {
    errors.push_back(judge.OfMap(matcher.MapVertices(candidate)));
  }
  const double best = *std::min_element(errors.begin(), errors.end());
  const double markers = judge.OfMarkers(matching.candidates[0].markers);
  std::printf("%.2f | %.2f | %.2f of %d | %s |\n", errors[0], best, markers,
              static_cast<int>(matching.candidates[0].markers.size()), times.c_str());
  for (size_t i = 0; FLAGS_candidates && i < errors.size(); ++i) {
    const internal::MapCandidate& candidate = matching.candidates[i];
    std::printf("  error %.2f cost %.3f isometry %.3f curvature %.3f orientation %.3f markers %d\n",
                errors[i], candidate.Cost(), candidate.isometry, candidate.curvature,
                candidate.orientation, static_cast<int>(candidate.markers.size()));
  }
  std::fflush(stdout);
  sum->first += errors[0];
  sum->best += best;
  sum->markers += markers;
  if (best > 10) ++sum->gross;
}

void PrintFolder(const std::string& folder) {
  std::printf(
      "\n| %s | extremities | tried | maps, refused | first | best | markers | seconds: bodies, "
      "assignments, maps, figures, markers |\n|---|---|---|---|---|---|---|---|\n",
      folder.c_str());
  std::ifstream stream(folder + "/pairs.txt");
  Sum sum;
  for (std::string source, target, truth; stream >> source >> target >> truth;) {
    if ((source + " " + target).find(FLAGS_name) == std::string::npos) continue;
    PrintPair(folder, source, target, truth, &sum);
  }
  const double found = sum.pairs - sum.none;
  std::printf("| mean of %d, %d without a map, %d gross | | | | %.2f | %.2f | %.2f | %.2f |\n",
              sum.pairs, sum.none, sum.gross, sum.first / found, sum.best / found,
              sum.markers / found, sum.seconds / sum.pairs);
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) {
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  for (int i = 1; i < argc; ++i) shapespace::PrintFolder(argv[i]);
}
