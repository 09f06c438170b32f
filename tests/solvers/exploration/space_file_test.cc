#include <shapespace/exploration/space_file.h>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/path/path_file.h>

#include "mesh/files.h"
#include "solvers/exploration/spaces.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectError;
using testing::FilesTest;
using testing::MadeUpSpace;
using testing::SmallTube;

class SpaceFileTest : public FilesTest {
 protected:
  const PoseSpace space_ = MadeUpSpace(SmallTube());
};

TEST_F(SpaceFileTest, EverythingComesBack) {
  WriteSpace(Path("a.space"), space_);
  const PoseSpace read = ReadSpace(Path("a.space"));
  EXPECT_EQ(read.nodes, space_.nodes);
  EXPECT_EQ(read.names, space_.names);
  EXPECT_EQ(read.translation, space_.translation);
  EXPECT_EQ(read.points, space_.points);
  EXPECT_EQ(read.triangles, space_.triangles);
  EXPECT_EQ(read.segments.cols(), 0);
  EXPECT_EQ(read.parents, space_.parents);
  EXPECT_EQ(read.distances, space_.distances);
  EXPECT_EQ(read.stress, space_.stress);
  EXPECT_EQ(read.provenance, space_.provenance);
  EXPECT_EQ(read.metric->unit, space_.metric->unit);
  EXPECT_EQ(read.At({.3, .4}), space_.At({.3, .4}));
  WriteSpace(Path("b.space"), read);
  EXPECT_EQ(Content(Path("a.space")), Content(Path("b.space")));
}

TEST_F(SpaceFileTest, DamageIsNoticedWhereverItIs) {
  WriteSpace(Path("a.space"), space_);
  const std::string whole = Content(Path("a.space"));
  for (size_t at = 8; at < whole.size(); at += whole.size() / 37) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    File("damaged.space", damaged);
    EXPECT_THROW(ReadSpace(Path("damaged.space")), FileError) << at;
    File("cut.space", whole.substr(0, at));
    EXPECT_THROW(ReadSpace(Path("cut.space")), FileError) << at;
  }
  ExpectError<FileError>([&] { ReadSpace(Path("damaged.space")); }, {"damaged.space", "damaged"});
}

TEST_F(SpaceFileTest, OtherFilesAreNamed) {
  ExpectError<FileError>([&] { ReadSpace(File("a.space", "solid")); },
                         {"a.space", "this is not a .space file"});
  ExpectError<FileError>([&] { ReadSpace(Path("none.space")); }, {"none.space"});
  WriteSpace(Path("a.path"), space_);
  ExpectError<FileError>([&] { ReadPath(Path("a.path")); }, {"this is not a .path file"});
}

TEST_F(SpaceFileTest, ASpaceThatIsNotValidIsNotWritten) {
  PoseSpace space = space_;
  space.names.clear();
  ExpectError<MeshError>([&] { WriteSpace(Path("a.space"), space); }, {"a.space", "poses"});
  EXPECT_FALSE(std::filesystem::exists(Path("a.space")));
}

TEST_F(SpaceFileTest, NamesMayBeOfAnyBytes) {
  PoseSpace space = space_;
  space.names[1] = "k\xf6rper";
  WriteSpace(Path("a.space"), space);
  EXPECT_EQ(ReadSpace(Path("a.space")).names, space.names);
}

TEST_F(SpaceFileTest, CurvesLeadThroughPointsAndPoses) {
  File("curve.json", R"({"points": [[0.5, 0.25], "c", [1e-3, 2]]})");
  const auto points = ReadCurve(Path("curve.json"), space_);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0], Eigen::Vector2d(0.5, 0.25));
  EXPECT_EQ(points[1], Eigen::Vector2d(1, 1));
  EXPECT_EQ(points[2], Eigen::Vector2d(1e-3, 2));
}

TEST_F(SpaceFileTest, WhatIsWrongInACurveIsNamed) {
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    ExpectError<FileError>([&] { ReadCurve(File("curve.json", text), space_); }, parts);
  };
  expect(R"({"points": []})", {"curve.json", "points"});
  expect(R"({"point": []})", {"point"});
  expect(R"({"points": [[1]]})", {"point 1", "two numbers"});
  expect(R"({"points": [[1, 2], ["a", 2]]})", {"point 2"});
  expect(R"({"points": ["nobody"]})", {"point 1", "nobody", "not a pose"});
  expect("{", {"curve.json", "line 1"});
}

}  // namespace
}  // namespace shapespace
