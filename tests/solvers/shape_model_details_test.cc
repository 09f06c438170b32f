// Averages, models, their pages and their pictures: figures against what they are defined to be.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/output/internal/text.h>
#include <shapespace/statistics/assess.h>
#include <shapespace/statistics/average.h>
#include <shapespace/statistics/modes_page.h>
#include <shapespace/statistics/modes_picture.h>
#include <shapespace/statistics/shape_model.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::Distance;
using testing::MessageOf;
using testing::Names;
using testing::Noise;
using testing::Refuses;
using testing::Rotation;

struct ReportRecorder : Progress {
  bool Report(const std::string& stage, int done, int total) override {
    stages.push_back(stage + " " + std::to_string(done) + "/" + std::to_string(total));
    return true;
  }
  std::vector<std::string> stages;
};

const ShapeFamily& SmallBar() {
  static const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  return bar;
}

// Bent and dented in different ways, far from the origin, in a unit of thousandths.
std::vector<Shape> BarPoses(int count, double scale = 1) {
  std::vector<Shape> poses;
  for (int i = 0; i < count; ++i) {
    Shape pose = SmallBar().pose(25 * i);
    pose += Noise(static_cast<int>(pose.cols()), 0.02, i + 1);
    poses.push_back((scale * Rotation(30 * i, {1, 2, 3}) * pose).colwise() +
                    Eigen::Vector3d(40, -20 + i, 7));
  }
  return poses;
}

const PoseModes& BarModes() {
  static const PoseModes modes =
      MakeShapeModel(SmallBar().connectivity, BarPoses(5), {"a", "b", "c", "d", "e"}).modes;
  return modes;
}

TEST(Average, TheSummaryIsOfTheWeightedPoses) {
  const std::vector<Shape> poses = BarPoses(4);
  AverageOptions options;
  options.weights = {1, 0, 3, 2};
  ReportRecorder recorder;
  const auto [shape, summary] = Average(SmallBar().connectivity, poses, options, &recorder);
  EXPECT_EQ(summary.vertices, shape.cols());
  EXPECT_EQ(summary.triangles, SmallBar().connectivity->NumTriangles());
  EXPECT_EQ(summary.poses, 3);
  const auto metric = FreezeMetric(options.geodesic.metric, SmallBar().connectivity,
                                   {poses[0], poses[2], poses[3]}, 0, PosePairs::kAll);
  EXPECT_EQ(summary.metric, DescribeMetric(metric->options));
  EXPECT_NEAR(summary.unit, metric->unit, 1e-12);
  EXPECT_GT(summary.variance, 0);
  EXPECT_GE(summary.residual, 0);
  EXPECT_LT(summary.residual, 0.1);
  EXPECT_GT(summary.iterations, 0);
  EXPECT_GT(summary.estimated_bytes, 0);
  EXPECT_GE(summary.energy, summary.lower_bound);
  EXPECT_GT(summary.lower_bound, 0);
  EXPECT_EQ(summary.refinements, 0);
  EXPECT_TRUE(std::isnan(summary.refined_by));
  EXPECT_LE(summary.certificate_seconds, summary.total_seconds);
  EXPECT_EQ(recorder.stages[0], "averaging 0/0");
  EXPECT_NE(std::find(recorder.stages.begin(), recorder.stages.end(),
                      "comparing with the lower bound 0/3"),
            recorder.stages.end());
  // Edges' lengths against their weighted geometric means.
  double squares = 0, area = 0;
  for (int e = 0; e < metric->connectivity->NumEdges(); ++e) {
    const auto edge = metric->connectivity->Edges().col(e);
    const auto log_length = [&](const Shape& x) {
      return std::log((x.col(edge(0)) - x.col(edge(1))).norm());
    };
    const double mean =
        (log_length(poses[0]) + 3 * log_length(poses[2]) + 2 * log_length(poses[3])) / 6;
    squares += metric->edge_area(e) * std::pow(log_length(shape) - mean, 2);
    area += metric->edge_area(e);
  }
  EXPECT_NEAR(summary.edge_rms, std::sqrt(squares / area), 1e-9);
  // It is where the poses are on the mean.
  const auto place = [&](const Shape& x) { return Centroid(x, metric->vertex_area); };
  const Eigen::Vector3d middle = (place(poses[0]) + 3 * place(poses[2]) + 2 * place(poses[3])) / 6;
  EXPECT_LT((place(shape) - middle).norm(), 1e-6);
  options.certify = false;
  const AverageResult plain = Average(SmallBar().connectivity, poses, options);
  EXPECT_EQ(plain.shape, shape);
  EXPECT_TRUE(std::isnan(plain.summary.energy));
  EXPECT_TRUE(std::isnan(plain.summary.lower_bound));
  EXPECT_TRUE(std::isnan(plain.summary.Ratio()));
  EXPECT_EQ(plain.summary.certificate_seconds, 0);
}

