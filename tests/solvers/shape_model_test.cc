#include <shapespace/statistics/shape_model.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/statistics/assess.h>
#include <shapespace/statistics/modes_page.h>
#include <shapespace/statistics/modes_picture.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/own_features.h"

namespace shapespace {
namespace {

using testing::Diameter;
using testing::Refuses;
using testing::Rotation;

std::vector<Shape> At(const ShapeFamily& body, const std::vector<double>& values) {
  std::vector<Shape> poses;
  for (double value : values) poses.push_back(body.pose(value));
  return poses;
}

// The mean distance after rigid alignment, as a share of the diameter.
double Distant(const Shape& shape, const Shape& truth) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(truth.cols());
  return (FitRigidMotion(shape, truth, ones)(shape) - truth).colwise().norm().mean() /
         Diameter(truth);
}

Eigen::VectorXd LogLengths(const Connectivity& connectivity, const Shape& shape) {
  Eigen::VectorXd lengths(connectivity.NumEdges());
  for (int e = 0; e < lengths.size(); ++e) {
    const auto edge = connectivity.Edges().col(e);
    lengths(e) = std::log((shape.col(edge(1)) - shape.col(edge(0))).norm());
  }
  return lengths;
}

// The rms by which log edge lengths leave the range that they have in the poses.
double Beyond(const Connectivity& connectivity, const std::vector<Shape>& poses,
              const Shape& shape) {
  const Eigen::VectorXd lengths = LogLengths(connectivity, shape);
  Eigen::VectorXd least = LogLengths(connectivity, poses[0]), most = least;
  for (const Shape& pose : poses) {
    least = least.cwiseMin(LogLengths(connectivity, pose));
    most = most.cwiseMax(LogLengths(connectivity, pose));
  }
  const Eigen::VectorXd out = (lengths - most).cwiseMax(0) + (least - lengths).cwiseMax(0);
  return std::sqrt(out.squaredNorm() / static_cast<double>(out.size()));
}

// The straight tube bent to an arc, to either side.
Shape Bent(const Shape& tube, double degrees) {
  const Shape straight =
      tube.colwise() - (tube.rowwise().maxCoeff() + tube.rowwise().minCoeff()) / 2;
  int axis;
  (straight.rowwise().maxCoeff() - straight.rowwise().minCoeff()).maxCoeff(&axis);
  const double length = straight.row(axis).maxCoeff() - straight.row(axis).minCoeff();
  const double radius = length / (degrees * M_PI / 180);
  Shape bent(3, straight.cols());
  for (Eigen::Index v = 0; v < straight.cols(); ++v) {
    const double turn = straight(axis, v) / radius;
    const double out = radius - straight((axis + 1) % 3, v);
    bent.col(v) << out * std::sin(turn), radius - out * std::cos(turn), straight((axis + 2) % 3, v);
  }
  return bent;
}

std::vector<Shape> BentTubes(const ShapeFamily& tube, const std::vector<double>& angles) {
  std::vector<Shape> poses;
  for (double angle : angles) poses.push_back(Bent(tube.pose(0), angle));
  return poses;
}

PoseModes Modes(const ShapeFamily& body, const std::vector<Shape>& poses, int modes = 0) {
  ShapeModelOptions options;
  options.modes = modes;
  return MakeShapeModel(body.connectivity, poses, {}, options).modes;
}

const SkinnedBody& Animal() {
  static const SkinnedBody animal = MakeQuadruped(800);
  return animal;
}

std::vector<Shape> AnimalPoses(int count) {
  std::vector<Shape> poses;
  for (int seed = 1; seed <= count; ++seed) poses.push_back(Animal().random_pose(seed));
  return poses;
}

const ShapeModel& AnimalModel() {
  static const ShapeModel model(MakeShapeModel(Animal().connectivity, AnimalPoses(6), {}).modes);
  return model;
}

TEST(ShapeModel, OfARolledSheetHasOneMode) {
  const ShapeFamily sheet = MakeSheet(2, 1, 16, 8);
  ShapeModelOptions options;
  options.average.geodesic.metric.lambda = 1e-9;  // straight lines would be best for positions
  const auto [modes, summary] =
      MakeShapeModel(sheet.connectivity, At(sheet, {0, 30, 70, 120, 130}), {}, options);
  EXPECT_GT(modes.Share(1), 0.9999);
  const ShapeModel model(FirstModes(modes, 1));
  EXPECT_LT(Distant(model.At(Eigen::VectorXd::Zero(1)).shape, sheet.pose(70)), 1e-4);
  // Beyond the poses too: angles are linear in the coordinate.
  const double per_degree =
      (model.Modes().Coordinates()(3, 0) - model.Modes().Coordinates()(1, 0)) / 90;
  const ModelShape beyond = model.At(Eigen::VectorXd::Constant(1, 110 * per_degree));
  EXPECT_TRUE(beyond.Converged());
  EXPECT_LT(Distant(beyond.shape, sheet.pose(180)), 1e-3);
}

TEST(ShapeModel, OfATubeThatIsBentBothWaysIsStraightInTheMean) {
  const ShapeFamily tube = MakeTube(800);
  const PoseModes modes = Modes(tube, BentTubes(tube, {-120, -80, -40, 40, 80, 120}));
  EXPECT_LT(Distant(modes.metric->unit * modes.mean, tube.pose(0)), 1e-3);
  EXPECT_GT(modes.Share(1), 0.999);
}

TEST(ShapeModel, CoordinatesOfThePosesAreStandardisedAndUncorrelated) {
  const PoseModes& modes = AnimalModel().Modes();
  EXPECT_EQ(modes.NumModes(), 5);
  const Eigen::MatrixXd coordinates = modes.Coordinates();
  EXPECT_LT((modes.weights.transpose() * coordinates).norm(), 1e-6);
  const Eigen::MatrixXd covariance =
      coordinates.transpose() * modes.weights.asDiagonal() * coordinates;
  EXPECT_LT((covariance - Eigen::MatrixXd::Identity(5, 5)).norm(), 1e-9);
  for (int k = 0; k < 5; ++k) {
    const double squared = modes.modes[k].colwise().squaredNorm().dot(modes.metric->vertex_area);
    EXPECT_NEAR(squared, modes.variances(k), 1e-6 * modes.variances(0));
    if (k > 0) {
      EXPECT_LT(modes.variances(k), modes.variances(k - 1));
    }
  }
}

// Whatever the metric adds up: modes are displacements to first order.
TEST(ShapeModel, ModesAreTheDerivativeOfTheShapeAtCoordinates) {
  testing::RegisterOwnFeatures();
  const SkinnedBody body = MakeQuadruped(400);
  std::vector<Shape> poses;
  for (int seed = 1; seed <= 3; ++seed) {
    poses.push_back((1 + 0.05 * seed) * body.random_pose(seed));
  }
  // Near to each other, so that there is a shape with the mean features.
  for (Shape& pose : poses) {
    pose = FitRigidMotion(pose, poses[0], Eigen::VectorXd::Ones(pose.cols()))(pose);
    pose = poses[0] + 0.02 * (pose - poses[0]);
  }
  poses[0] = 0.999 * poses[0];
  std::vector<MetricOptions> metrics(6);
  metrics[1].volume = 1;
  metrics[2].volume = 100;
  metrics[3].features = {{"spread", 2}};
  metrics[4].volume = 3;
  metrics[4].features = {{"spread", 5}, {"own volume", 1}};
  metrics[5] = MetricOptions::Isometric();
  metrics[5].volume = 10;
  for (const MetricOptions& metric : metrics) {
    SCOPED_TRACE(DescribeMetric(metric));
    ShapeModelOptions options;
    options.average.geodesic.metric = metric;
    const PoseModes modes = MakeShapeModel(body.connectivity, poses, {}, options).modes;
    const ShapeModel model(modes);
    ASSERT_EQ(modes.NumModes(), 2);
    for (int k = 0; k < 2; ++k) {
      constexpr double kStep = 0.25;
      const Eigen::VectorXd ahead = kStep * Eigen::VectorXd::Unit(2, k);
      const Tangent difference =
          (model.At(ahead).shape - model.At(-ahead).shape) / (2 * kStep * modes.metric->unit);
      EXPECT_LT((difference - modes.modes[k]).norm(), 0.02 * modes.modes[k].norm()) << k;
    }
  }
}

// A cost of volume makes no shape harder to find.
TEST(ShapeModel, ShapesAreFoundInAsManyIterationsWithASumAsWithout) {
  std::vector<int> iterations;
  for (const double volume : {0.0, 10.0}) {
    ShapeModelOptions options;
    options.average.geodesic.metric.volume = volume;
    const ShapeModel model(
        MakeShapeModel(Animal().connectivity, AnimalPoses(4), {}, options).modes);
    const ModelShape found = model.At(Eigen::Vector3d(1, -1, 0.5));
    EXPECT_TRUE(found.Converged()) << volume;
    iterations.push_back(found.iterations);
  }
  EXPECT_LE(iterations[1], 2 * iterations[0] + 2);
}

TEST(ShapeModel, AllModesReproduceThePoses) {
  const std::vector<Shape> poses = AnimalPoses(6);
  const ShapeModel& model = AnimalModel();
  for (int i = 0; i < 6; ++i) {
    const ModelCoordinates found = model.Coordinates(poses[i]);
    EXPECT_LT((found.coordinates - model.Modes().Coordinates().row(i).transpose()).norm(), 1e-5);
    EXPECT_LT(found.distance, 1e-4 * Diameter(poses[i]));
    EXPECT_LT((found.shape - poses[i]).colwise().norm().maxCoeff(), 1e-3 * Diameter(poses[i]));
    EXPECT_LT((model.Modes().PlacedPose(i) - poses[i]).norm(), 1e-9 * poses[i].norm());
  }
}

TEST(ShapeModel, RandomShapesKeepTheirEdges) {
  const ShapeModel& model = AnimalModel();
  double kept = 0, blended = 0;
  for (unsigned seed : {11u, 12u, 13u}) {
    const Eigen::VectorXd coordinates = model.Sample(seed);
    EXPECT_EQ(coordinates, model.Sample(seed));
    const ModelShape found = model.At(coordinates);
    EXPECT_TRUE(found.Converged());
    EXPECT_LT(Distant(model.Preview(coordinates), found.shape), 0.02);
    // The blend of the poses with the same coefficients.
    Shape blend = model.Modes().mean;
    for (int k = 0; k < coordinates.size(); ++k) blend += coordinates(k) * model.Modes().modes[k];
    const std::vector<Shape> poses = AnimalPoses(6);
    kept = std::max(kept, Beyond(*Animal().connectivity, poses, found.shape));
    blended = std::max(blended,
                       Beyond(*Animal().connectivity, poses, model.Modes().metric->unit * blend));
  }
  EXPECT_LT(kept, 0.03);
  EXPECT_LT(3 * kept, blended);
}

TEST(ShapeModel, PreviewIsTheMeanAtZeroAndFollowsTheModes) {
  const ShapeModel& model = AnimalModel();
  const Shape mean = model.At(Eigen::VectorXd()).shape;
  EXPECT_LT(Distant(model.Preview(Eigen::VectorXd::Zero(2)), mean), 1e-9);
  // To first order it is the displacement of the mode.
  const double step = 1e-3;
  const Shape ahead = model.Preview(Eigen::VectorXd::Constant(1, step));
  const Shape behind = model.Preview(Eigen::VectorXd::Constant(1, -step));
  const Tangent slope = (ahead - behind) / (2 * step) / model.Modes().metric->unit;
  const Tangent& mode = model.Modes().modes[0];
  EXPECT_LT((slope - mode).norm(), 0.05 * mode.norm());
}

// With all modes the triangles of a pose are turned and stretched as they are in it.
TEST(ShapeModel, PreviewReproducesThePoses) {
  const ShapeModel& model = AnimalModel();
  const Eigen::MatrixXd coordinates = model.Modes().Coordinates();
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(Distant(model.Preview(coordinates.row(i).transpose()), model.Modes().PlacedPose(i)),
              0.012)
        << i;
  }
}

