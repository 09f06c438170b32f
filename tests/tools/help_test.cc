#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;
using testing::ToolsTest;

constexpr const char* kTools[] = {"shape-average",     "shape-body",     "shape-correspond",
                                  "shape-deform",      "shape-export",   "shape-explore",
                                  "shape-extrapolate", "shape-inspect",  "shape-interpolate",
                                  "shape-statistics",  "shape-transfer", "shape-transport",
                                  "shape-view"};

class HelpTest : public ToolsTest {
 protected:
  /// The flags that --help-all lists, or --help.
  std::set<std::string> Listed(const std::string& tool, const char* help = "--help-all") const {
    std::set<std::string> flags;
    std::istringstream text(Run(tool, {help}).out);
    for (std::string line; std::getline(text, line);) {
      std::smatch match;
      static const std::regex flag("^  (?:-[a-z], )?--([a-z_-]+).*");
      if (std::regex_match(line, match, flag)) flags.insert(match[1]);
    }
    return flags;
  }
};

TEST_F(HelpTest, FitsTheTerminalAndSucceeds) {
  for (const char* tool : kTools) {
    const Outcome outcome = Run(tool, {"--help-all"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
    ExpectContains(outcome.out, std::string(tool) + ": ");
    std::istringstream text(outcome.out);
    for (std::string line; std::getline(text, line);) {
      EXPECT_LE(line.size(), 100u) << tool << ": " << line;
      EXPECT_TRUE(line.empty() || line.back() != ' ') << tool << ": " << line;
    }
  }
}

// It is read at one sight, and what it has is part of the whole.
TEST_F(HelpTest, IsAPageOfWhatPeopleUse) {
  for (const char* tool : kTools) {
    const std::string page = Run(tool, {"--help"}).out;
    EXPECT_LE(std::count(page.begin(), page.end(), '\n'), 66) << tool;
    const std::set<std::string> all = Listed(tool), usual = Listed(tool, "--help");
    EXPECT_LE(usual.size(), 18u) << tool;
    EXPECT_TRUE(std::includes(all.begin(), all.end(), usual.begin(), usual.end())) << tool;
    EXPECT_EQ(usual.count("output"), all.count("output")) << tool;
    EXPECT_EQ(usual.count("help-all"), 1u) << tool;
  }
}

TEST_F(HelpTest, HasHeadings) {
  const std::string text = Run("shape-transfer", {"--help-all"}).out;
  size_t last = 0;
  for (const char* heading : {"Transfer:\n", "Correspondence:\n", "Input:\n", "Path:\n",
                              "Metric:\n", "Output:\n", "Run:\n"}) {
    const size_t at = text.find(heading);
    ASSERT_NE(at, std::string::npos) << heading;
    EXPECT_GT(at, last) << heading;
    EXPECT_EQ(text.find(heading, at + 1), std::string::npos) << heading;
    last = at;
  }
}

TEST_F(HelpTest, ListsOurFlagsOnly) {
  EXPECT_EQ(
      Listed("shape-body"),
      (std::set<std::string>{"at", "help", "help-all", "output", "pose", "progress", "proportions",
                             "random", "seed", "table", "threads", "triangles", "version"}));
  EXPECT_EQ(Listed("shape-view"),
            (std::set<std::string>{"allow_outside_files", "help", "help-all", "open", "output",
                                   "progress", "solver", "threads", "up", "version", "view"}));
  EXPECT_EQ(
      Listed("shape-correspond"),
      (std::set<std::string>{"allow_nonmanifold", "allow_outside_files", "find_markers", "help",
                             "help-all", "hold_all_markers", "markers", "markers_out",
                             "memory_limit", "open_seams", "output", "progress", "proportions",
                             "report", "soft_markers", "strict", "threads", "version"}));
  const std::set<std::string> metric = {"bending", "discretization", "isometric", "lambda",
                                        "metric",  "rigid",          "stiffness", "strain",
                                        "volume",  "weighting"};
  std::set<std::string> wanted = metric;
  wanted.insert({"allow_mirrored", "allow_mismatch", "allow_nonmanifold", "allow_outside_files",
                 "help", "help-all", "mirror", "open_seams", "progress", "report", "threads",
                 "version"});
  EXPECT_EQ(Listed("shape-inspect"), wanted);
  wanted.insert({"bone_color",
                 "bone_error",
                 "bone_rest",
                 "bone_scale",
                 "bone_weights",
                 "bones",
                 "color",
                 "ease",
                 "fps",
                 "loop",
                 "loose_components",
                 "max_iterations",
                 "memory_limit",
                 "once",
                 "output",
                 "report",
                 "seconds",
                 "shapes",
                 "solver",
                 "stiffeners",
                 "strict",
                 "tolerance"});
  const std::set<std::string> listed = Listed("shape-interpolate");
  for (const std::string& flag : wanted) EXPECT_EQ(listed.count(flag), 1u) << flag;
  // Tools that begin with an interpolation of poses have the same flags but for those of smooth
  // motion and of a way between two poses, and their own.
  std::set<std::string> geodesic = listed;
  for (const char* flag : {"hold_limit", "obstacle", "spline", "times", "via"}) {
    EXPECT_EQ(geodesic.erase(flag), 1u) << flag;
  }
  std::set<std::string> extrapolate = geodesic;
  extrapolate.insert({"correct", "integrator", "keep", "step_iterations", "slide_at_contact",
                      "step_solver", "steps", "stop_at_contact"});
  EXPECT_EQ(Listed("shape-extrapolate"), extrapolate);
  std::set<std::string> transfer = geodesic;
  transfer.insert({"align", "connection", "find_markers", "hold_all_markers", "hybrids", "markers",
                   "markers_out", "method", "proportions", "scale", "soft_markers", "target"});
  EXPECT_EQ(Listed("shape-transfer"), transfer);
  std::set<std::string> deform = wanted;
  deform.insert({"avoid_contact", "balance", "coarsest", "fps", "ground_line", "handles", "labels",
                 "obstacle", "repair", "sound", "title", "unit", "up", "view"});
  EXPECT_EQ(Listed("shape-deform"), deform);
  for (const char* foreign : {"flagfile", "undefok", "logtostderr", "minloglevel", "v"}) {
    EXPECT_EQ(listed.count(foreign), 0u) << foreign;
  }
}

TEST_F(HelpTest, DefaultsReadAsTheyWouldBeTyped) {
  const std::string help = Run("shape-interpolate", {"--help-all"}).out;
  ExpectContains(help, "--bending 1e-05 ");
  ExpectContains(help, "--shapes 15 ");
  ExpectContains(help, "--tolerance 1e-04 ");
  ExpectContains(Run("shape-extrapolate", {"--help-all"}).out, "--tolerance 1e-06 ");
  ExpectContains(Run("shape-transfer", {"--help-all"}).out, "--shapes 7 ");
  ExpectContains(Run("shape-deform", {"--help-all"}).out, "--metric deformation ");
  ExpectContains(Run("shape-deform", {"--help-all"}).out, "--balance 0.01 ");
  ExpectLacks(help, "00000");
}

TEST_F(HelpTest, BashCompletesFlagsValuesAndBodies) {
  const auto replies = [&](const std::string& words) {
    File("complete.sh", "source '" SHAPESPACE_COMPLETION
                        "'\n"
                        "COMP_WORDS=(" SHAPESPACE_TOOLS_DIR "/" +
                            words +
                            ")\n"
                            "COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                            "_shapespace \"${COMP_WORDS[0]}\"\n"
                            "echo \"${COMPREPLY[@]}\" >replies\n"
                            "complete -p shape-transfer >registered\n");
    EXPECT_EQ(std::system(("cd '" + Path("") + "' && bash complete.sh").c_str()), 0);
    return Content(Path("replies"));
  };
  EXPECT_EQ(replies("shape-transfer a.obj --me"), "--method --metric --memory_limit\n");
  ExpectContains(Content(Path("registered")), "-F _shapespace shape-transfer");
  EXPECT_EQ(replies("shape-interpolate a.obj --metric ''"), "strain isometric rigid paper\n");
  EXPECT_EQ(replies("shape-interpolate --spline = n"), "natural not_a_knot\n");
  EXPECT_EQ(replies("shape-interpolate --color ="), "plain deviation parts\n");
  EXPECT_EQ(replies("shape-interpolate --output ''"), "\n");  // left to completion of files
  EXPECT_EQ(replies("shape-body st"), "strip steffen\n");
}

TEST_F(HelpTest, DashesServeForUnderscores) {
  ASSERT_EQ(Run("shape-body", {"bricard", "--at", "0", "--output", "a.obj"}).code, 0);
  EXPECT_EQ(Run("shape-inspect", {"a.obj", "--open-seams"}).code, 0);
  EXPECT_EQ(Run("shape-inspect", {"a.obj", "--open-seam"}).code, 2);
}

TEST_F(HelpTest, VersionIsOneLine) {
  for (const char* tool : kTools) {
    const Outcome outcome = Run(tool, {"--version"});
    EXPECT_EQ(outcome.code, 0);
    const std::regex line(std::string(tool) + " of shapespace [0-9]+\\.[0-9]+\\.[0-9]+\n");
    EXPECT_TRUE(std::regex_match(outcome.out, line)) << outcome.out;
  }
}

}  // namespace
}  // namespace shapespace
