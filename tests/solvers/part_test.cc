#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/matching/detail/border.h>
#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/detail/part_maps.h>
#include <shapespace/matching/internal/matching.h>
#include <shapespace/mesh/surface.h>

#include "bodies/measure.h"
#include "support/message_of.h"
#include "support/part_of.h"
#include "support/paths.h"
#include "support/threads.h"

// Targets that are a part of what the template is.

namespace shapespace::internal {
namespace {

using testing::Part;

using Keep = std::function<bool(const Eigen::Vector3d& place, const Eigen::Vector3d& normal)>;

// The triangles of a body all of whose corners are kept where it stands, in `shape`.
Part PartOf(const SkinnedBody& body, const Shape& shape, const Keep& keep) {
  const Shape rest = body.pose("stand"), normals = VertexNormals(*body.connectivity, rest);
  return testing::PartOf(*body.connectivity, shape, [&](int f) {
    const auto corners = body.connectivity->Triangles().col(f);
    return std::all_of(corners.begin(), corners.end(),
                       [&](int v) { return keep(rest.col(v), normals.col(v)); });
  });
}

constexpr double kCut = -0.25;
// Without the hind legs, the tail, and what is between them: 30 % of the area is cut off.
bool IsInFront(const Eigen::Vector3d& place, const Eigen::Vector3d&) { return place.z() > kCut; }
// About what is seen from one side: the ends of all limbs are on the border.
bool IsSeen(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) {
  return place.x() > 0 && normal.x() > 0.1;
}

// An animal that stands, and a part of another mesh of it in a pose.
struct CutAnimal {
  SkinnedBody body;
  Shape rest;
  Part part;
  Shape places;  // of each vertex of the part, its place on the template

  explicit CutAnimal(const std::string& pose = "stride", double noise = 0.002,
                     const Keep& keep = IsInFront)
      : body(MakeQuadruped(3000)), rest(body.pose("stand")) {
    const SkinnedBody other = MakeQuadruped(4000);
    const Shape shape = other.pose(pose);
    part = PartOf(other, shape + testing::Noise(static_cast<int>(shape.cols()), noise, 5), keep);
    places = other.pose("stand")(Eigen::all, part.vertices);
  }

  SurfaceMatcher Match() const {
    return {*body.connectivity, rest, *part.connectivity, part.shape};
  }
  // Of each vertex of the part the one of the template that is nearest to its place.
  std::vector<int> Images() const {
    std::vector<int> images;
    for (const auto& place : places.colwise()) {
      Eigen::Index at;
      (rest.colwise() - place).colwise().squaredNorm().minCoeff(&at);
      images.push_back(static_cast<int>(at));
    }
    return images;
  }
  // The mean distance of the template's vertices of markers from those that are right, likewise.
  double Error(const std::vector<std::pair<int, int>>& markers) const {
    std::vector<int> from, to;
    for (const auto& [v, y] : markers) {
      from.push_back(v);
      to.push_back(y);
    }
    return (rest(Eigen::all, from) - places(Eigen::all, to)).colwise().norm().mean() /
           std::sqrt(Area(*body.connectivity, rest));
  }
  // The mean distance of places from those that are right, as a share of the template's root area.
  double Error(const Shape& found) const {
    return (found - places).colwise().norm().mean() / std::sqrt(Area(*body.connectivity, rest));
  }

