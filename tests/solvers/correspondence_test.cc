#include <shapespace/correspondence/correspondence.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/body.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/correspondence/correspondence_picture.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/correspondence/detail/limb_turns.h>
#include <shapespace/correspondence/detail/marker_check.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/surface.h>
#include <shapespace/transfer/transfer.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"
#include "support/part_of.h"
#include "support/remeshed.h"
#include "support/renumbered.h"
#include "support/thin_triangles.h"

namespace shapespace {
namespace {

using testing::Listener;
using testing::MessageOf;
using testing::Names;
using testing::Part;
using testing::PartOf;
using testing::Remeshed;
using testing::Rotation;
using testing::SpreadMarkers;

bool Names(const std::vector<std::string>& warnings, const std::string& part) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
    return warning.find(part) != warning.npos;
  });
}

TEST(Correspond, MapsARemeshedCopyBackToItself) {
  const Remeshed bodies;
  const CorrespondenceResult result = bodies.Fit();
  EXPECT_TRUE(result.summary.Converged()) << result.summary.FullReport();
  const Eigen::VectorXd errors = bodies.Errors(result.map);
  EXPECT_LT(errors.mean(), 0.5 * bodies.Edge());
  EXPECT_LT(errors.maxCoeff(), 2 * bodies.Edge());
  EXPECT_LT(result.summary.turned, 2e-3);
  EXPECT_LT(result.summary.distance_rms, 2e-3);
  EXPECT_LT(result.summary.uncovered, 1e-3);
  EXPECT_TRUE(result.summary.warnings.empty()) << result.summary.warnings.front();
}

TEST(Correspond, FindsAnotherPoseOfTheBody) {
  for (const char* pose : {"sit", "stretch"}) {
    const Remeshed bodies(pose);
    const CorrespondenceResult result = bodies.Fit();
    const Eigen::VectorXd errors = bodies.Errors(result.map);
    EXPECT_LT(errors.mean(), 0.6 * bodies.Edge()) << pose << result.summary.FullReport();
    EXPECT_LT(result.summary.turned, 5e-3) << pose;
  }
}

// Without markers the map is found as well as with twenty, whatever the place, size and numbering
// of the target.
TEST(Correspond, FindsTheMapWithoutMarkers) {
  Remeshed bodies("sit");
  const double with_markers = bodies.Errors(bodies.Fit().map).mean();
  bodies.markers.clear();
  bodies.target =
      (30 * Rotation(100, {1, 2, 3}) * bodies.target).colwise() + Eigen::Vector3d(1e4, 0, 5e3);
  const CorrespondenceResult result = bodies.Fit();
  EXPECT_TRUE(result.summary.Converged()) << result.summary.FullReport();
  EXPECT_LT(bodies.Errors(result.map).mean(), 1.5 * with_markers) << result.summary.FullReport();
  ASSERT_FALSE(result.summary.candidates.empty());
  // As many as a person can look at.
  EXPECT_GT(result.markers.size(), 10u);
  EXPECT_LE(result.markers.size(), 40u);
  for (const CorrespondenceMarker& marker : result.markers) EXPECT_TRUE(marker.soft);
  EXPECT_TRUE(std::any_of(result.summary.candidates.begin(), result.summary.candidates.end(),
                          [](const auto& candidate) { return candidate.chosen; }));
  // One is given up after a rough fit.
  double least = std::numeric_limits<double>::infinity();
  for (const auto& map : result.summary.candidates) least = std::min(least, map.rough_cost);
  int given_up = 0;
  for (const auto& map : result.summary.candidates) {
    EXPECT_EQ(std::isnan(map.cost), map.rough_cost > 2 * least) << map.rough_cost / least;
    if (std::isnan(map.cost)) ++given_up;
  }
  EXPECT_EQ(given_up, 1);
}

// A fit of this template onto a body with short legs that rears does not reach all of a leg, which
// the fit of that body onto the template does.
TEST(Correspond, FindsWithoutMarkersWhatOnlyTheReverseFitReaches) {
  Remeshed bodies("rear", 2400, 3300, 0, NamedQuadrupedForm("short"));
  const CorrespondenceResult result = bodies.Fit();
  EXPECT_TRUE(result.summary.Converged()) << result.summary.FullReport();
  EXPECT_LT(bodies.Errors(result.map).mean(), bodies.Edge());
  EXPECT_LT(bodies.Errors(result.map).maxCoeff(), 8 * bodies.Edge());
}

// Of random animals with the seeds of each pair, the first onto the second.
void ExpectFoundWithoutMarkers(const std::vector<std::pair<unsigned, unsigned>>& seeds) {
  const Remeshed bodies;
  const auto animal = [](int triangles, unsigned seed) {
    return MakeQuadruped(triangles, RandomQuadrupedForm({}, seed)).random_pose(seed);
  };
  for (const auto& [one, other] : seeds) {
    const CorrespondenceResult result =
        Correspond(bodies.first.connectivity, animal(2400, one), bodies.second.connectivity,
                   animal(3300, other), {});
    EXPECT_LT(bodies.Errors(result.map).mean(), bodies.Edge()) << one;
  }
}

// Of some animals the snout sticks out most of the head, of others an ear, and the other less.
TEST(Correspond, FindsWithoutMarkersTheSnoutBesideAnEar) {
  ExpectFoundWithoutMarkers({{303, 310}, {101, 108}});
}

// On so few triangles the first of them lost a leg, and the ear of the second became a snout.
TEST(Correspond, FindsWithoutMarkersCoarseAnimals) {
  ExpectFoundWithoutMarkers({{303, 308}, {112, 105}});
}

// Each map of an animal to a bar is nonsense, which is said. Triangles collapse between the markers
// that the fits in both directions give.
TEST(Correspond, AnswersForBodiesThatHaveNothingInCommon) {
  const SkinnedBody animal = MakeQuadruped(2400);
  const ShapeFamily bar = MakeBody("bar");
  const CorrespondenceResult result = Correspond(animal.connectivity, animal.pose("rear"),
                                                 bar.connectivity, bar.pose(bar.begin), {});
  EXPECT_TRUE(result.fitted.allFinite());
  EXPECT_TRUE(Names(result.summary.warnings, "a guess")) << result.summary.FullReport();
}

