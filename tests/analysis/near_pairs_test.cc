#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/analysis/near_pairs.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>

namespace shapespace {
namespace {

using Key = std::pair<PairKind, std::array<int, 4>>;

// All pairs of elements that share no vertex, by the definition.
std::vector<Key> AllPairs(const Connectivity& connectivity) {
  std::vector<Key> pairs;
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    for (int t = 0; t < connectivity.NumTriangles(); ++t) {
      const auto corners = connectivity.Triangles().col(t);
      pairs.push_back({PairKind::kVertexTriangle, {v, corners(0), corners(1), corners(2)}});
    }
  }
  for (int e = 0; e < connectivity.NumEdges(); ++e) {
    for (int f = e + 1; f < connectivity.NumEdges(); ++f) {
      const auto first = connectivity.Edges().col(e), second = connectivity.Edges().col(f);
      pairs.push_back({PairKind::kEdgeEdge, {first(0), first(1), second(0), second(1)}});
    }
  }
  return pairs;
}

// Whether two vertices are joined by at most two edges.
bool WithinTwoEdges(const Connectivity& connectivity, int v, int w) {
  if (v == w) return true;
  for (const int e : connectivity.EdgesOfVertices()[v]) {
    const int next = connectivity.OtherEnd(e, v);
    if (next == w) return true;
    for (const int f : connectivity.EdgesOfVertices()[next]) {
      if (connectivity.OtherEnd(f, next) == w) return true;
    }
  }
  return false;
}

bool AreNeighbours(const Connectivity& connectivity, const Key& key) {
  const int first = key.first == PairKind::kVertexTriangle ? 1 : 2;
  for (int i = 0; i < first; ++i) {
    for (int j = first; j < 4; ++j) {
      if (WithinTwoEdges(connectivity, key.second[i], key.second[j])) return true;
    }
  }
  return false;
}

// Edges may be found in either order.
Key Sorted(const NearPair& pair) {
  Key key = {pair.kind, pair.vertices};
  auto& v = key.second;
  if (pair.kind == PairKind::kEdgeEdge && std::make_pair(v[0], v[1]) > std::make_pair(v[2], v[3])) {
    std::swap(v[0], v[2]);
    std::swap(v[1], v[3]);
  }
  return key;
}

Shape Shaken(const Shape& shape, double by, int seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-by, by);
  Shape result = shape;
  for (double& x : result.reshaped()) x += uniform(random);
  return result;
}

// A flat strip, and the same folded over: its ends come together.
struct Strip {
  Strip() : family(MakeSheet(6, 1, 12, 2)), flat(Shaken(family.pose(0), 0.05, 1)), folded(flat) {
    const double middle = (flat.row(0).maxCoeff() + flat.row(0).minCoeff()) / 2;
    for (int v = 0; v < folded.cols(); ++v) {
      if (folded(0, v) <= middle) continue;
      folded(0, v) = 2 * middle - folded(0, v);
      folded(2, v) += 0.35;
    }
  }
  ShapeFamily family;
  Shape flat, folded;
};

// All pairs during a motion are found, by the definition, and their times.
void ExpectAllPairs(const std::shared_ptr<const Connectivity>& shared, const Shape& from,
                    const Shape& to) {
  const Connectivity& connectivity = *shared;
  const NearPairs pairs(shared, {from}, connectivity.NumVertices());
  constexpr double kShare = 0.3, kMargin = 0.1;
  std::map<Key, NearPair> found;
  for (const NearPair& pair : pairs.Find(from, to, kShare, kMargin)) {
    EXPECT_TRUE(found.emplace(Sorted(pair), pair).second) << "a pair is found twice";
    EXPECT_FALSE(AreNeighbours(connectivity, Sorted(pair)));
  }
  int near = 0;
  for (const Key& key : AllPairs(connectivity)) {
    if (AreNeighbours(connectivity, key)) continue;
    NearPair pair = {key.first, key.second, 0, 1};
    const double within = kShare * pairs.Length(pair) + kMargin;
    for (int k = 0; k <= 20; ++k) {
      const double time = k / 20.;
      const FourPoints points = (1 - time) * pair.At(from) + time * pair.At(to);
      if (NearestPoints(pair.kind, points).Distance() >= within) continue;
      ++near;
      // Beyond two edges, neighbours by length are not expected either.
      const auto it = found.find(key);
      if (it == found.end()) {
        ADD_FAILURE() << "a pair is missing";
        break;
      }
      EXPECT_LE(it->second.begin, time);
      EXPECT_GE(it->second.end, time);
    }
  }
  EXPECT_GT(near, 100);
}

TEST(NearPairsTest, FindsAllThatComeNearAtSomeTimeAndWhen) {
  const Strip strip;
  ExpectAllPairs(strip.family.connectivity, strip.flat, strip.folded);
}

