#include <shapespace/matching/detail/markers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <shapespace/matching/detail/nearest_columns.h>

namespace shapespace::internal {
namespace {

constexpr size_t kMostMarkers = 40;
// How far the way to the target and back may end from where it began, and how far apart markers
// are; shares of the root of the area.
constexpr float kRoundTrip = 0.02F;
constexpr float kSpacing = 0.06F;
// The ends of a head are nearer to each other than this, feet are not.
constexpr float kNear = 0.3F;

// On coarse meshes, where edges are longer than that, the way back may end at a neighbour: the
// length of the edges of equal triangles of as many vertices.
float RoundTrip(const MatchingBody& body) {
  return std::max(kRoundTrip, 1.07F / std::sqrt(static_cast<float>(body.surface.NumVertices())));
}

// Where vertices of the template are sent to, and where their images are sent back to.
struct Ways {
  std::vector<int> there, back;

  Ways(const AlignedPoints& points, const std::vector<int>& vertices, int num_targets)
      : there(NearestColumns(Columns(points.on_template, vertices),
                             points.on_target.leftCols(num_targets))),
        back(NearestColumns(Columns(points.on_target, there), points.on_template)) {}

  static Eigen::MatrixXf Columns(const Eigen::MatrixXf& points, const std::vector<int>& which) {
    Eigen::MatrixXf columns(points.rows(), which.size());
    for (size_t i = 0; i < which.size(); ++i) columns.col(i) = points.col(which[i]);
    return columns;
  }
};

// Markers one after the other, with the distances of the even samples from all of them.
class Chosen {
 public:
  explicit Chosen(const EvenSamples& even)
      : even_(even),
        least_(Eigen::VectorXf::Constant(static_cast<Eigen::Index>(even.vertices.size()),
                                         std::numeric_limits<float>::infinity())) {}

  bool IsFull() const { return pairs_.size() >= kMostMarkers; }
  bool HasTarget(int to) const { return targets_.count(to) > 0; }
  const Eigen::VectorXf& Least() const { return least_; }
  const VertexPairs& Pairs() const { return pairs_; }

  // `distances` are those of all vertices from the marker.
  void KeepAwayFrom(const Eigen::VectorXf& distances, int to) {
    targets_.insert(to);
    for (Eigen::Index i = 0; i < least_.size(); ++i) {
      least_(i) = std::min(least_(i), distances(even_.vertices[i]));
    }
  }
  void Add(int from, int to, const Eigen::VectorXf& distances) {
    pairs_.emplace_back(from, to);
    KeepAwayFrom(distances, to);
  }

 private:
  const EvenSamples& even_;
  Eigen::VectorXf least_;
  std::set<int> targets_;
  VertexPairs pairs_;
};

// As the ears and the snout of a head are near each other. `distances` are those from the end.
bool HasAnotherEndNear(const MatchingBody& body, int end, const Eigen::VectorXf& distances) {
  return std::any_of(body.all_extremities.begin(), body.all_extremities.end(),
                     [&](int other) { return other != end && distances(other) < kNear; });
}

}  // namespace

VertexPairs ChooseMarkers(const MatchingBody& on_template, const MatchingBody& on_target,
                          const AlignedPoints& points, const VertexPairs& extremities,
                          const VertexPairs& given,
                          const std::function<bool(int from, int to)>& admits) {
  const EvenSamples& even = on_template.even;
  const float round_trip = RoundTrip(on_template);
  Chosen chosen(even);
  using Flags = Eigen::Array<bool, Eigen::Dynamic, 1>;
  Flags is_given = Flags::Constant(on_template.surface.NumVertices(), false);
  for (const auto& [from, to] : given) {
    const Eigen::VectorXf distances = on_template.graph.From(from);
    chosen.KeepAwayFrom(distances, to);
    is_given = is_given || distances.array() < kSpacing;
  }
  std::vector<int> ends;
  for (const auto& pair : extremities) ends.push_back(pair.first);
  const Ways of_ends(points, ends, on_target.surface.num_own);
  for (size_t i = 0; i < ends.size(); ++i) {
    const Eigen::VectorXf distances = on_template.graph.From(ends[i]);
    // Where the map is vague, the end of a limb is at least on the right limb; but an ear is no
    // snout.
    const bool vague = distances(of_ends.back[i]) > round_trip;
    const int to = vague ? extremities[i].second : of_ends.there[i];
    if (vague && (HasAnotherEndNear(on_template, ends[i], distances) ||
                  HasAnotherEndNear(on_target, to, on_target.graph.From(to)))) {
      continue;
    }
    if (is_given(ends[i]) || !admits(ends[i], to) || chosen.HasTarget(to)) continue;
    chosen.Add(ends[i], to, distances);
  }
  const Ways ways(points, even.vertices, on_target.surface.num_own);
  std::vector<bool> possible(even.vertices.size());
  for (size_t i = 0; i < possible.size(); ++i) {
    possible[i] =
        even.distances(ways.back[i], i) <= round_trip && admits(even.vertices[i], ways.there[i]);
  }
  while (!chosen.IsFull()) {
    int next = -1;
    for (size_t i = 0; i < possible.size(); ++i) {
      if (!possible[i] || chosen.Least()(i) < kSpacing) continue;
      if (next < 0 || chosen.Least()(i) > chosen.Least()(next)) next = static_cast<int>(i);
    }
    if (next < 0) break;
    possible[next] = false;
    if (chosen.HasTarget(ways.there[next])) continue;
    chosen.Add(even.vertices[next], ways.there[next], even.distances.col(next));
  }
  return chosen.Pairs();
}

}  // namespace shapespace::internal
