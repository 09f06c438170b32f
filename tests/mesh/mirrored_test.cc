#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/mirrored.h>

#include "mesh/bodies.h"

namespace shapespace {
namespace {

using testing::Connected;
using testing::Cube;
using testing::Grid;
using testing::MakeSoup;
using testing::Torus;

using Function = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

Shape Map(const Shape& shape, const Function& function) {
  Shape mapped(3, shape.cols());
  for (Eigen::Index v = 0; v < shape.cols(); ++v) mapped.col(v) = function(shape.col(v));
  return mapped;
}

/// A sheet over [-1/2, 1/2]^2, with vertices that are moved at random if `rough`.
Soup Sheet(int n, double rough = 0) {
  Soup sheet = Grid(n, n);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  for (int v = 0; v < sheet.NumVertices(); ++v) {
    for (int k = 0; k < 2; ++k) {
      double& x = sheet.vertices(k, v);
      if (x > 0 && x < n) x += rough * shift(random);
    }
  }
  sheet.vertices.topRows(2) = (sheet.vertices.topRows(2).array() / n - 0.5).matrix();
  return sheet;
}

/// Like a face: a nose, two sockets, and the cheeks fall back.
Eigen::Vector3d Face(const Eigen::Vector3d& p) {
  const auto bump = [&](double x, double y, double width) {
    return std::exp(-(std::pow(p.x() - x, 2) + std::pow(p.y() - y, 2)) / (width * width));
  };
  return {p.x(), p.y(),
          0.1 * bump(0, -0.05, 0.12) - 0.04 * bump(-0.2, 0.15, 0.1) - 0.04 * bump(0.2, 0.15, 0.1) -
              0.3 * p.x() * p.x() - 0.1 * p.y() * p.y()};
}

/// Rolls the plane, with its normal, onto a cylinder, by this angle from one end to the other.
Function Rolled(double angle, double direction) {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(direction, Eigen::Vector3d::UnitZ()));
  return [=](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector3d q = turn * p;
    const double radius = 1 / angle;
    return {(radius - q.z()) * std::sin(q.x() / radius), q.y(),
            radius - (radius - q.z()) * std::cos(q.x() / radius)};
  };
}

Shape Moved(const Shape& shape) {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, -1).normalized()));
  return ((3 * turn * shape).colwise() + Eigen::Vector3d(1e6, -2e6, 5e5)).eval();
}

Shape Flipped(Shape shape, int axis) {
  shape.row(axis) *= -1;
  return shape;
}

/// Both ways round: a pose, and its mirror images.
void ExpectMirroredOnlyIfFlipped(const Soup& soup, const Shape& reference, const Shape& pose) {
  const Eigen::Matrix3Xi triangles = Connected(soup)->Triangles();
  for (const Shape& placed : {pose, Moved(pose)}) {
    EXPECT_FALSE(IsMirrored(triangles, reference, placed));
    EXPECT_FALSE(IsMirrored(triangles, placed, reference));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(IsMirrored(triangles, reference, Flipped(placed, axis))) << axis;
      EXPECT_TRUE(IsMirrored(triangles, Flipped(placed, axis), reference)) << axis;
    }
  }
}

TEST(MirroredTest, OpenSurfacesAreToldFromTheirMirrorImages) {
  for (const int n : {8, 24, 60}) {
    for (const double rough : {0.0, 0.4}) {
      SCOPED_TRACE(std::to_string(n) + (rough > 0 ? ", rough" : ""));
      const Soup sheet = Sheet(n, rough);
      const Shape face = Map(sheet.vertices, Face);
      ExpectMirroredOnlyIfFlipped(sheet, face, face);
      const auto dome = [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
        return {p.x(), p.y(), -0.6 * p.x() * p.x() - 0.2 * p.y() * p.y()};
      };
      const Shape shell = Map(sheet.vertices, dome);
      ExpectMirroredOnlyIfFlipped(sheet, shell, shell);
    }
  }
}