TEST(Average, RefinementLowersTheDistances) {
  const std::vector<Shape> poses = BarPoses(3);
  AverageOptions options;
  options.geodesic.shapes = 3;
  options.geodesic.tolerance = 1e-6;
  options.weights = {1, 2, 5};
  const AverageResult plain = Average(SmallBar().connectivity, poses, options);
  options.refine = true;
  options.certify = false;
  const AverageResult refined = Average(SmallBar().connectivity, poses, options);
  EXPECT_GT(refined.summary.refinements, 0);
  EXPECT_LE(refined.summary.refinements, 20);
  EXPECT_NEAR(refined.summary.lower_bound, plain.summary.lower_bound,
              1e-9 * plain.summary.lower_bound);
  EXPECT_LE(refined.summary.energy, plain.summary.energy * (1 + 1e-6));
  EXPECT_NEAR(refined.summary.refined_by, 1 - refined.summary.energy / plain.summary.energy, 1e-5);
  EXPECT_GE(refined.summary.Ratio(), 1);
  EXPECT_LT(Distance(refined.shape, plain.shape), 0.2);
}

TEST(Average, RefusalsNameTheRemedy) {
  const auto message = [](const std::vector<double>& weights) {
    AverageOptions options;
    options.weights = weights;
    return MessageOf<InvalidOptions>(
        [&] { Average(SmallBar().connectivity, BarPoses(3), options); });
  };
  EXPECT_TRUE(Names(message({1, 2}), {"weights:", "3", "2"}));
  EXPECT_TRUE(Names(message({1, 2, -1}), {"weights:"}));
  EXPECT_TRUE(Names(message({1, 2, INFINITY}), {"weights:"}));
  EXPECT_TRUE(Names(message({0, 0, 0}), {"weights:"}));
  EXPECT_TRUE(Names(message({1e308, 1e308, 1e308}), {"weights:"}));
  const auto of_options = [](void (*change)(AverageOptions*)) {
    AverageOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { options.Validate(); });
  };
  EXPECT_TRUE(
      Names(of_options([](AverageOptions* o) { o->geodesic.metric = MetricOptions::Paper(); }),
            {"discretization:"}));
  EXPECT_TRUE(
      Names(of_options([](AverageOptions* o) { o->geodesic.metric = MetricOptions::Rigid(); }),
            {"rigid:"}));
  EXPECT_EQ(of_options([](AverageOptions* o) { o->tolerance = 0; }).find("tolerance:"), 0u);
  EXPECT_EQ(of_options([](AverageOptions* o) { o->max_iterations = 0; }).find("max_iterations:"),
            0u);
  EXPECT_EQ(of_options([](AverageOptions* o) { o->geodesic.shapes = -1; }).find("shapes:"), 0u);
  EXPECT_TRUE(Refuses<MeshError>([] { Average(SmallBar().connectivity, {}); }, {"average"}));
  AverageOptions options;
  options.geodesic.memory_limit = 1000;
  EXPECT_TRUE(Refuses<SolverError>([&] { Average(SmallBar().connectivity, BarPoses(3), options); },
                                   {"this average", "fewer poses"}));
}

