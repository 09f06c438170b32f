#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <regex>

#include <nlohmann/json.hpp>

#include <shapespace/analysis/deviation_sites.h>
#include <shapespace/analysis/path_intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/files/read.h>
#include <shapespace/path/path_file.h>
#include <shapespace/statistics/modes_file.h>
#include <shapespace/statistics/pose_table.h>
#include <shapespace/summary/internal/report.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using internal::Format;
using testing::Content;
using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

/// The figures that tools print and report, compared with those of the library, or of arithmetic.
class FiguresTest : public ToolsTest {
 protected:
  nlohmann::json ReportOf(const std::string& tool, Strings arguments) const {
    arguments.insert(arguments.end(), {"--report", "r.json"});
    Succeed(tool, arguments);
    return nlohmann::json::parse(Content(Path("r.json")));
  }
  // Three poses of a tube, and tubes.path, which goes on beyond them.
  void MakePath() const {
    Succeed("shape-body",
            {"tube", "--triangles", "400", "--at", "0,50,110", "--output", "tube%d.obj"});
    Succeed("shape-interpolate",
            {"tube0.obj", "tube1.obj", "tube2.obj", "--shapes", "2", "--output", "w.path"});
    Succeed("shape-extrapolate", {"w.path", "--steps", "2", "--output", "tubes.path"});
  }
};