// The head turns and nods: what bulges goes on to do so.
TEST(MirroredTest, AlsoWhereThePoseHasMoved) {
  const Soup sheet = Sheet(30, 0.3);
  const Shape face = Map(sheet.vertices, Face);
  const Shape rolled = Map(face, Rolled(-1.5, 0.3));
  ExpectMirroredOnlyIfFlipped(sheet, face, rolled);
  const Shape smiling = Map(face, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return {1.1 * p.x(), p.y() + 0.2 * p.x() * p.x(), 0.8 * p.z() + 0.03 * std::sin(9 * p.y())};
  });
  ExpectMirroredOnlyIfFlipped(sheet, face, smiling);
}

TEST(MirroredTest, TubesAreToldThoughTheyAreRolledUpOfSheets) {
  const int around = 24, along = 12;
  Shape vertices(3, around * (along + 1));
  std::vector<std::vector<int>> polygons;
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::acos(-1.) * i / around;
      vertices.col(j * around + i) << std::cos(angle), std::sin(angle), 0.3 * j;
      const int k = (i + 1) % around;
      if (j < along) {
        polygons.push_back(
            {j * around + i, j * around + k, (j + 1) * around + k, (j + 1) * around + i});
      }
    }
  }
  const Soup tube = MakeSoup(vertices, polygons);
  const Shape bent = Map(vertices, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const double angle = p.z() / 5;
    return {(p.x() + 5) * std::cos(angle), p.y(), (p.x() + 5) * std::sin(angle)};
  });
  ExpectMirroredOnlyIfFlipped(tube, vertices, bent);
}

TEST(MirroredTest, WhatBendingTurnsOverIsNoMirrorImage) {
  for (const int n : {4, 9, 30}) {
    for (const double rough : {0.0, 0.4}) {
      const Soup sheet = Sheet(n, rough);
      const Eigen::Matrix3Xi triangles = Connected(sheet)->Triangles();
      const auto expect_none = [&](const Shape& a, const Shape& b, const char* what) {
        EXPECT_FALSE(IsMirrored(triangles, a, b)) << what << ", " << n << ", " << rough;
        EXPECT_FALSE(IsMirrored(triangles, a, Flipped(Moved(b), 1))) << what << ", " << n;
      };
      const Shape& flat = sheet.vertices;
      expect_none(flat, flat, "flat");
      expect_none(flat, Map(flat, Rolled(2, 0.4)), "flat and rolled");
      expect_none(Map(flat, Rolled(1, 0.4)), Map(flat, Rolled(-1, 0.4)), "the other way");
      expect_none(Map(flat, Rolled(3, 0.4)), Map(flat, Rolled(-2, 0.4)), "more");
      expect_none(Map(flat, Rolled(1, 0.4)), Map(flat, Rolled(1, 1.2)), "in another direction");
      const auto waves = [&](double phase) {
        return Map(flat, [=](const Eigen::Vector3d& p) -> Eigen::Vector3d {
          return {p.x(), p.y(), 0.05 * std::sin(9 * p.x() + phase)};
        });
      };
      expect_none(waves(0), waves(1), "waves that go on");
      expect_none(waves(0), waves(3), "waves that go on to the next");
      const auto saddle = [&](double sign) {
        return Map(flat, [=](const Eigen::Vector3d& p) -> Eigen::Vector3d {
          return {p.x(), p.y(), sign * (p.x() * p.x() - p.y() * p.y()) / 2};
        });
      };
      expect_none(saddle(1), saddle(-1), "saddles, which are their own mirror images");
    }
  }
  // A book.
  const Soup book = Sheet(10);
  const auto opened = [&](double slope) {
    return Map(book.vertices, [=](const Eigen::Vector3d& p) -> Eigen::Vector3d {
      return {p.x(), p.y(), slope * std::abs(p.x())};
    });
  };
  EXPECT_FALSE(IsMirrored(Connected(book)->Triangles(), opened(1), opened(-1)));
}

