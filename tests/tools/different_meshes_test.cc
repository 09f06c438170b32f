#include <algorithm>
#include <cstdlib>

#include "tools/run.h"

// Of two meshes that are no poses of one, each tool names the command that makes them such.

namespace shapespace {
namespace {

using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

class DifferentMeshesTest : public ToolsTest {
 protected:
  /// a0.obj and a1.obj, poses of an animal, and another one, whose name a shell would take apart.
  void MakeBodies() const {
    Succeed("shape-body",
            {"quadruped", "--triangles", "1500", "--pose", "stand,sit", "--output", "a%d.obj"});
    Succeed("shape-body", {"quadruped", "--triangles", "2100", "--pose", "sit", "--proportions",
                           "heavy", "--output", "my %d.obj"});
  }

  static int CountOf(const std::string& text, const std::string& part) {
    int count = 0;
    for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
    return count;
  }

  /// Expects that the run fails, and names this template and the other mesh in a command.
  void ExpectCommand(const std::string& tool, const Strings& arguments,
                     const std::string& of) const {
    SCOPED_TRACE(tool);
    const Outcome outcome = Run(tool, arguments);
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_EQ(CountOf(outcome.err, "shape-correspond"), 1) << outcome.err;
    ExpectContains(outcome.err, "shape-correspond " + of + " 'my 0.obj' --output ");
    ExpectLacks(outcome.err, "Correspond ");
  }

  static constexpr char kOther[] = "my 0.obj";
};

TEST_F(DifferentMeshesTest, EachToolNamesTheCommand) {
  MakeBodies();
  Succeed("shape-interpolate", {"a0.obj", "a1.obj", "--shapes", "1", "--output", "w.path"});
  Succeed("shape-statistics", {"a0.obj", "a1.obj", "--output", "m.modes"});
  for (const char* tool : {"shape-interpolate", "shape-average", "shape-extrapolate",
                           "shape-statistics", "shape-inspect", "shape-explore"}) {
    ExpectCommand(tool, {"a0.obj", "a1.obj", kOther}, "a0.obj");
  }
  ExpectCommand("shape-transport", {"a0.obj", "a1.obj", kOther}, "a0.obj");
  ExpectCommand("shape-deform", {kOther, "--repair", "a0.obj", "--output", "b.obj"}, "a0.obj");
  // Of files that hold more than a mesh, the command has a name that the reader is to replace.
  ExpectCommand("shape-transport", {"w.path", kOther}, "template.obj");
  ExpectCommand("shape-statistics", {"m.modes", "--coordinates", kOther}, "template.obj");
}

TEST_F(DifferentMeshesTest, TheCommandCanBePasted) {
  MakeBodies();
  const Outcome refused = Run("shape-interpolate", {"a0.obj", kOther});
  const size_t begin = refused.err.find("shape-correspond ");
  ASSERT_NE(begin, refused.err.npos);
  const std::string command = refused.err.substr(begin, refused.err.find('\n', begin) - begin);
  ASSERT_EQ(std::system(("cd '" + Path("") + "' && PATH=" SHAPESPACE_TOOLS_DIR ":$PATH " + command +
                         " >said 2>&1")
                            .c_str()),
            0);
  const Strings files = Files();
  const std::string fitted = "my 0_as_a0.obj";
  ASSERT_EQ(std::count(files.begin(), files.end(), fitted), 1) << command;
  Succeed("shape-interpolate", {"a0.obj", fitted, "--shapes", "1", "--output", "w.path"});
}

// A recut copy has another remedy, and a graph has no surface to be fitted.
TEST_F(DifferentMeshesTest, OtherDifferencesDoNotNameIt) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  File("a.obj", points + "f 1 2 3\nf 1 3 4\n");
  File("cut.obj", points + "f 1 2 4\nf 2 3 4\n");
  File("line.obj", points + "l 1 2\n");
  File("lines.obj", points + "l 1 2\nl 2 3\n");
  ExpectLacks(Run("shape-interpolate", {"a.obj", "cut.obj"}).err, "correspond");
  ExpectLacks(Run("shape-interpolate", {"line.obj", "lines.obj"}).err, "correspond");
}

}  // namespace
}  // namespace shapespace
