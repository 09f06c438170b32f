// Deformation by handles, and repair, of scanned and modelled bodies; skipped if the folder of real
// meshes is missing.

#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/rigid_motion.h>

#include "support/motions.h"

namespace shapespace {
namespace {

using Eigen::Vector3d;
using testing::Where;

class RealDeformation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(SHAPESPACE_DATA_DIR)) {
      GTEST_SKIP() << "no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR";
    }
  }

  static Poses Read(const std::vector<std::string>& names, const ReadOptions& options = {}) {
    std::vector<std::string> files;
    for (const std::string& name : names) {
      files.push_back(std::filesystem::path(SHAPESPACE_DATA_DIR) / (name + ".obj"));
    }
    return ReadPoses(files, options);
  }
};

Vector3d Size(const Shape& shape) {
  return shape.rowwise().maxCoeff() - shape.rowwise().minCoeff();
}

// The vertices near the ground, y up, within a share of the height.
DeformationHandle Feet(const Shape& rest, double share) {
  DeformationHandle feet;
  const double top = rest.row(1).minCoeff() + share * Size(rest).y();
  feet.vertices = Where(rest, [&](const auto& p) { return p.y() < top; });
  return feet;
}

// The vertices within a share of the body's size from the one that is farthest in the direction
// `way`, rotated about a point at `arm` sizes from the body's centre.
DeformationHandle Limb(const Shape& rest, const Vector3d& way, double share, const Vector3d& axis,
                       double degrees, const Vector3d& arm) {
  int tip = 0;
  (way.transpose() * rest).maxCoeff(&tip);
  const double size = Size(rest).norm();
  DeformationHandle limb;
  limb.vertices =
      Where(rest, [&](const auto& p) { return (p - rest.col(tip)).norm() < share * size; });
  limb.motion.axis = axis;
  limb.motion.angle = degrees * M_PI / 180;
  const Shape moved = rest(Eigen::all, limb.vertices);
  limb.motion.point = moved.rowwise().mean() + size * arm;
  return limb;
}

void ExpectFits(const Poses& poses, const std::vector<DeformationHandle>& handles,
                double edge_rms) {
  DeformationOptions options;
  options.metric = MetricOptions::Deformation(*poses.connectivity, poses.shapes[0]);
  options.metric->volume = 30;
  const DeformationSummary summary =
      Deform(poses.connectivity, poses.shapes[0], handles, options).summary;
  EXPECT_TRUE(summary.Converged()) << summary.BriefReport();
  for (const auto& handle : summary.handles) {
    EXPECT_LT(handle.residual_max, 1e-12 * Size(poses.shapes[0]).norm());
  }
  EXPECT_LT(summary.error.edge_rms, edge_rms);
  EXPECT_LT(std::abs(summary.error.volume), 0.003);
  EXPECT_EQ(summary.error.inverted_hinges, 0);
}

TEST_F(RealDeformation, AnArmadilloLiftsAnArm) {
  const Poses poses = Read({"armadillo/arms_down"});
  const Shape& rest = poses.shapes[0];
  ExpectFits(poses,
             {Feet(rest, 0.1),
              Limb(rest, Vector3d::UnitX(), 0.08, Vector3d::UnitZ(), 80, Vector3d(-0.18, 0.12, 0))},
             0.07);
}

TEST_F(RealDeformation, ACatTurnsItsHead) {
  const Poses poses = Read({"cat/reference"});
  const Shape& rest = poses.shapes[0];
  ExpectFits(poses,
             {Feet(rest, 0.1),
              Limb(rest, Vector3d(0, 0.2, 1), 0.12, Vector3d::UnitY(), 60, Vector3d(0, 0, -0.1))},
             0.045);
}

TEST_F(RealDeformation, AnElephantRaisesItsTrunk) {
  const Poses poses = Read({"elephant/reference"});
  const Shape& rest = poses.shapes[0];
  ExpectFits(poses,
             {Feet(rest, 0.05), Limb(rest, Vector3d(0, -1, 0.7), 0.05, -Vector3d::UnitX(), 70,
                                     Vector3d(0, 0.18, -0.05))},
             0.03);
}

// 26 edges have more than two triangles, and the mesh has holes.
TEST_F(RealDeformation, ANonManifoldMeshIsTaken) {
  ReadOptions options;
  options.allow_nonmanifold = true;
  const Poses poses = Read({"camel_nonmanifold/reference"}, options);
  const Shape& rest = poses.shapes[0];
  DeformationHandle head =
      Limb(rest, Vector3d(0, 0.3, 1), 0.1, Vector3d::UnitY(), 30, Vector3d(0, 0, -0.1));
  const DeformationSummary summary =
      Deform(poses.connectivity, rest, {Feet(rest, 0.1), head}).summary;
  EXPECT_TRUE(summary.Converged()) << summary.BriefReport();
  EXPECT_LT(summary.error.edge_rms, 0.05);
}

// A dented shape half way on straight lines between two poses: the remaining loss of volume must be
// at most the share that the paper reports (3.6 of 25 %).
TEST_F(RealDeformation, DistortedPosesAreRepaired) {
  for (const auto& [first, second] :
       {std::pair("human/000", "human/007"), std::pair("cat/reference", "cat/01"),
        std::pair("hand/rest", "hand/curl65"),
        std::pair("armadillo/arms_up", "armadillo/arms_down")}) {
    SCOPED_TRACE(first);
    const Poses poses = Read({first, second});
    const Shape& reference = poses.shapes[0];
    const auto metric = FreezeMetric({}, poses.connectivity, {reference});
    Shape distorted = 0.5 * (reference + FitRigidMotion(poses.shapes[1], reference,
                                                        metric->vertex_area)(poses.shapes[1]));
    const Vector3d centre = Centroid(reference, metric->vertex_area);
    for (int k = 0; k < 12; ++k) {
      const Vector3d at = reference.col((k * 7919 + 13) % reference.cols());
      for (int v = 0; v < reference.cols(); ++v) {
        const double share = (reference.col(v) - at).norm() / (0.12 * metric->unit);
        if (share >= 1) continue;
        distorted.col(v) +=
            0.06 * metric->unit * std::pow(1 - share * share, 2) * (centre - at).normalized();
      }
    }
    const RepairSummary summary = Repair(poses.connectivity, reference, distorted).summary;
    EXPECT_TRUE(summary.Converged()) << summary.BriefReport();
    EXPECT_LT(std::abs(summary.after.volume), 3.6 / 25 * std::abs(summary.before.volume));
    EXPECT_LT(summary.after.edge_rms, 0.2 * summary.before.edge_rms);
    EXPECT_LT(summary.after.inverted_hinges, summary.before.inverted_hinges);
  }
}

}  // namespace
}  // namespace shapespace
