// Bodies that are cut as files store them move as the whole body does, without a gap.

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/handle_file.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/statistics/shape_model.h>
#include <shapespace/transfer/transfer.h>

#include "support/cut_body.h"
#include "support/motions.h"
#include "support/temporary_file.h"

namespace shapespace {
namespace {

using testing::CutBody;
using testing::Where;

double MostApart(const Shape& a, const Shape& b) { return (a - b).cwiseAbs().maxCoeff(); }

// A bar along x, bent or twisted, that is cut in the middle, where handles are to move nothing
// apart, or into all of its triangles.
class CutBar : public ::testing::TestWithParam<bool> {
 protected:
  std::vector<Shape> Cut(const std::vector<Shape>& shapes) const {
    std::vector<Shape> result;
    for (const Shape& shape : shapes) result.push_back(cut_.Of(shape));
    return result;
  }
  Shape Kept(const Shape& shape) const { return shape.leftCols(whole_->NumVertices()); }
  void ExpectSame(const Shape& cut, const Shape& whole, double tolerance) const {
    EXPECT_TRUE(cut_.HasNoGap(cut));
    EXPECT_LT(MostApart(Kept(cut), whole), tolerance);
  }
  void ExpectSame(const Path& cut, const Path& whole, double tolerance) const {
    ASSERT_EQ(cut.NumShapes(), whole.NumShapes());
    for (int i = 0; i < cut.NumShapes(); ++i) {
      ExpectSame(cut.Placed(i), whole.Placed(i), tolerance);
    }
  }

  const ShapeFamily bar_ = MakeBar(6, 1, 1, 9, 2, 2);
  const std::shared_ptr<const Connectivity> whole_ = bar_.connectivity;
  const std::vector<Shape> poses_ = {bar_.pose(0), bar_.pose(80), Twisted(bar_.pose(20))};
  const CutBody cut_ = GetParam() ? testing::CutIntoPolygons(*whole_) : CutInTheMiddle();
  const std::shared_ptr<const Connectivity> joined_ = testing::Joined(cut_, *whole_);

 private:
  static Shape Twisted(Shape shape) {
    for (auto p : shape.colwise()) {
      p = Eigen::AngleAxisd(0.2 * p.x(), Eigen::Vector3d::UnitX()) * Eigen::Vector3d(p);
    }
    return shape;
  }
  CutBody CutInTheMiddle() const {
    std::vector<int> island;
    for (const auto& triangle : whole_->Triangles().colwise()) {
      double sum = 0;
      for (const int v : triangle) sum += poses_[0](0, v);
      island.push_back(sum > 0);
    }
    return testing::CutIntoIslands(*whole_, island);
  }
};

TEST_P(CutBar, IsDeformedByHandlesAsAWhole) {
  DeformationHandle left, right;
  left.vertices = Where(poses_[0], [](const auto& p) { return p.x() < -2.7; });
  right.vertices = Where(poses_[0], [](const auto& p) { return p.x() > 2.7; });
  right.motion.axis = {0, 1, 0};
  right.motion.angle = 1;
  right.motion.translation = {-0.5, 0, 0.5};
  std::vector<DeformationHandle> of_cut = {left, right};
  for (DeformationHandle& handle : of_cut) {
    for (int& v : handle.vertices) v = cut_.LastCopy(v);
  }
  // All copies of a vertex too, in any order.
  for (size_t v = 0; v < cut_.source.size(); ++v) {
    if (cut_.LastCopy(cut_.source[v]) != static_cast<int>(v) &&
        poses_[0](0, cut_.source[v]) < -2.7) {
      of_cut[0].vertices.push_back(static_cast<int>(v));
    }
  }
  for (const auto solver :
       {DeformationOptions::Solver::kThreadedLbfgs, DeformationOptions::Solver::kTrustRegion}) {
    DeformationOptions options;
    options.solver = solver;
    options.shapes = 2;
    options.tolerance = 1e-10;
    options.max_iterations = 5000;
    const DeformationResult whole = Deform(whole_, poses_[0], {left, right}, options);
    const DeformationResult cut = Deform(joined_, cut_.Of(poses_[0]), of_cut, options);
    ExpectSame(cut.path, whole.path, 2e-4);
    EXPECT_EQ(cut.summary.free_components, 0);
    EXPECT_LT(cut.summary.handles[1].residual_max, 1e-9);
  }
}

// Handles of files turn about the centroid of their points, and not of the copies of these.
TEST_P(CutBar, HandlesOfFilesAreThoseOfTheWhole) {
  const std::string file = testing::TemporaryFile("handles.json");
  std::ofstream(file) << R"({"handles": [
      {"select": {"halfspace": {"point": [0, 0, 0], "normal": [1, 0.2, 0.1]}},
       "rotation": {"axis": [0, 1, 0], "degrees": 30}},
      {"select": {"ball": {"centre": [-3, -0.5, -0.5], "radius": 0.01}}, "position": [-3, 0, 0]}]})";
  const auto whole = ReadHandles(file, poses_[0], *whole_, {});
  const auto cut = ReadHandles(file, cut_.Of(poses_[0]), *joined_, {});
  EXPECT_LT((cut[0].motion.point - whole[0].motion.point).norm(), 1e-12);
  ASSERT_TRUE(cut[1].positions);
  EXPECT_EQ(cut[1].positions->col(0), whole[1].positions->col(0));
  EXPECT_EQ(cut[1].positions->cols(), static_cast<int>(cut[1].vertices.size()));
}

