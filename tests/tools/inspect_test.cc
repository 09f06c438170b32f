#include <filesystem>
#include <regex>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/files/write.h>

#include "mesh/bodies.h"
#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;
using testing::ToolsTest;

class InspectTest : public ToolsTest {};

TEST_F(InspectTest, TellsWhatIsInAMesh) {
  File("square.obj",
       "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvn 0 0 1\n"
       "f 1//1 2//1 3//1 4//1\n");
  const Outcome outcome = Run("shape-inspect", {"square.obj"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "4 vertices, 1 polygons, 0 segments, extent 2 x 1 x 0");
  ExpectContains(outcome.out, "boundary loops (1): 4 edges of length 6");
  ExpectContains(outcome.out, "genus 0");
  ExpectContains(outcome.out, "1 normals (vn) not kept");
}

TEST_F(InspectTest, WhatFollowsTwoDashesIsNoFlag) {
  MakeTubes();
  std::filesystem::rename(Path("tube1.obj"), Path("--other.obj"));
  const Outcome outcome = Run("shape-inspect", {"--", "tube0.obj", "--other.obj"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "--other.obj");
}

TEST_F(InspectTest, SeesThroughRigidMotion) {
  const Soup torus = testing::Torus(12, 8);
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(M_PI / 6, Eigen::Vector3d(1, 2, 3).normalized()));
  const Shape moved = (turn * torus.vertices).colwise() + Eigen::Vector3d(5, -7, 9);
  WriteMesh(Path("a.ply"), torus.vertices, torus);
  WriteMesh(Path("b.ply"), moved, torus);
  const Outcome outcome = Run("shape-inspect", {"a.ply", "b.ply"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "b.ply against a.ply");
  ExpectContains(outcome.out, "30 degrees");
  double apart = 1;
  const char* const key = "vertices apart       rms ";
  ASSERT_NE(outcome.out.find(key), std::string::npos) << outcome.out;
  sscanf(outcome.out.c_str() + outcome.out.find(key), "vertices apart rms %lf", &apart);
  EXPECT_LE(apart, 1e-9);
}

TEST_F(InspectTest, BadMeshesFailAndAreNamed) {
  File("fan.obj",
       "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\n"
       "f 1 2 3\nf 1 2 4\nf 2 1 5\n");
  const Outcome outcome = Run("shape-inspect", {"fan.obj"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.out, "non-manifold-edge");
  ExpectContains(outcome.out, "edge 1-2 of polygon 1 (line 6), polygon 2 (line 7) and polygon 3");
  ExpectContains(outcome.err, "not usable as it is");
}

TEST_F(InspectTest, PosesThatDoNotCorrespondFail) {
  MakeTubes(300);
  Succeed("shape-body", {"tube", "--triangles", "400", "--output", "other%d.obj"});
  const Outcome outcome = Run("shape-inspect", {"tube0.obj", "other1.obj"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.out, "vertex-count");
  ExpectContains(outcome.out, "other1.obj against tube0.obj");
}

TEST_F(InspectTest, MostEdgesMayKeepTheirLengthsAndTheFirstStretchMost) {
  // A row of squares, of which the second pose stretches the first alone.
  const auto row = [&](const char* name, double first) {
    std::string text;
    for (int i = 0; i < 20; ++i) {
      for (const int y : {0, 1}) {
        text += "v " + std::to_string(i == 0 ? first : i) + " " + std::to_string(y) + " 0\n";
      }
    }
    for (int i = 1; i < 20; ++i) {
      for (const int corner : {0, 2, 3, 1}) {
        text += (corner == 0 ? "f " : " ") + std::to_string(2 * i - 1 + corner);
      }
      text += "\n";
    }
    File(name, text);
  };
  row("rest.obj", 0);
  row("stretched.obj", -0.5);
  Succeed("shape-inspect", {"rest.obj", "stretched.obj", "--report", "r.json"});
  const auto comparison = nlohmann::json::parse(Content(Path("r.json")))["comparisons"][0];
  EXPECT_NEAR(comparison["stretch_median"].get<double>(), 0, 1e-9);
  EXPECT_NEAR(comparison["stretch_max"].get<double>(), 0.5, 1e-9);
}

TEST_F(InspectTest, TellsWhatIsInAPath) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "7", "--output", "w.path"});
  const Outcome outcome = Run("shape-inspect", {"w.path"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "9 shapes, 2 of them given; 152 vertices, 300 triangles");
  ExpectContains(outcome.out, "tube0.obj tube1.obj");
  ExpectContains(outcome.out, "strain 1, lambda 0.0001, bending 1e-05");
}

TEST_F(InspectTest, TellsPartsJointsAndCrossings) {
  Succeed("shape-body", {"tube", "--triangles", "1500", "--at", "0,110", "--output", "tube%d.obj"});
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "w.path"});
  const Outcome outcome = Run("shape-inspect", {"w.path"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(
      outcome.out,
      "crossings    pairs of triangles: poses up to 0; inner shapes 0, up to 0; 0 beyond");
  ExpectContains(outcome.out, "deviation    of edge lengths from the first pose");
  ExpectContains(outcome.out, "parts        3 move nearly rigidly");
  std::smatch joint;
  ASSERT_TRUE(std::regex_search(outcome.out, joint, std::regex("([0-9.]+)% of the surface is")));
  EXPECT_GT(std::stod(joint[1]), 2);
  EXPECT_LT(std::stod(joint[1]), 50);
}

TEST_F(InspectTest, TellsWhereAMeshPassesThroughItself) {
  // The apex of a pyramid, through a square below it.
  File("through.obj",
       "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\n"
       "v 1 2 1\nv 3 2 1\nv 2 3.5 1\nv 2.1 2.4 -1\n"
       "f 1 2 3\nf 1 3 4\nf 5 6 8\nf 6 7 8\nf 7 5 8\n");
  const Outcome through = Run("shape-inspect", {"through.obj"});
  EXPECT_EQ(through.code, 0) << through.err;
  std::smatch match;
  ASSERT_TRUE(
      std::regex_search(through.out, match, std::regex("([0-9]+) pairs of triangles cross")));
  EXPECT_GE(std::stoi(match[1]), 3);
  MakeTubes();
  const Outcome tube = Run("shape-inspect", {"tube0.obj"});
  EXPECT_TRUE(std::regex_search(tube.out, std::regex("self-intersections +none"))) << tube.out;
}

// Its crossings would tell nothing and take long to count.
TEST_F(InspectTest, OfAMeshThatDoesNotCorrespondTheCrossingsAreNotCounted) {
  MakeTubes();
  Succeed("shape-body", {"tube", "--triangles", "700", "--at", "50", "--output", "fine%d.obj"});
  const Outcome outcome =
      Run("shape-inspect", {"tube0.obj", "fine0.obj", "--report", "report.json"});
  EXPECT_EQ(outcome.code, 1);
  const auto report = nlohmann::json::parse(Content(Path("report.json")));
  EXPECT_EQ(report["files"][0]["intersections"], 0);
  EXPECT_EQ(report["files"][1]["usable"], false);
  EXPECT_EQ(report["files"][1].count("intersections"), 0u);
}

TEST_F(InspectTest, SeesForearmsThatPassThroughABody) {
  const std::string folder = std::string(SHAPESPACE_DATA_DIR) + "/scape/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real meshes";
  Succeed("shape-interpolate",
          {folder + "5.obj", folder + "6.obj", "--shapes", "7", "--output", "w.path"});
  const Outcome outcome = Run("shape-inspect", {"w.path"});
  std::smatch match;
  ASSERT_TRUE(std::regex_search(outcome.out, match,
                                std::regex("poses up to 0; .* ([0-9.]+) beyond the poses")))
      << outcome.out;
  EXPECT_GT(std::stod(match[1]), 10);
}

TEST_F(InspectTest, DamagedPathsFail) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "1", "--output", "w.path"});
  const std::string whole = testing::Content(Path("w.path"));
  File("cut.path", whole.substr(0, whole.size() / 2));
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 1;
  File("flipped.path", flipped);
  File("none.path", "a walk in the park\n");
  const struct {
    const char *file, *message;
  } cases[] = {
      {"cut.path", "damaged or was cut off"},
      {"flipped.path", "damaged or was cut off"},
      {"none.path", "this is not a .path file"},
      {"missing.path", "cannot be opened"},
  };
  for (const auto& [file, message] : cases) {
    const Outcome outcome = Run("shape-inspect", {file});
    EXPECT_EQ(outcome.code, 1) << file;
    ExpectContains(outcome.err, std::string(file) + ": ");
    ExpectContains(outcome.err, message);
    ExpectLacks(outcome.out, "shapes");
  }
}

