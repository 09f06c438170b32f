#include <cmath>
#include <cstdio>
#include <fstream>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/path/path_file.h>

#include "mesh/bodies.h"
#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

std::string Numbered(const char* pattern, int i) {
  char name[64];
  std::snprintf(name, sizeof name, pattern, i);
  return name;
}

/// The largest distance along an axis, as a share of the extent of `b`.
double Apart(const Shape& a, const Shape& b) {
  const double extent = (b.rowwise().maxCoeff() - b.rowwise().minCoeff()).maxCoeff();
  return (a - b).cwiseAbs().maxCoeff() / extent;
}

class InterpolateTest : public ToolsTest {
 protected:
  Shape Vertices(const std::string& file) const { return ReadSoup(Path(file)).vertices; }

  /// The report of a run on the tubes with these additional flags.
  nlohmann::json Report(Strings flags) const {
    flags.insert(flags.begin(), {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "w.path",
                                 "--report", "-"});
    const Outcome outcome = Run("shape-interpolate", flags);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

  /// Writes two poses of `soup`.
  void WritePoses(const Soup& soup, const Shape& other) const {
    WriteMesh(Path("a.obj"), soup.vertices, soup);
    WriteMesh(Path("b.obj"), other, soup);
  }
};

TEST_F(InterpolateTest, MainJob) {
  MakeTubes();
  const Outcome outcome =
      Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "15", "--output",
                                "walk.path,walk.png,frames/%03d.obj", "--report", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  Strings wanted = {"frames"};
  for (int i = 0; i <= 16; ++i) wanted.push_back(Numbered("frames/%03d.obj", i));
  wanted.insert(wanted.end(), {"tube0.obj", "tube1.obj", "walk.path", "walk.png"});
  EXPECT_EQ(Files(), wanted);

  constexpr double kNineDigits = 1e-9;
  EXPECT_LE(Apart(Vertices("frames/000.obj"), Vertices("tube0.obj")), kNineDigits);
  EXPECT_LE(Apart(Vertices("frames/016.obj"), Vertices("tube1.obj")), kNineDigits);

  const shapespace::Path path = ReadPath(Path("walk.path"));
  ASSERT_EQ(path.NumShapes(), 17);
  EXPECT_EQ(path.poses, (std::vector<int>{0, 16}));
  for (int i = 0; i <= 16; ++i) {
    EXPECT_LE(Apart(Vertices(Numbered("frames/%03d.obj", i)), path.Placed(i)), kNineDigits) << i;
  }
  ExpectContains(path.provenance, "tube0.obj tube1.obj");

  const std::string picture = Content(Path("walk.png"));
  ASSERT_GT(picture.size(), 1000u);
  EXPECT_EQ(picture.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(picture.substr(picture.size() - 8, 4), "IEND");

  const nlohmann::json report = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << outcome.out;
  EXPECT_EQ(report["converged"], true);
  EXPECT_EQ(report["vertices"], 152);
  EXPECT_EQ(report["shapes"], 15);
  EXPECT_GE(report["ratio"], 1.0);
  ExpectContains(outcome.err, "converged: 152 vertices, 2 poses, 15 shapes inserted");
}

TEST_F(InterpolateTest, ReportsGoWhereTheyAreSent) {
  MakeTubes();
  for (const char* file : {"r.json", "r.txt"}) {
    const Outcome outcome = Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3",
                                                      "--output", "w.path", "--report", file});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ExpectContains(outcome.out, "converged: 152 vertices");
    ExpectQuiet(outcome);
  }
  EXPECT_EQ(nlohmann::json::parse(Content(Path("r.json")))["converged"], true);
  ExpectContains(Content(Path("r.txt")), "Lower bound ");
}

TEST_F(InterpolateTest, PlyFramesKeepAllDigits) {
  MakeTubes();
  Succeed("shape-interpolate",
          {"tube0.obj", "tube1.obj", "--shapes", "2", "--output", "w.path,%d.ply"});
  const shapespace::Path path = ReadPath(Path("w.path"));
  for (int i = 0; i < 4; ++i) {
    const Soup frame = ReadSoup(Path(Numbered("%d.ply", i)));
    EXPECT_TRUE(frame.vertices == path.Placed(i)) << i;
    EXPECT_EQ(frame.corners, ReadSoup(Path("tube0.obj")).corners);
  }
}