TEST(MakeShapeModel, PosesOfNoWeightAndTheirNamesAreLeftOut) {
  const std::vector<Shape> poses = BarPoses(5);
  ShapeModelOptions options;
  options.average.weights = {1, 0, 2, 3, 4};
  options.modes = 2;
  ReportRecorder recorder;
  const auto [modes, summary] =
      MakeShapeModel(SmallBar().connectivity, poses, {"a", "b", "c", "d", "e"}, options, &recorder);
  EXPECT_EQ(modes.names, (std::vector<std::string>{"a", "c", "d", "e"}));
  EXPECT_TRUE(modes.weights.isApprox(Eigen::Vector4d(1, 2, 3, 4) / 10, 1e-14));
  ASSERT_EQ(modes.NumPoses(), 4);
  EXPECT_LT(Distance(modes.PlacedPose(1), poses[2]), 1e-9);
  EXPECT_LT(Distance(modes.PlacedPose(3), poses[4]), 1e-9);
  EXPECT_EQ(modes.NumModes(), 2);
  EXPECT_EQ(modes.coefficients.cols(), 2);
  EXPECT_EQ(summary.modes, 2);
  EXPECT_EQ(summary.rank, 3);
  ASSERT_EQ(summary.variances.size(), 3u);
  EXPECT_NEAR(summary.variances[0] + summary.variances[1] + summary.variances[2], 1, 1e-12);
  EXPECT_NEAR(summary.variances[1], modes.variances(1) / modes.total_variance, 1e-12);
  EXPECT_NEAR(modes.Share(2), summary.variances[0] + summary.variances[1], 1e-12);
  EXPECT_EQ(summary.average.poses, 4);
  EXPECT_EQ(std::count(recorder.stages.begin(), recorder.stages.end(), "finding modes 3/4"), 1);
  // The mean is the average, where it is.
  const Shape average = Average(SmallBar().connectivity, poses, options.average).shape;
  EXPECT_LT(Distance(modes.place(modes.metric->unit * modes.mean), average), 1e-9);
  EXPECT_LT(Centroid(modes.mean, modes.metric->vertex_area).norm(), 1e-12);
  for (int k = 0; k < 2; ++k) {
    Eigen::Index at;
    modes.coefficients.col(k).cwiseQuotient(modes.weights.cwiseSqrt()).cwiseAbs().maxCoeff(&at);
    EXPECT_GT(modes.coefficients(at, k), 0);
  }
  // Poses without a name are counted.
  options.average.weights.clear();
  EXPECT_EQ(MakeShapeModel(SmallBar().connectivity, BarPoses(3), {}, options).modes.names,
            (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [&] {
        MakeShapeModel(SmallBar().connectivity, BarPoses(3), {"a", "b"}, options);
      },
      {"names:", "3", "2"}));
  EXPECT_TRUE(
      Refuses<MeshError>([&] { MakeShapeModel(SmallBar().connectivity, {}, {}); }, {"modes"}));
}

TEST(MakeShapeModel, WarningsSayWhy) {
  const auto warnings = [](const std::vector<Shape>& poses) {
    return MakeShapeModel(SmallBar().connectivity, poses, {}).summary.warnings;
  };
  const Shape pose = SmallBar().pose(30);
  EXPECT_TRUE(testing::EachNames(warnings({pose}), {{"one pose", "no modes"}}));
  EXPECT_TRUE(testing::EachNames(warnings({pose, pose}), {{"same shape", "no modes"}}));
}

