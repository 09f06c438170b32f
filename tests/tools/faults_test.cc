#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/run.h"

namespace shapespace {
namespace {

namespace fs = std::filesystem;

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

const char* const kEveryTool[] = {"shape-average",     "shape-body",     "shape-correspond",
                                  "shape-deform",      "shape-explore",  "shape-export",
                                  "shape-extrapolate", "shape-inspect",  "shape-interpolate",
                                  "shape-statistics",  "shape-transfer", "shape-transport",
                                  "shape-view"};

/// What goes wrong outside of the tools: on disks, and with what they are given by who starts them.
class FaultsTest : public ToolsTest {
 protected:
  /// Runs a line of a shell in the test's folder; TOOL/ stands for the folder of the tools.
  Outcome Shell(std::string line) const {
    const std::string folder = "TOOL/";
    for (size_t at; (at = line.find(folder)) != line.npos;) {
      line.replace(at, folder.size(), SHAPESPACE_TOOLS_DIR "/");
    }
    Outcome outcome;
    const std::string command = "cd '" + Path("") + "' && { " + line + "; } 2>.stderr";
    outcome.code = WEXITSTATUS(std::system(command.c_str()));
    outcome.err = Content(Path(".stderr"));
    return outcome;
  }

  /// `Run`, where no file may have more than so many bytes.
  Outcome RunWithFilesUpTo(rlim_t bytes, const std::string& tool, const Strings& arguments) const {
    rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit small = {bytes, limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    Outcome outcome = Run(tool, arguments);
    setrlimit(RLIMIT_FSIZE, &limit);
    return outcome;
  }
};

TEST_F(FaultsTest, AFullStdoutIsAnErrorWhateverIsPrinted) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const auto expect_error = [&](const std::string& line) {
    const Outcome outcome = Shell("TOOL/" + line + " >/dev/full");
    EXPECT_EQ(outcome.code, 1) << line;
    ExpectContains(outcome.err, "stdout: writing failed");
  };
  for (const std::string tool : kEveryTool) {
    expect_error(tool + " --help");
    expect_error(tool + " --version");
  }
  expect_error("shape-body");
  expect_error("shape-body tube --at 0 --output -");
  expect_error("shape-body tube --at 0 --output tube%d.obj");
}

TEST_F(FaultsTest, FilesThatDoNotFitAreErrorsAndLeaveWhatWasThere) {
  MakeTubes();
  File("w.path", "old path");
  File("0.obj", "old mesh");
  const Strings before = Files();
  const Outcome none =
      RunWithFilesUpTo(1000, "shape-interpolate",
                       {"tube0.obj", "tube1.obj", "--shapes", "1", "--output", "w.path,%d.obj"});
  EXPECT_EQ(none.code, 1);
  ExpectContains(none.err, "w.path: writing failed: ");
  ExpectContains(none.err, "0.obj: writing failed: ");
  EXPECT_EQ(Content(Path("w.path")), "old path");
  EXPECT_EQ(Content(Path("0.obj")), "old mesh");
  EXPECT_EQ(Files(), before);

  // What fits is written: frames have some 15 KB.
  const Outcome some =
      RunWithFilesUpTo(17000, "shape-interpolate",
                       {"tube0.obj", "tube1.obj", "--shapes", "1", "--output", "w.path,%d.obj"});
  EXPECT_EQ(some.code, 1);
  ExpectContains(some.err, "w.path: writing failed: ");
  ExpectContains(some.out, "wrote 0.obj .. 2.obj");
  EXPECT_EQ(Content(Path("w.path")), "old path");
}

// A record that cannot be stored ends the run, as its result could not be stored either.
TEST_F(FaultsTest, RecordsThatDoNotFitAreNamed) {
  MakeTubes();
  const Outcome outcome =
      RunWithFilesUpTo(100, "shape-explore", {"tube0.obj", "tube1.obj", "--output", "d.csv"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "shape-explore: d.csv.records/");
  ExpectContains(outcome.err, ".geodesic: writing failed: ");
  EXPECT_EQ(Files(), (Strings{"d.csv.records", "tube0.obj", "tube1.obj"}));
}

TEST_F(FaultsTest, AStdinThatCannotBeReadIsNotTakenForAShortOne) {
  for (const char* from : {"<.", "<&-"}) {
    const Outcome outcome = Shell("TOOL/shape-inspect - " + std::string(from));
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err, "shape-inspect: stdin: cannot be read to its end\n") << from;
  }
}

// Otherwise the first file that is opened would be what messages are written to.
TEST_F(FaultsTest, StandardStreamsThatAreClosedAreNotUsedForFiles) {
  MakeTubes();
  for (const char* closed : {"0 <&-", "1 >&-"}) {
    const std::string number(closed, 1), how(closed + 2);
    const std::string stream = "/dev/fd/" + number;
    const Outcome outcome =
        Shell("TOOL/shape-deform tube0.obj --handles " + stream + " --output bent.obj " + how);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err, "shape-deform: " + stream + ": is empty\n");
  }
  EXPECT_EQ(Shell("TOOL/shape-body tube --at 0 --output - >&-").code, 1);
  EXPECT_EQ(Shell("TOOL/shape-body tube --at 0 --output quiet%d.obj 2>&-").code, 0);
  EXPECT_TRUE(fs::exists(Path("quiet0.obj")));
}

}  // namespace
}  // namespace shapespace