// Where there are no triangles, sides are those of the mean moved along the modes.
TEST(ShapeModel, PreviewOfAGraphIsLinear) {
  std::vector<std::pair<int, int>> segments;
  for (int v = 1; v < 8; ++v) segments.emplace_back(v - 1, v);
  const auto chain = Connectivity::Make(8, {0}, {}, segments);
  std::vector<Shape> poses(4, Shape::Zero(3, 8));
  for (int i = 0; i < 4; ++i) {
    for (int v = 0; v < 8; ++v) poses[i].col(v) << v, 0.05 * i * v * v, 0.3 * (i % 2) * (v % 3);
  }
  const PoseModes modes = MakeShapeModel(chain, poses, {}).modes;
  ASSERT_GE(modes.NumModes(), 2);
  const Shape expected =
      modes.place(modes.metric->unit * (modes.mean + 0.7 * modes.modes[0] - 0.4 * modes.modes[1]));
  const Shape preview = ShapeModel(modes).Preview(Eigen::Vector2d(0.7, -0.4));
  EXPECT_LT((preview - expected).norm(), 1e-4 * expected.norm());
}

TEST(ShapeModel, FitLowersTheDistanceOfAnUnknownPose) {
  const ShapeModel& model = AnimalModel();
  const Shape unknown = Animal().random_pose(40);
  const ModelCoordinates plain = model.Coordinates(unknown);
  const ModelCoordinates fitted = model.Coordinates(unknown, true);
  EXPECT_GT(fitted.rounds, 0);
  EXPECT_LT(fitted.distance, plain.distance);
  EXPECT_EQ(model.Coordinates(unknown, false, 2).coordinates.size(), 2);
}

