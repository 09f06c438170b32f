#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/matching/detail/assignments.h>
#include <shapespace/matching/detail/candidate_figures.h>
#include <shapespace/matching/detail/extremities.h>
#include <shapespace/matching/detail/farthest_points.h>
#include <shapespace/matching/detail/known_ends.h>
#include <shapespace/matching/detail/laplacian.h>
#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/detail/nearest_columns.h>
#include <shapespace/matching/detail/spectrum.h>
#include <shapespace/matching/detail/surface_graph.h>
#include <shapespace/matching/detail/turns.h>
#include <shapespace/matching/detail/working_surface.h>
#include <shapespace/matching/detail/zoomout.h>

namespace shapespace::internal {
namespace {

constexpr double kSquareOfPi = 9.8696044010893586;

TEST(Laplacian, OfASheetIsThatOfLinearFiniteElements) {
  const ShapeFamily sheet = MakeSheet(2, 0.5, 24, 8);
  const Shape shape = sheet.pose(0);
  const Laplacian laplacian = MakeLaplacian(*sheet.connectivity, shape);
  EXPECT_NEAR(laplacian.areas.sum(), 1, 1e-12);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(shape.cols());
  EXPECT_LT((laplacian.stiffness * one).cwiseAbs().maxCoeff(), 1e-12);
  // The integral of |grad x|^2.
  const Eigen::VectorXd x = shape.row(0);
  EXPECT_NEAR(x.dot(laplacian.stiffness * x), 1, 1e-12);
}

TEST(Laplacian, IsFiniteAndSemidefiniteOnSlivers) {
  // A square of four triangles around a vertex that lies on a side: one of them has no area.
  Shape shape(3, 5);
  shape << 0, 1, 1, 0, 0.5, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0;
  Eigen::Matrix3Xi triangles(3, 4);
  triangles << 0, 1, 2, 3, 1, 2, 3, 0, 4, 4, 4, 4;
  const Laplacian laplacian = MakeLaplacian(*Connectivity::FromTriangles(5, triangles), shape);
  EXPECT_GT(laplacian.areas.minCoeff(), 0);
  EXPECT_NEAR(laplacian.areas.sum(), 1, 1e-2);
  const Spectrum spectrum = ComputeSpectrum(laplacian, 5);
  EXPECT_TRUE(spectrum.functions.allFinite());
  EXPECT_NEAR(spectrum.values(0), 0, 1e-6);
  EXPECT_GT(spectrum.values(1), 1);
}

TEST(Spectrum, OfASquareIsThatOfCosines) {
  const ShapeFamily sheet = MakeSheet(1, 1, 40, 40);
  const Laplacian laplacian = MakeLaplacian(*sheet.connectivity, sheet.pose(0));
  const Spectrum spectrum = ComputeSpectrum(laplacian, 30);
  std::vector<double> exact;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) exact.push_back(kSquareOfPi * (i * i + j * j));
  }
  std::sort(exact.begin(), exact.end());
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(spectrum.values(i), exact[i], 0.02 * exact[i] + 1e-9);
  const Eigen::MatrixXd products =
      spectrum.functions.transpose() * laplacian.areas.asDiagonal() * spectrum.functions;
  EXPECT_LT((products - Eigen::MatrixXd::Identity(30, 30)).cwiseAbs().maxCoeff(), 1e-10);
  const Eigen::MatrixXd residuals =
      laplacian.stiffness * spectrum.functions -
      laplacian.areas.asDiagonal() * spectrum.functions * spectrum.values.asDiagonal();
  EXPECT_LT(residuals.norm(), 1e-6 * spectrum.values(29));
}

TEST(Spectrum, DoesNotDependOnTheMethodThatTheSizeSelects) {
  // 441 vertices are solved whole for 100 functions, and by Lanczos' method for 30.
  const ShapeFamily sheet = MakeSheet(1, 1.1, 20, 20);
  const Laplacian laplacian = MakeLaplacian(*sheet.connectivity, sheet.pose(0));
  const Spectrum whole = ComputeSpectrum(laplacian, 100), few = ComputeSpectrum(laplacian, 30);
  EXPECT_LT((whole.values.head(30) - few.values).cwiseAbs().maxCoeff(), 1e-6);
}

