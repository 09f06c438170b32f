#include <shapespace/matching/detail/known_ends.h>

namespace shapespace::internal {
namespace {

// A pair is at an extremity that is no farther from it, as a share of the root of the area: a hand
// of a person is 0.17 long, and the ears of a cat are as far from its eyes.
constexpr float kAtEnd = 0.08F;
// More than any assignment costs.
constexpr double kImpossible = 1e3;

// The extremity at a vertex, as an index; -1 if there is none.
int EndAt(const MatchingBody& body, const std::vector<int>& extremities, int vertex) {
  const Eigen::VectorXf distances = body.graph.From(vertex);
  int nearest = -1;
  for (size_t i = 0; i < extremities.size(); ++i) {
    const float distance = distances(extremities[i]);
    if (distance <= kAtEnd && (nearest < 0 || distance < distances(extremities[nearest]))) {
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

}  // namespace

KnownEnds::KnownEnds(const MatchingBody& on_template, const std::vector<int>& template_extremities,
                     const MatchingBody& on_target, const std::vector<int>& target_extremities,
                     const VertexPairs& known)
    : difference(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(template_extremities.size()),
                                       static_cast<Eigen::Index>(target_extremities.size()))) {
  for (const auto& [from, to] : known) {
    const int row = EndAt(on_template, template_extremities, from),
              column = EndAt(on_target, target_extremities, to);
    if (row < 0 || column < 0) {
      landmarks.emplace_back(from, to);
      continue;
    }
    const double before = difference(row, column);
    difference.row(row).setConstant(kImpossible);
    difference.col(column).setConstant(kImpossible);
    difference(row, column) = before;
  }
}

}  // namespace shapespace::internal