  // How far the shape halfway to a fit is from the one halfway to the pose, where the part shows
  // the body: the mean distance, as a share of the root of the area.
  double PathError(const std::string& pose, const Shape& fitted) const {
    const auto halfway = [&](const Shape& end) {
      GeodesicOptions options;
      options.shapes = 1;
      return Interpolate(body.connectivity, {rest, end}, options).path.Placed(1);
    };
    const Shape error = halfway(fitted) - halfway(body.pose(pose));
    double sum = 0;
    int count = 0;
    for (int v = 0; v < rest.cols(); ++v) {
      if (rest(2, v) <= kCut) continue;
      sum += error.col(v).norm();
      ++count;
    }
    return sum / count / std::sqrt(Area(*body.connectivity, rest));
  }
};

TEST(SurfaceBorder, HasTheLengthOfItsLongestPart) {
  // Two squares of sides 1 and 2, and a tetrahedron, which has no border.
  Shape shape(3, 12);
  shape << 0, 1, 1, 0, 5, 7, 7, 5, 9, 10, 9, 9,  //
      0, 0, 1, 1, 0, 0, 2, 2, 0, 0, 1, 0,        //
      0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1;
  Eigen::Matrix3Xi triangles(3, 8);
  triangles << 0, 0, 4, 4, 8, 8, 8, 9,  //
      1, 2, 5, 6, 10, 9, 11, 10,        //
      2, 3, 6, 7, 9, 11, 10, 11;
  const SurfaceBorder border(*Connectivity::FromTriangles(12, triangles), shape);
  EXPECT_NEAR(border.longest, 8, 1e-12);
  EXPECT_EQ(border.vertices, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

// What is cut off is a part; what has a hole of the same animal is complete, and so is what is as
// open as the template.
TEST(Part, HasALongBorderThatTheTemplateHasNot) {
  const CutAnimal animal;
  EXPECT_TRUE(animal.Match().TargetIsPart());
  const Shape rest = animal.rest;
  const auto with_hole = [&](double radius) {
    Eigen::Index at;
    (rest.colwise() - Eigen::Vector3d(0, 2, 0)).colwise().squaredNorm().minCoeff(&at);
    return PartOf(animal.body, rest,
                  [&, centre = Eigen::Vector3d(rest.col(at))](const Eigen::Vector3d& place,
                                                              const Eigen::Vector3d&) {
                    return (place - centre).norm() > radius;
                  });
  };
  const double unit = std::sqrt(Area(*animal.body.connectivity, rest));
  for (const double radius : {0.04, 0.12}) {
    const Part part = with_hole(radius * unit);
    const SurfaceMatcher matcher(*animal.body.connectivity, rest, *part.connectivity, part.shape);
    EXPECT_EQ(matcher.TargetIsPart(), radius > 0.1) << radius;
  }
  const Part& part = animal.part;
  EXPECT_FALSE(SurfaceMatcher(*part.connectivity, part.shape, *part.connectivity, part.shape)
                   .TargetIsPart());
}

TEST(Part, ExtremitiesOnItsBorderAreNone) {
  const CutAnimal animal;
  const MatchingBody body("target", *animal.part.connectivity, animal.part.shape, nullptr);
  ASSERT_GE(body.inner_extremities.size(), 3u);
  EXPECT_NE(body.extremities, body.inner_extremities);
  for (const int v : body.inner_extremities) {
    EXPECT_GT(animal.places(2, body.surface.vertices[v]), kCut + 0.1);
  }
  // They are behind the others, as what may be the end of a limb that is cut lengthwise.
  ASSERT_GT(body.part_extremities.size(), body.inner_extremities.size());
  for (size_t i = 0; i < body.part_extremities.size(); ++i) {
    const bool is_inner = i < body.inner_extremities.size();
    EXPECT_EQ(body.from_border(body.part_extremities[i]) > 0.04F, is_inner) << i;
    if (is_inner) {
      EXPECT_EQ(body.part_extremities[i], body.inner_extremities[i]);
    }
  }
  // Near the border neither curvature nor heat is that of the body.
  for (const int v : body.border.vertices) EXPECT_FALSE(body.IsInner(v));
  const MatchingBody whole("template", *animal.body.connectivity, animal.rest, nullptr);
  EXPECT_EQ(whole.extremities, whole.inner_extremities);
  EXPECT_EQ(whole.extremities, whole.part_extremities);
  EXPECT_TRUE(whole.IsInner(0));
}

TEST(Part, ItsScaleIsTheRootOfItsShare) {
  const CutAnimal animal("stand", 0);
  const MatchingBody whole("template", *animal.body.connectivity, animal.rest, nullptr),
      part("target", *animal.part.connectivity, animal.part.shape, nullptr);
  VertexPairs right;
  for (const int v : part.spread) {
    Eigen::Index at;
    (animal.rest.colwise() - animal.places.col(part.surface.vertices[v]))
        .colwise()
        .squaredNorm()
        .minCoeff(&at);
    right.emplace_back(static_cast<int>(at), v);
  }
  const double share = Area(*animal.part.connectivity, animal.part.shape) /
                       Area(*animal.body.connectivity, animal.rest);
  EXPECT_NEAR(RelativeScale(whole, part, right), std::sqrt(share), 0.03);
}

// The least error of the markers of any candidate.
double LeastError(const CutAnimal& animal) {
  const Matching matching = animal.Match().FindCandidates();
  EXPECT_FALSE(matching.candidates.empty()) << matching.problem;
  double least = 1;
  for (const MapCandidate& candidate : matching.candidates) {
    EXPECT_GT(candidate.markers.size(), 10u);
    least = std::min(least, animal.Error(candidate.markers));
  }
  return least;
}

// One of the candidates is right, under any motion and size of the target.
TEST(Part, IsFoundOnTheWholeBody) {
  CutAnimal animal;
  EXPECT_LT(LeastError(animal), 0.06);
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()));
  animal.part.shape = 30 * turn * animal.part.shape;
  EXPECT_LT(LeastError(animal), 0.06);
}

// The ends of limbs are on the border.
TEST(Part, IsFoundIfSeenFromOneSide) {
  const CutAnimal seen("stride", 0.002, IsSeen);
  EXPECT_TRUE(seen.Match().TargetIsPart());
  EXPECT_LT(LeastError(seen), 0.06);
}

TEST(Part, IsFoundInTheSameWayOnAnyThreads) {
  const CutAnimal animal;
  const auto results = testing::OnThreads([&] {
    std::vector<std::pair<int, int>> all;
    for (const MapCandidate& candidate : animal.Match().FindCandidates().candidates) {
      all.insert(all.end(), candidate.markers.begin(), candidate.markers.end());
    }
    return all;
  });
  ASSERT_FALSE(results[0].empty());
  for (const auto& result : results) EXPECT_EQ(result, results[0]);
}

TEST(Part, AgreesWithAGivenPair) {
  const CutAnimal animal;
  // A fore foot, and the same of the template.
  Eigen::Index to, from;
  (animal.places.row(0) - animal.places.row(1) * 5).maxCoeff(&to);
  (animal.rest.colwise() - animal.places.col(to)).colwise().squaredNorm().minCoeff(&from);
  const std::pair<int, int> pair(static_cast<int>(from), static_cast<int>(to));
  const Matching matching = animal.Match().FindCandidates({pair});
  ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
  for (const MapCandidate& candidate : matching.candidates) {
    EXPECT_EQ(candidate.markers.front(), pair);
  }
}

// With the map of a fit, here the right one, a candidate's markers are better.
TEST(Part, MarkersAreRefinedByAFit) {
  const CutAnimal animal;
  const SurfaceMatcher matcher = animal.Match();
  const Matching matching = matcher.FindCandidates();
  ASSERT_FALSE(matching.candidates.empty()) << matching.problem;
  const MapCandidate& best =
      *std::min_element(matching.candidates.begin(), matching.candidates.end(),
                        [&](const MapCandidate& a, const MapCandidate& b) {
                          return animal.Error(a.markers) < animal.Error(b.markers);
                        });
  const auto refined = matcher.RefinePartMarkers(best, animal.Images());
  EXPECT_GE(refined.size(), 20u);
  EXPECT_LT(animal.Error(refined), 0.75 * animal.Error(best.markers));
  const auto call = [&] { (void)matcher.RefinePartMarkers(best, {}); };
  EXPECT_TRUE(testing::Refuses<MeshError>(call, {"0 entries"}));
}

// The markers with which the template is fitted to a part are all over the part, those that were
// given first, and no vertex is in two of them.
TEST(Part, MarkersAreSpreadOverIt) {
  const CutAnimal animal;
  const Part& part = animal.part;
  const std::vector<int> images = animal.Images();
  const std::pair<int, int> given(images[7], 7);
  const auto pairs = animal.Match().SpreadPairs(images, 60, {given});
  ASSERT_EQ(pairs.size(), 60u);
  EXPECT_EQ(pairs.front(), given);
  std::set<int> from, to;
  for (const auto& [v, y] : pairs) {
    EXPECT_EQ(v, images[y]);
    from.insert(v);
    to.insert(y);
  }
  EXPECT_EQ(from.size(), pairs.size());
  EXPECT_EQ(to.size(), pairs.size());
  const Shape markers = part.shape(Eigen::all, std::vector<int>(to.begin(), to.end()));
  double farthest = 0;
  for (const auto& place : part.shape.colwise()) {
    farthest = std::max(farthest, (markers.colwise() - place).colwise().norm().minCoeff());
  }
  EXPECT_LT(farthest, 0.15 * std::sqrt(Area(*part.connectivity, part.shape)));
}

// The template is fitted to the part, and what that lacks follows.
TEST(Correspond, FindsWhereAPartBelongs) {
  for (const char* pose : {"stride", "stretch"}) {
    const CutAnimal animal(pose);
    const CorrespondenceResult result = Correspond(animal.body.connectivity, animal.rest,
                                                   animal.part.connectivity, animal.part.shape, {});
    const Shape found =
        PullBack(result.map.to_template, animal.body.connectivity->Triangles(), animal.rest);
    EXPECT_LT(animal.Error(found), 0.03) << pose << result.summary.FullReport();
    EXPECT_NEAR(result.summary.scale, 1, 0.08) << pose;
    EXPECT_LT(result.summary.uncovered, 0.02) << pose;
    EXPECT_LT(animal.PathError(pose, result.fitted), 0.03) << pose;
    EXPECT_NEAR(Area(*animal.body.connectivity, result.fitted) /
                    Area(*animal.body.connectivity, animal.rest),
                1, 0.1)
        << pose;
    const auto& candidates = result.summary.candidates;
    EXPECT_TRUE(std::any_of(candidates.begin(), candidates.end(),
                            [](const auto& candidate) { return candidate.chosen; }));
    EXPECT_EQ(result.in_doubt.size(), static_cast<size_t>(animal.rest.cols()));
    const std::string report = result.summary.FullReport();
    EXPECT_TRUE(testing::Names(report, {"lacks a part"}));
    EXPECT_FALSE(testing::HasWord(report, "much deformed")) << report;
  }
}

// Of an animal that is seen from one side two markers that lie far apart tell the rest. The user
// is told that so little of the body is seldom enough.
TEST(Correspond, FindsABodySeenFromOneSideWithTwoMarkers) {
  const CutAnimal animal("stride", 0.002, IsSeen);
  const std::vector<int> images = animal.Images();
  std::vector<CorrespondenceMarker> markers;
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(0, -1, 1), Eigen::Vector3d(0, 1, -1)}) {
    Eigen::Index to;
    (way.transpose() * animal.places).maxCoeff(&to);
    markers.push_back({images[to], static_cast<int>(to), false});
  }
  const CorrespondenceResult result = Correspond(
      animal.body.connectivity, animal.rest, animal.part.connectivity, animal.part.shape, markers);
  const Shape found =
      PullBack(result.map.to_template, animal.body.connectivity->Triangles(), animal.rest);
  EXPECT_LT(animal.Error(found), 0.03) << result.summary.FullReport();
  EXPECT_NEAR(result.summary.scale, 1, 0.1);
  EXPECT_TRUE(testing::Names(result.summary.FullReport(), {"shows"}));
}

}  // namespace
}  // namespace shapespace::internal