// Measurements that differ by noise alone: few hinges, or shallow ones, prove nothing.
TEST(MirroredTest, NoiseIsNoEvidence) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const int n = 2 + i % 3;
    const Soup sheet = Sheet(n);
    const auto noisy = [&] {
      Shape shape = sheet.vertices;
      for (int v = 0; v < shape.cols(); ++v) shape(2, v) += 0.05 / n * normal(random);
      return shape;
    };
    const Shape first = noisy(), second = noisy();
    found += IsMirrored(Connected(sheet)->Triangles(), first, second) ? 1 : 0;
  }
  EXPECT_LE(found, 12);
}

TEST(MirroredTest, ClosedBodiesAreToldInOtherPostures) {
  const Soup torus = Torus(24, 12);
  const Shape other = Map(torus.vertices, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return {p.x() * (1 + 0.2 * p.y()), p.y(), p.z() + 0.3 * p.x() * p.x()};
  });
  ExpectMirroredOnlyIfFlipped(torus, torus.vertices, other);
  ExpectMirroredOnlyIfFlipped(Cube(), Cube().vertices, Cube().vertices);
  // As thin as a leaf, whose sides can be exchanged.
  Shape leaf = torus.vertices;
  leaf.row(2) *= 1e-3;
  EXPECT_FALSE(IsMirrored(Connected(torus)->Triangles(), leaf, Flipped(leaf, 2)));
}

/// A closed bar along x, of squares.
Soup Bar(int length) {
  std::vector<std::vector<int>> polygons;
  const int rows = length + 1;
  Shape vertices(3, 4 * rows);
  const double y[] = {-0.5, 0.5, 0.5, -0.5}, z[] = {-0.5, -0.5, 0.5, 0.5};
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < 4; ++k) {
      vertices.col(4 * i + k) << i, y[k], z[k];
      const int l = (k + 1) % 4;
      if (i < length) polygons.push_back({4 * i + k, 4 * i + 4 + k, 4 * i + 4 + l, 4 * i + l});
    }
  }
  polygons.push_back({0, 1, 2, 3});
  polygons.push_back({4 * length + 3, 4 * length + 2, 4 * length + 1, 4 * length});
  return MakeSoup(vertices, polygons);
}

// The width changes its sign on the way, so that the rest of the bar is inside out.
TEST(MirroredTest, ABodyThatIsTurnedInsideOutInPartIsNone) {
  const Soup bar = Bar(20);
  for (const double from : {1.5, 3.5, 7.5}) {
    Soup pose = bar;
    for (int v = 0; v < bar.NumVertices(); ++v) {
      if (bar.vertices(0, v) > from) pose.vertices(1, v) *= -1;
    }
    EXPECT_FALSE(IsMirrored(Connected(bar)->Triangles(), bar.vertices, pose.vertices));
    const std::vector<Finding> findings = CheckSameMesh(bar, pose);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].kind, "inside-out");
    EXPECT_EQ(findings[0].severity, Severity::kWarning);
    EXPECT_EQ(MakePoses({bar, pose}).shapes[1], pose.vertices);  // is taken
  }
}

TEST(MirroredTest, PosesAreRefusedOrMirroredOrTakenAsTheyAre) {
  Soup face = Sheet(12);
  face.vertices = Map(face.vertices, Face);
  Soup flipped = face;
  flipped.vertices = Moved(Flipped(face.vertices, 0));
  EXPECT_THROW(MakePoses({face, flipped}), MismatchError);
  ReadOptions options;
  options.allow_mirrored = true;
  const Poses allowed = MakePoses({face, flipped}, options);
  EXPECT_EQ(allowed.shapes[1], flipped.vertices);
  EXPECT_FALSE(allowed.warnings.empty());
  options = {};
  options.mirror = 'y';
  const Poses mended = MakePoses({face, flipped}, options);
  EXPECT_EQ(mended.shapes[1], Flipped(flipped.vertices, 1));
  EXPECT_FALSE(IsMirrored(mended.connectivity->Triangles(), face.vertices, mended.shapes[1]));
  // Where there is no mirror image, the option would be without effect in silence.
  EXPECT_TRUE(MakePoses({face, face}).warnings.empty());
  EXPECT_EQ(MakePoses({face, face}, options).warnings.size(), 1u);
  EXPECT_TRUE(MakePoses({face}, options).warnings.empty());
}

}  // namespace
}  // namespace shapespace
