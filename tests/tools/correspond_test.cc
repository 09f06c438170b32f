#include <algorithm>
#include <fstream>
#include <iomanip>

#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using nlohmann::json;
using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

class CorrespondTest : public ToolsTest {
 protected:
  Shape Vertices(const std::string& file) const { return ReadSoup(Path(file)).vertices; }

  /// One animal as two unrelated meshes: a0.obj and a1.obj, standing and sitting, and b0.obj and
  /// b1.obj. markers.txt contains vertices at the same positions.
  void MakeBodies() const {
    Succeed("shape-body",
            {"quadruped", "--triangles", "1500", "--pose", "stand,sit", "--output", "a%d.obj"});
    Succeed("shape-body",
            {"quadruped", "--triangles", "2100", "--pose", "stand,sit", "--output", "b%d.obj"});
    const Shape a = Vertices("a0.obj"), b = Vertices("b0.obj");
    Eigen::RowVectorXd distance = (a.colwise() - a.col(0)).colwise().squaredNorm();
    std::ofstream file(Path("markers.txt"));
    for (int k = 0; k < 16; ++k) {
      Eigen::Index from = 0, to = 0;
      distance.maxCoeff(&from);
      distance = distance.cwiseMin(
          Eigen::RowVectorXd((a.colwise() - a.col(from)).colwise().squaredNorm()));
      (b.colwise() - a.col(from)).colwise().squaredNorm().minCoeff(&to);
      file << from + 1 << ' ' << to + 1 << '\n';
    }
  }
};

