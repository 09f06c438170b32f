#include <filesystem>
#include <regex>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/path/path_file.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

/// Messages of all tools: what was typed, and the flags and files that go with it.
class MessagesTest : public ToolsTest {
 protected:
  // Expects that a run fails with one message, which names these parts, and writes nothing.
  void ExpectMessage(int code, const std::string& tool, const Strings& arguments,
                     const Strings& parts) const {
    const Strings before = Files();
    const Outcome outcome = Run(tool, arguments);
    SCOPED_TRACE(outcome.err);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.find(tool + ": "), 0u);
    for (const std::string& part : parts) ExpectContains(outcome.err, part);
    const std::string help = code == 2 ? "Try " + tool + " --help\n" : "";
    const size_t end = outcome.err.find('\n');
    ASSERT_NE(end, std::string::npos);
    EXPECT_EQ(outcome.err.substr(end + 1), help);
    EXPECT_EQ(Files(), before);
  }
  void MakeWalk() const {
    MakeTubes(200);
    Succeed("shape-interpolate",
            {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "walk.path"});
  }
  Shape Vertices(const std::string& file) const { return ReadSoup(Path(file)).vertices; }
};

TEST_F(MessagesTest, OfAverage) {
  MakeTubes(200);
  const auto expect = [&](const Strings& arguments, const Strings& parts) {
    ExpectMessage(2, "shape-average", arguments, parts);
  };
  expect({}, {"poses"});
  expect({"tube0.obj", "--output", ", ,"}, {"--output: "});
  expect({"tube0.obj", "--output", "a.glb"}, {"--output a.glb: ", ".obj", ".mdd"});
  expect({"tube0.obj", "--output", "tube0.obj"}, {"--output tube0.obj ", "overwrite tube0.obj"});
  std::filesystem::create_directory(Path("a.obj"));
  ExpectMessage(1, "shape-average", {"tube0.obj", "--output", "a.obj"}, {"a.obj"});
}

TEST_F(MessagesTest, OfBody) {
  const auto expect = [&](const Strings& arguments, const Strings& parts) {
    ExpectMessage(2, "shape-body", arguments, parts);
  };
  expect({"bar", "--output", "a.glb"}, {"--output a.glb: ", ".obj", ".stl"});
  expect({"bar", "--output", "a.obj"}, {"--output a.obj: ", "%03d.obj"});
  expect({"quadruped", "--random", "2", "--at", "0"}, {"--random excludes --at", "--pose"});
  expect({"bar", "--triangles", "99999999"},
         {"--triangles 99999999: ", "99999999", "0", "10000000"});
}

TEST_F(MessagesTest, OfCorrespond) {
  MakeTubes(200);
  const auto expect = [&](const Strings& arguments, const Strings& parts) {
    ExpectMessage(2, "shape-correspond", arguments, parts);
  };
  expect({"tube0.obj"}, {"template", "target"});
  File("m.txt", "1 1\n");
  const Strings run = {"tube0.obj", "tube1.obj", "--markers", "m.txt", "--output"};
  const auto with = [&](const std::string& output) {
    Strings arguments = run;
    arguments.push_back(output);
    return arguments;
  };
  expect(with("a.glb"), {"--output a.glb: ", ".obj", ".png"});
  expect(with(","), {"--output: "});
  expect(with("tube1.obj"), {"--output tube1.obj ", "overwrite tube1.obj"});
  expect(with("m.txt"), {"--output m.txt ", "overwrite m.txt"});
  expect({"tube0.obj", "tube1.obj", "--markers", "a,b,c"}, {"--markers: "});
  expect({"tube0.obj", "tube1.obj", "--markers", ",a"}, {"--markers: "});
}