TEST(ShapeModel, DoesNotDependOnPlaceOrderOrUnit) {
  const std::vector<Shape> poses = AnimalPoses(4);
  std::vector<Shape> moved;
  for (int i : {3, 1, 0, 2}) {
    moved.push_back((1000 * Rotation(40 * i + 10, {3, 1, 2}) * poses[i]).colwise() +
                    Eigen::Vector3d(1e6, 0, -1e6));
  }
  const PoseModes one = MakeShapeModel(Animal().connectivity, poses, {}).modes;
  const PoseModes other = MakeShapeModel(Animal().connectivity, moved, {}).modes;
  EXPECT_LT((one.variances - other.variances).norm(), 1e-4 * one.variances(0));
  const ModelCoordinates a = ShapeModel(one).Coordinates(poses[0]);
  const ModelCoordinates b = ShapeModel(other).Coordinates(moved[2]);
  EXPECT_LT((a.coordinates.cwiseAbs() - b.coordinates.cwiseAbs()).norm(), 1e-2);
}

TEST(ShapeModel, WithoutSizeLargePosesAreTheSameShape) {
  const std::vector<Shape> poses = AnimalPoses(3);
  ShapeModelOptions options;
  options.size = PoseSize::kRemove;
  const ShapeModelResult made = MakeShapeModel(
      Animal().connectivity, {poses[0], 1.7 * poses[1], poses[2], 0.6 * poses[2]}, {}, options);
  EXPECT_EQ(made.summary.rank, 2);
  const ShapeModel model(made.modes);
  EXPECT_LT((model.Coordinates(poses[1]).coordinates - model.Coordinates(3 * poses[1]).coordinates)
                .norm(),
            1e-6);
  EXPECT_LT(model.Coordinates(3 * poses[1]).distance, 1e-3 * Diameter(poses[1]));
}

