#include <algorithm>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>

#include "output/read_page.h"
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
  const auto transfer = [&](const std::string& target, const Strings& flags,
                            const std::string& part) {
    Strings arguments = {"a0.obj", "a1.obj", "--target", target};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    refused("shape-transfer", arguments, 2, part);
  };
  transfer("a1.obj", {"--hold_all_markers"}, "--hold_all_markers");
  transfer("a1.obj", {"--markers_out", "m.txt"}, "--markers_out");
  transfer("b0.obj", {markers, "--hybrids", "h%d.obj"}, "--hybrids");
  transfer("b0.obj", {"--hybrids", "h%d.obj"}, "--hybrids");
  transfer("b0.obj", {"--markers_out", "a1.obj"}, "a1.obj");
}

// The target of a transfer needs no markers either, and the report says how good the fit is.
TEST_F(CorrespondTest, MovesABodyOfAnotherConnectivityWithoutMarkers) {
  MakeBodies();
  Succeed("shape-interpolate", {"a0.obj", "a1.obj", "--shapes", "1", "--output", "a.path"});
  const Shape target = Vertices("b0.obj");
  for (const Strings& source : {Strings{"a0.obj", "a1.obj"}, Strings{"a.path"}}) {
    Strings arguments = source;
    arguments.insert(arguments.end(), {"--target", "b0.obj", "--output", "out%d.obj", "--report",
                                       "r.json", "--markers_out", "found.txt"});
    Succeed("shape-transfer", arguments);
    EXPECT_EQ(ReadSoup(Path("out0.obj")).corners, ReadSoup(Path("b0.obj")).corners);
    EXPECT_LT((Vertices("out0.obj") - target).cwiseAbs().maxCoeff(), 1e-6);
    const json report = json::parse(Content(Path("r.json")));
    EXPECT_FALSE(report["correspondence"]["candidates"].empty());
    EXPECT_EQ(report["correspondence"]["converged"], true);
    const std::string found = Content(Path("found.txt"));
    EXPECT_GE(std::count(found.begin(), found.end(), '\n'), 3);
  }
  // It sits, as it would by the vertices that are known to correspond.
  Succeed("shape-transfer", {"a0.obj", "a1.obj", "--target", "b0.obj", "--output", "found%d.obj"});
  Succeed("shape-transfer", {"a0.obj", "a1.obj", "--target", "b0.obj", "--markers", "markers.txt",
                             "--output", "given%d.obj"});
  const Shape found = Vertices("found1.obj"), given = Vertices("given1.obj");
  EXPECT_LT((found - given).colwise().norm().mean(),
            0.2 * (given - target).colwise().norm().mean());
  // Also a mesh of the same faces, if that is asked for.
  const Outcome asked =
      Run("shape-transfer", {"a0.obj", "a1.obj", "--target", "a0.obj", "--find_markers", "--output",
                             "own%d.obj", "--report", "r.json"});
  EXPECT_EQ(asked.code, 0) << asked.err;
  EXPECT_TRUE(json::parse(Content(Path("r.json"))).contains("correspondence"));
}

// A target onto which nothing can be fitted ends the run, with nothing written.
TEST_F(CorrespondTest, ATransferEndsWithAFitThatFails) {
  MakeBodies();
  File("edge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n");
  const Strings before = Files();
  const Outcome outcome = Run("shape-transfer", {"a0.obj", "a1.obj", "--target", "edge.obj"});
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  EXPECT_EQ(Files(), before);
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
  std::istringstream found(Content(Path("found.txt")));
  int pairs = 0;
  for (std::string line; std::getline(found, line);) pairs += line[0] == '#' ? 0 : 1;
  EXPECT_GT(pairs, 10);
  EXPECT_LE(pairs, 40);
  EXPECT_EQ(again["markers"], pairs);
  EXPECT_GE(report["markers"], pairs);
  EXPECT_TRUE(again["candidates"].empty());
}

// The page shows both bodies, numbered as their files, in colours that belong together, and has the
// markers that --markers_out writes.
TEST_F(CorrespondTest, WritesAPageOfBothBodies) {
  MakeBodies();
  const Outcome outcome = Run("shape-correspond", {"a0.obj", "b0.obj", "--output", "check.html",
                                                   "--markers_out", "found.txt"});
  if (outcome.code == 1) {
    ExpectContains(outcome.err, "./dev viewer");
    GTEST_SKIP() << "built without the viewer's page";
  }
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<PageElement> elements = ReadPage(Path("check.html"));
  ASSERT_EQ(elements.size(), 2u);
  const DecodedScene source(elements[0].bytes), target(elements[1].bytes);
  EXPECT_EQ(source.header["name"], "a0.obj");
  EXPECT_EQ(target.header["name"], "b0.obj");
  std::string found;
  for (size_t k = 0; k < source.header["markers"].size(); ++k) {
    found += std::to_string(source.header["markers"][k].get<int>() + 1) + ' ' +
             std::to_string(target.header["markers"].at(k).get<int>() + 1) + '\n';
  }
  const std::string written = Content(Path("found.txt"));
  EXPECT_EQ(found, written.substr(written.find_first_of("0123456789")));
  // The two are one animal, so that places that are near each other have nearly the same colour.
  const Shape a = Vertices("a0.obj"), b = Vertices("b0.obj");
  const auto colours_of = [](const DecodedScene& scene) {
    Eigen::MatrixXd colours(3, scene.vertices);
    for (Eigen::Index k = 0; k < colours.size(); ++k) {
      colours.data()[k] = static_cast<unsigned char>(scene.colours.at(k));
    }
    return colours;
  };
  const Eigen::MatrixXd given = colours_of(source), carried = colours_of(target);
  double off = 0, apart = 0;
  for (Eigen::Index v = 0; v < b.cols(); ++v) {
    Eigen::Index near = 0;
    (a.colwise() - b.col(v)).colwise().squaredNorm().minCoeff(&near);
    off += (carried.col(v) - given.col(near)).norm();
    apart += (carried.col(v) - carried.col(0)).norm();
  }
  EXPECT_LT(off, 0.1 * apart);
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