TEST(ShapeModel, DistancesAreWeightedByAreaAndTheFitIsTheNearest) {
  const ShapeModel model(FirstModes(BarModes(), 2));
  const Metric& metric = *model.Modes().metric;
  const Shape other = BarPoses(7).back();
  for (const bool fit : {false, true}) {
    const ModelCoordinates found = model.Coordinates(other, fit);
    EXPECT_EQ(found.coordinates.size(), 2);
    EXPECT_EQ(found.rounds > 0, fit);
    const Eigen::VectorXd squared = (found.shape - other).colwise().squaredNorm().transpose();
    EXPECT_NEAR(found.distance,
                std::sqrt(squared.dot(metric.vertex_area) / metric.vertex_area.sum()),
                1e-6 * found.distance);
    // The shape is that at the coordinates, but for its place.
    const Shape there = model.At(found.coordinates).shape;
    EXPECT_LT(Distance(FitRigidMotion(there, found.shape, metric.vertex_area)(there), found.shape),
              1e-4);
    if (!fit) continue;
    for (int k = 0; k < 2; ++k) {
      for (const double step : {-0.2, 0.2}) {
        Eigen::VectorXd beside = found.coordinates;
        beside(k) += step;
        const Shape shape = model.At(beside).shape;
        const Shape moved = FitRigidMotion(shape, other, metric.vertex_area)(shape);
        const Eigen::VectorXd off = (moved - other).colwise().squaredNorm().transpose();
        EXPECT_GT(std::sqrt(off.dot(metric.vertex_area) / metric.vertex_area.sum()),
                  found.distance);
      }
    }
  }
  EXPECT_TRUE(
      Refuses<InvalidOptions>([&] { model.Coordinates(other, false, 3); }, {"modes:", "0", "2"}));
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { model.At(Eigen::Vector3d(1, 2, 3)); },
                                      {"coordinates:", "2", "3"}));
  EXPECT_TRUE(
      Refuses<InvalidOptions>([&] { model.Preview(Eigen::Vector2d(1, NAN)); }, {"coordinates:"}));
  const std::string count = std::to_string(other.cols());
  EXPECT_TRUE(Refuses<MeshError>([&] { model.Coordinates(other.leftCols(4)); }, {"4", count}));
}

TEST(ShapeModel, RandomCoordinatesAreIndependentAndNormal) {
  const ShapeModel model(FirstModes(BarModes(), 2));
  constexpr int kDrawn = 4000;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
  double fourth = 0;
  for (unsigned seed = 0; seed < kDrawn; ++seed) {
    const Eigen::Vector2d x = model.Sample(seed);
    mean += x / kDrawn;
    products += x * x.transpose() / kDrawn;
    fourth += std::pow(x(0), 4) / kDrawn;
  }
  EXPECT_LT(mean.norm(), 0.1);
  EXPECT_LT((products - Eigen::Matrix2d::Identity()).norm(), 0.15);
  EXPECT_NEAR(fourth, 3, 0.6);
}

TEST(AssessShapeModel, SamplesAreThoseOfSeedsInARowAndSharesHaveNoUnit) {
  AssessmentOptions options;
  options.samples = 2;
  options.seed = 5;
  ReportRecorder recorder;
  const auto assess = [&](double scale) {
    return AssessShapeModel(SmallBar().connectivity, BarPoses(4, scale), options, &recorder);
  };
  const Assessment both = assess(1);
  EXPECT_EQ(both.poses, 4);
  EXPECT_EQ(both.unconverged, 0);
  for (const char* stage : {"leaving out poses 0/4", "leaving out poses 3/4",
                            "drawing random shapes 0/2", "drawing random shapes 1/2"}) {
    EXPECT_EQ(std::count(recorder.stages.begin(), recorder.stages.end(), stage), 1) << stage;
  }
  const Assessment large = assess(1000);
  options.samples = 1;
  const Assessment first = assess(1);
  options.seed = 6;
  const Assessment second = assess(1);
  ASSERT_EQ(both.rows.size(), 2u);
  EXPECT_GT(both.rows[1].beyond, 0);
  const ShapeModel model(MakeShapeModel(SmallBar().connectivity, BarPoses(4), {}).modes);
  for (int k = 0; k < 2; ++k) {
    const ModelQuality &row = both.rows[k], &a = first.rows[k], &b = second.rows[k];
    EXPECT_EQ(row.modes, k + 1);
    EXPECT_NEAR(row.compactness, model.Modes().Share(k + 1), 1e-9);
    EXPECT_NEAR(row.specificity, (a.specificity + b.specificity) / 2, 1e-9);
    EXPECT_NEAR(row.beyond, (a.beyond + b.beyond) / 2, 1e-9);
    EXPECT_NE(a.specificity, b.specificity);
    EXPECT_NEAR(row.generalisation, a.generalisation, 1e-9);
    EXPECT_NEAR(large.rows[k].specificity, row.specificity, 1e-3 * row.specificity);
    EXPECT_NEAR(large.rows[k].generalisation, row.generalisation, 1e-3 * row.generalisation);
    EXPECT_NEAR(large.rows[k].generalisation_edges, row.generalisation_edges,
                1e-3 * row.generalisation_edges);
  }
}

