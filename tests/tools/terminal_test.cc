#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <regex>
#include <sstream>

#include <shapespace/path/path_file.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::ExpectContains;
using testing::ToolsTest;

/// The two ends of a terminal: programs use `inner`, the test uses `outer`.
class PseudoTerminal {
 public:
  PseudoTerminal() : outer_(posix_openpt(O_RDWR | O_NOCTTY)) {
    if (outer_ >= 0 && grantpt(outer_) == 0 && unlockpt(outer_) == 0) {
      inner_ = open(ptsname(outer_), O_RDWR | O_NOCTTY);
    }
  }
  ~PseudoTerminal() {
    close(inner_);
    close(outer_);
  }
  int Inner() const { return inner_; }

  /// Reads until `part` has been written since the previous call; false if that takes longer than
  /// `milliseconds`, or the other end is closed.
  bool WaitFor(const std::string& part, int milliseconds = 60000) {
    pollfd ready = {outer_, POLLIN, 0};
    for (const size_t begin = text_.size(); text_.find(part, begin) == std::string::npos;) {
      char buffer[256];
      if (poll(&ready, 1, milliseconds) != 1) return false;
      const ssize_t count = read(outer_, buffer, sizeof buffer);
      if (count <= 0) return false;
      text_.append(buffer, count);
    }
    return true;
  }
  const std::string& Text() const { return text_; }

  /// Writes until nothing more is taken, for as long as nobody reads.
  void Fill() const {
    const int again = open(ptsname(outer_), O_WRONLY | O_NOCTTY | O_NONBLOCK);
    while (write(again, "x", 1) == 1) continue;
    close(again);
  }

 private:
  int outer_, inner_ = -1;
  std::string text_;
};

class TerminalTest : public ToolsTest {
 protected:
  void SetUp() override {
    if (terminal_.Inner() < 0) GTEST_SKIP() << "this machine gives no pseudo-terminal";
  }

  /// Both poses, and flags for a solve between them that takes minutes.
  std::vector<std::string> LongSolve(const std::vector<std::string>& more) const {
    MakeTubes(4000);
    std::vector<std::string> arguments = {
        "tube0.obj", "tube1.obj", "--shapes",   "63",   "--tolerance",      "1e-15",
        "--start",   "first",     "--schedule", "flat", "--solver",         "lbfgs",
        "--lambda",  "1e-9",      "--bending",  "1e-9", "--max_iterations", "1000000"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  /// Starts a tool with stdout and stderr on the terminal, and sends it `signal` when it shows
  /// `part`, and again if `twice`. Returns its exit status.
  int Interrupt(int signal, const std::string& part, const std::string& tool,
                const std::vector<std::string>& arguments, bool twice = false) {
    const pid_t process = Start(tool, arguments, terminal_.Inner(), terminal_.Inner());
    const bool shown = terminal_.WaitFor(part);
    EXPECT_TRUE(shown) << terminal_.Text();
    kill(process, shown ? signal : SIGKILL);
    if (twice) kill(process, signal);
    return Wait(process);
  }

  /// The final content of the terminal, line by line.
  std::vector<std::string> Screen() {
    terminal_.WaitFor("nothing that is ever written", 100);
    std::vector<std::string> lines;
    std::istringstream text(terminal_.Text());
    for (std::string line; std::getline(text, line);) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      const size_t cleared = line.rfind("\r\033[K");
      lines.push_back(cleared == line.npos ? line : line.substr(cleared + 4));
    }
    return lines;
  }

  bool AnyPart() const {
    for (const std::string& file : Files()) {
      if (file.find(".part") != file.npos) return true;
    }
    return false;
  }

  PseudoTerminal terminal_;
};

constexpr int kOfSignal = 1000;  // what `Wait` adds to a signal's number

TEST_F(TerminalTest, CtrlCKeepsTheBestPathSoFarAndNothingElse) {
  const std::vector<std::string> arguments = LongSolve(
      {"--output", "walk.png,walk.path,frames/%03d.obj", "--report", "r.json", "--strict"});
  std::vector<std::string> files = Files();
  EXPECT_EQ(Interrupt(SIGINT, ": iteration ", "shape-interpolate", arguments), kOfSignal + SIGINT);
  files.push_back("walk.path");
  EXPECT_EQ(Files(), files);
  const shapespace::Path path = ReadPath(Path("walk.path"));
  EXPECT_FALSE(path.converged);
  EXPECT_EQ(path.NumShapes(), 65);
  ExpectContains(path.provenance, "tube0.obj tube1.obj");
  Screen();
  ExpectContains(terminal_.Text(), "stopping: writing the best path so far to walk.path");
  ExpectContains(terminal_.Text(), "NOT CONVERGED: cancelled");
  ExpectContains(terminal_.Text(), "wrote walk.path");
}

TEST_F(TerminalTest, CtrlCEndsAtOnceWhereThereIsNothingToKeep) {
  const std::vector<std::string> arguments =
      LongSolve({"--output", "walk.png,frames/%03d.obj", "--report", "r.json"});
  const std::vector<std::string> before = Files();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(Interrupt(signal, ": iteration ", "shape-interpolate", arguments),
              kOfSignal + signal);
    EXPECT_EQ(Files(), before);
  }
}