TEST(ShapeModel, ADistanceIsInTheUnitOfTheShape) {
  std::vector<Shape> poses = AnimalPoses(4);
  for (Shape& pose : poses) pose *= 1000;
  const Shape other = 1.5 * poses.back();
  poses.pop_back();
  for (const PoseSize size : {PoseSize::kKeep, PoseSize::kRemove}) {
    ShapeModelOptions options;
    options.size = size;
    const ShapeModel model(MakeShapeModel(Animal().connectivity, poses, {}, options).modes);
    const ModelCoordinates found = model.Coordinates(other);
    const Eigen::VectorXd squared = (found.shape - other).colwise().squaredNorm().transpose();
    const double distance = std::sqrt(squared.dot(model.Modes().metric->vertex_area));
    EXPECT_NEAR(found.distance, distance, 1e-6 * distance);
  }
}

TEST(ShapeModel, OfCopiesOfOneShapeHasNoModes) {
  const Shape pose = Animal().pose("sit");
  for (const int copies : {1, 3}) {
    std::vector<Shape> poses;
    for (int i = 0; i < copies; ++i) poses.push_back(Rotation(70 * i, {1, 1, 0}) * pose);
    const auto [modes, summary] = MakeShapeModel(Animal().connectivity, poses, {});
    EXPECT_EQ(modes.NumModes(), 0);
    ASSERT_EQ(summary.warnings.size(), 1u);
    EXPECT_NE(summary.warnings[0].find("no modes"), std::string::npos);
    EXPECT_LT(Distant(ShapeModel(modes).At(Eigen::VectorXd()).shape, pose), 1e-6);
  }
}

