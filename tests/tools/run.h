#ifndef SHAPESPACE_TESTS_TOOLS_RUN_H_
#define SHAPESPACE_TESTS_TOOLS_RUN_H_

#include <sys/types.h>

#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/files.h"

namespace shapespace::testing {

/// The result of running a program.
struct Outcome {
  int code = 0;  ///< exit code; 1000 + the signal if one ended it
  std::string out, err;
};

/// A test that runs the tools like a user, in a temporary folder.
class ToolsTest : public FilesTest {
 protected:
  /// Tools obey Ctrl-C even if these tests are run by nohup or in the background.
  ToolsTest();

  /// Runs a tool in the test's folder, and waits for it.
  Outcome Run(const std::string& tool, const std::vector<std::string>& arguments) const;

  /// The same for a run of which the test only needs success.
  void Succeed(const std::string& tool, const std::vector<std::string>& arguments) const;

  /// tube0.obj and tube1.obj: a straight tube of `triangles`, and one bent by 60 degrees.
  void MakeTubes(int triangles = 300) const;

  /// All files below the test's folder, sorted, except those of `Run` itself.
  std::vector<std::string> Files() const;

  /// Starts a tool in the test's folder, with stderr redirected to the file descriptor `error` and
  /// stdout to `out`, or if there is none to a file of `Run`.
  pid_t Start(const std::string& tool, const std::vector<std::string>& arguments, int error,
              int out = -1) const;
  static int Wait(pid_t process);
};

inline void ExpectContains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
}

inline void ExpectLacks(const std::string& text, const std::string& part) {
  EXPECT_EQ(text.find(part), std::string::npos) << "'" << part << "' in: " << text;
}

/// The run has succeeded, and nothing is on stderr but lines of progress, which begin with the
/// tool's name and are there where a run takes seconds.
inline void ExpectQuiet(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 0);
  std::istringstream lines(outcome.err);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_EQ(line.compare(0, 6, "shape-"), 0) << line;
  }
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_TOOLS_RUN_H_