// Its vertices come first, and what is added lies on its edges.
TEST(WorkingSurface, OfACoarseBodyIsTheSameSurfaceWithMoreTriangles) {
  const SkinnedBody body = MakeQuadruped(1200);
  const Shape shape = body.pose("sit");
  const WorkingSurface surface = MakeWorkingSurface("template", *body.connectivity, shape, nullptr);
  EXPECT_GE(surface.connectivity->NumTriangles(), 4000);
  EXPECT_EQ(surface.num_own, body.connectivity->NumVertices());
  const double scale = (surface.shape.col(1) - surface.shape.col(0)).norm() /
                       (shape.col(surface.vertices[1]) - shape.col(surface.vertices[0])).norm();
  const Eigen::VectorXd areas = MakeLaplacian(*surface.connectivity, surface.shape).areas;
  EXPECT_NEAR(areas.sum(), 1, 1e-12);
  EXPECT_NEAR(areas.sum(), scale * scale * MakeLaplacian(*body.connectivity, shape).areas.sum(),
              1e-12);
  double longest = 0;
  for (const auto& edge : body.connectivity->Edges().colwise()) {
    longest = std::max(longest, scale * (shape.col(edge(0)) - shape.col(edge(1))).norm());
  }
  for (int v = 0; v < surface.NumVertices(); ++v) {
    const int own = surface.Own(v);
    EXPECT_EQ(surface.vertices[own], surface.vertices[v]);
    EXPECT_EQ(v < surface.num_own, own == v);
    EXPECT_LE((surface.shape.col(v) - surface.shape.col(own)).norm(), longest);
  }
  const MatchingBody whole("template", *body.connectivity, shape, nullptr);
  for (const int v : whole.even.vertices) EXPECT_LT(v, surface.num_own);
  for (const int v : whole.all_extremities) EXPECT_LT(v, surface.num_own);
}

TEST(SurfaceGraph, DistancesOnASheetAreNearlyStraight) {
  const ShapeFamily sheet = MakeSheet(1, 1, 30, 30);
  for (const double angle : {0.0, 120.0}) {
    // Rolled up, the sheet has the same distances but for chords of arcs.
    const Shape flat = sheet.pose(0);
    const SurfaceGraph graph(*sheet.connectivity, sheet.pose(angle));
    const Eigen::VectorXf distances = graph.From(0);
    for (int v = 1; v < graph.NumVertices(); ++v) {
      const Eigen::Vector3d way = flat.col(v) - flat.col(0);
      const double straight = way.norm(), along_edges = std::abs(way(1)) < 1e-9 ? 1e-3 : 0.085;
      EXPECT_GE(distances(v), straight * (1 - 1e-3));
      EXPECT_LE(distances(v), straight * (1 + along_edges));
    }
  }
}

TEST(SurfaceGraph, DistancesAreAMetricOnTheVertices) {
  const SkinnedBody body = MakeQuadruped(1000);
  const SurfaceGraph graph(*body.connectivity, body.pose("sit"));
  std::vector<int> all(graph.NumVertices());
  for (int v = 0; v < graph.NumVertices(); ++v) all[v] = v;
  const Eigen::MatrixXf d = graph.FromEach(all);
  EXPECT_LT((d - d.transpose()).cwiseAbs().maxCoeff(), 1e-5F);
  for (int v = 0; v < graph.NumVertices(); v += 7) {
    for (int w = 0; w < graph.NumVertices(); w += 5) {
      EXPECT_LE(d(v, w), (d.col(v) + d.col(w)).minCoeff() + 1e-5F);
    }
  }
  const std::vector<int> sources = {3, 100, 77};
  const std::vector<int> nearest = graph.NearestOf(sources);
  for (int v = 0; v < graph.NumVertices(); ++v) {
    for (const int source : sources) EXPECT_LE(d(v, sources[nearest[v]]), d(v, source));
  }
}

TEST(FarthestPoints, CoverTheSurfaceEvenly) {
  const SkinnedBody body = MakeQuadruped(3000);
  const Shape shape = body.pose("stand");
  const SurfaceGraph graph(*body.connectivity, shape);
  const Laplacian laplacian = MakeLaplacian(*body.connectivity, shape);
  const EvenSamples samples = SampleEvenly(graph, shape, laplacian.areas, 100, graph.NumVertices());
  ASSERT_EQ(samples.vertices.size(), 100);
  float apart = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < i; ++j) apart = std::min(apart, samples.distances(samples.vertices[i], j));
  }
  // No vertex is farther from the samples than these are from each other.
  EXPECT_LE(samples.distances.rowwise().minCoeff().maxCoeff(), apart);
}