// Every pose against the model of the others, and a random shape against the nearest pose.
TEST(AssessShapeModel, DistancesAreMeansAsSharesOfTheMeanDiagonal) {
  const std::vector<Shape> poses = BarPoses(4);
  AssessmentOptions options;
  options.samples = 1;
  options.seed = 9;
  const Assessment assessment = AssessShapeModel(SmallBar().connectivity, poses, options);
  double diagonal = 0;
  for (const Shape& pose : poses) diagonal += testing::Diameter(pose) / 4;
  const auto mean_distance = [](const Metric& metric, const Shape& shape, const Shape& truth) {
    const Shape moved = FitRigidMotion(shape, truth, metric.vertex_area)(shape);
    return (moved - truth).colwise().norm().dot(metric.vertex_area) / metric.vertex_area.sum();
  };
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    std::vector<Shape> others = poses;
    others.erase(others.begin() + i);
    const ShapeModel model(MakeShapeModel(SmallBar().connectivity, others, {}).modes);
    sum +=
        mean_distance(*model.Modes().metric, model.Coordinates(poses[i], false, 1).shape, poses[i]);
  }
  EXPECT_NEAR(assessment.rows[0].generalisation, sum / 4 / diagonal, 1e-6 * sum);
  const ShapeModel model(MakeShapeModel(SmallBar().connectivity, poses, {}).modes);
  const Shape sample = model.At(model.Sample(9).head(2)).shape;
  double nearest = 1e9;
  for (const Shape& pose : poses) {
    nearest = std::min(nearest, mean_distance(*model.Modes().metric, sample, pose));
  }
  EXPECT_NEAR(assessment.rows[1].specificity, nearest / diagonal, 1e-5 * nearest);
  options.samples = 0;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { options.Validate(); }, {"samples:", "1"}));
  options.samples = 1;
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [&] {
        AssessShapeModel(SmallBar().connectivity, {poses[0], poses[1]}, options);
      },
      {"three"}));
}

// Some edges of a random shape are longer than in every pose, others are shorter.
TEST(AssessShapeModel, EdgesBeyondThoseOfThePosesCountOnBothSides) {
  const std::vector<Shape> poses = BarPoses(4);
  AssessmentOptions options;
  options.samples = 1;
  const ShapeModel model(MakeShapeModel(SmallBar().connectivity, poses, {}).modes);
  const Metric& metric = *model.Modes().metric;
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  const auto length = [&](const Shape& shape, Eigen::Index e) {
    return (shape.col(edges(0, e)) - shape.col(edges(1, e))).norm();
  };
  int longer_alone = 0, shorter_alone = 0;
  for (options.seed = 1; options.seed <= 3; ++options.seed) {
    const Assessment assessment = AssessShapeModel(SmallBar().connectivity, poses, options);
    const Shape sample = model.At(model.Sample(options.seed).head(2)).shape;
    double longer = 0, shorter = 0;
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      double least = 1e300, most = 0;
      for (const Shape& pose : poses) {
        least = std::min(least, length(pose, e));
        most = std::max(most, length(pose, e));
      }
      const double here = length(sample, e), share = metric.edge_area(e) / metric.edge_area.sum();
      if (here > most) longer += share * std::pow(std::log(here / most), 2);
      if (here < least) shorter += share * std::pow(std::log(least / here), 2);
    }
    const double beyond = std::sqrt(longer + shorter);
    EXPECT_NEAR(assessment.rows[1].beyond, beyond, 1e-4 * beyond);
    longer_alone += longer > 0.01 * shorter;
    shorter_alone += shorter > 0.01 * longer;
  }
  EXPECT_GT(longer_alone, 0);
  EXPECT_GT(shorter_alone, 0);
}