TEST_F(InspectTest, NonManifoldMeshesPassIfAllowed) {
  const std::string faces = "f 1 2 3\nf 1 2 4\nf 2 1 5\n";
  File("fan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\n" + faces);
  File("fan2.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nv 0 -1 0\n" + faces);
  const Outcome refused = Run("shape-inspect", {"fan.obj", "fan2.obj"});
  EXPECT_EQ(refused.code, 1);
  ExpectContains(refused.out, "--allow_nonmanifold");
  ExpectLacks(refused.out, "edges stretched by");
  const Outcome allowed = Run("shape-inspect", {"fan.obj", "fan2.obj", "--allow_nonmanifold"});
  EXPECT_EQ(allowed.code, 0) << allowed.err;
  EXPECT_TRUE(std::regex_search(allowed.out, std::regex("warning +non-manifold-edge")))
      << allowed.out;
  ExpectContains(allowed.out, "edges stretched by");
}

TEST_F(InspectTest, AFileThatCannotBeReadDoesNotHideTheOthers) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "1", "--output", "w.path"});
  File("cut.path", "SHAPPATH");
  File("cut.obj", "v 0 0 0\nv 1 0\n");
  const Outcome outcome =
      Run("shape-inspect", {"cut.path", "cut.obj", "none.obj", "tube0.obj", "w.path", "tube1.obj"});
  EXPECT_EQ(outcome.code, 1);
  for (const char* file : {"cut.path: ", "cut.obj:2: ", "none.obj: "}) {
    ExpectContains(outcome.err, std::string("shape-inspect: ") + file);
  }
  ExpectContains(outcome.out, "3 shapes, 2 of them given");
  ExpectContains(outcome.out, "tube0.obj\n  152 vertices");
  ExpectContains(outcome.out, "tube1.obj\n  152 vertices");
  ExpectContains(outcome.out, "tube1.obj against tube0.obj");
}

