#include <filesystem>

#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/output/picture.h>
#include <shapespace/path/path_file.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;

/// Files from strangers must not reach beyond their folder, nor the terminal of who reads them; and
/// what is made of one's own files must not tell strangers where they lie.
class HostileFilesTest : public testing::ToolsTest {
 protected:
  /// A square in home/ with a material library and a texture beside it, outside of home/.
  void MakeSquares() const {
    std::filesystem::create_directories(Path("home"));
    const std::string rest = "mtllib ../s.mtl\nusemtl s\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n";
    File("home/a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\n" + rest);
    File("home/b.obj", "v 0 0 0\nv 1 0 0\nv 1 2 0\n" + rest);
    File("s.mtl", "newmtl s\nmap_Kd s.png\n");
    WritePng(Path("s.png"), {2, 1, {255, 0, 0, 0, 0, 255}});
  }
};

TEST_F(HostileFilesTest, TexturesFromOutsideOfTheFolderNeedAFlag) {
  MakeSquares();
  const std::vector<std::string> arguments = {"home/a.obj", "home/b.obj",    "--metric",
                                              "strain",     "--shapes",      "1",
                                              "--output",   "w.glb,w/w.path"};
  const Outcome outcome = Run("shape-interpolate", arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.err, "s.mtl lies outside of the folder");
  ExpectContains(outcome.err, "allow_outside_files");
  ExpectLacks(Content(Path("w.glb")), "image/png");

  std::vector<std::string> trusting = arguments;
  trusting.push_back("--allow_outside_files");
  const Outcome trusted = Run("shape-interpolate", trusting);
  ExpectLacks(trusted.err, "lies outside");
  ExpectContains(Content(Path("w.glb")), "image/png");

  // A .path may name any folder: it is its own that counts.
  ExpectContains(Run("shape-export", {"w/w.path", "--output", "e.glb"}).err, "lies outside");
  ExpectLacks(Content(Path("e.glb")), "image/png");
  Succeed("shape-export", {"w/w.path", "--output", "e.glb", "--allow_outside_files"});
  ExpectContains(Content(Path("e.glb")), "image/png");
}

TEST_F(HostileFilesTest, OutputsNameFilesWithoutTheirFolders) {
  MakeSquares();
  std::filesystem::create_directories(Path("away"));
  std::filesystem::copy_file(Path("home/a.obj"), Path("away/a.obj"));
  Succeed("shape-interpolate", {Path("home/a.obj"), Path("home/b.obj"), "--metric", "strain",
                                "--shapes", "1", "--output", "w.glb,w.path"});
  ExpectContains(ReadPath(Path("w.path")).provenance, ": a.obj b.obj");
  const std::string folder = std::filesystem::path(Path("home")).parent_path().filename().string();
  ExpectContains(Content(Path("w.glb")), "a.obj b.obj");
  ExpectLacks(Content(Path("w.glb")), folder);
  ExpectLacks(Content(Path("w.path")), folder);

  File("away/b.obj", Content(Path("home/b.obj")));
  Succeed("shape-explore", {Path("home/a.obj"), Path("home/b.obj"), Path("away/b.obj"), "--metric",
                            "strain", "--depth", "0", "--output", "p.space"});
  ExpectLacks(Content(Path("p.space")), folder);
  ExpectContains(Content(Path("p.space")), "\"b 2\"");
}

TEST_F(HostileFilesTest, TerminalsGetNoControlCharactersFromFiles) {
  MakeSquares();
  Succeed("shape-interpolate", {"home/a.obj", "home/b.obj", "--metric", "strain", "--shapes", "1",
                                "--output", "w.path"});
  shapespace::Path path = ReadPath(Path("w.path"));
  path.provenance =
      "nobody\n\x1b[2J\x1b]0;title\x07 and \xc2\x9b"
      "31m caf\xc3\xa9";
  WritePath(Path("w.path"), path);
  const Outcome inspected = Run("shape-inspect", {"w.path"});
  EXPECT_EQ(inspected.code, 0) << inspected.err;
  ExpectContains(inspected.out,
                 "made by      nobody\\x0a\\x1b[2J\\x1b]0;title\\x07 and \\x9b31m caf\xc3\xa9\n");

  // Names in meshes and of files, in results and in messages.
  File("c\x1b[31m.obj", Content(Path("home/a.obj")) + "x\x1b[2Jy z\n");
  const Outcome mesh = Run("shape-inspect", {"c\x1b[31m.obj", "none\x1b[31m.obj"});
  ExpectContains(mesh.out, "c\\x1b[31m.obj");
  ExpectContains(mesh.err, "none\\x1b[31m.obj: cannot be opened");
  for (const std::string& text : {inspected.out, mesh.out, mesh.err}) ExpectLacks(text, "\x1b");
}

TEST_F(HostileFilesTest, DeepJsonIsRefusedWithAMessage) {
  const int levels = 200000;
  File("deep.gltf", "{\"asset\":{\"version\":\"2.0\",\"extras\":" + std::string(levels, '[') +
                        std::string(levels, ']') + "}}");
  const Outcome outcome = Run("shape-inspect", {"deep.gltf"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "deep.gltf: its lists and objects are nested more than 100 deep");
}

}  // namespace
}  // namespace shapespace