// Feet that stand, likewise.
TEST_P(CutBar, PartsStandAsThoseOfTheWhole) {
  GeodesicOptions options;
  options.shapes = 1;
  options.tolerance = 1e-9;
  const std::vector<Shape> pair = {poses_[0], poses_[1]};
  Path whole = Interpolate(whole_, pair, options).path;
  Path cut = Interpolate(joined_, Cut(pair), options).path;
  StandingPart part;
  part.vertices = Where(poses_[0], [](const auto& p) { return p.x() < -2.7; });
  part.poses = {{0, 1}};
  StandingPart of_cut = part;
  for (int& v : of_cut.vertices) v = cut_.LastCopy(v);
  DeformationOptions tight = StandingDefaults();
  tight.tolerance = 1e-9;
  HoldStandingParts(Path(whole), {part}, tight, &whole);
  HoldStandingParts(Path(cut), {of_cut}, tight, &cut);
  ExpectSame(cut, whole, 2e-3);
}

TEST_P(CutBar, WhatIsHeldByItsCopiesHangsByThem) {
  DeformationHandle twins;
  twins.vertices = {cut_.LastCopy(0)};
  twins.positions = Shape(poses_[0].col(0) + Eigen::Vector3d(0, 0, 2));
  const DeformationResult result = Deform(joined_, cut_.Of(poses_[0]), {twins});
  const Shape last = result.path.Placed(result.path.NumShapes() - 1);
  EXPECT_TRUE(cut_.HasNoGap(last));
  EXPECT_LT((last.col(0) - twins.positions->col(0)).norm(), 1e-9);
}

TEST_P(CutBar, IsInterpolatedAsAWholeByEverySolverAndMetric) {
  struct Case {
    GeodesicSolver solver;
    MetricOptions metric;
  };
  MetricOptions without_position;
  without_position.lambda = 0;
  for (const Case& one : {Case{GeodesicSolver::kLbfgs, {}},
                          {GeodesicSolver::kThreadedLbfgs, {}},
                          {GeodesicSolver::kTrustRegion, {}},
                          {GeodesicSolver::kLbfgs, without_position},
                          {GeodesicSolver::kThreadedLbfgs, without_position},
                          {GeodesicSolver::kLbfgs, MetricOptions::Isometric()},
                          {GeodesicSolver::kLbfgs, MetricOptions::Paper()},
                          {GeodesicSolver::kLbfgs, MetricOptions::Rigid()}}) {
    GeodesicOptions options;
    options.solver = one.solver;
    options.metric = one.metric;
    options.shapes = 3;
    options.tolerance = 1e-9;
    options.max_iterations = 3000;
    const GeodesicResult whole = Interpolate(whole_, poses_, options);
    const GeodesicResult cut = Interpolate(joined_, Cut(poses_), options);
    ExpectSame(cut.path, whole.path, 2e-3);
    EXPECT_NEAR(cut.summary.energy, whole.summary.energy, 1e-5 * whole.summary.energy);
  }
}

TEST_P(CutBar, AvoidsContactAsAWhole) {
  GeodesicOptions options;
  options.shapes = 3;
  options.avoid_contact = true;
  const std::vector<Shape> pair = {poses_[0], poses_[1]};
  const GeodesicResult whole = Interpolate(whole_, pair, options);
  const GeodesicResult cut = Interpolate(joined_, Cut(pair), options);
  ExpectSame(cut.path, whole.path, 1e-2);
  EXPECT_EQ(cut.summary.uncertified_segments, whole.summary.uncertified_segments);
}

