#include <cstdlib>
#include <filesystem>

#include "output/read_page.h"
#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

class ViewTest : public ToolsTest {
 protected:
  /// walk.path, of three shapes, and walk.glb.
  void MakeWalk() const {
    MakeTubes();
    Succeed("shape-interpolate",
            {"tube0.obj", "tube1.obj", "--shapes", "1", "--output", "walk.path,walk.glb"});
  }

  void ExpectRefusal(int code, const Strings& arguments, const std::string& part) const {
    const Strings before = Files();
    const Outcome outcome = Run("shape-view", arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    ExpectContains(outcome.err, part);
    if (code == 2) ExpectContains(outcome.err, "Try shape-view --help");
    EXPECT_EQ(Files(), before) << outcome.err;
  }

  /// Whether shape-view contains the page, which needs npm. Otherwise it explains how to get it.
  bool HasPage() const {
    const Outcome outcome = Run("shape-view", {"walk.path", "--output", "try.html"});
    if (outcome.code == 0) return true;
    EXPECT_EQ(outcome.code, 1);
    ExpectContains(outcome.err, "built without the viewer page");
    ExpectContains(outcome.err, "./dev viewer");
    EXPECT_FALSE(std::filesystem::exists(Path("try.html")));
    return false;
  }
};

TEST_F(ViewTest, MakesPagesOfPathsAndGlbs) {
  MakeWalk();
  if (!HasPage()) GTEST_SKIP() << "built without the viewer's page";
  Succeed("shape-view", {"walk.path", "walk.glb", "--output", "sub/both.html"});
  const std::vector<PageElement> elements = ReadPage(Path("sub/both.html"));
  ASSERT_EQ(elements.size(), 2u);
  const DecodedScene path(elements[0].bytes);
  EXPECT_EQ(path.header["name"], "walk.path");
  EXPECT_EQ(path.steps.size(), 3u);
  EXPECT_EQ(elements[1].name, "walk.glb");
  EXPECT_EQ(elements[1].bytes, Content(Path("walk.glb")));
}

TEST_F(ViewTest, WritesThePageThatComputesMotions) {
  ExpectRefusal(2, {"--solver", "walk.path"}, "--solver");
  const Outcome outcome = Run("shape-view", {"--solver", "--output", "sub/solver.html"});
  if (outcome.code != 0) {
    ExpectContains(outcome.err, "./dev wasm");
    EXPECT_FALSE(std::filesystem::exists(Path("sub/solver.html")));
    return;
  }
  const std::string page = Content(Path("sub/solver.html"));
  ExpectContains(page, "</html>");
  ExpectContains(page, "solver-module");
  EXPECT_LT(page.size(), 3u << 20);
}

TEST_F(ViewTest, EveryToolThatWritesAPathWritesItsPage) {
  MakeWalk();
  if (!HasPage()) {
    const Outcome outcome = Run("shape-export", {"walk.path", "--output", "sub/moved.html"});
    EXPECT_EQ(outcome.code, 1);
    ExpectContains(outcome.err, "built without the viewer page");
    return;
  }
  Succeed("shape-export", {"walk.path", "--output", "sub/moved.html,moved.png"});
  const std::vector<PageElement> elements = ReadPage(Path("sub/moved.html"));
  ASSERT_EQ(elements.size(), 1u);
  EXPECT_EQ(DecodedScene(elements[0].bytes).header["name"], "moved");
}

// The licence of three.js asks for its notice wherever a copy of it goes, and so does the page's
// own.
TEST_F(ViewTest, PagesHaveTheNoticesOfWhatTheyContain) {
  MakeWalk();
  if (!HasPage()) GTEST_SKIP() << "built without the viewer's page";
  Succeed("shape-view", {"walk.path", "--output", "walk.html"});
  const std::string page = Content(Path("walk.html"));
  for (const char* notice : {"three.js authors", "Permission is hereby granted, free of charge",
                             "The shapespace authors", "Redistribution and use"}) {
    ExpectContains(page, notice);
  }
}

TEST_F(ViewTest, MakesPagesOfSpaces) {
  MakeWalk();
  if (!HasPage()) GTEST_SKIP() << "built without the viewer's page";
  Succeed("shape-body",
          {"tube", "--triangles", "300", "--at", "0,50,100", "--output", "pose%d.obj"});
  Succeed("shape-explore", {"pose0.obj", "pose1.obj", "pose2.obj", "--output", "tubes.space"});
  Succeed("shape-view", {"tubes.space", "--output", "tubes.html"});
  const std::vector<PageElement> elements = ReadPage(Path("tubes.html"));
  ASSERT_EQ(elements.size(), 1u);
  const DecodedScene scene(elements[0].bytes);
  EXPECT_EQ(scene.header["kind"], "space");
  EXPECT_EQ(scene.header["names"].size(), 3u);
  EXPECT_EQ(scene.header["points"].size(), scene.steps.size());
}

TEST_F(ViewTest, PagesOfMeshesHaveTheNumbersOfTheirFiles) {
  // The second vertex belongs to no face, and three faces share an edge.
  File("fan.obj",
       "v 0 0 0\nv 9 9 9\nv 0 1 0\nv 1 0 0\nv -1 0 0\nv 0 0 1\nf 1 3 4\nf 1 3 5\nf 3 1 6\n");
  MakeWalk();
  if (!HasPage()) GTEST_SKIP() << "built without the viewer's page";
  Succeed("shape-view", {"fan.obj", "fan.obj", "--output", "fans.html"});
  const std::vector<PageElement> elements = ReadPage(Path("fans.html"));
  ASSERT_EQ(elements.size(), 2u);
  const DecodedScene scene(elements[1].bytes);
  EXPECT_EQ(scene.header["kind"], "mesh");
  EXPECT_EQ(scene.header["name"], "fan.obj");
  EXPECT_EQ(scene.triangles, (std::vector<int>{0, 2, 3, 0, 2, 4, 2, 0, 5}));
  EXPECT_LT((scene.Shape(0).col(1) - Eigen::Vector3d(9, 9, 9)).norm(), 1e-3);
}

TEST_F(ViewTest, ExplainsWrongCommandLines) {
  MakeWalk();
  ExpectRefusal(2, {"walk.path", "tubes.space"}, "tubes.space: a space is shown alone");
  ExpectRefusal(2, {}, "name one file, or two to compare");
  ExpectRefusal(2, {"walk.path", "walk.path", "walk.glb"}, "name one file, or two to compare");
  ExpectRefusal(2, {"tube0.png"}, "tube0.png: must be a .path");
  ExpectRefusal(2, {"walk.path", "tube0.obj"}, "tube0.obj: a mesh is shown alone");
  ExpectRefusal(2, {"walk.path", "--output", "walk.png"}, "--output walk.png: must end in .html");
  ExpectRefusal(1, {"walk.path", "--output", "walk.glb/x.html"}, "walk.glb is not a folder");
}

TEST_F(ViewTest, APageHasTheNameOfWhatItShows) {
  MakeWalk();
  if (!HasPage()) GTEST_SKIP() << "built without the viewer's page";
  std::filesystem::create_directory(Path("sub"));
  std::filesystem::rename(Path("walk.path"), Path("sub/walk.path"));
  ExpectContains(Run("shape-view", {"sub/walk.path"}).out, "walk.html");
  Succeed("shape-view", {"tube0.obj", "tube1.obj"});
  EXPECT_EQ(ReadPage(Path("walk.html")).size(), 1u);
  EXPECT_EQ(ReadPage(Path("tube0_and_tube1.html")).size(), 2u);
}

TEST_F(ViewTest, TheViewIsThatOfTheFlags) {
  MakeWalk();
  if (!HasPage()) GTEST_SKIP() << "built without the viewer's page";
  const auto header = [&](Strings arguments) {
    Succeed(arguments[0], {arguments.begin() + 1, arguments.end()});
    return DecodedScene(ReadPage(Path("a.html"))[0].bytes).header;
  };
  const auto given =
      header({"shape-view", "walk.path", "--up", "-x", "--view", "0,0,-2", "--output", "a.html"});
  EXPECT_EQ(given["up"], (std::vector<double>{-1, 0, 0}));
  EXPECT_EQ(given["eye"], (std::vector<double>{0, 0, -1}));
  EXPECT_EQ(header({"shape-export", "walk.path", "--up", "0,-3,4", "--output", "a.html"})["up"],
            (std::vector<double>{0, -0.6, 0.8}));
  ExpectRefusal(2, {"walk.path", "--up", "w"}, "--up w");
  ExpectRefusal(2, {"walk.path", "--up", "1,2"}, "--up 1,2");
  ExpectRefusal(2, {"walk.path", "--view", "0,0,0"}, "--view 0,0,0");
  ExpectRefusal(2, {"walk.path", "--up", "z", "--view", "0,0,1"}, "--up z");
}

// A program named xdg-open that the test puts first on the path stands for the user's browser.
TEST_F(ViewTest, APageCanBeOpened) {
  MakeWalk();
  if (!HasPage()) GTEST_SKIP() << "built without the viewer's page";
  std::filesystem::create_directory(Path("bin"));
  File("bin/xdg-open", "#!/bin/sh\necho \"$1\" >'" + Path("opened") + "'\n");
  std::filesystem::permissions(Path("bin/xdg-open"), std::filesystem::perms::owner_all);
  const std::string before = std::getenv("PATH");
  setenv("PATH", (Path("bin") + ":" + before).c_str(), 1);
  Succeed("shape-view", {"walk.path", "--open"});
  setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(Content(Path("opened")), std::filesystem::canonical(Path("walk.html")).string() + "\n");
  // Without a browser the page is written all the same.
  File("bin/xdg-open", "#!/bin/sh\nexit 3\n");
  setenv("PATH", (Path("bin") + ":" + before).c_str(), 1);
  const Outcome outcome = Run("shape-view", {"tube0.obj", "--open"});
  setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(outcome.code, 0);
  ExpectContains(outcome.err, "tube0.html");
}

TEST_F(ViewTest, OverwritesNothingThatItReads) {
  MakeWalk();
  std::filesystem::create_symlink(Path("walk.path"), Path("alias.html"));
  ExpectRefusal(2, {"walk.path", "--output", "alias.html"}, "would overwrite walk.path");
}

TEST_F(ViewTest, NamesFilesThatCannotBeRead) {
  MakeWalk();
  if (!HasPage()) GTEST_SKIP() << "built without the viewer's page";
  std::filesystem::remove(Path("try.html"));
  File("cut.path", Content(Path("walk.path")).substr(0, 500));
  File("no.glb", "no glb");
  ExpectRefusal(1, {"nowhere.path"}, "nowhere.path");
  ExpectRefusal(1, {"cut.path"}, "cut.path");
  ExpectRefusal(1, {"no.glb"}, "no.glb: is not a binary glTF file");
}

}  // namespace
}  // namespace shapespace
