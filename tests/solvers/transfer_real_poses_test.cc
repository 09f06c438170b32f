// Deformation transfer of scanned and modelled poses; skipped if the folder of real meshes is
// missing.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/files/read.h>
#include <shapespace/transfer/transfer.h>

#include "support/transfer_cases.h"

namespace shapespace {
namespace {

std::string RealMesh(const std::string& name) {
  return std::filesystem::path(SHAPESPACE_DATA_DIR) / (name + ".obj");
}

class RealTransfer : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(SHAPESPACE_DATA_DIR)) {
      GTEST_SKIP() << "no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR";
    }
  }
};

// Their poses contain folded hinges and nearly collapsed triangles.
TEST_F(RealTransfer, CopiesEndInExactCopies) {
  for (const auto& [reference, pose] :
       {std::pair("cat/reference", "cat/01"), std::pair("human/000", "human/007"),
        std::pair("horse/reference", "horse/01"), std::pair("elephant/reference", "elephant/01")}) {
    SCOPED_TRACE(pose);
    const Poses poses = ReadPoses({RealMesh(reference), RealMesh(pose)});
    const auto copy = [&](const Shape& shape) -> Shape {
      return (0.01 * testing::Rotation(100, {1, 2, 3}) * shape).colwise() +
             Eigen::Vector3d(7, 8, 9);
    };
    const auto [path, hybrids, summary] =
        TransferPoses(poses.connectivity, poses.shapes, copy(poses.shapes[0]));
    EXPECT_TRUE(summary.Converged()) << summary.BriefReport();
    EXPECT_LT(testing::Apart(path.Placed(1), copy(poses.shapes[1])), 1e-7);
  }
}

// Closer to the source's motion than Sumner and Popovic's transfer, in strains and in angles.
TEST_F(RealTransfer, APersonTakesAnothersPose) {
  const Poses poses =
      ReadPoses({RealMesh("human/000"), RealMesh("human/007"), RealMesh("human_b/024")});
  const std::vector<Shape> source = {poses.shapes[0], poses.shapes[1]};
  const auto ours = TransferPoses(poses.connectivity, source, poses.shapes[2]).summary;
  EXPECT_TRUE(ours.Converged()) << ours.BriefReport();
  TransferOptions options;
  options.metric.lambda = 1e8;  // Sumner and Popovic's, up to rounding
  const auto theirs =
      TransferPoses(poses.connectivity, source, poses.shapes[2], {}, options).summary;
  EXPECT_LT(ours.transfers[0].strain_rms, 0.92 * theirs.transfers[0].strain_rms);
  EXPECT_LT(ours.transfers[0].angle_rms, 0.65 * theirs.transfers[0].angle_rms);
}

}  // namespace
}  // namespace shapespace