// Rectangles of 6 x 8, whose corners are 5 from the centre, in millimetres and 10 per cent larger.
TEST_F(FiguresTest, ComparisonsOfPosesAreInTheUsersUnit) {
  const auto rectangle = [&](const std::string& name, double scale) {
    std::string text;
    for (const auto& [x, y] : {std::pair{0, 0}, {6, 0}, {6, 8}, {0, 8}}) {
      text += Format("v %.17g %.17g 0\n", scale * x, scale * y);
    }
    return File(name, text + "f 1 2 3\nf 1 3 4\n");
  };
  rectangle("a.obj", 1000);
  rectangle("b.obj", 1100);
  rectangle("c.obj", 900);
  const Outcome outcome = Run("shape-inspect", {"a.obj", "b.obj", "c.obj", "--report", "r.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string apart =
      "  vertices apart       rms 500, max 500 (user's units, once aligned)\n"
      "  edges stretched by   median 10%, 99th percentile 10%, max 10%\n";
  ExpectContains(outcome.out, "b.obj against a.obj\n  turned by            ");
  ExpectContains(outcome.out, apart);
  EXPECT_NE(outcome.out.find(apart), outcome.out.rfind(apart));
  ExpectContains(outcome.out,
                 "a.obj\n  4 vertices, 2 polygons, 0 segments, extent 6000 x 8000 x 0\n");
  const auto report = nlohmann::json::parse(Content(Path("r.json")));
  ASSERT_EQ(report["comparisons"].size(), 2u);
  for (const auto& [i, pose] : {std::pair{0, "b.obj"}, {1, "c.obj"}}) {
    const auto& comparison = report["comparisons"][i];
    EXPECT_EQ(comparison["pose"], pose);
    EXPECT_EQ(comparison["against"], "a.obj");
    EXPECT_NEAR(comparison["turned_by"], 0, 1e-5);
    EXPECT_NEAR(comparison["apart_rms"], 500, 1e-6);
    EXPECT_NEAR(comparison["apart_max"], 500, 1e-6);
    EXPECT_NEAR(comparison["stretch_median"], 0.1, 1e-9);
    EXPECT_NEAR(comparison["stretch_p99"], 0.1, 1e-9);
    EXPECT_NEAR(comparison["stretch_max"], 0.1, 1e-9);
    EXPECT_EQ(comparison["metric"], "strain 1, lambda 0.0001, bending 1e-05");
    ExpectContains(outcome.out,
                   Format("  distance             at least %.6g (strain 1, lambda 0.0001, "
                          "bending 1e-05)\n",
                          comparison["distance_at_least"].get<double>()));
  }
  const auto& mesh = report["files"][1];
  EXPECT_EQ(mesh["file"], "b.obj");
  EXPECT_EQ(mesh["kind"], "mesh");
  EXPECT_EQ(mesh["vertices"], 4);
  EXPECT_EQ(mesh["polygons"], 2);
  EXPECT_EQ(mesh["segments"], 0);
  EXPECT_NEAR(mesh["extent"][0], 6600, 1e-9);
  EXPECT_NEAR(mesh["extent"][1], 8800, 1e-9);
  EXPECT_EQ(mesh["extent"][2], 0);
}

TEST_F(FiguresTest, PercentilesOfStretchAreBetweenMedianAndMost) {
  // A row of 40 squares, of which the first is half as long again: 201 edges, of which 2 are half
  // as long again, and 2, its diagonals, less.
  const auto row = [&](const char* name, double first) {
    std::string text;
    for (int i = 0; i <= 40; ++i) {
      for (const int y : {0, 1}) {
        text += "v " + std::to_string(i == 0 ? first : i) + " " + std::to_string(y) + " 0\n";
      }
    }
    for (int i = 1; i <= 40; ++i) {
      text += Format("f %d %d %d %d\n", 2 * i - 1, 2 * i + 1, 2 * i + 2, 2 * i);
    }
    File(name, text);
  };
  row("a.obj", 0);
  row("b.obj", -0.5);
  const auto comparison = ReportOf("shape-inspect", {"a.obj", "b.obj"})["comparisons"][0];
  EXPECT_NEAR(comparison["stretch_median"], 0, 1e-9);
  EXPECT_NEAR(comparison["stretch_p99"], std::sqrt((1.5 * 1.5 + 1) / 2) - 1, 1e-9);
  EXPECT_NEAR(comparison["stretch_max"], 0.5, 1e-9);
}

TEST_F(FiguresTest, PathsAreToldAsTheyAreMeasured) {
  MakePath();
  const Outcome outcome = Run("shape-inspect", {"tubes.path", "--report", "r.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(Content(Path("r.json")))["files"][0];
  const shapespace::Path path = ReadPath(Path("tubes.path"));
  const Connectivity& connectivity = *path.metric->connectivity;
  const PathQuality quality = MeasureQuality(path);
  const PathIntersections crossings = MeasureIntersections(path);
  const RigidParts parts = FindRigidParts(path);
  const std::vector<DeviationSite> sites = FindDeviationSites(path, parts);
  ExpectContains(outcome.out,
                 Format("tubes.path\n  9 shapes, 3 of them given, 2 extrapolated; %d vertices, "
                        "%d triangles\n",
                        connectivity.NumVertices(), connectivity.NumTriangles()));
  ExpectContains(outcome.out, "  made by      " + path.provenance + "\n");
  ExpectContains(outcome.out,
                 Format("  metric       %s; unit of length %.6g\n",
                        DescribeMetric(path.metric->options).c_str(), path.metric->unit));
  ExpectContains(outcome.out,
                 Format("  edges        rms %.4g%%, 99th percentile %.4g%%, max "
                        "%.4g%% from the expected lengths\n",
                        100 * quality.edge_rms, 100 * quality.edge_p99, 100 * quality.edge_max));
  ExpectContains(outcome.out, Format("  roughness    %.4g degrees; folds %.4g per inner shape\n",
                                     quality.roughness, quality.folds));
  ExpectContains(outcome.out,
                 Format("  edges        rms %.4g%%, 99th percentile %.4g%%, max "
                        "%.4g%% from the lengths in the first shape\n",
                        100 * quality.first_rms, 100 * quality.first_p99, 100 * quality.first_max));
  ExpectContains(outcome.out, Format("poses up to %" PRId64 "; other shapes %.4g, up to %" PRId64
                                     "; %.4g beyond the poses\n",
                                     crossings.poses_max, crossings.inner_mean, crossings.inner_max,
                                     crossings.beyond_poses));
  ASSERT_FALSE(sites.empty());
  for (size_t i = 0; i < std::min<size_t>(sites.size(), 8); ++i) {
    const DeviationSite& site = sites[i];
    if (site.share < 0.001) {
      ExpectLacks(outcome.out, Format("%8d  %.4g, ", site.vertex + 1, site.position.x()));
      continue;
    }
    std::string touched;
    for (size_t k = 0; k < std::min<size_t>(site.parts.size(), 4); ++k) {
      touched += (k == 0 ? "" : ", ") + std::to_string(site.parts[k] + 1);
    }
    ExpectContains(
        outcome.out,
        Format("    %4.1f%%   %5.2f%%  %5.1f%%  %8d  %-30s  %s\n", 100 * site.share,
               100 * site.area_share, 100 * site.largest, site.vertex + 1,
               Format("%.4g, %.4g, %.4g", site.position.x(), site.position.y(), site.position.z())
                   .c_str(),
               touched.empty() ? "-" : touched.c_str()));
  }
  ASSERT_FALSE(parts.parts.empty());
  ExpectContains(outcome.out,
                 Format("  parts        %zu move nearly rigidly; %.3g%% of the surface is joint\n",
                        parts.parts.size(), 100 * parts.joint_share));
  for (size_t i = 0; i < parts.parts.size(); ++i) {
    const RigidPart& part = parts.parts[i];
    ExpectContains(outcome.out,
                   Format("    %4zu  %8d  %5.3g%%  %-8.3g (%.3g%% of size)  %9.3g%%  %.1f "
                          "degrees\n",
                          i + 1, part.num_vertices, 100 * part.area_share, part.residual,
                          100 * part.relative_residual, 100 * part.edge_deviation, part.turn));
    const auto& told = report["parts"][i];
    EXPECT_EQ(told["vertices"], part.num_vertices);
    EXPECT_EQ(told["area_share"], part.area_share);
    EXPECT_EQ(told["residual"], part.residual);
    EXPECT_EQ(told["relative_residual"], part.relative_residual);
    EXPECT_EQ(told["edge_deviation"], part.edge_deviation);
    EXPECT_EQ(told["turn"], part.turn);
    EXPECT_EQ(told["centre"][2], part.centre.z());
  }
  ASSERT_EQ(report["deviation_sites"].size(), sites.size());
  for (size_t i = 0; i < sites.size(); ++i) {
    const auto& told = report["deviation_sites"][i];
    EXPECT_EQ(told["vertex"], sites[i].vertex + 1);
    EXPECT_EQ(told["largest"], sites[i].largest);
    EXPECT_EQ(told["share"], sites[i].share);
    EXPECT_EQ(told["area_share"], sites[i].area_share);
    EXPECT_EQ(told["position"][1], sites[i].position.y());
    ASSERT_EQ(told["parts"].size(), sites[i].parts.size());
    for (size_t k = 0; k < sites[i].parts.size(); ++k) {
      EXPECT_EQ(told["parts"][k], sites[i].parts[k] + 1);
    }
  }
  EXPECT_EQ(report["file"], "tubes.path");
  EXPECT_EQ(report["made_by"], path.provenance);
  EXPECT_EQ(report["vertices"], connectivity.NumVertices());
  EXPECT_EQ(report["triangles"], connectivity.NumTriangles());
  EXPECT_EQ(report["shapes"], 9);
  EXPECT_EQ(report["poses"], 3);
  EXPECT_EQ(report["extrapolated"], 2);
  EXPECT_EQ(report["metric"], DescribeMetric(path.metric->options));
  EXPECT_EQ(report["unit"], path.metric->unit);
  EXPECT_EQ(report["converged"], true);
  EXPECT_EQ(report["joint_share"], parts.joint_share);
  // Without shapes beyond the poses, there are inner ones.
  const Outcome inner = Run("shape-inspect", {"w.path"});
  ExpectContains(inner.out, "7 shapes, 3 of them given; ");
  ExpectContains(inner.out, "; inner shapes ");
  ExpectLacks(inner.out, "from the lengths in the first shape");
}

TEST_F(FiguresTest, PathsWithoutDeviationSaySo) {
  Succeed("shape-body", {"bricard", "--at", "10", "--output", "a%d.obj"});
  Succeed("shape-interpolate", {"a0.obj", "a0.obj", "--shapes", "1", "--output", "still.path"});
  const Outcome outcome = Run("shape-inspect", {"still.path"});
  ExpectContains(outcome.out,
                 "  deviation    none: all edges keep the lengths of the first pose\n");
}

TEST_F(FiguresTest, SpacesAreToldAsTheyAre) {
  Succeed("shape-body", {"tube", "--triangles", "200", "--at", "0,50,110", "-o", "tube%d.obj"});
  Succeed("shape-explore", {"tube0.obj", "tube1.obj", "tube2.obj", "--depth", "1", "--shapes", "3",
                            "--threshold", "1e-9", "-o", "t.space"});
  const Outcome outcome = Run("shape-inspect", {"t.space", "--report", "r.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const PoseSpace space = ReadSpace(Path("t.space"));
  ASSERT_GT(space.NumNodes(), space.NumPoses());
  const Connectivity& connectivity = *space.metric->connectivity;
  std::string expected = "t.space\n  made by      " + space.provenance + "\n";
  expected += Format("  mesh         %d vertices, %d triangles\n", connectivity.NumVertices(),
                     connectivity.NumTriangles());
  expected += Format("  metric       %s; unit of length %.6g\n",
                     DescribeMetric(space.metric->options).c_str(), space.metric->unit);
  expected += Format("  nodes        %d, of which 3 are poses; %d triangles, %d segments\n",
                     space.NumNodes(), static_cast<int>(space.triangles.cols()),
                     static_cast<int>(space.segments.cols()));
  expected += Format("  distances    up to %.4g; stress of the plane %.3g\n",
                     space.distances.maxCoeff(), space.stress);
  for (int i = 0; i < 3; ++i) {
    expected += Format("  pose         at %12.6g %12.6g  tube%d\n", space.points(0, i),
                       space.points(1, i), i);
  }
  EXPECT_EQ(outcome.out, expected + "wrote r.json\n");
  const auto report = nlohmann::json::parse(Content(Path("r.json")))["files"][0];
  EXPECT_EQ(report["kind"], "space");
  EXPECT_EQ(report["made_by"], space.provenance);
  EXPECT_EQ(report["vertices"], connectivity.NumVertices());
  EXPECT_EQ(report["triangles"], connectivity.NumTriangles());
  EXPECT_EQ(report["unit"], space.metric->unit);
  EXPECT_EQ(report["nodes"], space.NumNodes());
  EXPECT_EQ(report["largest_distance"], space.distances.maxCoeff());
  EXPECT_EQ(report["stress"], space.stress);
  ASSERT_EQ(report["poses"].size(), 3u);
  EXPECT_EQ(report["poses"][2]["name"], "tube2");
  EXPECT_EQ(report["poses"][2]["at"],
            (std::vector<double>{space.points(0, 2), space.points(1, 2)}));

  const Outcome measured = Run("shape-explore", {"--measure", "3", "t.space", "--threshold",
                                                 "0.125", "--resolution", "100"});
  ASSERT_EQ(measured.code, 0) << measured.err;
  std::smatch match;
  ASSERT_TRUE(std::regex_search(
      measured.out, match,
      std::regex("at 3 points, on ([0-9]+) vertices, blends deviate by ([-0-9.e]+)% on the mean, "
                 "([-0-9.e]+)% at most, of the greatest distance between poses; ([0-9.]+)% of "
                 "them by at most 12.5%\n")))
      << measured.out;
  EXPECT_GE(std::stod(match[3]), std::stod(match[2]));
  EXPECT_GT(std::stod(match[3]), 0.001);
  EXPECT_LT(std::stod(match[3]), 12.5);
  EXPECT_EQ(std::stod(match[4]), 100);
  // 12.5 per cent is an eighth.
  EXPECT_EQ(Run("shape-explore",
                {"--measure", "3", "t.space", "--threshold", "12.5%", "--resolution", "100"})
                .out,
            measured.out);
  File("c.json", R"({"points": ["tube0", [1e9, 0], "tube2"]})");
  const Outcome far =
      Run("shape-explore", {"--sample", "c.json", "t.space", "--frames", "4", "-o", "c%d.ply"});
  ASSERT_EQ(far.code, 0) << far.err;
  ExpectContains(far.err,
                 " of the 4 points lie outside the poses' hull and were replaced by the nearest "
                 "points of the hull\n");
}

TEST_F(FiguresTest, ModesAreToldAsTheyAre) {
  Succeed("shape-body", {"tube", "--triangles", "200", "--at", "0,30,70,110", "-o", "tube%d.obj"});
  Succeed("shape-statistics", {"tube0.obj", "tube1.obj", "tube2.obj", "tube3.obj", "--modes", "2",
                               "--size", "remove", "-o", "t.modes"});
  const Outcome outcome = Run("shape-inspect", {"t.modes", "--report", "r.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const PoseModes modes = ReadModes(Path("t.modes"));
  const Connectivity& connectivity = *modes.metric->connectivity;
  std::string expected = "t.modes\n  made by      " + modes.provenance + "\n";
  expected += Format("  mesh         %d vertices, %d triangles\n", connectivity.NumVertices(),
                     connectivity.NumTriangles());
  expected += Format("  metric       %s; unit of length %.6g\n",
                     DescribeMetric(modes.metric->options).c_str(), modes.metric->unit);
  expected += "  poses        4, scaled to the same area\n";
  expected += Format("  modes        2, with %.3g%% of the variance\n", 100 * modes.Share(2));
  const Eigen::MatrixXd coordinates = modes.Coordinates();
  for (int i = 0; i < 4; ++i) {
    expected +=
        Format("  pose         at %7.3f %7.3f  tube%d\n", coordinates(i, 0), coordinates(i, 1), i);
  }
  EXPECT_EQ(outcome.out, expected + "wrote r.json\n");
  const auto report = nlohmann::json::parse(Content(Path("r.json")))["files"][0];
  EXPECT_EQ(report["kind"], "modes");
  EXPECT_EQ(report["made_by"], modes.provenance);
  EXPECT_EQ(report["vertices"], connectivity.NumVertices());
  EXPECT_EQ(report["triangles"], connectivity.NumTriangles());
  EXPECT_EQ(report["unit"], modes.metric->unit);
  EXPECT_EQ(report["scaled"], true);
  EXPECT_EQ(report["modes"], 2);
  EXPECT_EQ(report["share"], modes.Share(2));
  EXPECT_EQ(report["poses"][3]["name"], "tube3");
  EXPECT_EQ(report["poses"][3]["at"], (std::vector<double>{coordinates(3, 0), coordinates(3, 1)}));

  // Animations go from -2 to 2 standard deviations, point caches have the mean and one of each.
  Succeed("shape-statistics", {"t.modes", "-o", "mode%d.glb,t.pc2,c.csv"});
  const auto shape_at = [&](const std::string& at) -> Shape {
    Succeed("shape-statistics", {"t.modes", "--at=" + at, "-o", "at.ply"});
    return ReadSoup(Path("at.ply")).vertices;
  };
  const auto edges = [&](const Shape& shape) {
    Eigen::VectorXd lengths(connectivity.NumEdges());
    for (int e = 0; e < lengths.size(); ++e) {
      const Eigen::Vector2i v = connectivity.Edges().col(e);
      lengths(e) = (shape.col(v(0)) - shape.col(v(1))).norm();
    }
    return lengths;
  };
  for (int k = 1; k <= 2; ++k) {
    const std::vector<Soup> soups = ReadSoups(Path("mode" + std::to_string(k) + ".glb"));
    ASSERT_EQ(soups.size(), 17u);
    for (const auto& [i, coordinate] : {std::pair{0, "-2"}, {6, "-0.5"}, {16, "2"}}) {
      const Eigen::VectorXd lengths = edges(soups[i].vertices);
      const std::string at = (k == 1 ? "" : "0,") + std::string(coordinate);
      EXPECT_LT((lengths - edges(shape_at(at))).norm(), 1e-4 * lengths.norm()) << at;
    }
  }
  const std::string cache = Content(Path("t.pc2"));
  const int count = 3 * connectivity.NumVertices();
  ASSERT_EQ(cache.size(), 32u + 3 * 4 * count);
  for (const auto& [i, at] : {std::pair{0, "0"}, {1, "1"}, {2, "0,1"}}) {
    Eigen::Map<const Eigen::VectorXf> stored(
        reinterpret_cast<const float*>(cache.data() + 32) + i * count, count);
    const Shape expected_shape = shape_at(at);
    EXPECT_LT((stored.cast<double>() - expected_shape.reshaped()).norm(),
              1e-5 * expected_shape.norm())
        << at;
  }
  EXPECT_LT((ReadPoseTable(Path("c.csv")).NumbersOf(modes.names) - coordinates).norm(), 1e-9);
}

TEST_F(FiguresTest, BodiesTellTheirSizeAndRange) {
  const Outcome values =
      Run("shape-body", {"sheet", "--triangles", "60", "--at", "90", "-o", "s%d.obj"});
  const Soup sheet = ReadSoup(Path("s0.obj"));
  EXPECT_EQ(values.out, Format("sheet: %d vertices, %d triangles; roll angle, degrees from 0 to "
                               "360\nwrote s0.obj\n",
                               sheet.NumVertices(), sheet.NumPolygons()));
  const Outcome poses = Run(
      "shape-body", {"quadruped", "--triangles", "500", "--pose", "sit", "--output", "a%d.obj"});
  const Soup animal = ReadSoup(Path("a0.obj"));
  EXPECT_EQ(poses.out,
            Format("quadruped: %d vertices, %d triangles; poses are stand, stride, sit, stretch, "
                   "rear, pass, other_stride, other_pass\nwrote a0.obj\n",
                   animal.NumVertices(), animal.NumPolygons()));
  const Outcome random =
      Run("shape-body", {"quadruped", "--triangles", "500", "--random", "1", "--proportions",
                         "heavy", "--table", "t.csv", "--output", "r%d.obj"});
  EXPECT_EQ(random.out, "wrote r0.obj\nwrote t.csv\n");
  const PoseTable table = ReadPoseTable(Path("t.csv"));
  EXPECT_EQ(table.columns,
            (Strings{"body_length", "body_girth", "neck_length", "neck_girth", "head_size",
                     "ear_length", "leg_length", "leg_girth", "tail_length"}));
  const Eigen::MatrixXd measures = table.NumbersOf({"r0"});
  EXPECT_LE(measures(0, 8), 0.6 * 4 / 3);  // the tail of the heavy
  EXPECT_GE(measures(0, 1), 1.35 * 3 / 4);
}

}  // namespace
}  // namespace shapespace