TEST_F(MessagesTest, OfExport) {
  MakeWalk();
  const auto expect = [&](int code, const Strings& more, const Strings& parts) {
    Strings arguments = {"walk.path", "--output", "e%d.ply"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectMessage(code, "shape-export", arguments, parts);
  };
  ExpectMessage(2, "shape-export", {}, {".path"});
  ExpectMessage(2, "shape-export", {"walk.path", "walk.path"}, {".path"});
  ExpectMessage(2, "shape-export", {"walk.path", "-o", "w.glb,x.PATH"}, {"--output x.PATH: "});
  expect(2, {"--ease"}, {"--ease", "--frames", ".glb"});
  expect(2, {"--at", ".5", "--frames", "3"}, {"--at and --frames: "});
  expect(2, {"--frames", "1"}, {"--frames 1: ", "2"});
  expect(2, {"--frames=-3"}, {"--frames -3: ", "2"});
  expect(2, {"--memory_limit", "0"}, {"--memory_limit 0: "});
  expect(2, {"--at", ".5,x"}, {"--at .5,x: ", "'x'"});
  expect(2, {"--at", ".5,,1"}, {"--at .5,,1: ", "''"});
  expect(2, {"--at", "inf"}, {"--at inf: ", "'inf'"});
  expect(2, {"--ground_line", "1,2"}, {"--ground_line 1,2: "});
  expect(2, {"--up", "w"}, {"--up w: "});
  expect(2, {"--loop", "--once"}, {"--loop and --once"});
}

TEST_F(MessagesTest, OfFramesAndTimes) {
  MakeWalk();
  const Outcome eased =
      Run("shape-export", {"walk.path", "--frames", "5", "--ease", "-o", "e%d.ply"});
  EXPECT_EQ(eased.out, "5 shapes of walk.path\nwrote e0.ply .. e4.ply\n");
  // A quarter of the time is (1 - cos(pi / 4)) / 2 of the way.
  Succeed("shape-export", {"walk.path", "--at", "0.14644660940672624,0.5", "-o", "at%d.ply"});
  EXPECT_LT((Vertices("e1.ply") - Vertices("at0.ply")).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((Vertices("e2.ply") - Vertices("at1.ply")).cwiseAbs().maxCoeff(), 1e-6);
  // 65 frames are more than an animation holds.
  const Outcome many = Run("shape-export", {"walk.path", "--frames", "65", "-o", "m.glb"});
  EXPECT_EQ(many.out, "65 shapes of walk.path\nwrote m.glb\n");
  EXPECT_EQ(many.err,
            "note: m.glb: 32 of the 65 shapes, evenly spaced, because players do not support "
            "more\n");
  const Outcome coloured =
      Run("shape-export", {"walk.path", "--color", "deviation", "-o", "c%d.obj"});
  EXPECT_EQ(coloured.code, 0);
  ExpectContains(coloured.err, "note: c%d.obj: the last colour stands for a deviation of ");
  const double end = std::stod(coloured.err.substr(coloured.err.find(" of ", 50) + 4));
  const auto extras = [&] {
    Succeed("shape-export", {"walk.path", "--color", "deviation", "-o", "c.glb"});
    const std::string glb = Content(Path("c.glb"));
    return std::stod(glb.substr(glb.find("\"last_colour_deviation\":") + 24));
  }();
  EXPECT_GT(extras, 0);
  EXPECT_LT(extras, 1);
  EXPECT_GE(100 * extras, end / 3);
  EXPECT_LE(100 * extras, 3 * end);
}

TEST_F(MessagesTest, OfExplore) {
  MakeTubes(200);
  const auto expect = [&](const Strings& arguments, const Strings& parts) {
    ExpectMessage(2, "shape-explore", arguments, parts);
  };
  const Strings poses = {"tube0.obj", "tube1.obj"};
  const auto with = [&](const Strings& more) {
    Strings arguments = poses;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expect({}, {".space"});
  expect(with({"--output", "a.obj"}), {"--output a.obj: ", ".space", ".csv"});
  expect(with({"--threshold", "1,2"}), {"--threshold 1,2: "});
  expect(with({"--threshold", "%"}), {"--threshold %: "});
  expect(with({"--threshold", ""}), {"--threshold : "});
  expect(with({"--measure=-1"}), {"--measure -1: ", "0"});
  expect(with({"--frames", "3"}), {"--frames: ", "--sample"});
  expect(with({"--sample", "c.json"}), {"--sample: ", ".space"});
  expect({"a.space"}, {"a.space", "--sample", "--measure"});
  expect({"a.space", "--sample", "c.json"}, {"--sample: ", "--output", ".glb"});
  expect({"a.space", "--sample", "c.json", "-o", "a.glb", "--lambda", "1"},
         {"--lambda: ", "--sample"});
  expect({"a.space", "--sample", "c.json", "-o", "a.glb", "--tolerance", "0.1"},
         {"--tolerance: ", "--sample"});
  expect({"a.space", "--sample", "c.json", "-o", "a.glb", "--resolution", "9"},
         {"--resolution: ", "--sample"});
  expect({"a.space", "--sample", "c.json", "-o", "a.path"}, {"--output a.path: "});
  expect({"a.space", "--sample", "c.json", "-o", "a.glb", "--frames", "0"}, {"--frames 0: ", "1"});
  for (const char* flag : {"depth", "output", "report", "stiffeners"}) {
    const std::string value = flag == std::string("depth") ? "3" : "x.json";
    expect({"a.space", "--measure", "5", "--" + std::string(flag), value},
           {"--" + std::string(flag) + ": ", "a.space"});
  }
  expect(with({"-o", "d.csv", "--threshold", "1%"}), {"--threshold: ", ".space"});
  expect(with({"-o", "d.csv", "--report", "r.json"}), {"--report: ", ".space"});
}

TEST_F(MessagesTest, OfStatistics) {
  MakeTubes(200);
  const auto expect = [&](const Strings& more, const Strings& parts) {
    Strings arguments = {"tube0.obj", "tube1.obj"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectMessage(2, "shape-statistics", arguments, parts);
  };
  expect({"--fit"}, {"--fit: ", "--coordinates", "--assess"});
  expect({"--seed", "3"}, {"--seed 3: ", "--sample", "--scalars", "--groups", "--assess"});
  expect({"--seed", "3", "--at", "1", "-o", "a.obj"},
         {"--seed 3: ", "--sample", "--scalars", "--groups", "--assess"});
  expect({"--predict", "1", "--groups", "g.csv"}, {"--predict 1: ", "--scalars"});
  expect({"--permutations", "9", "--assess"}, {"--permutations 9: ", "--scalars", "--groups"});
  expect({"--sample", "0"}, {"--sample 0: ", "1"});
  expect({"--sample", "1", "--seed=-1"}, {"--seed -1: ", "0"});
  expect({"--groups", "g.csv", "--scalars", "s.csv"}, {"--scalars and --groups: "});
  expect({"--at", "1", "-o", "a.csv"}, {"--output a.csv: ", ".obj", ".stl"});
  expect({"--scalars", "s.csv", "--predict", "1", "-o", "a.html"},
         {"--output a.html: ", ".obj", ".stl"});
  expect({"--scalars", "s.csv", "-o", "a.obj"}, {"--output a.obj: ", ".html", "--predict", ".stl"});
  expect({"--sample", "2", "-o", "a%d.glb"}, {"--output a%d.glb: ", ".obj", ".csv"});
  expect({"--sample", "2", "-o", "a.obj"}, {"--output a.obj: ", "%03d.obj"});
  expect({"--sample", "2"}, {"--output: ", "shape.obj"});
  expect({"--at", "1", "-o", ","}, {"--output: ", "shape.obj"});
  expect({"--coordinates", "tube0.obj", "-o", "a.obj"}, {"--output a.obj: ", ".csv"});
  expect({"--groups", "g.csv", "-o", "a.csv"}, {"--output: ", "--groups", "--report"});
  expect({"--assess", "-o", "a.csv"}, {"--output: ", "--assess", "--report"});
  expect({"-o", "a.glb"}, {"--output a.glb: ", "%03d.obj"});
  expect({"-o", "a.obj"}, {"--output a.obj: ", ".modes", ".mdd"});
  expect({"--sample", "2", "-o", "tube%d.obj"}, {"--output tube%d.obj: ", "overwrite tube0.obj"});
}

TEST_F(MessagesTest, OfStatisticsOfModes) {
  Succeed("shape-body", {"tube", "--triangles", "200", "--at", "0,40,90", "-o", "tube%d.obj"});
  Succeed("shape-statistics", {"tube0.obj", "tube1.obj", "tube2.obj", "-o", "t.modes"});
  const auto refuse = [&](const Strings& more, const std::string& flag) {
    Strings arguments = {"t.modes"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectMessage(2, "shape-statistics", arguments, {"--" + flag + ": ", "t.modes"});
  };
  refuse({"--size", "remove"}, "size");
  refuse({"--nocertify"}, "certify");
  refuse({"--refine"}, "refine");
  refuse({"--strict"}, "strict");
  refuse({"--bending", "1"}, "bending");
  File("s.csv", "pose,age\ntube0,1\ntube1,2\ntube2,4\n");
  for (const auto& [value, warning] :
       {std::pair{"1", ""},
        {"4", ""},
        {"0.5", "warning: age = 0.5 is outside of the poses' range, 1 to 4\n"},
        {"4.5", "warning: age = 4.5 is outside of the poses' range, 1 to 4\n"}}) {
    const Outcome outcome = Run(
        "shape-statistics", {"t.modes", "--scalars", "s.csv", "--predict", value, "-o", "p.obj"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, warning) << value;
    ExpectContains(outcome.out, "wrote p.obj\n");
  }
  const Outcome far = Run("shape-statistics", {"t.modes", "--at=0,-3.25", "-o", "far.obj"});
  EXPECT_EQ(far.err,
            "warning: a coordinate is 3.25 standard deviations from the mean; the poses say little "
            "about shapes that far\n");
  EXPECT_EQ(Run("shape-statistics", {"t.modes", "--at", "3,-3", "-o", "far.obj"}).err, "");
  // Samples are numbered, and of seeds that follow one another.
  Succeed("shape-statistics", {"t.modes", "--sample", "3", "--seed", "5", "-o", "a%d.ply,a.csv"});
  Succeed("shape-statistics", {"t.modes", "--sample", "1", "--seed", "7", "-o", "b%d.ply,b.csv"});
  EXPECT_EQ(Content(Path("a2.ply")), Content(Path("b0.ply")));
  const std::string table = Content(Path("a.csv")), row = Content(Path("b.csv"));
  EXPECT_EQ(table.rfind("pose,mode 1,mode 2\n0,", 0), 0u);
  EXPECT_EQ(table.substr(table.find("\n2,") + 2), row.substr(row.find("\n0,") + 2));
  // One mode only, and none.
  const Outcome one = Run("shape-statistics", {"t.modes", "--modes", "1", "-o", "m%d.glb"});
  EXPECT_EQ(one.out, "wrote m1.glb\n");
  const Outcome none = Run("shape-statistics", {"t.modes", "--modes", "0", "-o", "m.png,c.csv"});
  EXPECT_EQ(none.code, 1);
  EXPECT_EQ(none.err, "shape-statistics: m.png: there are no modes to show\n");
  EXPECT_EQ(none.out, "wrote c.csv\n");
  const Outcome coordinates =
      Run("shape-statistics", {"t.modes", "--coordinates", "tube1.obj,tube2.obj", "-o", "n.csv"});
  EXPECT_EQ(coordinates.code, 0) << coordinates.err;
  EXPECT_EQ(Content(Path("n.csv")).rfind("pose,mode 1,mode 2,distance\ntube1,", 0), 0u);
  ExpectContains(coordinates.out, "tube1: ");
  ExpectContains(coordinates.out, "tube2: ");
  ExpectContains(coordinates.out, " away (rms)\nwrote n.csv\n");
}

TEST_F(MessagesTest, OfTransport) {
  MakeTubes(200);
  ExpectMessage(2, "shape-transport", {"tube0.obj", "tube1.obj"}, {".path"});
  ExpectMessage(2, "shape-transport", {"a.path", "b.obj", "--tolerance", "0.1"},
                {"--tolerance: ", ".path"});
  ExpectMessage(2, "shape-transport", {"a.path", "b.obj", "--steps", "1"}, {"--steps", "2"});
  const Outcome outcome =
      Run("shape-transport", {"tube0.obj", "tube0.obj", "tube1.obj", "--steps", "2", "-o",
                              "there.ply,there%d.ply", "--tangents", "t.csv", "--report", "r.txt"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out,
                 "wrote there.ply\nwrote there0.ply .. there2.ply\nwrote t.csv\nwrote r.txt\n");
  EXPECT_EQ(Vertices("there.ply"), Vertices("there2.ply"));
  const std::string table = Content(Path("t.csv"));
  EXPECT_EQ(table.rfind("pose,first_x,first_y,first_z,last_x,last_y,last_z\n1,", 0), 0u);
  ExpectContains(table, "\n" + std::to_string(Vertices("tube0.obj").cols()) + ",");
}

TEST_F(MessagesTest, OfInterpolateAndTheCommandLine) {
  MakeTubes(200);
  const auto expect = [&](const Strings& more, const Strings& parts) {
    Strings arguments = {"tube0.obj", "tube1.obj"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectMessage(2, "shape-interpolate", arguments, parts);
  };
  expect({"-shapes", "0"}, {"--shapes 0: ", "1"});
  expect({"--max-iterations", "0"}, {"--max_iterations 0: ", "1"});
  expect({"-o", "a.path,b%d.path"}, {"--output b%d.path: ", ".vtp", ".path"});
  expect({"--avoid_contact", "--obstacle", "tube0.obj", "--anchor", "{\"vertices\": [1]}"},
         {"--anchor", "--obstacle"});
  expect({"--progress", "much"}, {"--progress much: "});
  // The last of several wins, and what is given as the default is not given.
  const Outcome outcome = Run("shape-interpolate", {"--shapes", "9", "tube0.obj", "--shapes=1",
                                                    "tube1.obj", "-o", "w.path"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(ReadPath(Path("w.path")).NumShapes(), 3);
  ExpectMessage(1, "shape-interpolate", {"tube0.obj", "tube1.obj", "-o", "tube0.obj/w.path"},
                {"tube0.obj/w.path: ", Path("tube0.obj") + " is not a folder"});
}

TEST_F(MessagesTest, OfMirroredTargets) {
  MakeWalk();
  const Soup tube = ReadSoup(Path("tube0.obj"));
  Succeed("shape-body", {"tube", "--triangles", "200", "--at", "25", "-o", "bent%d.ply"});
  Soup bent = ReadSoup(Path("bent0.ply"));
  bent.vertices.row(1) *= -1;
  WriteMesh(Path("flipped.ply"), bent.vertices, bent);
  const Outcome outcome = Run("shape-transport", {"walk.path", "flipped.ply", "--mirror", "y",
                                                  "--steps", "2", "-o", "a.ply"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.err,
                 "warning: flipped.ply: is a mirror image of the path's first shape; its y has "
                 "changed sign\n");
}

TEST_F(MessagesTest, OfPeriodicSplines) {
  Succeed("shape-body", {"tube", "--triangles", "200", "--at", "0,40,80", "-o", "t%d.obj"});
  // The way back to the first pose has frames too: 3 times 2, and the last.
  std::filesystem::rename(Path("t2.obj"), Path("f6.obj"));
  const Strings run = {"t0.obj", "t1.obj", "f6.obj", "--shapes", "1"};
  const auto with = [&](const Strings& more) {
    Strings arguments = run;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  ExpectMessage(2, "shape-interpolate", with({"--spline", "periodic", "-o", "f%d.obj"}),
                {"--output f%d.obj: ", "overwrite f6.obj"});
  const std::string part = R"([{"select": {"vertices": [1]}, "poses": [1, 4]}])";
  Succeed("shape-interpolate", with({"--spline", "periodic", "--anchor", part, "-o", "p.path"}));
  const shapespace::Path periodic = ReadPath(Path("p.path"));
  EXPECT_EQ(periodic.NumShapes(), 7);
  EXPECT_EQ(periodic.poses, (std::vector<int>{0, 2, 4, 6}));
  ExpectContains(periodic.provenance, "t0.obj t1.obj f6.obj");
  ExpectContains(periodic.provenance, "; standing parts held");
  Succeed("shape-interpolate", with({"-o", "f%d.ply"}));
  EXPECT_FALSE(std::filesystem::exists(Path("f5.ply")));
}

TEST_F(MessagesTest, OfHybrids) {
  MakeWalk();
  const std::string paint = Content(Path("tube0.obj"));
  File("target.obj",
       "mtllib paint.mtl\n" + std::string(paint).insert(paint.find("\nf ") + 1, "usemtl red\n"));
  const Outcome outcome =
      Run("shape-transfer", {"walk.path", "--target", "target.obj", "--ground", "y=2", "-o",
                             "t.path,t%d.obj", "--hybrids", "h.path,h%d.obj"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out,
                 "wrote t.path\nwrote t0.obj .. t4.obj\nwrote h.path\nwrote h0.obj .. h4.obj\n");
  const shapespace::Path path = ReadPath(Path("t.path")), hybrids = ReadPath(Path("h.path"));
  ExpectContains(path.provenance, ": walk.path target.obj; on the ground y=2");
  ExpectContains(hybrids.provenance, ": walk.path target.obj; hybrids; on the ground y=2");
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(path.Placed(i).row(1).minCoeff(), 2, 1e-9) << i;
    EXPECT_NEAR(hybrids.Placed(i).row(1).minCoeff(), 2, 1e-9) << i;
  }
  ExpectContains(Content(Path("t3.obj")), "usemtl red");
  ExpectContains(Content(Path("h3.obj")), "usemtl red");
}

TEST_F(MessagesTest, OfPValuesAndAssessments) {
  Succeed("shape-body", {"tube", "--triangles", "200", "--at", "0,30,60,100", "-o", "tube%d.obj"});
  Succeed("shape-statistics",
          {"tube0.obj", "tube1.obj", "tube2.obj", "tube3.obj", "--modes", "2", "-o", "t.modes"});
  File("g.csv", "pose,group\ntube0,a\ntube1,a\ntube2,b\ntube3,b\n");
  File("s.csv", "pose,age\ntube0,1\ntube1,2\ntube2,3\ntube3,5\n");
  const auto report = [&](Strings flags) {
    flags.insert(flags.begin(), "t.modes");
    flags.insert(flags.end(), {"--report", "r.json"});
    Succeed("shape-statistics", flags);
    // Without the times.
    return std::regex_replace(Content(Path("r.json")), std::regex("\"[a-z_]*seconds\": [^,\n]*"),
                              "");
  };
  // With one permutation a p-value is 1/2 or 1.
  report({"--groups", "g.csv", "--permutations", "1"});
  const auto groups = nlohmann::json::parse(Content(Path("r.json")));
  for (const char* name : {"t_squared_p", "distance_p"}) {
    const double p = groups[0][name];
    EXPECT_TRUE(p == 0.5 || p == 1) << name << ": " << p;
  }
  for (const Strings& question :
       {Strings{"--groups", "g.csv", "--permutations", "20"},
        Strings{"--scalars", "s.csv", "--permutations", "20"}, Strings{"--assess"}}) {
    const std::string first = report(question);
    EXPECT_EQ(report(question), first) << question[0];
    bool differs = false;
    for (const char* seed : {"2", "3", "4", "5"}) {
      Strings other = question;
      other.insert(other.end(), {"--seed", seed});
      differs = differs || report(other) != first;
    }
    EXPECT_TRUE(differs) << question[0];
  }
  EXPECT_NE(report({"--assess", "--fit"}), report({"--assess"}));
}

TEST_F(MessagesTest, OfAverages) {
  MakeTubes(200);
  const Outcome outcome = Run("shape-average", {"tube0.obj", "tube1.obj", "tube1.obj", "-o",
                                                "m.ply,m.pc2,m.png,m.obj", "--report", "r.txt"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string wrote = "wrote m.ply\nwrote m.pc2\nwrote m.png\nwrote m.obj\nwrote r.txt\n";
  EXPECT_EQ(outcome.out.substr(outcome.out.find('\n') + 1), wrote);
  // Weights are as good as repetitions.
  Succeed("shape-average", {"tube0.obj", "tube1.obj", "--weights", "1,2", "-o", "w.ply"});
  const Shape average = Vertices("m.ply");
  Succeed("shape-average", {"tube0.obj", "tube1.obj", "-o", "half.ply"});
  const double off = (Vertices("w.ply") - average).norm();
  EXPECT_LT(off, 1e-3 * average.norm());
  EXPECT_LT(20 * off, (Vertices("half.ply") - average).norm());
  const std::string cache = Content(Path("m.pc2"));
  const auto size = static_cast<size_t>(average.size());
  ASSERT_EQ(cache.size(), 32 + 4 * size);
  const Eigen::Map<const Eigen::VectorXf> stored(reinterpret_cast<const float*>(cache.data() + 32),
                                                 average.size());
  EXPECT_EQ(stored, average.reshaped().cast<float>());
}

// The last frame of each tool counts, and the one after it does not.
TEST_F(MessagesTest, OfFramesThatWouldOverwriteWhatIsRead) {
  MakeWalk();
  const std::string pose = Content(Path("tube1.obj"));
  for (int i = 1; i <= 5; ++i) File("f" + std::to_string(i) + ".obj", pose);
  File("h.json", R"({"handles": [{"fixed": true, "select": {"vertices": [1]}}]})");
  const auto refused = [&](const std::string& tool, Strings arguments, const std::string& file) {
    arguments.insert(arguments.end(), {"-o", "f%d.obj"});
    ExpectMessage(2, tool, arguments, {"--output f%d.obj: ", "overwrite " + file});
  };
  refused("shape-interpolate", {"tube0.obj", "f4.obj", "--shapes", "3"}, "f4.obj");
  refused("shape-extrapolate", {"tube0.obj", "f5.obj", "--shapes", "2", "--steps", "2"}, "f5.obj");
  refused("shape-extrapolate",
          {"tube0.obj", "f3.obj", "--shapes", "7", "--keep", "2", "--steps", "2"}, "f3.obj");
  refused("shape-deform", {"f1.obj", "--handles", "h.json"}, "f1.obj");
  refused("shape-deform", {"f3.obj", "--handles", "h.json", "--shapes", "3"}, "f3.obj");
  refused("shape-transport", {"tube0.obj", "tube1.obj", "f2.obj", "--steps", "2"}, "f2.obj");
  refused("shape-statistics", {"tube0.obj", "f3.obj", "--sample", "4"}, "f3.obj");
  refused("shape-transfer", {"tube0.obj", "tube1.obj", "tube1.obj", "--target", "f2.obj"},
          "f2.obj");
  const auto written = [&](const std::string& tool, Strings arguments) {
    arguments.insert(arguments.end(), {"-o", "f%d.obj"});
    const Outcome outcome = Run(tool, arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (int i = 1; i <= 5; ++i) File("f" + std::to_string(i) + ".obj", pose);
  };
  written("shape-interpolate", {"tube0.obj", "f5.obj", "--shapes", "3"});
  written("shape-extrapolate",
          {"tube0.obj", "f4.obj", "--shapes", "2", "--keep", "2", "--steps", "2"});
  written("shape-transport", {"tube0.obj", "tube0.obj", "f3.obj", "--steps", "2"});
}

// What another tool cures is said with the command.
TEST_F(MessagesTest, NameTheToolThatHelps) {
  MakeTubes();
  const auto expect = [&](const std::string& tool, const Strings& arguments, const Strings& parts) {
    const Outcome outcome = Run(tool, arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    for (const std::string& part : parts) ExpectContains(outcome.err, part);
  };
  const Outcome mesh = Run("shape-export", {"tube0.obj"});
  EXPECT_EQ(mesh.code, 1);
  ExpectContains(mesh.err, "shape-interpolate tube0.obj");
  expect("shape-deform", {"tube0.obj"}, {"--handles", "shape-view tube0.obj"});
  expect("shape-interpolate", {"tube0.obj", "tube1.obj", "a.png"}, {"--output a.png"});
  expect("shape-interpolate", {"tube0.obj", "tube1.obj", "--frames", "3"}, {"shape-export"});
  expect("shape-interpolate", {"tube0.obj", "tube1.obj", "--shape", "3"}, {"--shapes"});
  expect("shape-interpolate", {"tube0.obj", "tube1.obj", "--avoid-contac"}, {"--avoid_contact"});
  // What is near to no flag is no hint.
  EXPECT_EQ(Run("shape-export", {"--zzzzzz"}).err.find("--zzzzzz"),
            Run("shape-export", {"--zzzzzz"}).err.rfind("--z"));
}

}  // namespace
}  // namespace shapespace
