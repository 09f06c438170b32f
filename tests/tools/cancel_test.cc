#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::ExpectContains;
using testing::ToolsTest;

/// The two ends of a terminal: programs see `inner`, the test sees `outer`.
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

  /// Reads on until `part` was written; false if that takes a minute, or nobody writes any more.
  bool WaitFor(const std::string& part) {
    constexpr int kMinute = 60000;
    pollfd ready = {outer_, POLLIN, 0};
    while (text_.find(part) == std::string::npos) {
      char buffer[256];
      if (poll(&ready, 1, kMinute) != 1) return false;
      const ssize_t count = read(outer_, buffer, sizeof buffer);
      if (count <= 0) return false;
      text_.append(buffer, count);
    }
    return true;
  }
  const std::string& Text() const { return text_; }

 private:
  int outer_, inner_ = -1;
  std::string text_;
};

class CancelTest : public ToolsTest {};

TEST_F(CancelTest, CtrlCLeavesNothingBehind) {
  MakeTubes(4000);
  const std::vector<std::string> before = Files();
  PseudoTerminal terminal;
  if (terminal.Inner() < 0) GTEST_SKIP() << "this machine gives no pseudo-terminal";
  // So accurate that it takes minutes.
  const pid_t process =
      Start("shape-interpolate",
            {"tube0.obj", "tube1.obj", "--shapes", "63", "--tolerance", "1e-15", "--max_iterations",
             "1000000", "--output", "walk.path,walk.png,frames/%03d.obj", "--report", "r.json"},
            terminal.Inner());
  const bool solving = terminal.WaitFor(": iteration 3");
  kill(process, solving ? SIGINT : SIGKILL);
  ASSERT_TRUE(solving) << terminal.Text();
  EXPECT_TRUE(terminal.WaitFor("shape-interpolate: cancelled")) << terminal.Text();
  EXPECT_EQ(Wait(process), 1);
  EXPECT_EQ(Files(), before);
}

TEST_F(CancelTest, ProgressIsForTerminalsOnly) {
  MakeTubes();
  const testing::Outcome outcome =
      Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "w.path"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace shapespace
