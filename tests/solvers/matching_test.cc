#include <shapespace/matching/internal/matching.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/renumbered.h"
#include "support/threads.h"

namespace shapespace {
namespace {

using internal::MapCandidate;
using internal::Matching;
using internal::MatchingOptions;
using internal::SurfaceMatcher;
using testing::MessageOf;
using testing::Names;
using VertexPairs = std::vector<std::pair<int, int>>;

struct MatchedBody {
  std::shared_ptr<const Connectivity> connectivity;
  Shape shape;
};

MatchedBody Animal(const std::string& pose, int triangles, const QuadrupedForm& form = {}) {
  const SkinnedBody body = MakeQuadruped(triangles, form);
  return {body.connectivity, body.pose(pose)};
}

double RootArea(const MatchedBody& body) {
  double area = 0;
  for (const auto& t : body.connectivity->Triangles().colwise()) {
    const Eigen::Vector3d a = body.shape.col(t(0));
    area += 0.5 * (body.shape.col(t(1)) - a).cross(body.shape.col(t(2)) - a).norm();
  }
  return std::sqrt(area);
}

SurfaceMatcher Match(const MatchedBody& first, const MatchedBody& second,
                     const MatchingOptions& options = {}) {
  return SurfaceMatcher(*first.connectivity, first.shape, *second.connectivity, second.shape,
                        options);
}

// The mean distance between images and the places `right` (3 x vertices of the template), on a body
// whose vertices are at `places`, as a share of its root area.
double MeanError(const std::vector<int>& map, const MatchedBody& on, const Shape& right) {
  double sum = 0;
  for (size_t v = 0; v < map.size(); ++v) sum += (on.shape.col(map[v]) - right.col(v)).norm();
  return sum / static_cast<double>(map.size()) / RootArea(on);
}

std::vector<int> RandomOrder(Eigen::Index count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  return order;
}

MatchedBody MirrorImage(const MatchedBody& body) {
  Shape shape = body.shape;
  shape.row(0) *= -1;
  Eigen::Matrix3Xi triangles = body.connectivity->Triangles();
  triangles.row(1).swap(triangles.row(2));
  return {Connectivity::FromTriangles(static_cast<int>(shape.cols()), triangles), shape};
}

// A ball or an egg: an octahedron, each edge of which is divided by two several times.
MatchedBody Egg(int divisions, double length) {
  std::vector<Eigen::Vector3d> points;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) points.push_back(sign * Eigen::Vector3d::Unit(axis));
  }
  std::vector<Eigen::Vector3i> triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                            {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int division = 0; division < divisions; ++division) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), 0);
      if (is_new) {
        found->second = static_cast<int>(points.size());
        points.push_back((points[a] + points[b]).normalized());
      }
      return found->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& t : triangles) {
      const int a = middle(t(1), t(2)), b = middle(t(2), t(0)), c = middle(t(0), t(1));
      for (const Eigen::Vector3i& part : {Eigen::Vector3i(t(0), c, b), Eigen::Vector3i(c, t(1), a),
                                          Eigen::Vector3i(b, a, t(2)), Eigen::Vector3i(a, b, c)}) {
        finer.push_back(part);
      }
    }
    triangles = finer;
  }
  Shape shape(3, points.size());
  for (size_t v = 0; v < points.size(); ++v) shape.col(v) = points[v];
  shape.row(2) *= length;
  Eigen::Matrix3Xi columns(3, triangles.size());
  for (size_t f = 0; f < triangles.size(); ++f) columns.col(f) = triangles[f];
  return {Connectivity::FromTriangles(static_cast<int>(points.size()), columns), shape};
}

// Two animals that are one, with different connectivity: the second is in a pose.
struct TwoMeshes {
  MatchedBody first, second;
  Shape right;  // of each vertex of the first, its place on the second

  TwoMeshes(const std::string& pose, int first_triangles, int second_triangles)
      : first(Animal("stand", first_triangles)), second(Animal(pose, second_triangles)) {
    const MatchedBody rest = Animal("stand", second_triangles);
    right.resize(3, first.shape.cols());
    for (Eigen::Index v = 0; v < right.cols(); ++v) {
      Eigen::Index nearest;
      (rest.shape.colwise() - first.shape.col(v)).colwise().squaredNorm().minCoeff(&nearest);
      right.col(v) = second.shape.col(nearest);
    }
  }
};