TEST_F(CorrespondTest, WritesTheFittedTemplateTheMapAndAPicture) {
  MakeBodies();
  const Outcome outcome =
      Run("shape-correspond", {"a0.obj", "b1.obj", "--markers", "markers.txt", "--output",
                               "fitted.obj,map.txt,check.png", "--report", "r.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "16 markers");
  EXPECT_EQ(Files(), (Strings{"a0.obj", "a1.obj", "b0.obj", "b1.obj", "check.png", "fitted.obj",
                              "map.txt", "markers.txt", "r.json"}));
  const Soup fitted = ReadSoup(Path("fitted.obj")), source = ReadSoup(Path("a0.obj"));
  EXPECT_EQ(fitted.corners, source.corners);
  ExpectContains(Content(Path("map.txt")),
                 "to_target " + std::to_string(source.NumVertices()) + "\n");
  EXPECT_EQ(json::parse(Content(Path("r.json")))["doubtful"].size(), 0u);
  // The fitted template is a pose of the template for all other tools.
  EXPECT_EQ(Run("shape-inspect", {"a0.obj", "fitted.obj"}).code, 0);
}

TEST_F(CorrespondTest, MovesABodyOfAnotherConnectivity) {
  MakeBodies();
  const Outcome outcome =
      Run("shape-transfer", {"a0.obj", "a1.obj", "--target", "b0.obj", "--markers", "markers.txt",
                             "--output", "out/%02d.obj,out.path"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Soup target = ReadSoup(Path("b0.obj"));
  EXPECT_EQ(ReadSoup(Path("out/00.obj")).corners, target.corners);
  EXPECT_LT((Vertices("out/00.obj") - target.vertices).cwiseAbs().maxCoeff(), 1e-6);
  // It sits as in its own pose, up to a translation.
  const auto centred = [](const Shape& shape) -> Shape {
    return shape.colwise() - shape.rowwise().mean();
  };
  const double off =
      (centred(Vertices("out/01.obj")) - centred(Vertices("b1.obj"))).colwise().norm().mean();
  const double moved =
      (centred(target.vertices) - centred(Vertices("b1.obj"))).colwise().norm().mean();
  EXPECT_LT(off, 0.2 * moved);
  // The same with a path.
  Succeed("shape-interpolate", {"a0.obj", "a1.obj", "--shapes", "1", "--output", "a.path"});
  Succeed("shape-transfer",
          {"a.path", "--target", "b0.obj", "--markers", "markers.txt", "--output", "b.path"});
  ExpectContains(Run("shape-inspect", {"b.path"}).out, std::to_string(target.NumVertices()));
}

// The vertices of the markers as landmarks: of the template in RAS, of the target in LPS.
TEST_F(CorrespondTest, LandmarksAreMarkers) {
  MakeBodies();
  const Shape a = Vertices("a0.obj"), b = Vertices("b1.obj");
  std::ifstream markers(Path("markers.txt"));
  std::ofstream fcsv(Path("a.fcsv")), list(Path("b.mrk.json"));
  fcsv << std::setprecision(17)
       << "# CoordinateSystem = RAS\n# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc\n";
  json points = json::array();
  int from = 0, to = 0;
  for (int k = 0; markers >> from >> to; ++k) {
    const Eigen::Vector3d p = a.col(from - 1), q = b.col(to - 1);
    const std::string label = "L" + std::to_string(k);
    fcsv << k << ',' << -p.x() << ',' << -p.y() << ',' << p.z() << ",0,0,0,1,1,1,0," << label
         << ",\n";
    points.push_back({{"label", label}, {"position", {q.x(), q.y(), q.z()}}});
  }
  std::reverse(points.begin(), points.end());
  points.push_back({{"label", "extra"}, {"position", {0, 0, 0}}});
  list << json{{"markups", {{{"coordinateSystem", "LPS"}, {"controlPoints", points}}}}};
  fcsv.close();
  list.close();
  const Outcome outcome = Run("shape-correspond", {"a0.obj", "b1.obj", "--markers",
                                                   "a.fcsv,b.mrk.json", "--output", "f.obj"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.err, "warning: b.mrk.json: landmark 17 'extra' was ignored");
  Succeed("shape-correspond",
          {"a0.obj", "b1.obj", "--markers", "markers.txt", "--output", "other.obj"});
  EXPECT_EQ(Content(Path("f.obj")), Content(Path("other.obj")));

  const auto refused = [&](const std::string& files, int code, const std::string& words) {
    const Outcome refusal = Run("shape-correspond", {"a0.obj", "b1.obj", "--markers", files});
    EXPECT_EQ(refusal.code, code);
    ExpectContains(refusal.err, words);
  };
  refused("a.fcsv", 1, "a.fcsv: has landmarks of one mesh");
  refused(",a.fcsv", 2, "--markers");
  refused("a.fcsv,b.mrk.json,c.txt", 2, "--markers");
  refused("b.mrk.json,a.fcsv", 1, "exchange LPS and RAS");
  const Outcome overwriting =
      Run("shape-transfer", {"a0.obj", "a1.obj", "--target", "b1.obj", "--markers",
                             "a.fcsv,b.mrk.json", "--report", "b.mrk.json"});
  EXPECT_EQ(overwriting.code, 2);
  ExpectContains(overwriting.err, "would overwrite b.mrk.json");
}

TEST_F(CorrespondTest, SaysWhatIsWrongAndWritesNothing) {
  MakeBodies();
  const Strings before = Files();
  const auto refused = [&](const std::string& tool, const Strings& arguments, int code,
                           const std::string& part) {
    const Outcome outcome = Run(tool, arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    ExpectContains(outcome.err, part);
    EXPECT_EQ(Files(), before);
  };
  const std::string tool = "shape-correspond", markers = "--markers=markers.txt";
  refused(tool, {"a0.obj", markers}, 2, "name two meshes");
  refused(tool, {"a0.obj", "b0.obj", "--markers_out", "a0.obj"}, 2, "would overwrite");
  refused(tool, {"a0.obj", "b0.obj", markers, "--output", "x.glb"}, 2, "must end in");
  refused(tool, {"a0.obj", "b0.obj", markers, "--output", "b0.obj"}, 2, "would overwrite");
  refused(tool, {"a0.obj", "b0.obj", markers, "--output", "markers.txt"}, 2, "would overwrite");
  refused(tool, {"a0.obj", "b0.obj", markers, "--proportions", "0"}, 2, "--proportions 0");
  refused(tool, {"a0.obj", "b0.obj", "--markers", "none.txt"}, 1, "none.txt");
  refused("shape-transfer", {"a0.obj", "a1.obj", "--target", "b0.obj", "--hold_all_markers"}, 2,
          "--hold_all_markers: goes with --markers");
  refused("shape-transfer",
          {"a0.obj", "a1.obj", "--target", "b0.obj", markers, "--hybrids", "h%d.obj"}, 2,
          "--hybrids: does not go with --markers");
}

// The markers that are found are a file of markers, which can be mended and read again.
TEST_F(CorrespondTest, WritesTheMarkersThatItFinds) {
  MakeBodies();
  Succeed("shape-correspond", {"a0.obj", "b1.obj", "--markers_out", "found.txt", "--output",
                               "first.obj", "--report", "first.json"});
  const json report = json::parse(Content(Path("first.json")));
  EXPECT_FALSE(report["candidates"].empty());
  Succeed("shape-correspond", {"a0.obj", "b1.obj", "--markers", "found.txt", "--soft_markers",
                               "--output", "again.obj", "--report", "again.json"});
  const json again = json::parse(Content(Path("again.json")));
  EXPECT_EQ(again["markers"], report["markers"]);
  EXPECT_TRUE(again["candidates"].empty());
}

TEST_F(CorrespondTest, NamesTheLineOfAMarkerAndWhatIsWrongWithIt) {
  MakeBodies();
  File("bad.txt", "1 2\n3 4\n5 tail\n");
  const Outcome outcome = Run("shape-correspond", {"a0.obj", "b0.obj", "--markers", "bad.txt"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "bad.txt:3: 'tail' is neither");
}

}  // namespace
}  // namespace shapespace