TEST(PageOf, HasTheKeysOfAllModesAndPairsAndTheNumbersOfTheModel) {
  PoseModes modes = FirstModes(BarModes(), 3);
  modes.appearance.vertex_colours = Eigen::MatrixXd::Constant(3, modes.mean.cols(), 0.25);
  const ShapeModel model(modes);
  Regression regression;
  regression.scalars = {"age", "weight"};
  regression.least = Eigen::Vector2d(1, 2);
  regression.most = Eigen::Vector2d(11, 12);
  regression.mean = Eigen::Vector2d(5, 6);
  regression.intercept = Eigen::Vector3d(0.5, 1.5, 2.5);
  regression.slopes = Eigen::MatrixXd::Constant(3, 2, 0.75);
  const PageModes page = PageOf(model, "", &regression);
  EXPECT_EQ(page.connectivity, modes.metric->connectivity);
  EXPECT_EQ(page.places, (std::vector<double>{-3, -1.5, 1.5, 3}));
  EXPECT_EQ(page.pair_place, 1.5);
  ASSERT_EQ(page.keys.size(), 1u + 3 * 4 + 3);
  EXPECT_LT(Distance(page.keys[0], modes.place(modes.metric->unit * modes.mean)), 1e-12);
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 4; ++j) {
      Eigen::Vector3d at = Eigen::Vector3d::Zero();
      at(k) = page.places[j];
      EXPECT_LT(Distance(page.keys[1 + 4 * k + j], model.At(at).shape), 1e-9);
    }
    EXPECT_NEAR(page.shares[k], modes.variances(k) / modes.total_variance, 1e-14);
  }
  const int pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (int p = 0; p < 3; ++p) {
    const auto at = [&](double a, double b) {
      Eigen::Vector3d coordinates = Eigen::Vector3d::Zero();
      coordinates(pairs[p][0]) = a;
      coordinates(pairs[p][1]) = b;
      return model.Preview(coordinates);
    };
    const Shape mixed = (at(1.5, 1.5) - at(1.5, -1.5) - at(-1.5, 1.5) + at(-1.5, -1.5)) / 4;
    EXPECT_LT(Distance(page.keys[13 + p] - page.keys[0], mixed), 1e-9) << p;
  }
  EXPECT_EQ(page.names, modes.names);
  EXPECT_TRUE(page.coordinates.isApprox(modes.Coordinates(), 1e-14));
  EXPECT_EQ(page.up, UpOf(modes));
  EXPECT_EQ(page.vertex_colours, modes.appearance.vertex_colours);
  EXPECT_EQ(page.name, "modes");
  EXPECT_EQ(page.file, "MODES_FILE");
  ASSERT_EQ(page.scalars.size(), 2u);
  EXPECT_EQ(page.scalars[1].name, "weight");
  EXPECT_EQ(page.scalars[1].least, 2);
  EXPECT_EQ(page.scalars[1].most, 12);
  EXPECT_EQ(page.scalars[1].value, 6);
  EXPECT_EQ(page.intercept, regression.intercept);
  EXPECT_EQ(page.slopes, regression.slopes);
  EXPECT_EQ(PageOf(model, "in/some.modes").name, "some.modes");
  EXPECT_TRUE(PageOf(model, "in/some.modes").scalars.empty());
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [&] { PageOf(ShapeModel(FirstModes(modes, 0)), "some.modes"); }, {"modes:"}));
}