std::string Warnings(const std::shared_ptr<const Connectivity>& connectivity,
                     const std::vector<Shape>& poses, const ShapeModelOptions& options = {}) {
  std::string all;
  for (const std::string& each :
       MakeShapeModel(connectivity, poses, {}, options).summary.warnings) {
    all += each + '\n';
  }
  return all;
}

TEST(ShapeModel, WarnsWhereModesSayLittle) {
  const std::vector<Shape> poses = AnimalPoses(3);
  EXPECT_EQ(Warnings(Animal().connectivity, poses), "");
  ShapeModelOptions isometric;
  isometric.average.geodesic.metric = MetricOptions::Isometric();
  EXPECT_NE(Warnings(Animal().connectivity, poses, isometric).find("isometric metric"),
            std::string::npos);
  // Crumpled in different ways.
  std::mt19937_64 random(1);
  std::vector<Shape> crumpled = poses;
  for (Shape& pose : crumpled) {
    const double size = 0.06 * Diameter(pose);
    for (double& x : pose.reshaped())
      x += size * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
  }
  EXPECT_NE(Warnings(Animal().connectivity, crumpled).find("so different"), std::string::npos);
  const AverageSummary summary = Average(Animal().connectivity, crumpled).summary;
  EXPECT_GT(summary.Ratio(), 1.1);
  ASSERT_FALSE(summary.warnings.empty());
  EXPECT_NE(summary.warnings[0].find("so different"), std::string::npos);
}

TEST(ShapeModel, RefusesWhatItCannotDo) {
  const std::vector<Shape> poses = AnimalPoses(3);
  ShapeModelOptions options;
  options.modes = 3;
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [&] { MakeShapeModel(Animal().connectivity, poses, {}, options); }, {"modes:", "2"}));
  options.modes = -1;
  EXPECT_THROW(options.Validate(), InvalidOptions);
  EXPECT_THROW(MakeShapeModel(Animal().connectivity, poses, {"one"}), InvalidOptions);
  EXPECT_THROW(MakeShapeModel(Animal().connectivity, {}, {}), MeshError);
  const ShapeModel& model = AnimalModel();
  EXPECT_THROW(model.At(Eigen::VectorXd::Zero(6)), InvalidOptions);
  EXPECT_THROW(model.Preview(Eigen::VectorXd::Constant(1, std::nan(""))), InvalidOptions);
  EXPECT_THROW(model.Coordinates(Shape::Zero(3, 4)), MeshError);
  EXPECT_THROW(model.Coordinates(poses[0], false, 6), InvalidOptions);
  EXPECT_THROW(FirstModes(model.Modes(), 9), InvalidOptions);
  EXPECT_THROW(RenderModes(model, 0), InvalidOptions);
  PoseModes far = model.Modes();
  far.motions[0].translation.setConstant(1e308);
  far.poses[0].setConstant(1e308);
  EXPECT_THROW(far.Validate(), MeshError);
}

TEST(AssessShapeModel, MoreModesDescribeMore) {
  const ShapeFamily tube = MakeTube(200);
  AssessmentOptions options;
  options.samples = 4;
  const Assessment assessment =
      AssessShapeModel(tube.connectivity, BentTubes(tube, {-90, -50, 10, 40, 100}), options);
  ASSERT_EQ(assessment.rows.size(), 3u);
  EXPECT_EQ(assessment.unconverged, 0);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(assessment.rows[k].modes, static_cast<int>(k) + 1);
    EXPECT_LE(assessment.rows[k].compactness, 1 + 1e-9);
    // A tube that bends has one mode.
    EXPECT_LT(assessment.rows[k].generalisation, 0.01);
    EXPECT_LT(assessment.rows[k].beyond, 0.015);
    EXPECT_GT(assessment.rows[k].specificity, 0);
  }
  EXPECT_GT(assessment.rows[1].compactness, assessment.rows[0].compactness);
  EXPECT_THROW(AssessShapeModel(tube.connectivity, BentTubes(tube, {10, 90})), InvalidOptions);
}

