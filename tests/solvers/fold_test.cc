// Poses between which hinges turn by exactly 180 degrees, such as sheets that are folded flat. Both
// ways round are equal, so that the blend of two such poses, and each of them, is symmetric, and
// the energy has no gradient that leads out of the plane.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/sheet.h>
#include <shapespace/geodesic/detail/align_folds.h>
#include <shapespace/geodesic/detail/turning_motion.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/metric/dihedral.h>
#include <shapespace/path/align.h>

#include "support/motions.h"

namespace shapespace {
namespace {

using internal::HasFolds;
using internal::TurningMotion;
using testing::Distance;
using testing::Rotation;

constexpr double kDegreesOfRadian = 180 / M_PI;

// A mesh in two poses.
struct FoldedBody {
  std::shared_ptr<const Connectivity> mesh;
  Shape first, last;
};

using Place = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

Shape Placed(const Shape& shape, const Place& place) {
  Shape result = shape;
  for (int v = 0; v < shape.cols(); ++v) result.col(v) = place(shape.col(v));
  return result;
}

// A square of side 1 about the origin, in cells x cells cells, and where `fold` puts it.
FoldedBody SquareSheet(int cells, const Place& fold) {
  const ShapeFamily sheet = MakeSheet(1, 1, cells, cells);
  const Shape flat = sheet.pose(0);
  return {sheet.connectivity, flat, Placed(flat, fold)};
}

// Turns over what is beyond x = at.
Place Over(double at) {
  return [at](const Eigen::Vector3d& p) {
    return p(0) > at ? Eigen::Vector3d(2 * at - p(0), p(1), p(2)) : p;
  };
}

// To and fro, in panels of the same width.
Place Panels(int count) {
  return [count](const Eigen::Vector3d& p) {
    const double along = (p(0) + 0.5) * count;
    const int panel = std::min(static_cast<int>(along + 1e-9), count - 1);
    const double within = panel % 2 == 0 ? along - panel : panel + 1 - along;
    return Eigen::Vector3d(within / count, p(1), 0);
  };
}

// Both ends onto the middle.
Eigen::Vector3d Letter(const Eigen::Vector3d& p) {
  return Over(0.25)({std::max(p(0), -0.5 - p(0)), p(1), 0});
}

Eigen::Vector3d AlongACurve(const Eigen::Vector3d& p) {
  return Over(0.2 * std::cos(M_PI * p(1)))(p);
}

// The angles of all hinges in degrees.
std::vector<double> HingeAngles(const Connectivity& mesh, const Shape& shape) {
  std::vector<double> angles;
  for (const auto& hinge : mesh.Hinges().colwise()) {
    double x[12];
    for (int k = 0; k < 4; ++k) Eigen::Map<Eigen::Vector3d>(x + 3 * k) = shape.col(hinge(k));
    angles.push_back(kDegreesOfRadian * Dihedral().Angle(x));
  }
  return angles;
}

// The folds, in their order among the hinges.
std::vector<int> FoldsOf(const FoldedBody& folding) {
  const std::vector<double> first = HingeAngles(*folding.mesh, folding.first);
  const std::vector<double> last = HingeAngles(*folding.mesh, folding.last);
  std::vector<int> folds;
  for (size_t h = 0; h < first.size(); ++h) {
    if (std::abs(std::abs(last[h] - first[h]) - 180) < 1e-6) folds.push_back(static_cast<int>(h));
  }
  return folds;
}

double GreatestStretch(const Connectivity& mesh, const Shape& rest, const Shape& shape) {
  double greatest = 0;
  for (const auto& edge : mesh.Edges().colwise()) {
    const double before = (rest.col(edge(1)) - rest.col(edge(0))).norm();
    const double now = (shape.col(edge(1)) - shape.col(edge(0))).norm();
    greatest = std::max(greatest, std::abs(now / before - 1));
  }
  return greatest;
}

// The same surface with all triangles turned over.
std::shared_ptr<const Connectivity> TurnedOver(const Connectivity& mesh) {
  Eigen::Matrix3Xi triangles = mesh.Triangles();
  triangles.row(1).swap(triangles.row(2));
  return Connectivity::FromTriangles(mesh.NumVertices(), triangles);
}

// A box of side 1 with a lid, which is closed in the first pose and opened by 180 degrees in the
// last.
FoldedBody BoxWithLid() {
  Shape closed(3, 10), open;
  for (int v = 0; v < 8; ++v) closed.col(v) << v % 2, v / 2 % 2, v / 4;
  closed.col(8) << 1, 0, 1;
  closed.col(9) << 1, 1, 1;
  open = closed;
  open(0, 8) = open(0, 9) = -1;
  Eigen::Matrix3Xi triangles(3, 12);
  triangles << 0, 0, 0, 0, 0, 0, 2, 2, 1, 1, 4, 4,  //
      2, 3, 4, 6, 1, 5, 7, 6, 3, 7, 8, 9,           //
      3, 1, 6, 2, 5, 4, 3, 7, 7, 5, 9, 6;
  return {Connectivity::FromTriangles(10, triangles), closed, open};
}

TEST(HasFolds, AreHingesThatTurnByHalfATurn) {
  FoldedBody sheet = SquareSheet(4, Over(0));
  EXPECT_TRUE(HasFolds(*sheet.mesh, sheet.first, sheet.last));
  EXPECT_TRUE(HasFolds(*sheet.mesh, sheet.last, sheet.first));
  EXPECT_FALSE(HasFolds(*sheet.mesh, sheet.first, sheet.first));
  EXPECT_FALSE(HasFolds(*sheet.mesh, sheet.last, sheet.last));
  // Coordinates of six decimals.
  const auto rounded = [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return (1e6 * p).array().round() / 1e6;
  };
  const Shape turned = Rotation(50, {1, 2, 3}) * sheet.last;
  EXPECT_TRUE(HasFolds(*sheet.mesh, sheet.first, Placed(turned, rounded)));
  const auto bent = [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return p(0) > 0 ? Eigen::Vector3d(Rotation(179.9, {0, 1, 0}) * p) : p;
  };
  EXPECT_FALSE(HasFolds(*sheet.mesh, sheet.first, Placed(sheet.first, bent)));
}

TEST(TurningMotion, FoldsPanelsWithoutStretchingThem) {
  for (const Place& fold : {Over(0), Over(0.25), Panels(4), Place(Letter)}) {
    const FoldedBody sheet = SquareSheet(8, fold);
    const TurningMotion motion(*sheet.mesh, sheet.first, sheet.last);
    EXPECT_LT(Distance(motion.At(0), sheet.first), 1e-9);
    EXPECT_LT(Distance(motion.At(1), sheet.last), 1e-9);
    for (const double t : {0.25, 0.5, 0.75}) {
      const Shape shape = motion.At(t);
      EXPECT_LT(GreatestStretch(*sheet.mesh, sheet.first, shape), 1e-3);
      const std::vector<double> angles = HingeAngles(*sheet.mesh, shape);
      for (const int h : FoldsOf(sheet)) EXPECT_NEAR(std::abs(angles[h]), 180 * t, 0.1);
    }
  }
}

TEST(TurningMotion, AFoldRisesOnTheSideOfTheNormals) {
  const FoldedBody sheet = SquareSheet(4, Over(0));
  const auto other = TurnedOver(*sheet.mesh);
  for (const double sign : {1.0, -1.0}) {
    const Connectivity& mesh = sign > 0 ? *sheet.mesh : *other;
    for (const Shape& half : {TurningMotion(mesh, sheet.first, sheet.last).At(0.5),
                              TurningMotion(mesh, sheet.last, sheet.first).At(0.5)}) {
      const std::vector<double> angles = HingeAngles(mesh, half);
      EXPECT_NEAR(*std::min_element(angles.begin(), angles.end()), -90, 0.1);
      EXPECT_LT(*std::max_element(angles.begin(), angles.end()), 0.1);
    }
  }
}

TEST(TurningMotion, ParallelFoldsOpenLikeStairs) {
  const FoldedBody sheet = SquareSheet(8, Panels(4));
  const std::vector<double> angles =
      HingeAngles(*sheet.mesh, TurningMotion(*sheet.mesh, sheet.first, sheet.last).At(0.5));
  int rising = 0, falling = 0;
  for (const int h : FoldsOf(sheet)) {
    // The middle one of three folds goes the other way than the outer ones.
    const Eigen::Vector4i hinge = sheet.mesh->Hinges().col(h);
    const bool middle = std::abs(sheet.first(0, hinge(0))) < 1e-9;
    (middle ? falling : rising) += angles[h] > 0 ? 1 : -1;
  }
  EXPECT_EQ(std::abs(rising), 16);
  EXPECT_EQ(std::abs(falling), 8);
  EXPECT_LT(rising * falling, 0);
}

// The lid's hinge passes through 0 degrees, not through 180.
TEST(TurningMotion, ALidOpensOutwards) {
  const FoldedBody box = BoxWithLid();
  for (const Shape& half : {TurningMotion(*box.mesh, box.first, box.last).At(0.5),
                            TurningMotion(*box.mesh, box.last, box.first).At(0.5)}) {
    EXPECT_GT(half(2, 8) - half(2, 4), 0.99);
    EXPECT_GT(half(2, 9) - half(2, 6), 0.99);
  }
}

// Triangles without area in a pose have no rotation of their own, and turn with a neighbour.
TEST(TurningMotion, TrianglesWithoutAreaTurnWithTheirNeighbours) {
  FoldedBody sheet = SquareSheet(8, Over(0));
  const std::vector<int> merged = testing::Where(
      sheet.first, [](const Eigen::Vector3d& p) { return std::abs(p(1)) < 0.2 && p(0) > 0.2; });
  for (const int v : merged) sheet.last.col(v) = sheet.last.col(merged[0]);
  for (const Shape& half : {TurningMotion(*sheet.mesh, sheet.first, sheet.last).At(0.5),
                            TurningMotion(*sheet.mesh, sheet.last, sheet.first).At(0.5)}) {
    const std::vector<double> angles = HingeAngles(*sheet.mesh, half);
    for (const int h : FoldsOf(sheet)) EXPECT_NEAR(angles[h], -90, 15);
  }
}

TEST(TurningMotion, DoesNotDependOnTheFrames) {
  for (const Place& fold : {Over(0), Over(0.25), Panels(4), Place(Letter), Place(AlongACurve)}) {
    const FoldedBody sheet = SquareSheet(8, fold);
    const Shape half = TurningMotion(*sheet.mesh, sheet.first, sheet.last).At(0.5);
    const std::vector<double> angles = HingeAngles(*sheet.mesh, half);
    for (const double degrees : {40.0, 133.0, 180.0}) {
      const Shape turned = Rotation(degrees, {1, -2, 0.5}) * sheet.last;
      const Shape other = TurningMotion(*sheet.mesh, sheet.first, turned).At(0.5);
      const std::vector<double> others = HingeAngles(*sheet.mesh, other);
      for (size_t h = 0; h < angles.size(); ++h) EXPECT_NEAR(angles[h], others[h], 1e-4);
    }
  }
}

// For a sheet that is folded in half, all rotations about the fold are equally near to the flat
// sheet.
TEST(AlignFolds, BothHalvesOfASheetTurnByTheSameAngle) {
  const FoldedBody sheet = SquareSheet(8, Over(0));
  const auto metric = FreezeMetric({}, sheet.mesh, {sheet.first, sheet.last});
  for (const double degrees : {0.0, 40.0, 133.0}) {
    const std::vector<Shape> poses = {sheet.first, Rotation(degrees, {1, -2, 0.5}) * sheet.last};
    const AlignedPoses aligned = internal::AlignFolds(*metric, AlignPoses(*metric, poses));
    EXPECT_LT(aligned.shapes[1].row(0).cwiseAbs().maxCoeff(), 1e-3);
    for (int i = 0; i < 2; ++i) {
      EXPECT_LT(Distance(aligned.motions[i](metric->unit * aligned.shapes[i]), poses[i]), 1e-9);
    }
  }
}

// What position costs depends on the angle, so without it the angle is even.
TEST(Folds, ABookShutsThroughEvenAngles) {
  Shape open(3, 4), shut;
  open << 0, 0, 1, -1, 0, 1, 0, 0, 0, 0, 0, 0;
  shut = open;
  shut(0, 3) = 1;
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 0, 2, 1, 1, 3;
  const auto mesh = Connectivity::FromTriangles(4, triangles);
  GeodesicOptions options;
  options.shapes = 3;
  options.tolerance = 1e-11;
  options.metric.lambda = 0;
  for (const bool backwards : {false, true}) {
    for (const double degrees : {0.0, 70.0}) {
      const Shape turned = Rotation(degrees, {1, -2, 0.5}) * shut;
      const std::vector<Shape> poses =
          backwards ? std::vector<Shape>{turned, open} : std::vector<Shape>{open, turned};
      const auto [path, summary] = Interpolate(mesh, poses, options);
      EXPECT_EQ(summary.termination, Termination::kConverged);
      for (int i = 1; i <= 3; ++i) {
        const double expected = backwards ? 180 - 45 * i : 45 * i;
        EXPECT_NEAR(HingeAngles(*mesh, path.shapes[i])[0], -expected, 0.5);
      }
    }
  }
}

// With the cost of position, too, the book turns, by the same angles in every frame.
TEST(Folds, ABookTurnsInEveryFrame) {
  Shape open(3, 4), shut;
  open << 0, 0, 1, -1, 0, 1, 0, 0, 0, 0, 0, 0;
  shut = open;
  shut(0, 3) = 1;
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 0, 2, 1, 1, 3;
  const auto mesh = Connectivity::FromTriangles(4, triangles);
  GeodesicOptions options;
  options.shapes = 3;
  options.tolerance = 1e-8;
  std::vector<double> half;
  for (const double degrees : {0.0, 70.0, 180.0}) {
    const Shape turned = Rotation(degrees, {1, -2, 0.5}) * shut;
    const auto [path, summary] = Interpolate(mesh, {open, turned}, options);
    EXPECT_LT(summary.Ratio(), 1.21);
    half.push_back(HingeAngles(*mesh, path.shapes[2])[0]);
    EXPECT_NEAR(half.back(), -90, 15);
    EXPECT_NEAR(half.back(), half.front(), 0.5);
  }
}

struct NamedFold {
  std::string name;
  Place fold;
};

class FoldedSheets : public ::testing::TestWithParam<NamedFold> {};

TEST_P(FoldedSheets, AreNearTheBoundAndTheSameInEveryFrame) {
  const FoldedBody sheet = SquareSheet(20, GetParam().fold);
  GeodesicOptions options;
  options.shapes = 7;
  std::vector<double> expected;
  const RigidMotion far = {Rotation(63, {1, -2, 0.5}), {1e6, -2e6, 1e6}};
  for (const Shape& last : {sheet.last, far(sheet.last)}) {
    const auto [path, summary] = Interpolate(sheet.mesh, {sheet.first, last}, options);
    EXPECT_LT(summary.Ratio(), 1.2);
    const std::vector<double> angles = HingeAngles(*sheet.mesh, path.shapes[4]);
    if (expected.empty()) expected = angles;
    for (const int h : FoldsOf(sheet)) {
      EXPECT_NEAR(std::abs(angles[h]), 90, 30);
      EXPECT_GT(angles[h] * expected[h], 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Folds, FoldedSheets,
                         ::testing::Values(NamedFold{"Once", Over(0)},
                                           NamedFold{"AsideOfTheMiddle", Over(0.25)},
                                           NamedFold{"Twice", Letter},
                                           NamedFold{"FourPanels", Panels(4)},
                                           NamedFold{"AlongACurve", AlongACurve}),
                         [](const auto& info) { return info.param.name; });

// Of four folds that meet at right angles two opposite ones can turn at a time, as long as nothing
// is stretched: each pair in half of the time, for twice the bound.
TEST(Folds, FoldsThatMeetFollowEachOther) {
  const FoldedBody sheet =
      SquareSheet(20, [](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p.cwiseAbs(); });
  GeodesicOptions options;
  options.shapes = 7;
  for (const Shape& last : {sheet.last, Shape(Rotation(63, {1, -2, 0.5}) * sheet.last)}) {
    EXPECT_LT(Interpolate(sheet.mesh, {sheet.first, last}, options).summary.Ratio(), 2);
  }
}

// A dome with a brim, whose outer half folds over.
TEST(Folds, APartOfABodyThatIsNotPlanar) {
  FoldedBody body = SquareSheet(12, Over(0.25));
  const auto raise = [&](Shape* shape) {
    for (int v = 0; v < shape->cols(); ++v) {
      const double x = body.first(0, v), y = body.first(1, v);
      if (x < 0) (*shape)(2, v) = 0.3 * std::sin(2 * M_PI * -x) * std::cos(M_PI * y);
    }
  };
  Shape first = body.first;
  raise(&first);
  raise(&body.last);
  body.first = first;
  GeodesicOptions options;
  options.shapes = 7;
  const auto [path, summary] = Interpolate(body.mesh, {body.first, body.last}, options);
  EXPECT_LT(summary.Ratio(), 1.1);
  const std::vector<double> angles = HingeAngles(*body.mesh, path.shapes[4]);
  const std::vector<int> folds = FoldsOf(body);
  EXPECT_EQ(folds.size(), 12u);
  for (const int h : folds) EXPECT_NEAR(angles[h], -90, 10);
}

}  // namespace
}  // namespace shapespace