// A box that is turned upside down is the same again. Neither map costs anything but rounding, and
// that one has more of it than the other says nothing.
TEST(Correspond, SaysThatAnExactlySymmetricBodyHasTwoMaps) {
  const ShapeFamily bar = MakeBody("bar");
  const Shape shape = bar.pose(bar.begin);
  std::vector<int> place(shape.cols());
  std::iota(place.begin(), place.end(), 0);
  for (const unsigned seed : {1, 2, 3}) {
    std::shuffle(place.begin(), place.end(), std::mt19937(seed));
    const auto [connectivity, renumbered] = testing::Renumbered(*bar.connectivity, shape, place);
    const CorrespondenceSummary summary =
        Correspond(bar.connectivity, shape, connectivity, renumbered, {}).summary;
    EXPECT_LT(summary.certainty, 1.01) << summary.FullReport();
    ASSERT_EQ(summary.parts_in_doubt.size(), 1u) << seed;
    EXPECT_GT(summary.parts_in_doubt.front().share, 0.9) << seed;
  }
}

// The body is its own mirror image, nearly; one marker that is on the other side turns the map
// round.
TEST(Correspond, OneMarkerDecidesBetweenMaps) {
  Remeshed bodies("stand");
  const CorrespondenceMarker marker = bodies.markers.front();
  bodies.markers = {marker};
  const CorrespondenceResult result = bodies.Fit();
  EXPECT_EQ(result.fitted.col(marker.template_vertex), bodies.target.col(marker.target_vertex));
  EXPECT_LT(bodies.Errors(result.map).mean(), bodies.Edge());
}

// Large bodies are decimated to find the map. What is found has the numbers of their own vertices,
// and so has the pair that is given. Three levels are fitted: the last but one reaches the last
// weight, so that the last needs no other.
TEST(Correspond, FindsTheMapOfLargeBodies) {
  Remeshed bodies("sit", 34000, 40000);
  const CorrespondenceMarker given = bodies.markers.front();
  bodies.markers = {given};
  const CorrespondenceResult result = bodies.Fit();
  EXPECT_LT(bodies.Errors(result.map).mean(), 2 * bodies.Edge()) << result.summary.FullReport();
  EXPECT_EQ(result.fitted.col(given.template_vertex), bodies.target.col(given.target_vertex));
  EXPECT_GT(result.markers.size(), 10u);
  for (const CorrespondenceMarker& marker : result.markers) {
    const Eigen::Vector3d from = bodies.rest.col(marker.template_vertex);
    EXPECT_LT((bodies.other_rest.col(marker.target_vertex) - from).norm(), 20 * bodies.Edge());
  }
  EXPECT_EQ(result.in_doubt.size(), static_cast<size_t>(bodies.rest.cols()));
  const CorrespondenceSummary::Stage &last = result.summary.stages.back(),
                                     &before = *(result.summary.stages.end() - 2);
  EXPECT_EQ(last.vertices, bodies.rest.cols());
  EXPECT_LT(before.vertices, last.vertices);
  EXPECT_EQ(before.weight, last.weight);
}

// Needles, caps, and noise of a third of an edge at every tenth vertex.
TEST(Correspond, FindsTheMapWithoutMarkersOnBadMeshes) {
  const auto error = [](Remeshed bodies, const testing::PosedMesh& mesh) {
    bodies.markers.clear();
    bodies.second.connectivity = mesh.connectivity;
    bodies.target = mesh.poses[0];
    bodies.other_rest = mesh.poses[1];
    return bodies.Errors(bodies.Fit().map).mean();
  };
  const Remeshed bodies("stride");
  const testing::PosedMesh mesh = {bodies.second.connectivity, {bodies.target, bodies.other_rest}};
  testing::PosedMesh noisy = mesh;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-bodies.Edge() / 3, bodies.Edge() / 3);
  for (Eigen::Index v = 0; v < bodies.target.cols(); v += 10) {
    for (double& x : noisy.poses[0].col(v)) x += noise(random);
  }
  EXPECT_LT(error(bodies, noisy), 1.5 * bodies.Edge());
  const auto with = [&](const Eigen::Vector3d& place) {
    return testing::WithInnerVertices(mesh, place, 2);
  };
  EXPECT_LT(error(bodies, with(testing::NeedlePlace(1e-3))), bodies.Edge());
  EXPECT_LT(error(bodies, with(testing::CapPlace(1e-3))), bodies.Edge());
}

TEST(Correspond, SaysWhyNothingIsFoundInABodyOfFourVertices) {
  const auto solid = Connectivity::FromTriangles(
      4, (Eigen::Matrix3Xi(3, 4) << 0, 0, 0, 1, 2, 3, 1, 2, 1, 1, 2, 3).finished());
  Shape shape = Shape::Zero(3, 4);
  shape.rightCols<3>().setIdentity();
  const std::string message =
      MessageOf<MeshError>([&] { Correspond(solid, shape, solid, shape, {}); });
  EXPECT_TRUE(testing::Names(message, {"template", "4 vertices", "markers"})) << message;
}

// A marker that is beside its place distorts a fit that meets it, and one that it leads does not.
TEST(Correspond, SoftMarkersLeadAndDoNotDistort) {
  Remeshed bodies("sit");
  const Shape& target = bodies.target;
  CorrespondenceMarker& off = bodies.markers[bodies.markers.size() / 2];
  // To a neighbour of its vertex.
  const int edge = *bodies.second.connectivity->EdgesOfVertices()[off.target_vertex].begin();
  off.target_vertex = bodies.second.connectivity->OtherEnd(edge, off.target_vertex);
  const double hard = bodies.Errors(bodies.Fit().map).mean();
  for (CorrespondenceMarker& marker : bodies.markers) marker.soft = true;
  const CorrespondenceResult result = bodies.Fit();
  EXPECT_LT(bodies.Errors(result.map).mean(), 1.2 * hard);
  EXPECT_GT((result.fitted.col(off.template_vertex) - target.col(off.target_vertex)).norm(), 0);
}