TEST(Matching, FindsABodyInItselfRenumberedMovedAndScaled) {
  const MatchedBody body = Animal("stride", 4000);
  const std::vector<int> order = RandomOrder(body.shape.cols());
  const auto [connectivity, shape] = testing::Renumbered(*body.connectivity, body.shape, order);
  MatchedBody other = {connectivity, shape};
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()));
  other.shape = (1e-3 * turn * other.shape).colwise() + Eigen::Vector3d(5, -7, 9);
  const SurfaceMatcher matcher = Match(body, other);
  const Matching matching = matcher.FindCandidates();
  ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
  EXPECT_EQ(matching.template_extremities, 6);
  EXPECT_EQ(matching.target_extremities, 6);
  const MapCandidate& best = matching.candidates[0];
  Shape right(3, body.shape.cols());
  for (Eigen::Index v = 0; v < right.cols(); ++v) right.col(v) = other.shape.col(order[v]);
  EXPECT_LT(MeanError(matcher.MapVertices(best), other, right), 0.005);
  EXPECT_LT(best.isometry, 0.01);
  EXPECT_GT(best.curvature, 0.99);
  EXPECT_GT(best.orientation, 0.99);
  EXPECT_LT(best.Cost(), 0.01);
}

TEST(Matching, DoesNotFindAMirrorImage) {
  const MatchedBody body = Animal("stride", 3000), mirrored = MirrorImage(body);
  const SurfaceMatcher matcher = Match(body, mirrored);
  const Matching matching = matcher.FindCandidates();
  ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
  for (const MapCandidate& candidate : matching.candidates) {
    EXPECT_GE(candidate.orientation, 0.2);
    // That each vertex is mapped to its own image would be a perfect isometry.
    EXPECT_GT(MeanError(matcher.MapVertices(candidate), mirrored, mirrored.shape), 0.05);
  }
}

TEST(Matching, FindsAnotherPoseOfAnotherMesh) {
  for (const std::string pose : {"rear", "sit"}) {
    const TwoMeshes pair(pose, 3000, 4400);
    const SurfaceMatcher matcher = Match(pair.first, pair.second);
    const Matching matching = matcher.FindCandidates();
    ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
    double least = std::numeric_limits<double>::infinity();
    for (const MapCandidate& candidate : matching.candidates) {
      least = std::min(least, MeanError(matcher.MapVertices(candidate), pair.second, pair.right));
    }
    EXPECT_LT(least, 0.03) << pose;
  }
}

TEST(Matching, MarkersAreSpreadOverTheBodyAndNearTheirPlaces) {
  const TwoMeshes pair("stride", 3000, 4400);
  const Matching matching = Match(pair.first, pair.second).FindCandidates();
  ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
  const MapCandidate& best = matching.candidates[0];
  EXPECT_GE(best.markers.size(), 30);
  EXPECT_LE(best.markers.size(), 40);
  std::set<int> from, to;
  double sum = 0;
  for (const auto& [a, b] : best.markers) {
    from.insert(a);
    to.insert(b);
    sum += (pair.second.shape.col(b) - pair.right.col(a)).norm();
  }
  EXPECT_EQ(from.size(), best.markers.size());
  EXPECT_EQ(to.size(), best.markers.size());
  EXPECT_LT(sum / best.markers.size() / RootArea(pair.second), 0.03);
  // Extremities come before all others.
  const auto is_end = [&](const auto& marker) {
    return std::any_of(best.extremities.begin(), best.extremities.end(),
                       [&](const auto& end) { return end.first == marker.first; });
  };
  EXPECT_GE(std::count_if(best.markers.begin(), best.markers.end(), is_end), 1);
  EXPECT_TRUE(std::is_partitioned(best.markers.begin(), best.markers.end(), is_end));
}

TEST(Matching, IsTheSameOnAnyThreads) {
  const TwoMeshes pair("rear", 2000, 2600);
  const auto results = testing::OnThreads([&] {
    const Matching matching = Match(pair.first, pair.second).FindCandidates();
    std::vector<double> numbers;
    for (const MapCandidate& candidate : matching.candidates) {
      for (const double figure : {candidate.isometry, candidate.curvature, candidate.orientation,
                                  static_cast<double>(candidate.from_target.sum())}) {
        numbers.push_back(figure);
      }
      for (const auto& [a, b] : candidate.markers) {
        numbers.push_back(a);
        numbers.push_back(b);
      }
    }
    return numbers;
  });
  ASSERT_FALSE(results[0].empty());
  for (const auto& result : results) EXPECT_EQ(result, results[0]);
}

