#include <shapespace/exploration/detail/refinement.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <shapespace/base/internal/stopwatch.h>

namespace shapespace::internal {
namespace {

using Edge = std::pair<int, int>;  // the smaller node first

Edge MakeEdge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class Refinement {
 public:
  Refinement(const ExploreOptions& options, PairSolver* solver, PoseSpace* space)
      : options_(options), solver_(*solver), space_(*space) {}

  // Measures all new edges. Returns false if none is too long.
  bool Measure(Progress* progress, ExploreSummary::Level* level);
  // Splits the cells that have an edge that is too long.
  void Split();
  std::set<Edge> EdgesNotMeasured() const;

 private:
  struct Side {
    bool marked = false;
    int middle = -1;  // index of the midpoint's node, once it exists
    Shape shape;      // the midpoint, until then
  };

  std::set<Edge> Edges() const;
  bool IsMarked(int a, int b) const { return sides_.at(MakeEdge(a, b)).marked; }
  int Middle(int a, int b);
  void SplitTriangles();
  void SplitSegments();

  const ExploreOptions& options_;
  PairSolver& solver_;
  PoseSpace& space_;
  std::map<Edge, Side> sides_;  // all measured edges
};

std::set<Edge> Refinement::Edges() const {
  std::set<Edge> edges;
  for (int t = 0; t < space_.triangles.cols(); ++t) {
    const Eigen::Vector3i v = space_.triangles.col(t);
    for (int k = 0; k < 3; ++k) edges.insert(MakeEdge(v(k), v((k + 1) % 3)));
  }
  for (int s = 0; s < space_.segments.cols(); ++s) {
    edges.insert(MakeEdge(space_.segments(0, s), space_.segments(1, s)));
  }
  return edges;
}

std::set<Edge> Refinement::EdgesNotMeasured() const {
  std::set<Edge> edges = Edges();
  for (const auto& side : sides_) edges.erase(side.first);
  return edges;
}

bool Refinement::Measure(Progress* progress, ExploreSummary::Level* level) {
  const std::set<Edge> edges = EdgesNotMeasured();
  std::vector<Pair> pairs;
  for (const Edge& edge : edges) {
    pairs.push_back({&space_.nodes[edge.first], &space_.nodes[edge.second]});
  }
  std::vector<PairResult> results = solver_.Solve(pairs, "shapes half way", progress);
  level->cells = static_cast<int>(space_.triangles.cols() + space_.segments.cols());
  level->edges = static_cast<int>(edges.size());
  size_t i = 0;
  for (const Edge& edge : edges) {
    PairResult& result = results[i++];
    const double excess = result.length > 0 ? result.blend_length / result.length - 1 : 0;
    level->greatest_excess = std::fmax(level->greatest_excess, excess);
    const bool marked = excess > options_.threshold;
    if (marked) ++level->marked;
    sides_[edge] = {marked, -1, std::move(result.shape)};
  }
  return level->marked > 0;
}

int Refinement::Middle(int a, int b) {
  const Edge edge = MakeEdge(a, b);
  Side& side = sides_.at(edge);
  if (side.middle < 0) {
    side.middle = space_.NumNodes();
    space_.nodes.push_back(std::move(side.shape));
    space_.parents.push_back({edge.first, edge.second});
    space_.points.conservativeResize(2, side.middle + 1);
    space_.points.col(side.middle) =
        0.5 * (space_.points.col(edge.first) + space_.points.col(edge.second));
  }
  return side.middle;
}

void Refinement::Split() {
  if (space_.triangles.cols() > 0) {
    SplitTriangles();
  } else {
    SplitSegments();
  }
}

void Refinement::SplitTriangles() {
  const Eigen::Matrix3Xi before = space_.triangles;
  // A triangle with a marked side is split into four, which halves all its sides. A neighbour with
  // two halved sides is split too, and so on until nothing changes.
  std::set<Edge> split;
  std::vector<bool> is_split(before.cols(), false);
  const auto count_split = [&](int t) {
    int count = 0;
    for (int k = 0; k < 3; ++k)
      count += split.count(MakeEdge(before(k, t), before((k + 1) % 3, t)));
    return count;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (int t = 0; t < before.cols(); ++t) {
      if (is_split[t]) continue;
      const Eigen::Vector3i v = before.col(t);
      if (!IsMarked(v(0), v(1)) && !IsMarked(v(1), v(2)) && !IsMarked(v(2), v(0)) &&
          count_split(t) < 2) {
        continue;
      }
      for (int k = 0; k < 3; ++k) split.insert(MakeEdge(v(k), v((k + 1) % 3)));
      is_split[t] = changed = true;
    }
  }

  std::vector<Eigen::Vector3i> after;
  for (int t = 0; t < before.cols(); ++t) {
    const Eigen::Vector3i v = before.col(t);
    if (is_split[t]) {
      const Eigen::Vector3i m(Middle(v(0), v(1)), Middle(v(1), v(2)), Middle(v(2), v(0)));
      after.emplace_back(v(0), m(0), m(2));
      after.emplace_back(m(0), v(1), m(1));
      after.emplace_back(m(2), m(1), v(2));
      after.push_back(m);
      continue;
    }
    int side = 0;
    while (side < 3 && split.count(MakeEdge(v(side), v((side + 1) % 3))) == 0) ++side;
    if (side == 3) {
      after.push_back(v);
      continue;
    }
    const int a = v(side), b = v((side + 1) % 3), c = v((side + 2) % 3), m = Middle(a, b);
    after.emplace_back(a, m, c);
    after.emplace_back(m, b, c);
  }
  space_.triangles.resize(3, after.size());
  for (size_t t = 0; t < after.size(); ++t) space_.triangles.col(t) = after[t];
}

void Refinement::SplitSegments() {
  std::vector<Eigen::Vector2i> after;
  for (int s = 0; s < space_.segments.cols(); ++s) {
    const int a = space_.segments(0, s), b = space_.segments(1, s);
    if (IsMarked(a, b)) {
      after.emplace_back(a, Middle(a, b));
      after.emplace_back(Middle(a, b), b);
    } else {
      after.emplace_back(a, b);
    }
  }
  space_.segments.resize(2, after.size());
  for (size_t s = 0; s < after.size(); ++s) space_.segments.col(s) = after[s];
}

}  // namespace

void Refine(const ExploreOptions& options, PairSolver* solver, Progress* progress, PoseSpace* space,
            ExploreSummary* summary) {
  Refinement refinement(options, solver, space);
  for (int depth = 0; depth < options.depth; ++depth) {
    const Stopwatch stopwatch;
    ExploreSummary::Level level;
    const int nodes = space->NumNodes();
    const bool some_are_marked = refinement.Measure(progress, &level);
    if (some_are_marked) refinement.Split();
    level.new_nodes = space->NumNodes() - nodes;
    level.seconds = stopwatch.Seconds();
    summary->levels.push_back(level);
    if (!some_are_marked) break;
  }
  summary->edges_not_measured = static_cast<int>(refinement.EdgesNotMeasured().size());
}

}  // namespace shapespace::internal