TEST_P(CutBar, IsContinuedAsAWhole) {
  GeodesicOptions geodesic;
  geodesic.shapes = 7;
  geodesic.tolerance = 1e-10;
  const std::vector<Shape> pair = {poses_[0], poses_[1]};
  const Path whole = Interpolate(whole_, pair, geodesic).path;
  const Path cut = Interpolate(joined_, Cut(pair), geodesic).path;
  const Path longer = Extrapolate(cut, 3).path;
  ExpectSame(longer, Extrapolate(whole, 3).path, 2e-3);
  ExpectSame(CorrectPath(longer).path, CorrectPath(Extrapolate(whole, 3).path).path, 5e-3);
  const Tangent velocity = InitialVelocity(cut);
  EXPECT_TRUE(cut_.HasNoGap(velocity));
  const Tangent logarithm = Logarithm(cut.metric, cut.Placed(0), cut.Placed(2));
  EXPECT_TRUE(cut_.HasNoGap(logarithm));
  EXPECT_TRUE(cut_.HasNoGap(Exponential(cut.metric, cut.Placed(0), logarithm, 4)));
  ExponentialOptions first_integral;
  first_integral.integrator = GeodesicIntegrator::kFirstIntegral;
  for (const Shape& shape : Extrapolate(cut, 1, first_integral).path.Placed()) {
    EXPECT_TRUE(cut_.HasNoGap(shape));
  }
}

TEST_P(CutBar, ATargetThatIsOpenWhereTheSourceIsClosedIsSaid) {
  const Path source = MakePath(FreezeMetric({}, joined_, Cut(poses_)), Cut({poses_[0], poses_[1]}));
  Shape target = cut_.Of(poses_[2]);
  EXPECT_TRUE(Transfer(source, target).summary.warnings.empty());
  target.rightCols(1).array() += 0.01;
  const TransferResult result = Transfer(source, target);
  EXPECT_EQ(result.summary.warnings.size(), 1u);
  for (const Shape& shape : result.path.Placed()) EXPECT_TRUE(cut_.HasNoGap(shape));
}

TEST_P(CutBar, HasTheModesOfTheWhole) {
  const ShapeModelResult whole = MakeShapeModel(whole_, poses_, {});
  const ShapeModelResult cut = MakeShapeModel(joined_, Cut(poses_), {});
  ASSERT_EQ(cut.modes.NumModes(), whole.modes.NumModes());
  EXPECT_LT((cut.modes.variances - whole.modes.variances).norm(),
            1e-4 * whole.modes.variances.norm());
  for (const Tangent& mode : cut.modes.modes) EXPECT_TRUE(cut_.HasNoGap(mode));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(cut_.HasNoGap(cut.modes.PlacedPose(i)));
  const ShapeModel model(cut.modes), of_whole(whole.modes);
  const Eigen::Vector2d coordinates(0.7, -0.4);
  ExpectSame(model.At(coordinates).shape, of_whole.At(coordinates).shape, 2e-3);
  ExpectSame(model.Preview(coordinates), of_whole.Preview(coordinates), 2e-3);
  const ModelCoordinates found = model.Coordinates(cut_.Of(poses_[1]), true);
  EXPECT_TRUE(cut_.HasNoGap(found.shape));
}

TEST_P(CutBar, IsExploredAsAWhole) {
  ExploreOptions options;
  options.geodesic.shapes = 3;
  options.threshold = 0.01;
  options.depth = 1;
  const std::vector<std::string> names = {"a", "b", "c"};
  const ExploreResult whole = Explore(whole_, poses_, names, options);
  const ExploreResult cut = Explore(joined_, Cut(poses_), names, options);
  EXPECT_LT((cut.space.distances - whole.space.distances).norm(),
            1e-3 * whole.space.distances.norm());
  for (int node = 0; node < cut.space.NumNodes(); ++node) {
    EXPECT_TRUE(cut_.HasNoGap(cut.space.Placed(node)));
  }
  EXPECT_TRUE(cut_.HasNoGap(cut.space.At(cut.space.points.rowwise().mean())));
}

TEST_P(CutBar, CorrespondsAsAWhole) {
  const Shape target = poses_[1];
  std::vector<CorrespondenceMarker> markers, of_cut;
  for (const int v : Where(poses_[0], [](const auto& p) {
         return std::abs(p.y()) > 0.49 && std::abs(p.z()) > 0.49 && std::abs(p.x()) > 2.9;
       })) {
    markers.push_back({v, v});
    of_cut.push_back({cut_.LastCopy(v), cut_.LastCopy(v)});
  }
  ASSERT_EQ(markers.size(), 8u);
  const CorrespondenceResult whole = Correspond(whole_, poses_[0], whole_, target, markers);
  const CorrespondenceResult cut =
      Correspond(joined_, cut_.Of(poses_[0]), joined_, cut_.Of(target), of_cut);
  ExpectSame(cut.fitted, whole.fitted, 1e-2);
  const Shape landed = PullBack(cut.map.to_target, joined_->Triangles(), cut_.Of(target));
  EXPECT_TRUE(cut_.HasNoGap(landed));
  for (const CorrespondenceMarker& marker : markers) {
    EXPECT_EQ(landed.col(marker.template_vertex), target.col(marker.target_vertex));
  }
}

INSTANTIATE_TEST_SUITE_P(, CutBar, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Soup" : "InTheMiddle"; });

}  // namespace
}  // namespace shapespace
