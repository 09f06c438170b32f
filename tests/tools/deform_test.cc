#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/mesh/volume.h>
#include <shapespace/path/path_file.h>

#include "output/read_glb.h"
#include "tools/run.h"

namespace shapespace {
namespace {

using nlohmann::json;
using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

// For the straight tube, which lies along x from -0.62 to 6.48.
constexpr char kRoot[] = R"({"halfspace": {"point": [0.5, 0, 0], "normal": [-1, 0, 0]}})";
constexpr char kTip[] = R"({"halfspace": {"point": [5.5, 0, 0], "normal": [1, 0, 0]}})";
constexpr double kRootEnd = 0.5, kTipBegin = 5.5;

class DeformTest : public ToolsTest {
 protected:
  /// Writes handles.json with these entries.
  void Handles(const Strings& entries) const {
    std::string text;
    for (const std::string& entry : entries) text += (text.empty() ? "" : ",\n  ") + entry;
    File("handles.json", "{\"handles\": [\n  " + text + "\n]}\n");
  }

  static std::string Fixed(const std::string& select) {
    return R"({"name": "root", "fixed": true, "select": )" + select + "}";
  }

  /// Writes tube0.obj and tube1.obj, and handles.json, which bends the first upwards by its tip.
  void MakeCase() const {
    MakeTubes();
    Handles({Fixed(kRoot), std::string(R"({"name": "tip", "select": )") + kTip +
                               R"(, "rotation": {"axis": [0, -1, 0], "degrees": 60},
                                    "translation": [-1, 0, 2]})"});
  }

  /// Writes dented.obj: half way on straight lines from tube0.obj to tube1.obj, and flattened at
  /// the tip.
  void MakeDented() const {
    MakeTubes(1000);
    const Soup tube = ReadSoup(Path("tube0.obj"));
    Shape dented = 0.5 * (tube.vertices + Vertices("tube1.obj"));
    for (int v : TipVertices()) dented.col(v).y() *= 0.4;
    WriteMesh(Path("dented.obj"), dented, tube);
  }

  Shape Vertices(const std::string& file) const { return ReadSoup(Path(file)).vertices; }

  std::vector<int> TipVertices() const {
    const Shape tube = Vertices("tube0.obj");
    std::vector<int> vertices;
    for (int v = 0; v < tube.cols(); ++v) {
      if (tube(0, v) >= kTipBegin) vertices.push_back(v);
    }
    return vertices;
  }

  double Volume(const std::string& file) const {
    const Soup soup = ReadSoup(Path(file));
    Eigen::Matrix3Xi triangles(3, soup.NumPolygons());
    std::copy(soup.corners.begin(), soup.corners.end(), triangles.data());
    return EnclosedVolume(triangles, soup.vertices);
  }

  /// The output of --report - of a run with `flags`, by handles unless `flags` contains --repair.
  json Report(const std::string& mesh, Strings flags) const {
    if (std::find(flags.begin(), flags.end(), "--repair") == flags.end()) {
      flags.insert(flags.begin(), {"--handles", "handles.json"});
    }
    flags.insert(flags.begin(), mesh);
    flags.insert(flags.end(), {"--output", "report.path", "--report", "-"});
    const Outcome outcome = Run("shape-deform", flags);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const json report = json::parse(outcome.out, nullptr, false);
    EXPECT_TRUE(report.is_object()) << outcome.out;
    return report.is_object() ? report : json::object();
  }