// One that is not joined to the strip and falls through it, and one that is a side of a triangle.
TEST(NearPairsTest, FindsSegmentsThatComeNear) {
  const Strip strip;
  const Eigen::Matrix3Xi& triangles = strip.family.connectivity->Triangles();
  std::vector<int> begin = {0};
  for (int t = 0; t < triangles.cols(); ++t) begin.push_back(3 * (t + 1));
  const int count = strip.family.connectivity->NumVertices();
  const auto connectivity =
      Connectivity::Make(count + 2, begin, {triangles.data(), triangles.data() + triangles.size()},
                         {{count, count + 1}, {0, 1}});
  Shape from(3, count + 2), to = from;
  from << strip.flat, Eigen::Vector3d(-1, 0.1, 1.5), Eigen::Vector3d(0.5, -0.3, 0.7);
  to << strip.folded, Eigen::Vector3d(-1.2, -0.2, -0.5), Eigen::Vector3d(0.5, 0.2, -0.7);
  int with_segment = 0;
  const NearPairs pairs(connectivity, {from}, count + 2);
  for (const NearPair& pair : pairs.Find(from, to, 0.3, 0.1)) {
    with_segment += *std::max_element(pair.vertices.begin(), pair.vertices.end()) >= count ? 1 : 0;
  }
  EXPECT_GT(with_segment, 10);
  ExpectAllPairs(connectivity, from, to);
}

// A triangle, a segment through its inside, one that ends on it, one near it, one far away, and one
// that is a side of it.
TEST(NearPairsTest, FindsSegmentsThatTouch) {
  const auto connectivity =
      Connectivity::Make(11, {0, 3}, {0, 1, 2}, {{3, 4}, {5, 6}, {7, 8}, {9, 10}, {0, 1}});
  Shape shape(3, 11);
  shape << 0, 4, 0, 1, 1.2, 2, 3, 0.5, 0.5, 8, 9,  //
      0, 0, 4, 1, 1, 1, 4, 1, 2, 8, 9,             //
      0, 0, 0, 3, -3, 0, 2, 0.1, 3, 0, 1;
  const NearPairs pairs(connectivity, {shape}, 11);
  const auto touching = [&](double share) {
    std::vector<int> segments;
    for (const auto& [corners, ends] : pairs.FindTouchingSegments(shape, share)) {
      EXPECT_EQ(corners, Eigen::Vector3i(0, 1, 2));
      EXPECT_EQ(ends(1), ends(2));
      segments.push_back(ends(0));
    }
    std::sort(segments.begin(), segments.end());
    return segments;
  };
  EXPECT_EQ(touching(1e-3), (std::vector<int>{3, 5}));
  EXPECT_EQ(touching(0.04), (std::vector<int>{3, 5, 7}));
}

TEST(NearPairsTest, FixedVerticesAreNotPairedWithEachOther) {
  const Strip strip;
  const int num_vertices = strip.family.connectivity->NumVertices();
  const NearPairs all(strip.family.connectivity, {strip.flat}, num_vertices);
  const NearPairs half(strip.family.connectivity, {strip.flat}, num_vertices / 2);
  const NearPairs none(strip.family.connectivity, {strip.flat}, 0);
  size_t expected = 0;
  for (const NearPair& pair : all.Find(strip.folded, strip.folded, 0.3, 0.1)) {
    if (*std::min_element(pair.vertices.begin(), pair.vertices.end()) < num_vertices / 2)
      ++expected;
  }
  EXPECT_EQ(half.Find(strip.folded, strip.folded, 0.3, 0.1).size(), expected);
  EXPECT_TRUE(none.Find(strip.folded, strip.folded, 0.3, 0.1).empty());
}

TEST(NearPairsTest, AFlatSurfaceIsNotNearToItself) {
  const ShapeFamily sheet = MakeSheet(4, 4, 10, 10);
  const NearPairs pairs(sheet.connectivity, {sheet.pose(0)}, sheet.connectivity->NumVertices());
  EXPECT_TRUE(pairs.Find(sheet.pose(0), sheet.pose(0), 0.4, 0).empty());
}

TEST(NearPairsTest, RefusesWhatHasNoTrianglesOrIsNotFinite) {
  const ShapeFamily sheet = MakeSheet(4, 4, 2, 2);
  const auto graph = Connectivity::Make(2, {0}, {}, {{0, 1}});
  EXPECT_THROW(NearPairs(graph, {Shape::Random(3, 2)}, 2), MeshError);
  Shape broken = sheet.pose(0);
  broken(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(NearPairs(sheet.connectivity, {broken}, 9), MeshError);
  EXPECT_THROW(NearPairs(sheet.connectivity, {Shape::Random(3, 2)}, 9), MeshError);
}

}  // namespace
}  // namespace shapespace