TEST(Extremities, AreTheEndsOfAnAnimal) {
  for (const char* pose : {"stand", "rear", "sit"}) {
    const SkinnedBody body = MakeQuadruped(3000);
    const Shape shape = body.pose(pose);
    const Laplacian laplacian = MakeLaplacian(*body.connectivity, shape);
    const double unit = std::sqrt(laplacian.areas.sum());
    const Shape scaled = shape / unit;
    const SurfaceGraph graph(*body.connectivity, scaled);
    const EvenSamples samples =
        SampleEvenly(graph, scaled, laplacian.areas, 200, graph.NumVertices());
    const auto found = FindExtremities(graph, samples, laplacian.areas, 0.02);
    const std::vector<int> ends = PrincipalExtremities(found);
    ASSERT_EQ(ends.size(), 6) << pose;
    // In the standing pose, the head is in front and above, the tail behind, and feet are below.
    const Shape rest = body.pose("stand");
    const double height = rest.row(1).maxCoeff();
    int feet = 0;
    for (const int v : ends) feet += rest(1, v) < 0.1 * height;
    EXPECT_EQ(feet, 4) << pose;
  }
}

Eigen::MatrixXd RandomDistances(int count, std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(0.2, 1);
  Eigen::MatrixXd distances = Eigen::MatrixXd::Zero(count, count);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < i; ++j) distances(i, j) = distances(j, i) = uniform(*random);
  }
  return distances;
}

TEST(Assignments, FindAHiddenPermutationAmongMore) {
  std::mt19937 random(1);
  const Eigen::MatrixXd large = RandomDistances(8, &random);
  const std::vector<int> which = {5, 0, 7, 2, 3, 6};
  Eigen::MatrixXd small(6, 6);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) small(i, j) = large(which[i], which[j]);
  }
  for (const bool swapped : {false, true}) {
    const Assignments found =
        swapped ? AssignExtremities({large, small, Eigen::MatrixXd::Zero(8, 6)}, 5, 3)
                : AssignExtremities({small, large, Eigen::MatrixXd::Zero(6, 8)}, 5, 3);
    ASSERT_EQ(found.best.size(), 5);
    EXPECT_NEAR(found.best[0].cost, 0, 1e-12);
    for (int i = 1; i < 5; ++i) EXPECT_GE(found.best[i].cost, found.best[i - 1].cost);
    for (const auto& [a, b] : found.best[0].pairs)
      EXPECT_EQ(swapped ? a : b, which[swapped ? b : a]);
    EXPECT_EQ(found.best[0].pairs.size(), 6);
  }
}

TEST(Assignments, TheBoundLosesNoneOfTheBest) {
  std::mt19937 random(2);
  const Eigen::MatrixXd a = RandomDistances(5, &random), b = RandomDistances(5, &random);
  const Eigen::MatrixXd difference = Eigen::MatrixXd::Random(5, 5).cwiseAbs();
  // With room for all there is nothing to leave out.
  const Assignments all = AssignExtremities({a, b, difference}, 100000, 3);
  const Assignments few = AssignExtremities({a, b, difference}, 10, 3);
  EXPECT_LT(few.tried, all.tried);
  ASSERT_EQ(few.best.size(), 10);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(few.best[i].cost, all.best[i].cost, 1e-12);
}

TEST(Assignments, KnownPointsTellEqualExtremitiesApart) {
  // Four ends of a table, equally far from each other, and a point near the third and the second.
  const Eigen::MatrixXd between = Eigen::MatrixXd::Ones(4, 4) - Eigen::MatrixXd::Identity(4, 4);
  LandmarkDistances distances{Eigen::MatrixXd::Ones(4, 5), Eigen::MatrixXd::Ones(4, 5),
                              Eigen::MatrixXd::Zero(4, 4)};
  distances.on_template.leftCols(4) = distances.on_target.leftCols(4) = between;
  distances.on_template(2, 4) = distances.on_target(1, 4) = 0.1;
  const Assignments found = AssignExtremities(distances, 6, 3);
  ASSERT_EQ(found.best.size(), 6);
  for (const Assignment& assignment : found.best) {
    ASSERT_EQ(assignment.pairs.size(), 4);
    EXPECT_EQ(assignment.pairs[2].second, 1);
  }
}

TEST(Assignments, EndForManyEqualExtremities) {
  const Eigen::MatrixXd between = Eigen::MatrixXd::Ones(9, 9) - Eigen::MatrixXd::Identity(9, 9);
  const Assignments found =
      AssignExtremities({between, between, Eigen::MatrixXd::Zero(9, 9)}, 24, 3);
  EXPECT_EQ(found.best.size(), 24);
  EXPECT_LE(found.tried, 1000000);
}

TEST(NearestColumns, AreThoseOfASearchOneByOne) {
  for (const auto& [dimensions, queries, points] :
       {std::tuple(1, 5, 3), std::tuple(7, 13, 100), std::tuple(120, 50, 333)}) {
    const Eigen::MatrixXf a = Eigen::MatrixXf::Random(dimensions, queries);
    Eigen::MatrixXf b = Eigen::MatrixXf::Random(dimensions, points);
    b.col(points - 1) = b.col(0);  // of equal columns the first is taken
    const std::vector<int> nearest = NearestColumns(a, b);
    ASSERT_EQ(nearest.size(), queries);
    for (int q = 0; q < queries; ++q) {
      Eigen::Index expected;
      (b.colwise() - a.col(q)).colwise().squaredNorm().minCoeff(&expected);
      EXPECT_EQ(nearest[q], expected);
    }
  }
}

