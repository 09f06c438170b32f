#include <shapespace/correspondence/landmark_file.h>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/correspondence/marker_file.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::ExpectError;
using Strings = std::vector<std::string>;

const std::string kFcsv = "# Markups fiducial file version = 4.13\n# CoordinateSystem = ";
const std::string kColumns =
    "\n# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n";

std::string FcsvLine(const std::string& coordinates, const std::string& label) {
  return "1," + coordinates + ",0,0,0,1,1,1,0," + label + ",,,2,0\n";
}

std::string Json(const std::string& system, const std::string& points) {
  return R"({"@schema": "markups-schema-v1.0.3.json#", "markups": [{"type": "Fiducial",)"
         R"("coordinateSystem": ")" +
         system + R"(", "coordinateUnits": "mm", "controlPoints": [)" + points + "]}]}";
}

class LandmarkFileTest : public testing::FilesTest {
 protected:
  LandmarkFileTest() {
    // A bent sheet of 6 x 4 squares of side 1, on which no reflection of an axis is near itself.
    Soup sheet = testing::Grid(6, 4);
    sheet.vertices.colwise() += Eigen::Vector3d(10, 20, 0);
    for (int v = 0; v < sheet.NumVertices(); ++v) {
      sheet.vertices(2, v) = 0.1 * sheet.vertices(0, v) * sheet.vertices(1, v);
    }
    sheet.file = "sheet";
    mesh_ = MakePoses({sheet});
  }

  const Shape& Vertices() const { return mesh_.shapes[0]; }

  /// x, y and z of a vertex and of what is beside it, separated by `separator`.
  std::string At(int vertex, const std::string& separator, double sign = 1) const {
    const Eigen::Vector3d p = Vertices().col(vertex) + Eigen::Vector3d(0.2, -0.1, 0.05);
    return std::to_string(sign * p.x()) + separator + std::to_string(sign * p.y()) + separator +
           std::to_string(p.z());
  }

  std::vector<std::pair<int, int>> Matched(const std::string& first,
                                           const std::string& second) const {
    std::vector<std::pair<int, int>> pairs;
    for (const CorrespondenceMarker& marker : MatchLandmarks(first, second, mesh_, mesh_).markers) {
      pairs.emplace_back(marker.template_vertex, marker.target_vertex);
    }
    return pairs;
  }

  void Refused(const std::string& first, const std::string& second, const Strings& parts) const {
    ExpectError<FileError>([&] { MatchLandmarks(first, second, mesh_, mesh_); }, parts);
  }

  Poses mesh_;
};

TEST_F(LandmarkFileTest, AllFormatsAndCoordinateSystemsGiveTheSameVertices) {
  const int vertices[] = {3, 17, 30};
  const Strings labels = {"nose", "\"ear, left\"", "tail"};
  std::string lps = kFcsv + "LPS" + kColumns, ras = kFcsv + "0" + kColumns, text = "# x y z\n";
  std::string json_lps, json_ras;
  for (int k = 0; k < 3; ++k) {
    const int v = vertices[k];
    lps += FcsvLine(At(v, ","), labels[k]);
    ras += FcsvLine(At(v, ",", -1), labels[k]);
    text += At(v, " ") + "\n";
    const std::string label = k == 1 ? "ear, left" : labels[k];
    const auto point = [&](double sign) {
      return std::string(k > 0 ? ", " : "") + R"({"id": "1", "label": ")" + label +
             R"(", "position": [)" + At(v, ", ", sign) + R"(], "positionStatus": "defined"})";
    };
    json_lps += point(1);
    json_ras += point(-1);
  }
  const std::string unplaced = R"(, {"label": "chin", "positionStatus": "undefined"})";
  const Strings files = {File("lps.fcsv", lps), File("ras.fcsv", ras), File("plain.txt", text),
                         File("lps.mrk.json", Json("LPS", json_lps + unplaced)),
                         File("ras.mrk.json", Json("RAS", json_ras))};
  const std::vector<std::pair<int, int>> expected = {{3, 3}, {17, 17}, {30, 30}};
  for (const std::string& first : files) {
    for (const std::string& second : files) {
      EXPECT_EQ(Matched(first, second), expected) << first << " " << second;
      EXPECT_TRUE(MatchLandmarks(first, second, mesh_, mesh_).warnings.empty());
    }
  }
  EXPECT_EQ(ReadLandmarks(files[1])[1].label, "ear, left");
  EXPECT_EQ(ReadLandmarks(files[3]).size(), 3u);
}

TEST_F(LandmarkFileTest, LabelsComeBeforeTheOrder) {
  const std::string head = kFcsv + "LPS" + kColumns;
  const std::string first =
      File("a.fcsv", head + FcsvLine(At(3, ","), "a") + FcsvLine(At(8, ","), "x") +
                         FcsvLine(At(17, ","), "b"));
  const std::string second =
      File("b.fcsv", head + FcsvLine(At(20, ","), "b") + FcsvLine(At(30, ","), "a"));
  EXPECT_EQ(Matched(first, second), (std::vector<std::pair<int, int>>{{3, 30}, {17, 20}}));
  const Strings warnings = MatchLandmarks(first, second, mesh_, mesh_).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(testing::Names(warnings[0], {"landmark 2", "'x'"})) << warnings[0];
  // Without a common label, by order.
  const std::string other =
      File("c.fcsv", head + FcsvLine(At(20, ","), "c") + FcsvLine(At(30, ","), "d"));
  EXPECT_EQ(Matched(second, other), (std::vector<std::pair<int, int>>{{20, 20}, {30, 30}}));
  EXPECT_EQ(MatchLandmarks(second, other, mesh_, mesh_).warnings.size(), 1u);
  Refused(first, other, {"c.fcsv", "2 landmarks", "3", "same order"});
  const std::string twice =
      File("d.fcsv", head + FcsvLine(At(20, ","), "a") + FcsvLine(At(30, ","), "a"));
  Refused(first, twice, {"d.fcsv", "two landmarks", "'a'"});
}