TEST(Matching, AgreesWithGivenPairs) {
  const TwoMeshes pair("stride", 3000, 4400);
  const SurfaceMatcher matcher = Match(pair.first, pair.second);
  const Matching free = matcher.FindCandidates();
  ASSERT_FALSE(free.candidates.empty()) << free.problem;
  const VertexPairs ends = free.candidates[0].extremities;
  ASSERT_EQ(ends.size(), 6);
  // A given pair that is right stays the first marker.
  const VertexPairs right = {ends[0]};
  const Matching same = matcher.FindCandidates(right);
  ASSERT_FALSE(same.candidates.empty()) << same.problem;
  EXPECT_EQ(same.candidates[0].markers[0], right[0]);
  EXPECT_LT(MeanError(matcher.MapVertices(same.candidates[0]), pair.second, pair.right), 0.05);
  // An end that is given a partner a little beside that of the map has no other marker.
  Eigen::VectorXd apart =
      (pair.second.shape.colwise() - pair.second.shape.col(ends[0].second)).colwise().norm();
  apart(ends[0].second) = 1e9;
  Eigen::Index beside;
  apart.minCoeff(&beside);
  for (const MapCandidate& candidate :
       matcher.FindCandidates({{ends[0].first, static_cast<int>(beside)}}).candidates) {
    EXPECT_EQ(std::count_if(candidate.markers.begin(), candidate.markers.end(),
                            [&](const auto& marker) { return marker.first == ends[0].first; }),
              1);
  }
  // An end that is given another partner has this partner in all candidates.
  const VertexPairs other = {{ends[0].first, ends[1].second}};
  for (const MapCandidate& candidate : matcher.FindCandidates(other).candidates) {
    EXPECT_EQ(std::count(candidate.extremities.begin(), candidate.extremities.end(), other[0]), 1);
    EXPECT_EQ(candidate.markers[0], other[0]);
  }
  const auto call = [&] { (void)matcher.FindCandidates({{0, 1000000}}); };
  EXPECT_NE(MessageOf<MeshError>(call).find("vertex 1000001 of the target"), std::string::npos);
}

TEST(Matching, SaysWhyABodyOfFewVerticesHasNoMap) {
  const Matching tiny = Match(Egg(0, 1), Animal("stand", 1500)).FindCandidates();
  EXPECT_TRUE(tiny.candidates.empty());
  EXPECT_TRUE(Names(tiny.problem, {"template", "6 vertices"}));
}

// An egg with a flat side and a bump has no limbs, and no symmetry.
TEST(Matching, FindsBodiesWithoutLimbsByTheirAxes) {
  const auto body = [](int divisions) {
    MatchedBody egg = Egg(divisions, 2.2);
    for (auto point : egg.shape.colwise()) {
      point(1) = std::min(point(1), 0.6);
      const double bump = std::exp(-20 * (point - Eigen::Vector3d(0.9, 0, 1)).squaredNorm());
      point += 0.25 * bump * Eigen::Vector3d(1, 0.3, 0.6);
      point(0) *= 1 + 0.2 * point(2);
    }
    return egg;
  };
  const MatchedBody first = body(4);
  MatchedBody second = body(5);
  const Shape right = second.shape;
  second.shape =
      0.1 * Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix() *
      second.shape;
  const SurfaceMatcher matcher = Match(first, second);
  const Matching matching = matcher.FindCandidates();
  ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
  EXPECT_LT(matching.template_extremities, 3);
  const std::vector<int> map = matcher.MapVertices(matching.candidates[0]);
  double sum = 0;
  for (int v = 0; v < first.shape.cols(); ++v) {
    sum += (right.col(map[v]) - first.shape.col(v)).norm();
  }
  EXPECT_LT(sum / static_cast<double>(map.size()) / RootArea(first), 0.03);
}