TEST_F(TerminalTest, ASecondCtrlCDoesNotWait) {
  const std::vector<std::string> arguments = LongSolve({"--output", "walk.path"});
  EXPECT_EQ(Interrupt(SIGINT, ": iteration ", "shape-interpolate", arguments, true),
            kOfSignal + SIGINT);
  EXPECT_FALSE(AnyPart());
}

// As after Ctrl-S. The tool waits until its progress can be written, and has to end nevertheless.
TEST_F(TerminalTest, ATerminalThatTakesNoTextDoesNotKeepItFromEnding) {
  for (const std::string output : {"walk.png", "walk.path"}) {
    const pid_t process = Start("shape-interpolate", LongSolve({"--output", output}),
                                terminal_.Inner(), terminal_.Inner());
    ASSERT_TRUE(terminal_.WaitFor(": iteration ")) << terminal_.Text();
    terminal_.Fill();
    int status = 0;
    bool ended = false;
    for (int tenths = 0; tenths < 300 && !ended; ++tenths) {
      kill(process, SIGTERM);
      poll(nullptr, 0, 100);
      ended = waitpid(process, &status, WNOHANG) == process;
    }
    EXPECT_TRUE(ended) << output;
    if (!ended) {
      kill(process, SIGKILL);
      Wait(process);
    }
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
    Screen();  // so that the next one can write
  }
}

TEST_F(TerminalTest, CtrlCWhileWritingLeavesNoHalfFile) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "w.path"});
  EXPECT_EQ(Interrupt(SIGINT, "writing f/%d.obj", "shape-export",
                      {"w.path", "--frames", "5000", "--output", "f/%d.obj"}),
            kOfSignal + SIGINT);
  EXPECT_FALSE(AnyPart());
}

TEST_F(TerminalTest, CtrlCKeepsTheStepsOfAnExtrapolation) {
  MakeTubes();
  // A path at rest can be continued without limit.
  Succeed("shape-interpolate", {"tube0.obj", "tube0.obj", "--shapes", "1", "--output", "w.path"});
  EXPECT_EQ(Interrupt(SIGINT, "shooting: 1", "shape-extrapolate",
                      {"w.path", "--steps", "100000", "--output", "on.path"}),
            kOfSignal + SIGINT);
  const shapespace::Path path = ReadPath(Path("on.path"));
  EXPECT_GE(path.extrapolated, 1);
  EXPECT_LT(path.extrapolated, 100000);
  EXPECT_FALSE(path.converged);
}

TEST_F(TerminalTest, CtrlCWhilePosesAreInterpolatedKeepsThatPath) {
  std::vector<std::string> arguments = LongSolve({"--output", "on.path,on.png"});
  EXPECT_EQ(Interrupt(SIGINT, ": iteration ", "shape-extrapolate", arguments), kOfSignal + SIGINT);
  const shapespace::Path path = ReadPath(Path("on.path"));
  EXPECT_EQ(path.NumShapes(), 65);
  EXPECT_EQ(path.extrapolated, 0);
  EXPECT_FALSE(path.converged);
  EXPECT_FALSE(std::filesystem::exists(Path("on.png")));
}