TEST_F(InspectTest, ReportsWhatItPrints) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "5", "--output", "w.path"});
  const Outcome printed = Run("shape-inspect", {"w.path", "tube0.obj", "tube1.obj"});
  Succeed("shape-inspect", {"w.path", "tube0.obj", "tube1.obj", "--report", "r.txt"});
  EXPECT_EQ(Content(Path("r.txt")), printed.out);
  const Outcome outcome =
      Run("shape-inspect", {"w.path", "tube0.obj", "tube1.obj", "none.obj", "--report", "-"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "7 shapes, 2 of them given");  // as stdout has the report alone
  const auto report = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(report["files"].size(), 4u);
  const auto& path = report["files"][0];
  EXPECT_EQ(path["kind"], "path");
  EXPECT_EQ(path["shapes"], 7);
  EXPECT_EQ(path["intersections"]["pairs"].size(), 7u);
  const int vertices = report["files"][1]["vertices"];
  double area = path["joint_share"];
  for (const auto& part : path["parts"]) area += part["area_share"].get<double>();
  EXPECT_NEAR(area, 1, 1e-6);
  for (const auto& site : path["deviation_sites"]) {
    EXPECT_GE(site["vertex"], 1);
    EXPECT_LE(site["vertex"], vertices);
  }
  EXPECT_EQ(report["files"][1]["usable"], true);
  EXPECT_EQ(report["files"][1]["intersections"], 0);
  EXPECT_EQ(report["files"][3]["file"], "none.obj");
  ExpectContains(report["files"][3]["error"], "none.obj: ");
  ASSERT_EQ(report["comparisons"].size(), 1u);
  // The length of the path is no less than the bound.
  EXPECT_GT(report["comparisons"][0]["distance_at_least"], 0);
}

TEST_F(InspectTest, ReportsMeshesThatCannotServe) {
  File("fan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 2 1 5\n");
  const Outcome outcome = Run("shape-inspect", {"fan.obj", "--report", "-"});
  EXPECT_EQ(outcome.code, 1);
  const auto file = nlohmann::json::parse(outcome.out)["files"][0];
  EXPECT_EQ(file["usable"], false);
  bool found = false;
  for (const auto& finding : file["findings"]) {
    found =
        found || (finding["kind"] == "non-manifold-edge" && finding["severity"] == "non-manifold");
  }
  EXPECT_TRUE(found) << outcome.out;
}

TEST_F(InspectTest, NeedsAFile) {
  const Outcome outcome = Run("shape-inspect", {});
  EXPECT_EQ(outcome.code, 2);
  ExpectContains(outcome.err, "name one or more files");
}

}  // namespace
}  // namespace shapespace