TEST(Matching, MapsTheLargestComponent) {
  const TwoMeshes pair("rear", 2000, 2600);
  // A small ball and a vertex without triangle before the body.
  const MatchedBody ball = Egg(1, 1);
  const int before = static_cast<int>(ball.shape.cols()) + 1;
  MatchedBody more;
  more.shape.resize(3, before + pair.first.shape.cols());
  more.shape << Eigen::Vector3d(9, 9, 9), (0.01 * ball.shape).colwise() + Eigen::Vector3d(3, 0, 0),
      pair.first.shape;
  Eigen::Matrix3Xi triangles(
      3, ball.connectivity->NumTriangles() + pair.first.connectivity->NumTriangles());
  triangles << ball.connectivity->Triangles().array() + 1,
      pair.first.connectivity->Triangles().array() + before;
  more.connectivity = Connectivity::FromTriangles(static_cast<int>(more.shape.cols()), triangles);
  const SurfaceMatcher alone = Match(pair.first, pair.second), among = Match(more, pair.second);
  const Matching first = alone.FindCandidates(), second = among.FindCandidates();
  ASSERT_EQ(second.candidates.size(), first.candidates.size());
  const std::vector<int> map = alone.MapVertices(first.candidates[0]);
  const std::vector<int> with_others = among.MapVertices(second.candidates[0]);
  EXPECT_EQ(std::count(with_others.begin(), with_others.begin() + before, -1), before);
  const auto moved = [&](const std::vector<int>& whole) {
    return std::vector<int>(whole.begin() + before, whole.end());
  };
  const double off = MeanError(moved(with_others), pair.second, pair.right);
  EXPECT_NEAR(off, MeanError(map, pair.second, pair.right), 0.005);
}

TEST(Matching, EnduresTrianglesWithoutArea) {
  const TwoMeshes pair("rear", 2000, 2600);
  // A vertex on a side of every tenth triangle, but not of its neighbour.
  MatchedBody worn = pair.first;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Eigen::Vector3d> added;
  const auto count = static_cast<int>(pair.first.shape.cols());
  for (int f = 0; f < pair.first.connectivity->NumTriangles(); ++f) {
    const Eigen::Vector3i t = pair.first.connectivity->Triangles().col(f);
    if (f % 10 != 0) {
      triangles.push_back(t);
      continue;
    }
    const int middle = count + static_cast<int>(added.size());
    added.push_back(0.5 * (worn.shape.col(t(0)) + worn.shape.col(t(1))));
    triangles.emplace_back(t(0), t(1), middle);
    triangles.emplace_back(t(1), t(2), middle);
    triangles.emplace_back(t(2), t(0), middle);
  }
  worn.shape.conservativeResize(Eigen::NoChange, count + static_cast<Eigen::Index>(added.size()));
  for (size_t i = 0; i < added.size(); ++i) worn.shape.col(count + i) = added[i];
  Eigen::Matrix3Xi columns(3, triangles.size());
  for (size_t f = 0; f < triangles.size(); ++f) columns.col(f) = triangles[f];
  worn.connectivity = Connectivity::FromTriangles(static_cast<int>(worn.shape.cols()), columns);
  const SurfaceMatcher matcher = Match(worn, pair.second);
  const Matching matching = matcher.FindCandidates();
  ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
  std::vector<int> map = matcher.MapVertices(matching.candidates[0]);
  map.resize(count);
  EXPECT_LT(MeanError(map, pair.second, pair.right), 0.035);
}

TEST(Matching, DecimatesLargeMeshes) {
  const TwoMeshes pair("stride", 24000, 4400);
  const SurfaceMatcher matcher = Match(pair.first, pair.second);
  const Matching matching = matcher.FindCandidates();
  ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
  EXPECT_LT(MeanError(matcher.MapVertices(matching.candidates[0]), pair.second, pair.right), 0.05);
}

TEST(Matching, StopsWhenAskedTo) {
  const TwoMeshes pair("rear", 1500, 2000);
  const auto call = [&](Progress* progress) {
    const SurfaceMatcher matcher(*pair.first.connectivity, pair.first.shape,
                                 *pair.second.connectivity, pair.second.shape, {}, progress);
    (void)matcher.FindCandidates({}, progress);
  };
  testing::Listener all;
  call(&all);
  for (int last = 1; last <= all.reports; ++last) {
    testing::Listener listener(last);
    EXPECT_THROW(call(&listener), Cancelled) << last;
  }
}

TEST(Matching, RefusesWhatIsNoSurface) {
  const MatchedBody body = Animal("stand", 500);
  MatchedBody broken = body;
  broken.shape(1, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(MessageOf<MeshError>([&] { Match(broken, body); }).find("the template has"),
            std::string::npos);
  broken.shape.setZero();
  EXPECT_NE(MessageOf<MeshError>([&] { Match(body, broken); }).find("the target has no area"),
            std::string::npos);
  broken.shape.resize(3, 7);
  EXPECT_NE(MessageOf<MeshError>([&] { Match(body, broken); }).find("its shape 7"),
            std::string::npos);
  MatchingOptions options;
  options.max_candidates = 0;
  EXPECT_THROW(Match(body, body, options), InvalidOptions);
}

}  // namespace
}  // namespace shapespace