// Of one mode the page interpolates its keys, of which the mean is one.
TEST(PageOf, TheErrorIsTheMeanOverRandomShapes) {
  const ShapeModel model(FirstModes(BarModes(), 1));
  const PageModes page = PageOf(model, "some.modes");
  const Metric& metric = *model.Modes().metric;
  const double places[] = {0, -3, -1.5, 1.5, 3};
  double sum = 0;
  for (unsigned seed : {1u, 2u, 3u, 4u}) {
    const double at = std::clamp(model.Sample(seed)(0), -2., 2.);
    Shape shown = Shape::Zero(3, page.keys[0].cols());
    for (int j = 0; j < 5; ++j) {
      double weight = 1;
      for (int i = 0; i < 5; ++i) {
        if (i != j) weight *= (at - places[i]) / (places[j] - places[i]);
      }
      shown += weight * page.keys[j];
    }
    const Shape exact = model.At(Eigen::VectorXd::Constant(1, at)).shape;
    const Shape moved = FitRigidMotion(shown, exact, metric.vertex_area)(shown);
    sum += (moved - exact).colwise().norm().dot(metric.vertex_area) / metric.vertex_area.sum();
  }
  EXPECT_GT(page.error, 0);
  EXPECT_NEAR(page.error, sum / 4 / testing::Diameter(page.keys[0]), 1e-6 * page.error + 1e-12);
}

TEST(DistanceFromMean, IsOfEveryVertexAsAShareOfTheDiagonal) {
  const PoseModes& modes = BarModes();
  const Eigen::VectorXd distance = DistanceFromMean(modes, modes.PlacedPose(3));
  const Eigen::VectorXd expected =
      (modes.poses[3] - modes.mean).colwise().norm().transpose() / testing::Diameter(modes.mean);
  EXPECT_TRUE(distance.isApprox(expected, 1e-6));
}

TEST(RenderModes, BarsAreTheSharesOfTheVariance) {
  const PoseModes modes = FirstModes(BarModes(), 3);
  FilmStripOptions options;
  options.frame_width = 80;
  options.samples = 1;
  const RgbImage image = RenderModes(ShapeModel(modes), 2, options);
  const int size = internal::TextSize(80), line = internal::LineHeight(size), margin = size / 2;
  const int foot = image.height - line - 2 * margin;
  const int pitch = std::min(4 * size, (image.width - 2 * margin) / 3);
  const auto is_drawn = [&](int x, int y) {
    const unsigned char* pixel = &image.pixels[3 * (static_cast<size_t>(y) * image.width + x)];
    return pixel[0] == 0x40 && pixel[1] == 0x44 && pixel[2] == 0x48;
  };
  for (int k = 0; k < 3; ++k) {
    // Along the middle of a bar, upwards until the paper begins.
    const int x = margin + k * pitch + std::max(1, pitch / 2) - 1;
    int length = 0;
    while (is_drawn(x, foot - 1 - length)) ++length;
    const double share = modes.variances(k) / modes.total_variance;
    EXPECT_EQ(length, std::max<long>(1, std::lround(share * (6 * size - line)))) << k;
    EXPECT_FALSE(is_drawn(x, foot)) << k;
    EXPECT_FALSE(is_drawn(x + 1, foot - 1)) << k;
    EXPECT_TRUE(is_drawn(margin + k * pitch, foot - 1)) << k;
    EXPECT_FALSE(is_drawn(margin + k * pitch - 1, foot - 1)) << k;
  }
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { RenderModes(ShapeModel(modes), 4, options); },
                                      {"modes:", "1", "3"}));
}

}  // namespace
}  // namespace shapespace