TEST_F(TerminalTest, AnIgnoredCtrlCStaysIgnored) {
  const std::vector<std::string> arguments = LongSolve({"--output", "walk.png"});
  signal(SIGINT, SIG_IGN);  // as nohup and scripts do for processes that they start
  const pid_t process = Start("shape-interpolate", arguments, terminal_.Inner());
  signal(SIGINT, SIG_DFL);
  ASSERT_TRUE(terminal_.WaitFor(": iteration ")) << terminal_.Text();
  kill(process, SIGINT);
  kill(process, SIGTERM);
  EXPECT_EQ(Wait(process), kOfSignal + SIGTERM);
}

TEST_F(TerminalTest, ResultsStandOnLinesOfTheirOwn) {
  MakeTubes();
  const pid_t process =
      Start("shape-interpolate",
            {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "w.path,w.png,f/%d.obj"},
            terminal_.Inner(), terminal_.Inner());
  EXPECT_EQ(Wait(process), 0);
  const std::vector<std::string> screen = Screen();
  ASSERT_EQ(screen.size(), 4u) << terminal_.Text();
  EXPECT_EQ(screen[0].rfind("converged: 152 vertices, ", 0), 0u) << screen[0];
  EXPECT_EQ(screen[1], "wrote w.path");
  EXPECT_EQ(screen[2], "wrote w.png");
  EXPECT_EQ(screen[3], "wrote f/0.obj .. f/4.obj");
}

TEST_F(TerminalTest, TellsHowLongItStillTakes) {
  const std::vector<std::string> arguments = LongSolve({"--output", "walk.png"});
  EXPECT_EQ(Interrupt(SIGINT, " left", "shape-interpolate", arguments), kOfSignal + SIGINT);
  const std::string text = terminal_.Text();
  EXPECT_TRUE(std::regex_search(
      text, std::regex("vertices, [0-9]+ inner shapes?(: iteration [0-9]+)?; about [0-9]+ "
                       "(s|min|h) left")))
      << text;
}

// Takes ten seconds, the interval between lines if there is no terminal.
TEST_F(TerminalTest, WithoutATerminalALineComesNowAndThen) {
  const std::vector<std::string> arguments = LongSolve({"--output", "walk.png"});
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t process = Start("shape-interpolate", arguments, ends[1]);
  close(ends[1]);
  pollfd ready = {ends[0], POLLIN, 0};
  char text[256] = {};
  EXPECT_EQ(poll(&ready, 1, 60000), 1);
  EXPECT_GT(read(ends[0], text, sizeof text - 1), 0);
  kill(process, SIGKILL);
  Wait(process);
  close(ends[0]);
  EXPECT_TRUE(std::regex_match(
      text, std::regex("shape-interpolate: 2012 vertices, [0-9]+ inner shapes?[:;] .*\n")))
      << text;
}

// The threads of OpenBLAS would only wait, in busy loops.
TEST_F(TerminalTest, BlasHasNoThreads) {
  const auto tasks = [&](const char* blas_threads) {
    setenv("OPENBLAS_NUM_THREADS", blas_threads, 1);
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    const pid_t process =
        Start("shape-interpolate", LongSolve({"--threads", "1", "--progress", "lines"}), ends[1]);
    close(ends[1]);
    std::string text;
    for (char c; text.find(" inner shapes") == text.npos && read(ends[0], &c, 1) == 1;) text += c;
    ExpectContains(text, " inner shapes");  // it has factorised a matrix
    const std::filesystem::directory_iterator all("/proc/" + std::to_string(process) + "/task");
    const auto count = std::distance(begin(all), end(all));
    kill(process, SIGKILL);
    Wait(process);
    close(ends[0]);
    unsetenv("OPENBLAS_NUM_THREADS");
    return count;
  };
  EXPECT_EQ(tasks("8"), tasks("1"));
}

TEST_F(TerminalTest, AShortRunIsSilentWithoutATerminal) {
  MakeTubes();
  const testing::Outcome outcome =
      Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "w.path"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace shapespace