  /// Expects that the run fails with `code` and this message, and leaves no file behind.
  void ExpectRefusal(int code, const Strings& arguments, const std::string& message) const {
    SCOPED_TRACE(message);
    const Strings before = Files();
    const Outcome outcome = Run("shape-deform", arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    ExpectContains(outcome.err, message);
    if (code == 2) ExpectContains(outcome.err, "--help");
    EXPECT_EQ(Files(), before);
  }
};

TEST_F(DeformTest, WritesTheLastShapeAloneAndAllKindsOfPaths) {
  MakeCase();
  const Outcome outcome =
      Run("shape-deform",
          {"tube0.obj", "--handles", "handles.json", "--shapes", "3", "--output",
           "out/bent.obj,bent.PLY,frames/%02d.obj,w.path,w.png,w.glb", "--report", "r.txt"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectQuiet(outcome);
  EXPECT_EQ(Files(),
            (Strings{"bent.PLY", "frames", "frames/00.obj", "frames/01.obj", "frames/02.obj",
                     "frames/03.obj", "handles.json", "out", "out/bent.obj", "r.txt", "tube0.obj",
                     "tube1.obj", "w.glb", "w.path", "w.png"}));
  ExpectContains(outcome.out, "converged: 152 vertices, 3 shapes, 2 handles; off by at most ");
  ExpectContains(outcome.out, "wrote out/bent.obj\n");
  ExpectContains(outcome.out, "wrote frames/00.obj .. frames/03.obj\n");

  const Soup tube = ReadSoup(Path("tube0.obj")), bent = ReadSoup(Path("out/bent.obj"));
  EXPECT_EQ(bent.corners, tube.corners);
  EXPECT_TRUE(bent.vertices == Vertices("frames/03.obj"));
  EXPECT_TRUE(bent.vertices == Vertices("bent.PLY"));
  EXPECT_LT((Vertices("frames/00.obj") - tube.vertices).cwiseAbs().maxCoeff(), 1e-12);
  const shapespace::Path path = ReadPath(Path("w.path"));
  ASSERT_EQ(path.NumShapes(), 4);
  EXPECT_EQ(path.poses, std::vector<int>{0});
  EXPECT_EQ(path.extrapolated, 0);
  EXPECT_TRUE(path.Placed(3) == bent.vertices);
  ExpectContains(path.provenance, ": tube0.obj handles.json");
  EXPECT_EQ(Glb(Path("w.glb")).json["meshes"][0]["primitives"][0]["targets"].size(), 3u);
  EXPECT_EQ(Content(Path("w.png")).substr(1, 3), "PNG");
  ExpectContains(Content(Path("r.txt")), "\nroot ");
  // Other tools accept the result.
  Succeed("shape-export", {"w.path", "--at", "0.5", "--output", "half%d.obj"});
}

TEST_F(DeformTest, HardHandlesAreWhereTheyWereAskedToBeInAllShapes) {
  MakeCase();
  Succeed("shape-deform", {"tube0.obj", "--handles", "handles.json", "--output", "%d.obj"});
  const Shape tube = Vertices("tube0.obj");
  const std::vector<int> tip = TipVertices();
  const Eigen::Vector3d centre = tube(Eigen::all, tip).rowwise().mean();
  for (int i = 0; i <= 5; ++i) {
    const Shape shape = Vertices(std::to_string(i) + ".obj");
    const double angle = i / 5.0 * M_PI / 3;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, -Eigen::Vector3d::UnitY()).toRotationMatrix();
    for (int v : tip) {
      const Eigen::Vector3d wanted =
          turn * (tube.col(v) - centre) + centre + i / 5.0 * Eigen::Vector3d(-1, 0, 2);
      EXPECT_LT((shape.col(v) - wanted).norm(), 1e-12) << i;
    }
    for (int v = 0; v < tube.cols(); ++v) {
      if (tube(0, v) > kRootEnd) continue;
      EXPECT_LT((shape.col(v) - tube.col(v)).norm(), 1e-12) << i;
    }
  }
}

TEST_F(DeformTest, ASingleVertexAndASoftHandlePull) {
  MakeTubes();
  const int tip = TipVertices().back();
  const std::string vertex = R"("select": {"vertices": [)" + std::to_string(tip + 1) + "]}";
  Handles({Fixed(kRoot), R"({"position": [5, 1, 2], )" + vertex + "}"});
  Succeed("shape-deform", {"tube0.obj", "--handles", "handles.json", "--output", "hard.obj"});
  const Eigen::Vector3d wanted(5, 1, 2);
  EXPECT_LT((Vertices("hard.obj").col(tip) - wanted).norm(), 1e-12);
  // The smaller --balance, the nearer is a soft handle to its target; at 1 nothing moves.
  Handles({Fixed(kRoot), R"({"position": [5, 1, 2], "weight": 1, )" + vertex + "}"});
  double before = 0;
  for (const char* balance : {"0.0001", "0.1", "0.9"}) {
    const json report = Report("tube0.obj", {"--balance", balance});
    const double off = report["handles"][1]["residual_max"];
    EXPECT_GT(off, before) << balance;
    EXPECT_EQ(report["handles"][1]["hard"], false);
    EXPECT_EQ(report["balance"], std::stod(balance));
    before = off;
  }
  Succeed("shape-deform",
          {"tube0.obj", "--handles", "handles.json", "--balance", "1", "--output", "still.obj"});
  EXPECT_LT((Vertices("still.obj") - Vertices("tube0.obj")).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(DeformTest, AHandlePushesOtherPartsAside) {
  Succeed("shape-body",
          {"quadruped", "--triangles", "1000", "--pose", "stand", "--output", "a%d.obj"});
  Handles({Fixed(R"({"box": {"low": [0, 0, -1], "high": [1, 0.1, 1]}})"),
           Fixed(R"({"box": {"low": [-1, 1.25, 0.5], "high": [1, 2, 2]}})"),
           R"({"name": "hind paw", "translation": [0, 0.15, 1.1],
               "select": {"box": {"low": [-1, 0, -1], "high": [0, 0.1, 0]}}})"});
  const json through = Report("a0.obj", {}), aside = Report("a0.obj", {"--avoid_contact"});
  EXPECT_EQ(through["uncertified_segments"], -1);
  EXPECT_TRUE(through["contact_distance"].is_null());
  EXPECT_EQ(aside["uncertified_segments"], 0);
  EXPECT_GT(aside["contact_distance"], 0);
  EXPECT_EQ(aside["levels"].back()["start"], "contact");
  EXPECT_LT(aside["handles"][2]["residual_max"], 1e-12);
  // A floor, into which the other fore paw is to be pressed.
  std::ofstream(Path("floor.obj")) << "v -9 -.1 -9\nv 9 -.1 -9\nv 9 -.1 9\nv -9 -.1 9\nf 1 2 3 4\n";
  Handles({Fixed(R"({"box": {"low": [-1, 0, -1], "high": [1, 0.1, 0]}})"),
           R"({"name": "fore paws", "translation": [0, -0.3, 0],
               "select": {"box": {"low": [-1, 0, 0], "high": [1, 0.1, 1]}}})"});
  const json stopped = Report("a0.obj", {"--avoid_contact", "--obstacle", "floor.obj"});
  EXPECT_GT(stopped["uncertified_segments"], 0);
  EXPECT_NE(stopped["warnings"][0].get<std::string>().find("or the obstacle: the handles got"),
            std::string::npos);
}

TEST_F(DeformTest, PicturesMarkWhatHandlesHold) {
  MakeCase();
  Succeed("shape-deform", {"tube0.obj", "--handles", "handles.json", "--output", "w.png,w.path"});
  Succeed("shape-export", {"w.path", "--output", "plain.png"});
  EXPECT_NE(Content(Path("w.png")), Content(Path("plain.png")));
}

TEST_F(DeformTest, TheMetricsPresetSuitsTheMeshAndFlagsOverrideIt) {
  MakeCase();
  EXPECT_EQ(Report("tube0.obj", {})["metric"],
            "isometric 0.3, strain 0.7, bending 7e-05, volume 0.05");
  EXPECT_EQ(Report("tube0.obj", {"--metric", "deformation", "--bending", "1e-3"})["metric"],
            "isometric 0.3, strain 0.7, bending 0.001, volume 0.05");
  EXPECT_EQ(Report("tube0.obj", {"--metric", "strain"})["metric"],
            "strain 1, lambda 0.0001, bending 1e-05");
  EXPECT_EQ(Report("tube0.obj", {"--metric", "isometric", "--lambda", "0"})["metric"],
            "isometric 1, bending 1e-05");
  Succeed("shape-body", {"sheet", "--triangles", "100", "--at", "0", "--output", "sheet%d.obj"});
  Handles({Fixed(R"({"vertices": [1, 2, 3]})")});
  EXPECT_EQ(Report("sheet0.obj", {})["metric"], "isometric 0.3, strain 0.7, bending 3e-05");
}

TEST_F(DeformTest, VolumeIsKeptIfAsked) {
  MakeTubes();
  // Compressed by a fifth of its length.
  Handles({Fixed(kRoot), std::string(R"({"translation": [-1.4, 0, 0], "select": )") + kTip + "}"});
  const double rest = Volume("tube0.obj");
  const auto change = [&](const Strings& flags) {
    Strings arguments = {"tube0.obj", "--handles", "handles.json", "--output", "b.obj"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    Succeed("shape-deform", arguments);
    return std::abs(Volume("b.obj") / rest - 1);
  };
  const double without = change({}), with = change({"--volume", "3"});
  EXPECT_GT(without, 0.05);
  EXPECT_LT(with, 0.01);
}

TEST_F(DeformTest, SolversAgree) {
  MakeCase();
  const json own = Report("tube0.obj", {}),
             ceres = Report("tube0.obj", {"--solver", "trust_region"});
  EXPECT_NEAR(ceres["energy"], own["energy"].get<double>(), 1e-3 * own["energy"].get<double>());
}

TEST_F(DeformTest, TurnsBeyond180DegreesAreWhatTheySay) {
  MakeTubes();
  Handles({Fixed(kRoot), std::string(R"({"rotation": {"axis": [1, 0, 0], "degrees": 360}, )") +
                             R"("select": )" + kTip + "}"});
  Succeed("shape-deform", {"tube0.obj", "--handles", "handles.json", "--output", "%d.obj"});
  // The tip is back in its position, and the middle has turned by half as much.
  const Shape tube = Vertices("tube0.obj"), wound = Vertices("5.obj");
  const int tip = TipVertices().front();
  EXPECT_LT((wound.col(tip) - tube.col(tip)).norm(), 1e-12);
  double turn = 0;
  int middle = 0;
  for (int v = 0; v < tube.cols(); ++v) {
    if (std::abs(tube(0, v) - 0.5 * (kRootEnd + kTipBegin)) > 0.3) continue;
    turn += wound.col(v).tail(2).normalized().dot(tube.col(v).tail(2).normalized());
    ++middle;
  }
  ASSERT_GT(middle, 0);
  EXPECT_LT(turn / middle, -0.7);
}

TEST_F(DeformTest, RepairRestoresVolumeAndLengths) {
  MakeDented();
  const Outcome outcome = Run("shape-deform", {"dented.obj", "--repair", "tube0.obj", "--output",
                                               "mended.obj,%d.obj,m.png", "--report", "r.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Files(), (Strings{"0.obj", "1.obj", "dented.obj", "m.png", "mended.obj", "r.json",
                              "tube0.obj", "tube1.obj"}));
  ExpectContains(outcome.out, "converged: ");
  ExpectContains(outcome.out, "; before: edges off by ");
  ExpectContains(outcome.out, "; after: edges off by ");
  const json report = json::parse(Content(Path("r.json")));
  EXPECT_LT(report["before"]["volume"], -0.1);
  EXPECT_GT(report["after"]["volume"], -0.03);
  EXPECT_LT(report["after"]["edge_rms"], 0.3 * report["before"]["edge_rms"].get<double>());
  EXPECT_NEAR(Volume("mended.obj") / Volume("tube0.obj"),
              1 + report["after"]["volume"].get<double>(), 1e-6);
  EXPECT_EQ(report["deformation"]["shapes"], 1);
  EXPECT_EQ(report["deformation"]["balance"], 0.5);
  // A larger balance restores more of the reference.
  const json more = Report("dented.obj", {"--repair", "tube0.obj", "--balance", "0.9"});
  EXPECT_LT(more["after"]["edge_rms"], report["after"]["edge_rms"]);
  EXPECT_GT(more["moved"], report["moved"]);
  EXPECT_EQ(
      Report("dented.obj", {"--repair", "tube0.obj", "--shapes", "3"})["deformation"]["shapes"], 3);
}

TEST_F(DeformTest, RepairKeepsThePlacesOfWhatIsSound) {
  // The tip, whose vertices are the last ones, is shrunk and displaced.
  MakeTubes(1000);
  const Soup tube = ReadSoup(Path("tube0.obj"));
  const std::vector<int> tip = TipVertices();
  ASSERT_EQ(tip.back() - tip.front() + 1, static_cast<int>(tip.size()));
  Shape broken = tube.vertices;
  for (int v : tip) broken.col(v) *= 0.2;
  WriteMesh(Path("broken.obj"), broken, tube);
  const std::string sound = R"({"vertices": [[1, )" + std::to_string(tip.front()) + "]]}";
  Succeed("shape-deform",
          {"broken.obj", "--repair", "tube0.obj", "--sound", sound, "--output", "sound.obj"});
  Succeed("shape-deform", {"broken.obj", "--repair", "tube0.obj", "--output", "all.obj"});
  const auto distance = [&](const std::string& file) {
    return (Vertices(file) - tube.vertices).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(distance("sound.obj"), 0.1);
  EXPECT_GT(distance("all.obj"), 1);
}

TEST_F(DeformTest, WarnsOfWhatNothingHoldsAndOfContradictions) {
  MakeTubes();
  const Soup tube = ReadSoup(Path("tube0.obj"));
  // The tube twice, the second one beside the first.
  std::string two = Content(Path("tube0.obj"));
  std::string faces;
  for (int v = 0; v < tube.NumVertices(); ++v) {
    const Eigen::Vector3d x = tube.vertices.col(v);
    two += "v " + std::to_string(x.x()) + " " + std::to_string(x.y() + 5) + " " +
           std::to_string(x.z()) + "\n";
  }
  for (size_t c = 0; c < tube.corners.size(); ++c) {
    faces += (c % 3 == 0 ? "f " : " ") + std::to_string(tube.corners[c] + 1 + tube.NumVertices());
    if (c % 3 == 2) faces += "\n";
  }
  File("two.obj", two + faces);
  Handles({Fixed(R"({"vertices": [[1, 10]]})"),
           R"({"name": "off", "translation": [0, 0, 1], "select": {"vertices": [[8, 20]]}})"});
  const Outcome outcome =
      Run("shape-deform", {"two.obj", "--handles", "handles.json", "--output", "b.obj"});
  EXPECT_EQ(outcome.code, 0);
  ExpectContains(outcome.err,
                 "warning: no handle holds the connected component of 152 vertices that begins "
                 "with vertex 153");
  ExpectContains(outcome.err, "warning: the hard handle \"root\" shares vertices with another");
  ExpectContains(outcome.err, "warning: the hard handle \"off\" shares vertices with another");
  EXPECT_TRUE(Vertices("b.obj").rightCols(152).isApprox(Vertices("two.obj").rightCols(152), 1e-12));
  const json report = Report("two.obj", {});
  EXPECT_EQ(report["free_components"], 1);
  EXPECT_EQ(report["warnings"].size(), 3u);
  EXPECT_NEAR(report["handles"][0]["residual_max"], 0.5, 1e-9);
}

TEST_F(DeformTest, WhatDoesNotConvergeSaysSo) {
  MakeCase();
  Strings arguments = {"tube0.obj", "--handles",   "handles.json", "--max_iterations",
                       "1",         "--tolerance", "1e-12",        "--output",
                       "w.path"};
  const Outcome lenient = Run("shape-deform", arguments);
  EXPECT_EQ(lenient.code, 0);
  ExpectContains(lenient.out, "NOT CONVERGED");
  ExpectContains(lenient.err, "warning: out of iterations");
  EXPECT_FALSE(ReadPath(Path("w.path")).converged);
  arguments.push_back("--strict");
  EXPECT_EQ(Run("shape-deform", arguments).code, 1);
}

TEST_F(DeformTest, WrongCommandLines) {
  MakeCase();
  const Strings handles = {"tube0.obj", "--handles", "handles.json"};
  const Strings repair = {"tube1.obj", "--repair", "tube0.obj"};
  const struct {
    Strings base, more;
    const char* message;
  } cases[] = {
      {{}, {}, "name one mesh"},
      {{"--handles", "handles.json"}, {}, "name one mesh"},
      {{"tube1.obj"}, handles, "name one mesh"},
      {{"tube0.obj"}, {}, "give --handles, or --repair"},
      {handles, {"--repair", "tube1.obj"}, "give --handles, or --repair"},
      {handles, {"--sound", R"({"vertices": [1]})"}, "--sound: goes with --repair"},
      {repair, {"--sound", R"({"vertices": [999]})"}, "--sound: vertices: 999 is not a vertex"},
      {repair, {"--sound", "feet"}, "--sound: line 1: this is not valid JSON"},
      {handles,
       {"--solver", "magic"},
       "--solver magic: must be one of threaded_lbfgs, trust_region"},
      {handles, {"--balance", "0"}, "--balance 0: must be in (0, 1]"},
      {repair, {"--balance", "1.5"}, "--balance 1.5: must be in (0, 1]"},
      {handles, {"--shapes", "0"}, "--shapes 0: must be 1 or more"},
      {handles, {"--coarsest", "3"}, "--coarsest 3: must be 4 triangles or more"},
      {handles, {"--tolerance", "0"}, "--tolerance 0: must be between 0 and 1"},
      {handles, {"--max_iterations", "0"}, "--max_iterations 0: must be 1 or more"},
      {handles, {"--output", "tube0.obj"}, "--output tube0.obj would overwrite tube0.obj"},
      {handles, {"--output", "tube%d.obj"}, "tube0.obj would overwrite tube0.obj"},
      {handles, {"--report", "./handles.json"}, "would overwrite handles.json"},
      {repair, {"--output", "tube0.obj"}, "--output tube0.obj would overwrite tube0.obj"},
      {handles, {"--output", "b.obj,./b.obj"}, "--output ./b.obj would overwrite"},
      {handles, {"--output", "b%s.obj"}, "b%s.obj: a name for frames needs one number"},
      {handles, {"--metric", "rigid"}, "--metric rigid: a deformation takes no rigid metric"},
      {handles,
       {"--metric", "paper"},
       "--metric paper: a deformation takes the midpoint form only"},
      {{"tube0.obj"}, {"--handles", ""}, "--handles: is empty"},
      {handles, {"--rigid", "1"}, "--rigid 1: a deformation takes no rigid metric"},
      {handles,
       {"--discretization", "trapezoid"},
       "--discretization trapezoid: a deformation takes the midpoint form only"},
      {handles,
       {"--metric", "taxicab"},
       "--metric taxicab: must be strain, isometric, rigid or paper, or deformation"},
  };
  for (const auto& [base, more, message] : cases) {
    Strings arguments = base;
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectRefusal(2, arguments, message);
  }
  const Outcome geodesic =
      Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--metric", "deformation"});
  EXPECT_EQ(geodesic.code, 2);
  ExpectContains(geodesic.err, "--metric deformation: must be strain, isometric, rigid or paper");
}

TEST_F(DeformTest, FilesThatCannotServe) {
  MakeCase();
  Succeed("shape-body", {"bar", "--triangles", "300", "--at", "0", "--output", "bar%d.obj"});
  const auto with = [](const std::string& handles) {
    return Strings{"tube0.obj", "--handles", handles, "--output", "b.obj"};
  };
  ExpectRefusal(1, {"none.obj", "--handles", "handles.json"}, "none.obj: cannot be opened");
  ExpectRefusal(1, with("none.json"), "none.json: cannot be opened");
  ExpectRefusal(1, {"tube0.obj", "--repair", "none.obj"}, "none.obj: cannot be opened");
  ExpectRefusal(1, {"tube0.obj", "--repair", "bar0.obj"}, "these are not poses of one mesh");
  const struct {
    std::string content, message;
  } cases[] = {
      {"{\"handles\": [\n  feet\n]}", "bad.json: line 2: this is not valid JSON"},
      {R"({"handles": []})", "bad.json: handles: the list is empty"},
      {R"({"handle": []})", "bad.json: unknown key 'handle'; the keys here are handles, $schema"},
      {R"({"handles": [)" + Fixed(kRoot) + R"(, {"name": "tip", "select": )" + kTip +
           R"(, "rotation": {"axis": [0, 0, 0], "degrees": 9}}]})",
       "bad.json: handle 2 ('tip'): rotation.axis: must not be zero"},
      {R"({"handles": [{"fixed": true, "select": {"vertices": [153]}}]})",
       "bad.json: handle 1: select: vertices: 153 is not a vertex of this mesh, which has 152"},
      {R"({"handles": [{"fixed": true, "weight": 0, "select": {"vertices": [1]}}]})",
       "bad.json: handle 1: weight: must be positive"},
  };
  for (const auto& [content, message] : cases) {
    File("bad.json", content);
    ExpectRefusal(1, with("bad.json"), message);
  }
}

}  // namespace
}  // namespace shapespace