TEST_F(InterpolateTest, ThreePosesArePassedThrough) {
  Succeed("shape-body",
          {"tube", "--triangles", "300", "--at", "0,60,30", "--output", "tube%d.obj"});
  Succeed("shape-interpolate",
          {"tube0.obj", "tube1.obj", "tube2.obj", "--shapes", "3", "--output", "w.path,f%d.obj"});
  const shapespace::Path path = ReadPath(Path("w.path"));
  EXPECT_EQ(path.NumShapes(), 9);
  EXPECT_EQ(path.poses, (std::vector<int>{0, 4, 8}));
  EXPECT_DOUBLE_EQ(path.parameters[4], 0.5);
  for (int pose = 0; pose < 3; ++pose) {
    EXPECT_LE(
        Apart(Vertices(Numbered("f%d.obj", 4 * pose)), Vertices(Numbered("tube%d.obj", pose))),
        1e-9);
  }
}

TEST_F(InterpolateTest, AWayRoundContactLeadsNearOtherShapes) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "1", "--output", "m%d.obj"});
  const nlohmann::json free = Report({"--avoid_contact"});
  EXPECT_EQ(free["uncertified_segments"], 0);
  EXPECT_EQ(free["crossings_between"], 0);
  const nlohmann::json via = Report({"--avoid_contact", "--via", "m1.obj,m1.obj"});
  EXPECT_EQ(via["uncertified_segments"], 0);
  EXPECT_EQ(via["poses"], 2);
  EXPECT_NEAR(via["ratio"], free["ratio"], 0.02);
  EXPECT_EQ(ReadPath(Path("w.path")).NumShapes(), 5);
  EXPECT_EQ(Report({})["uncertified_segments"], -1);
}

TEST_F(InterpolateTest, APathAvoidsAnObstacle) {
  MakeTubes();
  std::ofstream(Path("floor.obj")) << "v -9 -9 -9\nv 9 -9 -9\nv 9 9 -9\nv -9 9 -9\nf 1 2 3 4\n";
  const nlohmann::json past = Report({"--avoid_contact", "--obstacle", "floor.obj"});
  EXPECT_EQ(past["uncertified_segments"], 0);
  EXPECT_TRUE(past["warnings"].empty());
  // Another tube, which stands within the way.
  const nlohmann::json within = Report({"--avoid_contact", "--obstacle", "tube1.obj"});
  EXPECT_FALSE(within["warnings"].empty());
}

TEST_F(InterpolateTest, SplinesAreSmoothAtThePoses) {
  Succeed("shape-body",
          {"tube", "--triangles", "300", "--at", "0,60,30,90", "--output", "tube%d.obj"});
  const Strings poses = {"tube0.obj", "tube1.obj", "tube2.obj", "tube3.obj", "--shapes", "7"};
  const auto run = [&](Strings flags) {
    flags.insert(flags.begin(), poses.begin(), poses.end());
    flags.insert(flags.end(), {"--output", "w.path", "--report", "-"});
    const Outcome outcome = Run("shape-interpolate", flags);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  };
  for (const std::string ends : {"natural", "clamped", "not_a_knot", "periodic"}) {
    const nlohmann::json report = run({"--spline", ends});
    EXPECT_EQ(report["ends"], ends);
    EXPECT_EQ(report["smooth"], true);
    EXPECT_GT(report["jump_before"], 1.0);
    EXPECT_LT(report["jump_after"], 0.2) << ends;
    const shapespace::Path path = ReadPath(Path("w.path"));
    EXPECT_TRUE(path.smooth);
    const Strings names = {"tube0.obj", "tube1.obj", "tube2.obj", "tube3.obj", "tube0.obj"};
    ASSERT_EQ(path.poses.size(), ends == "periodic" ? 5u : 4u);
    for (size_t i = 0; i < path.poses.size(); ++i) {
      EXPECT_LE(Apart(path.Placed(path.poses[i]), Vertices(names[i])), 1e-9) << ends << i;
    }
  }
  const Outcome two = Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "7",
                                                "--spline", "natural", "--output", "w.path"});
  EXPECT_EQ(two.code, 0);
  ExpectContains(two.err, "only two poses: the motion is the geodesic");
  EXPECT_FALSE(ReadPath(Path("w.path")).smooth);
  run({"--spline", "natural", "--times", "0,1,3,8"});
  EXPECT_NEAR(ReadPath(Path("w.path")).parameters[8], 0.125, 1e-12);
  run({"--spline", "natural", "--times", "length"});
  const std::vector<double> times = ReadPath(Path("w.path")).parameters;
  EXPECT_GT(times[8] - times[0], 1.8 * (times[16] - times[8]));
}