TEST(Correspond, FindsABodyOfOtherProportions) {
  const Remeshed bodies("stand", 2400, 3300, 20, NamedQuadrupedForm("heavy"));
  const CorrespondenceResult result = bodies.Fit();
  EXPECT_LT(bodies.Errors(result.map).mean(), bodies.Edge()) << result.summary.FullReport();
  EXPECT_TRUE(result.summary.doubtful.empty());
}

TEST(Correspond, IsExactAtMarkers) {
  const Remeshed bodies("sit");
  const CorrespondenceResult result = bodies.Fit();
  ASSERT_TRUE(result.summary.doubtful.empty());
  const Shape landed =
      PullBack(result.map.to_target, bodies.second.connectivity->Triangles(), bodies.target);
  const Shape back =
      PullBack(result.map.to_template, bodies.first.connectivity->Triangles(), bodies.rest);
  for (const CorrespondenceMarker& marker : bodies.markers) {
    EXPECT_EQ(result.fitted.col(marker.template_vertex), bodies.target.col(marker.target_vertex));
    EXPECT_EQ(landed.col(marker.template_vertex), bodies.target.col(marker.target_vertex));
    EXPECT_EQ(back.col(marker.target_vertex), bodies.rest.col(marker.template_vertex));
  }
}

TEST(Correspond, MovesAndScalesWithTheTarget) {
  const Remeshed bodies("sit");
  const CorrespondenceResult result = bodies.Fit();
  const Eigen::Matrix3d rotation = Rotation(180, Eigen::Vector3d(1, 0.3, 0.2).normalized());
  const Eigen::Vector3d far(1e6, -2e6, 3e6);
  Remeshed moved = bodies;
  moved.target = (10 * rotation * bodies.target).colwise() + far;
  const CorrespondenceResult other = moved.Fit();
  const Shape wanted = (10 * rotation * result.fitted).colwise() + far;
  // Up to the rounding of coordinates so far from the origin.
  EXPECT_LT((other.fitted - wanted).colwise().norm().maxCoeff(), 1e-6);
  EXPECT_NEAR(other.summary.scale / result.summary.scale, 10, 1e-6);
  EXPECT_NEAR(other.summary.distance_rms, result.summary.distance_rms, 1e-8);
}