TEST_F(LandmarkFileTest, LandmarksFarFromTheSurfaceAreNamed) {
  const std::string good = File("good.txt", At(3, " ") + "\n" + At(17, " ") + "\n");
  const Eigen::Vector3d size = Vertices().rowwise().maxCoeff() - Vertices().rowwise().minCoeff();
  const Eigen::Vector3d corner = Vertices().col(0);
  // Beside the corner, where the nearest point is the corner itself.
  const auto beside = [&](double share) {
    std::ostringstream text;
    text << At(17, " ") << "\n"
         << corner.x() - share * kFarthestLandmark * size.norm() << " " << corner.y() << " "
         << corner.z() << "\n";
    return text.str();
  };
  EXPECT_EQ(Matched(good, File("near.txt", beside(0.9)))[1].second, 0);
  Refused(good, File("far.txt", beside(1.2)), {"far.txt", "landmark 2", "sheet"});
  // Coordinates in the other system are on the other side of the axis.
  const std::string wrong =
      File("wrong.fcsv",
           kFcsv + "RAS" + kColumns + FcsvLine(At(3, ","), "nose") + FcsvLine(At(17, ","), "ear"));
  Refused(good, wrong, {"wrong.fcsv", "landmark 1 'nose'", "exchange LPS and RAS"});
  Refused(good, File("huge.txt", "1e300 0 0\n1 1 1\n"), {"huge.txt", "landmark 1"});
  Refused(good, File("same.txt", At(3, " ") + "\n" + At(3, " ") + "\n"),
          {"same.txt", "landmark 1 and landmark 2", "vertex 4 of sheet"});
}

// Some editors begin a text with a byte order mark.
TEST_F(LandmarkFileTest, AByteOrderMarkIsNoPartOfTheFirstLine) {
  const auto landmarks = ReadLandmarks(File("mark.fcsv",
                                            "\xEF\xBB\xBF"
                                            "# CoordinateSystem = RAS\n1,2,3,4\n"));
  ASSERT_EQ(landmarks.size(), 1u);
  EXPECT_EQ(landmarks[0].position, Eigen::Vector3d(-2, -3, 4));
}

TEST_F(LandmarkFileTest, WhatCannotBeReadIsNamed) {
  const auto refused = [&](const std::string& name, const std::string& text, const Strings& parts) {
    ExpectError<FileError>([&] { ReadLandmarks(File(name, text)); }, parts);
  };
  refused("a.fcsv", "1,2,3,4\n", {"a.fcsv:1", "CoordinateSystem"});
  refused("a.fcsv", "# CoordinateSystem = IJK\n", {"a.fcsv:1", "'IJK'", "LPS"});
  refused("a.fcsv", "# CoordinateSystem = LPS\n1,2,3\n", {"a.fcsv:2", "landmark 1", "z"});
  refused("a.fcsv", "# CoordinateSystem = LPS\n1,2,x,3\n", {"a.fcsv:2", "landmark 1", "'x'"});
  refused("a.fcsv", "# CoordinateSystem = LPS\n# columns = a,b\n", {"a.fcsv:2", "column x"});
  refused("a.fcsv", "# CoordinateSystem = LPS\n", {"a.fcsv", "no landmark"});
  refused("a.mrk.json", "{", {"a.mrk.json", "line 1"});
  refused("a.mrk.json", "[]", {"a.mrk.json", "markups"});
  refused("a.mrk.json", R"({"markups": [{}]})", {"markups.coordinateSystem", "missing"});
  refused("a.mrk.json", R"({"markups": [{}, {}]})", {"2 lists"});
  refused("a.mrk.json", Json("IJK", ""), {"'IJK'"});
  refused("a.mrk.json", Json("LPS", ""), {"no landmark"});
  refused("a.mrk.json", Json("LPS", R"({"label": "a"})"), {"point 1", "position", "missing"});
  refused("a.mrk.json", Json("LPS", R"({"position": [1, 2]})"), {"point 1", "three numbers"});
  refused("a.mrk.json", Json("LPS", R"({"position": [1, 2, 3], "label": 4})"), {"label", "text"});
  refused("a.txt", "1 2 3\n1 2\n", {"a.txt:2", "landmark 2", "z"});
  refused("a.txt", "1 2 3 nose\n", {"a.txt:1", "'nose'"});
  refused("a.txt", "1 2 inf\n", {"a.txt:1", "finite"});
  ExpectError<FileError>([&] { ReadMarkers(File("b.fcsv", "x"), mesh_, mesh_); },
                         {"b.fcsv", "each of the two"});
}

}  // namespace
}  // namespace shapespace