TEST_F(InterpolateTest, PartsThatStandAreHeldInAllShapes) {
  Succeed("shape-body",
          {"tube", "--triangles", "300", "--at", "0,60,30", "--output", "tube%d.obj"});
  const std::string parts =
      R"([{"name": "root", "select": {"vertices": [[1, 12]]}, "poses": [1, 3]},
          {"select": {"vertices": [[100, 110]]}, "poses": [[2, 3]]}])";
  const Strings run = {"tube0.obj", "tube1.obj", "tube2.obj", "--shapes", "3",     "--spline",
                       "natural",   "--anchor",  parts,       "--output", "w.path"};
  const Outcome outcome = Run("shape-interpolate", run);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "2 standing parts held in 6 shapes");
  const shapespace::Path path = ReadPath(Path("w.path"));
  ExpectContains(path.provenance, "; standing parts held");
  // Half way from pose to pose the parts are half way between their places there.
  const auto half = [&](int pose) -> Shape {
    return (path.Placed(4 * pose) + path.Placed(4 * pose + 4)) / 2 - path.Placed(4 * pose + 2);
  };
  EXPECT_LT(half(0).middleCols(0, 12).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(half(1).middleCols(0, 12).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(half(1).middleCols(99, 11).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(half(0).middleCols(99, 11).cwiseAbs().maxCoeff(), 1e-3);
}

TEST_F(InterpolateTest, GraphsStayGraphs) {
  // A straight stick of ten edges becomes an arc.
  std::string straight, bent, lines;
  for (int i = 0; i <= 10; ++i) {
    straight += "v " + std::to_string(i) + " 0 0\n";
    bent += "v " + std::to_string(5 * std::sin(0.2 * i)) + " " +
            std::to_string(5 - 5 * std::cos(0.2 * i)) + " 0\n";
    if (i > 0) lines += "l " + std::to_string(i) + " " + std::to_string(i + 1) + "\n";
  }
  File("a.obj", straight + lines);
  File("b.obj", bent + lines);
  const Outcome outcome = Run("shape-interpolate", {"a.obj", "b.obj", "--shapes", "3", "--output",
                                                    "w.png,%d.obj,%d.ply", "--report", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Soup input = ReadSoup(Path("a.obj"));
  for (const char* pattern : {"%d.obj", "%d.ply"}) {
    const Soup frame = ReadSoup(Path(Numbered(pattern, 2)));
    EXPECT_EQ(frame.segments, input.segments);
    EXPECT_EQ(frame.NumPolygons(), 0);
  }
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(report["triangles"], 0);
  EXPECT_EQ(report["edges"], 10);
  EXPECT_LE(report["quality"]["edge_max"], 0.01);
}

TEST_F(InterpolateTest, QuadsStayQuads) {
  const Soup cube = testing::Cube();
  Shape sheared = cube.vertices;
  sheared.row(0) += 0.3 * sheared.row(2);
  WritePoses(cube, sheared);
  Succeed("shape-interpolate", {"a.obj", "b.obj", "--shapes", "1", "--output", "%d.obj,%d.ply"});
  for (const char* file : {"1.obj", "1.ply"}) {
    const Soup frame = ReadSoup(Path(file));
    EXPECT_EQ(frame.polygon_begin, cube.polygon_begin) << file;
    EXPECT_EQ(frame.corners, cube.corners) << file;
  }
}

TEST_F(InterpolateTest, ObjFramesKeepTextureAndMaterialsAndPlySaysThatItDropsThem) {
  const std::string appearance =
      "vt 0 0\nvt 0.5 0\nvt 1 0\nvt 0 1\nvt 0.5 1\nvt 1 1\n"
      "usemtl red\nf 1/1 2/2 5/5 4/4\nusemtl blue\nf 2/2 3/3 6/6 5/5\n";
  File("a.obj",
       "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n" + appearance);
  File("b.obj",
       "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 1\nv 0 1 0\nv 1 1 0\nv 2 1 1\n" + appearance);
  const Outcome obj =
      Run("shape-interpolate", {"a.obj", "b.obj", "--shapes", "1", "--output", "%d.obj"});
  ASSERT_EQ(obj.code, 0) << obj.err;
  ExpectLacks(obj.err, "dropped");
  const std::string frame = Content(Path("1.obj"));
  EXPECT_EQ(frame.rfind("mtllib paint.mtl\n", 0), 0u) << frame;
  EXPECT_EQ(frame.substr(frame.find("vt ")), appearance);

  const Outcome ply =
      Run("shape-interpolate", {"a.obj", "b.obj", "--shapes", "1", "--output", "%d.ply"});
  ASSERT_EQ(ply.code, 0) << ply.err;
  ExpectContains(ply.err, "%d.ply: materials are dropped");
}

TEST_F(InterpolateTest, StiffenersHoldWhatTheyJoin) {
  // A book of two triangles, opened upwards in one pose and downwards in the other: it is flat on
  // the way, unless a stiffener connects the tips.
  const std::string faces = "f 1 2 3\nf 2 1 4\n";
  File("a.obj", "v 0 0 0\nv 0 1 0\nv -0.8 0.5 0.6\nv 0.8 0.5 0.6\n" + faces);
  File("b.obj", "v 0 0 0\nv 0 1 0\nv -0.8 0.5 -0.6\nv 0.8 0.5 -0.6\n" + faces);
  File("stiff.txt", "# tips\n3 4\n");
  const auto middle_span = [&](Strings flags) {
    flags.insert(flags.begin(),
                 {"a.obj", "b.obj", "--shapes", "1", "--bending", "0", "--output", "%d.obj"});
    Succeed("shape-interpolate", flags);
    const Shape middle = Vertices("1.obj");
    return (middle.col(2) - middle.col(3)).norm();
  };
  const double free = middle_span({}), held = middle_span({"--stiffeners", "stiff.txt"});
  EXPECT_GT(free, 1.95);  // twice the height 1 of a triangle, while 1.6 at both ends
  EXPECT_NEAR(held, 1.6, 0.02);
}

TEST_F(InterpolateTest, PresetsSetDefaultsAndGivenFlagsWin) {
  MakeTubes();
  EXPECT_EQ(Report({})["metric"], "strain 1, lambda 0.0001, bending 1e-05");
  EXPECT_EQ(Report({"--metric", "isometric"})["metric"],
            "isometric 1, lambda 0.0001, bending 1e-05");
  EXPECT_EQ(Report({"--metric", "paper"})["metric"],
            "isometric 1, lambda 0.001, uniform weights, trapezoid");
  // Given values override a preset, also if they are the defaults of another one.
  EXPECT_EQ(Report({"--metric", "paper", "--lambda", "1e-4", "--weighting", "area"})["metric"],
            "isometric 1, lambda 0.0001, trapezoid");
  const nlohmann::json rigid = Report({"--metric", "rigid"});
  EXPECT_EQ(rigid["metric"], "rigid 1, lambda 0.0001");
  EXPECT_TRUE(rigid["lower_bound"].is_null());
  EXPECT_EQ(Report({"--bending", "0", "--volume", "0.3", "--isometric", "2"})["metric"],
            "isometric 2, strain 1, lambda 0.0001, volume 0.3");
}

TEST_F(InterpolateTest, StiffnessIsOfStretchingAndOfBending) {
  MakeTubes();
  const shapespace::Poses tubes = ReadPoses({Path("tube0.obj"), Path("tube1.obj")});
  MetricOptions options;
  std::string lines;
  options.stretching_stiffness.resize(tubes.connectivity->NumVertices());
  for (int v = 0; v < options.stretching_stiffness.size(); ++v) {
    options.stretching_stiffness(v) = 1 + v % 5;
    lines += std::to_string(1 + v % 5) + "\n";
  }
  options.bending_stiffness = options.stretching_stiffness;
  File("stiff.txt", lines);
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "1", "--stiffness",
                                "stiff.txt", "--output", "w.path"});
  const auto metric = ReadPath(Path("w.path")).metric;
  const auto expected = FreezeMetric(options, tubes.connectivity, tubes.shapes);
  ASSERT_EQ(metric->features.size(), expected->features.size());
  for (size_t i = 0; i < metric->features.size(); ++i) {
    EXPECT_TRUE(metric->features[i]->Weights().isApprox(expected->features[i]->Weights(), 1e-12))
        << metric->features[i]->Name();
  }
}

TEST_F(InterpolateTest, ThreadsDoNotChangeAByte) {
  MakeTubes(2000);
  const Strings outputs = {"w.path", "w.png", "0.obj", "4.obj", "8.obj"};
  Strings content[2];
  for (int k = 0; k < 2; ++k) {
    Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "7", "--threads",
                                  std::to_string(k + 1), "--output", "w.path,w.png,%d.obj"});
    for (const std::string& file : outputs) content[k].push_back(Content(Path(file)));
  }
  for (size_t i = 0; i < outputs.size(); ++i) {
    EXPECT_TRUE(content[0][i] == content[1][i]) << outputs[i];
  }
}

TEST_F(InterpolateTest, ScaledPosesGiveScaledFrames) {
  MakeTubes();
  Succeed("shape-interpolate",
          {"tube0.obj", "tube1.obj", "--shapes", "7", "--output", "one%d.ply"});
  for (const double scale : {1e-4, 1e4}) {
    for (int pose = 0; pose < 2; ++pose) {
      const Soup soup = ReadSoup(Path(Numbered("tube%d.obj", pose)));
      WriteMesh(Path(Numbered("scaled%d.ply", pose)), scale * soup.vertices, soup);
    }
    Succeed("shape-interpolate",
            {"scaled0.ply", "scaled1.ply", "--shapes", "7", "--output", "%d.ply"});
    for (int i = 0; i < 9; ++i) {
      EXPECT_LE(Apart(Vertices(Numbered("%d.ply", i)), scale * Vertices(Numbered("one%d.ply", i))),
                1e-9)
          << "frame " << i << " at scale " << scale;
    }
  }
}

}  // namespace
}  // namespace shapespace
