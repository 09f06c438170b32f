#include <algorithm>
#include <filesystem>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/topology.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::ExpectError;

/// Real meshes, described in the README of their folder.
class RealDataTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(SHAPESPACE_DATA_DIR)) {
      GTEST_SKIP() << "no real meshes";
    }
  }

  static std::vector<std::string> Files(const std::string& folder,
                                        const std::vector<std::string>& names) {
    std::vector<std::string> files;
    for (const std::string& name : names) {
      files.push_back(std::string(SHAPESPACE_DATA_DIR) + "/" + folder + "/" + name + ".obj");
    }
    return files;
  }
};

TEST_F(RealDataTest, HealthyPosesAreTakenWithoutAWord) {
  struct Case {
    const char* folder;
    std::vector<std::string> names;
    int vertices, triangles, loops;
  };
  for (const Case& c :
       {Case{"finger", {"0", "1", "var"}, 2046, 4088, 0},
        Case{"cactus", {"00", "01", "03", "04", "05", "08"}, 5261, 10518, 0},
        Case{"plate", {"flat", "rolledA", "rolledB"}, 1089, 2048, 1},
        Case{"leaf", {"original", "bend0", "bend1"}, 1355, 2548, 1},
        Case{"scape", {"ref", "5", "6"}, 2000, 3995, 1},
        Case{"human", {"000", "007"}, 6890, 13776, 0},
        Case{"hand", {"rest", "curl30", "curl65", "point", "pinch"}, 1159, 2314, 0},
        Case{"horse", {"reference", "01", "02", "03"}, 8431, 16843, 2},
        Case{"cat", {"reference", "01", "02", "03", "04"}, 7207, 14410, 0},
        Case{"lion", {"reference", "01", "02"}, 5000, 9996, 0},
        Case{"elephant", {"reference", "01", "02"}, 42321, 84638, 0},
        Case{"armadillo", {"rest", "arms_up", "arms_down", "step", "kick"}, 14587, 29170, 0},
        Case{"horse_lowpoly", {"base", "m01", "m03", "m05", "m07"}, 494, 984, 0},
        Case{"steffen", {"steffen_polyhedron"}, 9, 14, 0}}) {
    SCOPED_TRACE(c.folder);
    const Poses poses = ReadPoses(Files(c.folder, c.names));
    EXPECT_EQ(poses.connectivity->NumVertices(), c.vertices);
    EXPECT_EQ(poses.connectivity->NumTriangles(), c.triangles);
    EXPECT_EQ(poses.warnings, std::vector<std::string>());
    const Topology topology = ComputeTopology(*poses.connectivity);
    EXPECT_TRUE(topology.manifold);
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.genus, 0);
    EXPECT_EQ(static_cast<int>(topology.boundary_loops.size()), c.loops);
  }
}

TEST_F(RealDataTest, DefectsAreNamedAndCanBeAllowed) {
  const std::vector<std::string> camel = Files("camel_nonmanifold", {"reference", "01"});
  ExpectError<MeshError>([&] { ReadPoses(camel); },
                         {"reference.obj: edges with more than two polygons (26): edge 6394-6417",
                          "surface touch (3): vertex 19857 (line 19857)", "or allow it"});
  ReadOptions allow;
  allow.allow_nonmanifold = true;
  EXPECT_EQ(ReadPoses(camel, allow).warnings.size(), 3u);
  ExpectError<MeshError>([&] { ReadPoses(Files("bad/head_nonmanifold_vertex", {"reference"})); },
                         {"surface touch (4): vertex 1368 (line 1368)"});
  ExpectError<MeshError>([&] { ReadPoses(Files("bad/lowpoly_cat_nonmanifold", {"01"})); },
                         {"edges with more than two polygons (4): edge 54-55"});
}

TEST_F(RealDataTest, WrongCorrespondenceThatCountsDoNotShow) {
  const Poses poses = ReadPoses(Files("bad/face_broken", {"reference", "01"}));
  ASSERT_EQ(poses.warnings.size(), 1u);
  EXPECT_NE(poses.warnings[0].find("01.obj"), std::string::npos);
  EXPECT_NE(poses.warnings[0].find("vertex 22942 (line 22942)"), std::string::npos)
      << poses.warnings[0];
}

TEST_F(RealDataTest, DifferentAnimalsAreRefused) {
  ExpectError<MismatchError>(
      [&] {
        ReadPoses({Files("cat", {"reference"})[0], Files("lion", {"reference"})[0]});
      },
      {"5000 vertices instead of 7207"});
}

}  // namespace
}  // namespace shapespace