TEST(Turns, AreTheAreaOfGradientsAndChangeSignUnderReflection) {
  const ShapeFamily sheet = MakeSheet(2, 0.5, 12, 6);
  const Shape shape = sheet.pose(0);
  const Laplacian laplacian = MakeLaplacian(*sheet.connectivity, shape);
  Eigen::MatrixXf functions(shape.cols(), 2);
  functions.col(0) = (2 * shape.row(0) + shape.row(1)).transpose().cast<float>();
  functions.col(1) = (3 * shape.row(1) - shape.row(0)).transpose().cast<float>();
  // The normal is +z, and (2, 1) x (-1, 3) is 7.
  const Eigen::MatrixXf turns =
      GradientTurns(*sheet.connectivity, laplacian.areas, functions, AllPairs(2));
  EXPECT_LT((turns.array() - 7).abs().maxCoeff(), 1e-4F);
  Eigen::Matrix3Xi triangles = sheet.connectivity->Triangles();
  triangles.row(0).swap(triangles.row(1));
  const auto reversed = Connectivity::FromTriangles(static_cast<int>(shape.cols()), triangles);
  const Eigen::MatrixXf back = GradientTurns(*reversed, laplacian.areas, functions, AllPairs(2));
  EXPECT_LT((back.array() + 7).abs().maxCoeff(), 1e-4F);
}

TEST(CandidateFigures, TellAReflectionFromTheIdentity) {
  const SkinnedBody body = MakeQuadruped(2000);
  const Shape shape = body.pose("stride");
  Shape reflected = shape;
  reflected.row(0) *= -1;
  Eigen::Matrix3Xi triangles = body.connectivity->Triangles();
  triangles.row(1).swap(triangles.row(2));
  const auto turned = Connectivity::FromTriangles(static_cast<int>(shape.cols()), triangles);
  const MatchingBody first("template", *body.connectivity, shape, nullptr);
  const MatchingBody second("target", *turned, reflected, nullptr);
  for (const MatchingBody* other : {&first, &second}) {
    // The map that sends each vertex to that of the same number.
    SpectralMap map;
    map.from_target = (first.spectrum.functions.leftCols(60).transpose() *
                       first.laplacian.areas.asDiagonal() * other->spectrum.functions.leftCols(60))
                          .cast<float>();
    map.from_template = map.from_target.transpose();
    const CandidateFigures figures(first, *other);
    const SpectralMap whole = figures.WithAllImages(map);
    if (other == &first) {
      EXPECT_GT(figures.Orientation(whole), 0.99);
    } else {
      EXPECT_LT(figures.Orientation(whole), -0.95);
    }
    EXPECT_GT(figures.Curvature(whole), 0.95);
    EXPECT_LT(figures.Isometry({whole})[0], 0.02);
  }
}

// Of an animal and itself: pairs at the ends of limbs, or near them, say which is which; one in the
// middle is a landmark.
TEST(KnownEnds, PairsAtExtremitiesForbidAllOthers) {
  const SkinnedBody animal = MakeQuadruped(2400);
  const MatchingBody body("body", *animal.connectivity, animal.pose("stand"), nullptr);
  const std::vector<int>& ends = body.extremities;
  ASSERT_EQ(ends.size(), 6u);
  const auto at_distance = [&](int from, float distance) {
    Eigen::Index v = 0;
    (body.graph.From(from).array() - distance).abs().minCoeff(&v);
    return static_cast<int>(v);
  };
  const int middle = at_distance(ends[0], 0.6F);
  const KnownEnds known(body, ends, body, ends,
                        {{ends[0], ends[1]},
                         {at_distance(ends[2], 0.05F), at_distance(ends[4], 0.04F)},
                         {middle, middle},
                         {ends[3], middle}});
  EXPECT_EQ(known.landmarks, (VertexPairs{{middle, middle}, {ends[3], middle}}));
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const bool is_known = i == 0 || j == 1 || i == 2 || j == 4;
      const bool is_right = (i == 0 && j == 1) || (i == 2 && j == 4);
      const double difference = known.difference(i, j);
      EXPECT_TRUE(is_known && !is_right ? difference > 100 : difference == 0) << i << ' ' << j;
    }
  }
}

}  // namespace
}  // namespace shapespace::internal