TEST(AssessShapeModel, SizesThatAreRemovedAndPosesOfNoWeightDoNotMatter) {
  const SkinnedBody body = MakeQuadruped(400);
  std::vector<Shape> poses, others;
  for (int seed = 1; seed <= 4; ++seed) {
    poses.push_back(body.random_pose(seed));
    others.push_back((0.4 + 0.6 * seed) * poses.back());
  }
  AssessmentOptions options;
  options.samples = 2;
  options.model.size = PoseSize::kRemove;
  const Assessment one = AssessShapeModel(body.connectivity, poses, options);
  others.insert(others.begin() + 2, 9 * body.random_pose(7));
  options.model.average.weights = {1, 1, 0, 1, 1};
  const Assessment other = AssessShapeModel(body.connectivity, others, options);
  EXPECT_EQ(other.poses, 4);
  ASSERT_EQ(other.rows.size(), one.rows.size());
  for (size_t k = 0; k < one.rows.size(); ++k) {
    const ModelQuality &a = one.rows[k], &b = other.rows[k];
    EXPECT_NEAR(a.compactness, b.compactness, 1e-5);
    EXPECT_NEAR(a.generalisation / b.generalisation, 1, 1e-4);
    EXPECT_NEAR(a.generalisation_edges / b.generalisation_edges, 1, 1e-4);
    EXPECT_NEAR(a.specificity / b.specificity, 1, 1e-4);
  }
  options.model.average.weights = {1, 1, 0, 0, 0};
  EXPECT_THROW(AssessShapeModel(body.connectivity, others, options), InvalidOptions);
}

TEST(AssessShapeModel, WeightsBelongToTheirPosesInAnyOrder) {
  const SkinnedBody body = MakeQuadruped(500);
  std::vector<Shape> poses;
  for (int seed = 1; seed <= 4; ++seed) poses.push_back(body.random_pose(seed));
  AssessmentOptions options;
  options.samples = 1;
  options.model.average.weights = {0, 1, 1, 1};  // the first is no pose of any model
  const Assessment one = AssessShapeModel(body.connectivity, poses, options);
  std::reverse(poses.begin(), poses.end());
  options.model.average.weights = {1, 1, 1, 0};
  const Assessment other = AssessShapeModel(body.connectivity, poses, options);
  ASSERT_EQ(one.rows.size(), other.rows.size());
  for (size_t k = 0; k < one.rows.size(); ++k) {
    EXPECT_NEAR(one.rows[k].compactness, other.rows[k].compactness, 1e-3);
    EXPECT_NEAR(one.rows[k].generalisation / other.rows[k].generalisation, 1, 1e-2);
  }
}

TEST(PageOf, ShowsTheKeysWhereTheyAreExact) {
  const ShapeModel model(FirstModes(AnimalModel().Modes(), 2));
  const PageModes page = PageOf(model, "some/herd.modes");
  EXPECT_EQ(page.keys.size(), 1 + 2 * page.places.size() + 1);
  EXPECT_EQ(page.name, "herd.modes");
  EXPECT_EQ(page.file, "some/herd.modes");
  EXPECT_LT(page.error, 0.02);
  const Eigen::Vector2d at(0, page.places[0]);
  EXPECT_LT((page.keys[1 + page.places.size()] - model.At(at).shape).norm(),
            1e-9 * page.keys[0].norm());
}

TEST(RenderModes, HasARowForEachMode) {
  FilmStripOptions options;
  options.frame_width = 60;
  options.samples = 1;
  const RgbImage one = RenderModes(AnimalModel(), 1, options);
  const RgbImage three = RenderModes(AnimalModel(), 3, options);
  EXPECT_EQ(one.width, three.width);
  EXPECT_GT(three.height, one.height + 60);
  EXPECT_EQ(three.pixels.size(), 3u * three.width * three.height);
}

}  // namespace
}  // namespace shapespace