TEST(Correspond, DoesNotCareWhereTheTemplateIs) {
  const Remeshed bodies("sit");
  const CorrespondenceResult result = bodies.Fit();
  Remeshed moved = bodies;
  moved.rest =
      (1e-3 * Rotation(120, Eigen::Vector3d(0.1, 1, -0.4).normalized()) * bodies.rest).colwise() +
      Eigen::Vector3d(1e3, 0, -1e3);
  const CorrespondenceResult other = moved.Fit();
  EXPECT_LT((other.fitted - result.fitted).colwise().norm().maxCoeff(), 1e-6);
  EXPECT_LT((other.map.round_trip - result.map.round_trip).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Correspond, ThereAndBackIsNearTheIdentity) {
  const Remeshed bodies("sit");
  const CorrespondenceResult there = bodies.Fit();
  std::vector<CorrespondenceMarker> reversed;
  for (const CorrespondenceMarker& marker : bodies.markers) {
    reversed.push_back({marker.target_vertex, marker.template_vertex});
  }
  const CorrespondenceResult back = Correspond(bodies.second.connectivity, bodies.target,
                                               bodies.first.connectivity, bodies.rest, reversed);
  const Shape first =
      PullBack(back.map.to_target, bodies.first.connectivity->Triangles(), bodies.rest);
  const Shape both = PullBack(there.map.to_target, bodies.second.connectivity->Triangles(), first);
  EXPECT_LT((both - bodies.rest).colwise().norm().mean(), 0.75 * bodies.Edge());
}

// A scan that ends at the neck. The round trip shows where the map is wrong.
TEST(Correspond, TrustsItselfLessWhereTheTargetHasNothing) {
  const Remeshed bodies;
  // The target without its highest part, including the ears, left open.
  const double cut = 1.25;
  std::vector<Eigen::Vector3i> kept;
  for (const Eigen::Vector3i triangle : bodies.second.connectivity->Triangles().colwise()) {
    if ((bodies.target(1, triangle).array() < cut).all()) kept.push_back(triangle);
  }
  Eigen::Matrix3Xi triangles(3, kept.size());
  for (size_t f = 0; f < kept.size(); ++f) triangles.col(static_cast<Eigen::Index>(f)) = kept[f];
  std::vector<CorrespondenceMarker> markers;
  for (const CorrespondenceMarker& marker : bodies.markers) {
    if (bodies.target(1, marker.target_vertex) < cut - 0.2) markers.push_back(marker);
  }
  const CorrespondenceResult result =
      Correspond(bodies.first.connectivity, bodies.rest,
                 Connectivity::FromTriangles(bodies.second.connectivity->NumVertices(), triangles),
                 bodies.target, markers);
  EXPECT_TRUE(Names(result.summary.warnings, "border")) << result.summary.FullReport();
  double above = 0, below = 0;
  int num_above = 0, num_below = 0;
  const Eigen::VectorXd errors = bodies.Errors(result.map);
  double wrong_below = 0;
  for (int v = 0; v < bodies.rest.cols(); ++v) {
    if (bodies.rest(1, v) > cut + 0.1) {
      above += result.map.round_trip(v), ++num_above;
    } else if (bodies.rest(1, v) < cut - 0.2) {
      below += result.map.round_trip(v), ++num_below;
      wrong_below += errors(v);
    }
  }
  // Where the surface continues beyond the border, the template continues too.
  double off_beyond = 0;
  int num_beyond = 0;
  for (int v = 0; v < bodies.rest.cols(); ++v) {
    if (bodies.rest(1, v) < cut || bodies.rest(1, v) > cut + 0.15) continue;
    off_beyond += (result.fitted.col(v) - bodies.rest.col(v)).norm(), ++num_beyond;
  }
  ASSERT_GT(num_beyond, 20);
  EXPECT_LT(off_beyond / num_beyond, 0.5 * bodies.Edge());
  ASSERT_GT(num_above, 20);
  EXPECT_GT(above / num_above, 5 * below / num_below);
  EXPECT_LT(wrong_below / num_below, bodies.Edge());
}

// A square of 2 x 2 cells, each cut along the same diagonal.
TEST(Target, KnowsTheBorderAtCornersOfAnyTriangle) {
  Eigen::Matrix3Xi triangles(3, 8);
  triangles << 0, 0, 1, 1, 3, 3, 4, 4, 1, 4, 2, 5, 4, 7, 5, 8, 4, 3, 5, 4, 7, 6, 8, 7;
  Shape square(3, 9);
  square << 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 0, 0, 1, 1, 1, 2, 2, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0;
  const internal::MarkerDistances distances(Eigen::MatrixXf::Zero(9, 1),
                                            Eigen::MatrixXf::Zero(9, 1));
  const internal::Target target(Connectivity::FromTriangles(9, triangles), square, distances);
  for (int f = 0; f < 8; ++f) {
    for (int k = 0; k < 3; ++k) {
      ClosestPoint foot;
      foot.triangle = f;
      foot.barycentric = Eigen::Vector3d::Unit(k);
      EXPECT_EQ(target.IsOnBorder(foot), triangles(k, f) != 4) << f << ' ' << k;
      foot.barycentric = Eigen::Vector3d(0.5, 0.5, 0.5) - 0.5 * foot.barycentric;
      const Eigen::Vector3d middle = square(Eigen::all, triangles.col(f)) * foot.barycentric;
      const bool is_outside =
          (middle.head<2>().array() == 0).any() || (middle.head<2>().array() == 2).any();
      EXPECT_EQ(target.IsOnBorder(foot), is_outside) << f << ' ' << k;
    }
  }
}

// A template on one level, with distances from markers that permit every match.
struct AnyMatch {
  explicit AnyMatch(const std::shared_ptr<const Connectivity>& connectivity)
      : level{connectivity, {}, internal::BorderOf(*connectivity)},
        distances(Eigen::MatrixXf::Zero(connectivity->NumVertices(), 1),
                  Eigen::MatrixXf::Zero(connectivity->NumVertices(), 1)) {
    level.vertices.resize(connectivity->NumVertices());
    std::iota(level.vertices.begin(), level.vertices.end(), 0);
  }

  std::vector<internal::PointToPlaneTerm> Terms(const Shape& shape, const Shape& target_shape,
                                                int samples, double weight) const {
    const internal::Target target(level.connectivity, target_shape, distances);
    double distance = 0;
    return internal::FindTerms(level, shape, internal::VertexAreas(*level.connectivity, shape),
                               target, SampleTarget(target, samples), weight, &distance);
  }

  internal::Level level;
  internal::MarkerDistances distances;
};

// Bodies of area 1, one a little larger, so that each of their points has a near one on the other.
TEST(FindTerms, TheTargetsVerticesPullAsStronglyAsTheTemplates) {
  const ShapeFamily bar = MakeBar(2, 1, 1, 8, 4, 4);
  const Shape target = bar.pose(0) / std::sqrt(10);
  const AnyMatch match(bar.connectivity);
  for (const int samples : {1000, 100, 40}) {
    double templates = 0, targets = 0;
    for (const auto& term : match.Terms(1.01 * target, target, samples, 0.7)) {
      const bool is_vertex = term.vertices(0) == term.vertices(1);
      (is_vertex ? templates : targets) += term.weight;
    }
    EXPECT_NEAR(templates, 0.7, 1e-12) << samples;
    EXPECT_NEAR(targets, 0.7, 1e-12) << samples;
  }
}

// A square over a smaller one: all of its vertices but the one in the middle are nearest to the
// border, also where the first triangle at a vertex of the border has no side there.
TEST(FindTerms, WhatIsNearestToTheBorderIsNotPulled) {
  Eigen::Matrix3Xi triangles(3, 8);
  triangles << 1, 0, 0, 1, 3, 3, 4, 4, 5, 1, 4, 2, 4, 7, 5, 8, 4, 4, 3, 5, 7, 6, 8, 7;
  Shape square(3, 9);
  square << 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 0, 0, 1, 1, 1, 2, 2, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0;
  square = 0.5 * (square.colwise() - square.col(4)).eval();
  const Shape larger = (1.02 * square).colwise() + Eigen::Vector3d(0, 0, 0.01);
  std::vector<int> pulled;
  for (const auto& term :
       AnyMatch(Connectivity::FromTriangles(9, triangles)).Terms(larger, square, 9, 1)) {
    if (term.vertices(0) == term.vertices(1)) pulled.push_back(term.vertices(0));
  }
  EXPECT_EQ(pulled, std::vector<int>{4});
}

// Two meshes of an animal with long legs, of area 1, of which the first is to be fitted to the
// other. A front leg ends in a hand, which is flat and wider in front than behind, and is turned by
// half a turn.
struct TurnedHand {
  TurnedHand()
      : body(MakeQuadruped(6000, NamedQuadrupedForm("long"))),
        other(MakeQuadruped(8000, NamedQuadrupedForm("long"))) {
    const Shape standing = body.pose("stand");
    double area = 0;
    for (const auto& triangle : body.connectivity->Triangles().colwise()) {
      area += internal::TriangleArea(standing, triangle);
    }
    rest = WithHand(standing / std::sqrt(area));
    target = WithHand(other.pose("stand") / std::sqrt(area));
    turned = rest;
    for (auto point : turned.colwise()) {
      if (!IsLeg(point)) continue;
      const double twist = std::min(1., (kTop - point(1)) / 0.22);
      point =
          Axis() + Eigen::AngleAxisd(EIGEN_PI * twist, Eigen::Vector3d::UnitY()) * (point - Axis());
    }
  }

  static constexpr double kTop = 0.37, kWrist = 0.15;
  static Eigen::Vector3d Axis() { return {0.07, 0, 0.2}; }
  static bool IsLeg(const Eigen::Vector3d& point) {
    return point(0) > 0 && point(2) > 0.1 && point(1) < kTop;
  }
  static Shape WithHand(Shape shape) {
    for (auto point : shape.colwise()) {
      if (!IsLeg(point)) continue;
      const double hand = std::min(1., std::max(0., (kWrist - point(1)) / 0.04));
      const double wider = point(2) > Axis()(2) ? 0.6 : 0.2;
      point(0) -= hand * 0.6 * (point(0) - Axis()(0));
      point(2) += hand * wider * (point(2) - Axis()(2));
    }
    return shape;
  }

  // How many limbs are turned, with these vertices held.
  int Turn(const std::vector<int>& held, Shape* shape) const {
    const AnyMatch match(body.connectivity);
    const internal::MarkerDistances distances(match.distances.OnTemplate(),
                                              Eigen::MatrixXf::Zero(target.cols(), 1));
    return TurnLimbs(match.level, rest, held, {other.connectivity, target, distances}, {}, nullptr,
                     shape);
  }

  SkinnedBody body, other;
  Shape rest, target, turned;
};

TEST(TurnLimbs, TurnsAHand) {
  const TurnedHand hand;
  Shape shape = hand.turned;
  EXPECT_EQ(hand.Turn({}, &shape), 1);
  EXPECT_GT((hand.turned - hand.rest).colwise().norm().maxCoeff(), 0.1);
  EXPECT_LT((shape - hand.rest).colwise().norm().maxCoeff(), 0.02);
}

TEST(TurnLimbs, LeavesWhatIsRight) {
  const TurnedHand hand;
  Shape shape = hand.rest;
  EXPECT_EQ(hand.Turn({}, &shape), 0);
  EXPECT_EQ(shape, hand.rest);
}

// A person who holds a vertex where it is wants it there.
TEST(TurnLimbs, DoesNotMoveWhatIsHeld) {
  const TurnedHand hand;
  Eigen::Index front = 0;
  (hand.turned - hand.rest).colwise().norm().maxCoeff(&front);
  Shape shape = hand.turned;
  hand.Turn({static_cast<int>(front)}, &shape);
  EXPECT_EQ(shape.col(front), hand.turned.col(front));
}

// Markers on the vertices of a square grid, whose distances are those in the plane: what is found
// if those that should be at `right` are at `placed`.
constexpr int kGrid = 11;
std::vector<CorrespondenceSummary::Doubt> DoubtsOnAGrid(const std::vector<int>& right,
                                                        const std::vector<int>& placed) {
  const auto place = [](int v) -> Eigen::Vector2f {
    return Eigen::Vector2f(v % kGrid, v / kGrid) / (kGrid - 1);
  };
  const auto distances = [&](const std::vector<int>& markers) -> Eigen::MatrixXf {
    return Eigen::MatrixXf::NullaryExpr(kGrid * kGrid, markers.size(), [&](int v, int k) {
      return (place(v) - place(markers[k])).norm();
    });
  };
  return internal::FindDoubtfulMarkers(distances(right), distances(placed), right, placed);
}

TEST(FindDoubtfulMarkers, MarkersAreSwappedOnlyIfEachIsExpectedAtTheOther) {
  std::vector<int> right;
  for (const int row : {0, 3, 7, 10}) {
    for (const int column : {0, 4, 6, 10}) right.push_back(kGrid * row + column);
  }
  const auto doubts = [&](const std::vector<int>& placed) { return DoubtsOnAGrid(right, placed); };
  std::vector<int> swapped = right;
  std::swap(swapped[0], swapped[10]);
  ASSERT_EQ(doubts(swapped).size(), 2u);
  for (const auto& doubt : doubts(swapped)) EXPECT_EQ(doubt.swapped, 10 - doubt.marker);
  // The first marker is at the place of the other, which is at a third place.
  std::vector<int> displaced = right;
  displaced[0] = right[10];
  displaced[10] = kGrid * 5 + 1;
  ASSERT_EQ(doubts(displaced).size(), 2u);
  for (const auto& doubt : doubts(displaced)) {
    EXPECT_EQ(doubt.expected, right[doubt.marker]);
    EXPECT_EQ(doubt.swapped, -1) << doubt.marker;
  }
}

// A marker is judged by four others at least, and not by those that are in doubt already: of five
// markers one at most can be.
TEST(FindDoubtfulMarkers, ThoseInDoubtDoNotJudgeOthers) {
  const std::vector<int> right = {0, kGrid - 1, kGrid * 5 + 5, kGrid * 10, kGrid * 11 - 1};
  bool is_any = false;
  for (int a = 0; a < kGrid * kGrid; a += 7) {
    for (int b = 3; b < kGrid * kGrid; b += 11) {
      std::vector<int> placed = right;
      placed[0] = a;
      placed[3] = b;
      const size_t count = DoubtsOnAGrid(right, placed).size();
      is_any = is_any || count == 1;
      EXPECT_LE(count, 1u) << a << ", " << b;
    }
  }
  EXPECT_TRUE(is_any);
}

TEST(Correspond, NamesAWrongMarkerAndLeavesItOut) {
  Remeshed bodies("sit");
  const double right = bodies.Errors(bodies.Fit().map).mean();
  // At the position of the last marker, which is ignored.
  const CorrespondenceMarker last = bodies.markers.back();
  bodies.markers.pop_back();
  bodies.markers[2].target_vertex = last.target_vertex;
  const CorrespondenceResult result = bodies.Fit();
  ASSERT_EQ(result.summary.doubtful.size(), 1u) << result.summary.FullReport();
  EXPECT_EQ(result.summary.doubtful[0].marker, 2);
  EXPECT_EQ(result.summary.doubtful[0].swapped, -1);
  EXPECT_EQ(result.summary.markers, 14);
  EXPECT_TRUE(Names(result.summary.warnings, "marker 3 "));
  EXPECT_LT(bodies.Errors(result.map).mean(), 2 * right);
  CorrespondenceOptions hold;
  hold.drop_doubtful = false;
  const CorrespondenceResult held = bodies.Fit(hold);
  EXPECT_EQ(held.summary.markers, 15);
  EXPECT_GT(bodies.Errors(held.map).mean(), 2 * bodies.Errors(result.map).mean());
}

TEST(Correspond, NamesMarkersThatHaveChangedPlaces) {
  Remeshed bodies("stretch");
  std::swap(bodies.markers[1].target_vertex, bodies.markers[5].target_vertex);
  const CorrespondenceResult result = bodies.Fit();
  ASSERT_EQ(result.summary.doubtful.size(), 2u) << result.summary.FullReport();
  std::set<int> named;
  for (const auto& doubt : result.summary.doubtful) {
    named.insert(doubt.marker);
    EXPECT_EQ(doubt.swapped, doubt.marker == 1 ? 5 : 1);
  }
  EXPECT_EQ(named, (std::set<int>{1, 5}));
  EXPECT_TRUE(Names(result.summary.warnings, "exchanged with marker 6"));
}

TEST(Correspond, RefusesMarkersThatCannotDo) {
  const Remeshed bodies;
  const auto message = [&](const std::function<void(std::vector<CorrespondenceMarker>*)>& change) {
    Remeshed changed = bodies;
    change(&changed.markers);
    return MessageOf<MeshError>([&] { changed.Fit(); });
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(message([](auto* m) { (*m)[1] = (*m)[0]; }), "marker 2 and marker 1 are on the same");
  expect(message([](auto* m) { (*m)[3].target_vertex = 100000; }),
         "marker 4: the target has no vertex 100001");
  expect(message([](auto* m) { (*m)[3].template_vertex = -1; }),
         "marker 4: the template has no vertex 0");
  expect(message([](auto* m) { *m = {{0, 100000}}; }), "marker 1: the target has no vertex 100001");
  const ShapeFamily bar = MakeBar(6, 1, 1, 24, 4, 4);
  const Shape rest = bar.pose(0);
  std::vector<CorrespondenceMarker> line;  // a long edge of the bar
  for (int v = 0; v < rest.cols(); ++v) {
    if (rest(1, v) == rest.row(1).maxCoeff() && rest(2, v) == rest.row(2).maxCoeff()) {
      line.push_back({v, v});
    }
  }
  ASSERT_GE(line.size(), 3u);
  expect(MessageOf<MeshError>(
             [&] { Correspond(bar.connectivity, rest, bar.connectivity, rest, line); }),
         "on one line of the template");
}

// With the orientation of every face reversed.
std::shared_ptr<const Connectivity> Reversed(const Connectivity& connectivity) {
  return Connectivity::FromTriangles(connectivity.NumVertices(),
                                     connectivity.Triangles().colwise().reverse());
}

TEST(Correspond, RefusesMirrorImagesAndWhatIsInsideOut) {
  const auto expect = [](const Remeshed& bodies, const std::string& part) {
    const std::string message = MessageOf<MeshError>([&] { bodies.Fit(); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  for (const char* pose : {"stand", "sit", "stretch"}) {
    Remeshed bodies(pose);
    bodies.second.connectivity = Reversed(*bodies.second.connectivity);
    expect(bodies, "the target is inside out");
    bodies.target.row(0) *= -1;  // outwards again
    expect(bodies, "the cyclic order of the markers around each other is reversed");
    bodies.second.connectivity = Reversed(*bodies.second.connectivity);
    expect(bodies, "the target is inside out");
  }
  // An open body has no inside, but has the markers of a mirror image.
  Remeshed open;
  open.target.row(0) *= -1;
  open.second.connectivity = Connectivity::FromTriangles(
      open.second.connectivity->NumVertices(), open.second.connectivity->Triangles().rightCols(
                                                   open.second.connectivity->NumTriangles() - 1));
  expect(open, "fit a mirror image");
}

TEST(Correspond, RefusesShapesThatAreNone) {
  const Remeshed bodies;
  const auto expect = [&](const std::function<void(Remeshed*)>& change, const std::string& part) {
    Remeshed changed = bodies;
    change(&changed);
    const std::string message = MessageOf<MeshError>([&] { changed.Fit(); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect([](Remeshed* b) { b->target(0, 7) = std::numeric_limits<double>::quiet_NaN(); },
         "the target has a coordinate");
  expect([](Remeshed* b) { b->rest.conservativeResize(3, 5); }, "the template has");
  expect([](Remeshed* b) { b->rest.setOnes(); }, "the template has no area");
}

// A copy of the body beside it, as a second component.
std::shared_ptr<const Connectivity> Twice(const Connectivity& connectivity) {
  Eigen::Matrix3Xi triangles(3, 2 * connectivity.NumTriangles());
  triangles << connectivity.Triangles(),
      connectivity.Triangles().array() + connectivity.NumVertices();
  return Connectivity::FromTriangles(2 * connectivity.NumVertices(), triangles);
}

Shape Beside(const Shape& shape) {
  Shape both(3, 2 * shape.cols());
  both << shape, shape.colwise() + Eigen::Vector3d(3, 0, 0);
  return both;
}

TEST(Correspond, RefusesMarkersThatLeaveTheTemplateNoArea) {
  // Every vertex of a square is a marker, and the ends of its diagonal lie at one place of the
  // target.
  const auto square =
      Connectivity::FromTriangles(4, (Eigen::Matrix3Xi(3, 2) << 0, 0, 1, 2, 2, 3).finished());
  Shape shape(3, 4);
  shape << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  const ShapeFamily sheet = MakeSheet(2, 2, 2, 2);
  Shape target = sheet.pose(0);
  target.col(8) = target.col(0);
  EXPECT_TRUE(Names(
      MessageOf<MeshError>([&] {
        Correspond(square, shape, sheet.connectivity, target, {{0, 0}, {1, 6}, {2, 8}, {3, 2}});
      }),
      {"area"}));
}

TEST(Correspond, SaysWhatItDoesWithFurtherComponents) {
  const Remeshed bodies;
  const CorrespondenceResult result =
      Correspond(bodies.first.connectivity, bodies.rest, Twice(*bodies.second.connectivity),
                 Beside(bodies.target), bodies.markers);
  EXPECT_TRUE(Names(result.summary.warnings, "2 components")) << result.summary.FullReport();
  const Eigen::VectorXi& triangle = result.map.to_target.triangle;
  EXPECT_LT(triangle.maxCoeff(), bodies.second.connectivity->NumTriangles());
}

// An eye without a marker keeps its place on a body that is only turned, moved and enlarged.
TEST(Correspond, ComponentsWithoutMarkersFollowTheOthers) {
  const Remeshed bodies;
  const Connectivity& body = *bodies.first.connectivity;
  const Eigen::Index count = bodies.rest.cols();
  Eigen::Matrix3Xi triangles(3, body.NumTriangles() + 4);
  Eigen::Matrix<int, 3, 4> eye;
  eye << 0, 0, 0, 1, 2, 3, 1, 2, 1, 1, 2, 3;
  triangles << body.Triangles(), eye.array() + static_cast<int>(count);
  Shape rest(3, count + 4);
  rest.leftCols(count) = bodies.rest;
  rest.rightCols(4) = bodies.rest.col(bodies.markers[0].template_vertex).replicate(1, 4);
  rest.rightCols<3>() += 0.02 * Eigen::Matrix3d::Identity();
  const RigidMotion motion{
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
      Eigen::Vector3d(5, 6, 7)};
  const double scale = 3;
  for (const bool found : {false, true}) {
    const CorrespondenceResult result =
        Correspond(Connectivity::FromTriangles(static_cast<int>(count) + 4, triangles), rest,
                   bodies.second.connectivity, motion(scale * bodies.other_rest),
                   found ? std::vector<CorrespondenceMarker>{} : bodies.markers);
    const Shape right = motion(scale * rest);
    const double off = (result.fitted - right).rightCols<4>().colwise().norm().maxCoeff() / scale;
    EXPECT_LT(off, bodies.Edge()) << result.summary.FullReport();
    EXPECT_TRUE(Names(result.summary.warnings, "1 component"));
    EXPECT_EQ(result.map.to_target.NumVertices(), count + 4);
  }
}

// A body seen from one side, of which a scanner has missed some triangles: others hang by one
// vertex or two. Nothing keeps these from turning, and none may leave the body.
TEST(Correspond, KeepsWhatHangsOnARoughBorder) {
  const Remeshed bodies("sit");
  const Shape normals = TriangleNormals(*bodies.second.connectivity, bodies.target);
  for (const unsigned seed : {1, 2, 3, 4}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.4);
    const Part side = PartOf(*bodies.second.connectivity, bodies.target, [&](int f) {
      return normals.col(f).dot(Eigen::Vector3d(0.6, 0, 0.8)) + noise(random) >= 0.1;
    });
    const Shape places = bodies.other_rest(Eigen::all, side.vertices);
    const CorrespondenceResult result =
        Correspond(side.connectivity, side.shape, bodies.first.connectivity, bodies.rest,
                   SpreadMarkers(side.shape, places, bodies.rest, 30));
    EXPECT_LT((result.fitted - places).colwise().norm().maxCoeff(), 13 * bodies.Edge()) << seed;
  }
}

// Two limbs in contact: the nearest point is on the other limb.
TEST(Correspond, DoesNotTakeOneLegForAnother) {
  Remeshed bodies;
  // Legs are pressed together until left and right intersect slightly.
  for (Shape* shape : {&bodies.target}) {
    for (int v = 0; v < shape->cols(); ++v) {
      const double height = (*shape)(1, v);
      if (height < 0.6) (*shape)(0, v) *= 1 - 0.75 * std::min(1.0, (0.6 - height) / 0.3);
    }
  }
  const CorrespondenceResult result = bodies.Fit();
  const Shape landed =
      PullBack(result.map.to_target, bodies.second.connectivity->Triangles(), bodies.other_rest);
  int wrong = 0, low = 0;
  for (int v = 0; v < landed.cols(); ++v) {
    if (bodies.rest(1, v) > 0.3) continue;
    ++low;
    wrong += landed(0, v) * bodies.rest(0, v) < 0;
  }
  ASSERT_GT(low, 50);
  EXPECT_EQ(wrong, 0);
}

TEST(Correspond, SaysWhenItHasNotComeToRest) {
  const Remeshed bodies("sit");
  CorrespondenceOptions options;
  options.max_iterations = 1;
  options.tolerance = 1e-9;
  const CorrespondenceResult result = bodies.Fit(options);
  EXPECT_FALSE(result.summary.Converged());
  EXPECT_TRUE(Names(result.summary.warnings, "the final rounds did not converge"));
}

TEST(Correspond, StopsWhenAskedTo) {
  const Remeshed bodies("sit");
  const auto run = [&](Progress* progress) {
    return Correspond(bodies.first.connectivity, bodies.rest, bodies.second.connectivity,
                      bodies.target, bodies.markers, {}, progress);
  };
  Listener all;
  run(&all);
  ASSERT_GT(all.reports, 5);
  Listener first(1), early(3), late(all.reports - 1);
  EXPECT_THROW(run(&first), Cancelled);
  EXPECT_THROW(run(&early), Cancelled);
  const CorrespondenceResult result = run(&late);
  EXPECT_TRUE(result.summary.cancelled);
  EXPECT_FALSE(result.summary.Converged());
}

TEST(Correspond, RefusesOptionsByName) {
  const auto message = [](const std::function<void(CorrespondenceOptions*)>& change) {
    CorrespondenceOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { options.Validate(); });
  };
  EXPECT_EQ(message([](auto* o) { o->proportions = 0; }).rfind("proportions: ", 0), 0u);
  EXPECT_EQ(message([](auto* o) { o->bending = -1; }).rfind("bending: ", 0), 0u);
  EXPECT_EQ(message([](auto* o) { o->tolerance = 1; }).rfind("tolerance: ", 0), 0u);
  EXPECT_EQ(message([](auto* o) { o->max_iterations = 0; }).rfind("max_iterations: ", 0), 0u);
  EXPECT_EQ(message([](auto* o) { o->coarsest = 0; }).rfind("coarsest: ", 0), 0u);
}

TEST(Correspond, ReportsAreWhole) {
  const Remeshed bodies;
  const CorrespondenceResult result = bodies.Fit();
  const auto json = nlohmann::json::parse(result.summary.ToJson());
  EXPECT_EQ(json["markers"], 16);
  EXPECT_EQ(json["template_vertices"], bodies.rest.cols());
  EXPECT_GE(json["stages"].size(), 3u);
  const RgbImage image =
      RenderCorrespondence(*bodies.first.connectivity, bodies.rest, *bodies.second.connectivity,
                           bodies.target, bodies.markers, result);
  EXPECT_GT(image.width, 300);
  EXPECT_GT(image.height, 300);
}

// Transferred poses have the other mesh's own faces.
TEST(CarryPath, TakesATransferredPoseToTheTargetsOwnMesh) {
  const Remeshed bodies;
  const CorrespondenceResult fit = bodies.Fit();
  const PoseTransferResult moved =
      TransferPoses(bodies.first.connectivity, {bodies.rest, bodies.first.pose("sit")}, fit.fitted);
  const Path path = CarryPath(fit, moved.path, bodies.second.connectivity, bodies.target);
  ASSERT_EQ(path.NumShapes(), 2);
  EXPECT_NO_THROW(path.Validate());
  EXPECT_LT((path.Placed(0) - bodies.target).colwise().norm().maxCoeff(), 1e-9);
  EXPECT_THROW(CarryPath(fit, moved.path, bodies.second.connectivity, bodies.rest), MeshError);
  EXPECT_THROW(CarryPath(fit, moved.path, bodies.first.connectivity, bodies.rest), MeshError);
  const Shape wanted = bodies.second.pose("sit");
  const RigidMotion motion =
      FitRigidMotion(path.Placed(1), wanted, Eigen::VectorXd::Ones(wanted.cols()));
  const double off = (motion(path.Placed(1)) - wanted).colwise().norm().mean();
  EXPECT_LT(off, 0.5 * bodies.Edge());
}

// The template is closed and was deformed under a cost of volume, which an open scan cannot have.
TEST(CarryPath, TakesADeformationOfAClosedTemplateToAnOpenScan) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const Shape rest = bar.pose(0);
  const Eigen::Matrix3Xi& triangles = bar.connectivity->Triangles();
  const int count = static_cast<int>(rest.cols());
  const auto scan = Connectivity::FromTriangles(count, triangles.leftCols(triangles.cols() - 4));
  CorrespondenceResult fit;
  fit.fitted = rest;
  fit.map.gap = Eigen::VectorXd::Zero(count);
  fit.map.to_template.triangle.resize(count);
  fit.map.to_template.barycentric.setZero(3, count);
  for (int f = 0; f < triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      fit.map.to_template.triangle(triangles(k, f)) = f;
      fit.map.to_template.barycentric.col(triangles(k, f)) = Eigen::Vector3d::Unit(k);
    }
  }
  DeformationHandle left, right;
  left.vertices = testing::Where(rest, [](const auto& p) { return p.x() < -2.7; });
  right.vertices = testing::Where(rest, [](const auto& p) { return p.x() > 2.7; });
  right.motion.angle = 0.5;
  const Path path = Deform(bar.connectivity, rest, {left, right}).path;
  ASSERT_GT(path.metric->options.volume, 0);
  const Path carried = CarryPath(fit, path, scan, rest);
  EXPECT_EQ(carried.metric->options.volume, 0);
  EXPECT_EQ(carried.metric->options.bending, path.metric->options.bending);
  EXPECT_LT(testing::Distance(carried, path), 1e-9);

  // The scan has other edges, so that the stiffness of the template's goes by way of vertices.
  MetricOptions options = path.metric->options;
  options.bending_stiffness.setConstant(bar.connectivity->NumEdges(), 5);
  options.stiffness_on = StiffnessOn::kEdges;
  const std::vector<Shape> shapes = path.Placed();
  const Path stiff =
      MakePath(FreezeMetric(options, bar.connectivity, shapes), shapes, path.parameters);
  const MetricOptions of_scan = CarryPath(fit, stiff, scan, rest).metric->options;
  EXPECT_EQ(of_scan.stiffness_on, StiffnessOn::kVertices);
  EXPECT_TRUE(of_scan.bending_stiffness.isApproxToConstant(5, 1e-12));
  EXPECT_EQ(of_scan.bending_stiffness.size(), count);
}

// Parts of the target without a corresponding part of the template move with their neighbourhood.
TEST(CarryPath, KeepsTogetherWhatTheTemplateDoesNotHave) {
  const Remeshed bodies;
  const double cut = 1.25;  // the template ends at the neck
  const auto& all = bodies.first.connectivity->Triangles();
  std::vector<int> kept;
  for (int f = 0; f < all.cols(); ++f) {
    if ((bodies.rest(1, all.col(f)).array() < cut).all()) kept.push_back(f);
  }
  const auto headless =
      Connectivity::FromTriangles(bodies.first.connectivity->NumVertices(), all(Eigen::all, kept));
  std::vector<CorrespondenceMarker> markers;
  for (const CorrespondenceMarker& marker : bodies.markers) {
    if (bodies.rest(1, marker.template_vertex) < cut - 0.1) markers.push_back(marker);
  }
  const CorrespondenceResult fit =
      Correspond(headless, bodies.rest, bodies.second.connectivity, bodies.target, markers);
  EXPECT_GT(fit.summary.uncovered, 0.05);
  // The vertices of what is not covered have the gap 1.
  const Eigen::VectorXd areas = internal::VertexAreas(*bodies.second.connectivity, bodies.target);
  EXPECT_NEAR((fit.map.gap.array() == 1).select(areas, 0).sum(), fit.summary.uncovered, 1e-9);
  EXPECT_TRUE(Names(fit.summary.warnings, "not near any part"));
  const PoseTransferResult moved =
      TransferPoses(headless, {bodies.rest, bodies.first.pose("sit")}, fit.fitted);
  const Shape sitting =
      CarryPath(fit, moved.path, bodies.second.connectivity, bodies.target).Placed(1);
  double most = 0;
  for (const auto& edge : bodies.second.connectivity->Edges().colwise()) {
    const auto length = [&](const Shape& shape) {
      return (shape.col(edge(0)) - shape.col(edge(1))).norm();
    };
    most = std::max(most, length(sitting) / length(bodies.target));
  }
  EXPECT_LT(most, 3);

  // Scaling by a thousand and a large translation do not change the result.
  const auto move = [](const Shape& shape) -> Shape {
    return (1e3 * shape).colwise() + Eigen::Vector3d(1e6, -2e6, 3e6);
  };
  CorrespondenceResult large = fit;
  large.fitted = move(fit.fitted);
  const PoseTransferResult far =
      TransferPoses(headless, {bodies.rest, bodies.first.pose("sit")}, large.fitted);
  const Shape other =
      CarryPath(large, far.path, bodies.second.connectivity, move(bodies.target)).Placed(1);
  EXPECT_LT((other - move(sitting)).colwise().norm().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace shapespace
