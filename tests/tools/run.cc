#include "tools/run.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace shapespace::testing {
namespace {

constexpr char kOut[] = ".stdout", kErr[] = ".stderr";

int OpenToWrite(const std::string& file) {
  return open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
}

}  // namespace

ToolsTest::ToolsTest() {
  // They may be ignored: by nohup, or for background jobs of a script.
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
}

pid_t ToolsTest::Start(const std::string& tool, const std::vector<std::string>& arguments,
                       int error, int out) const {
  const std::string program = std::string(SHAPESPACE_TOOLS_DIR) + "/" + tool;
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  const std::string folder = Path("");
  const bool to_file = out < 0;
  if (to_file) out = OpenToWrite(Path(kOut));
  const pid_t process = fork();
  if (process == 0) {
    dup2(out, STDOUT_FILENO);
    dup2(error, STDERR_FILENO);
    if (chdir(folder.c_str()) == 0) execv(program.c_str(), argv.data());
    _exit(127);
  }
  if (to_file) close(out);
  return process;
}

int ToolsTest::Wait(pid_t process) {
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

Outcome ToolsTest::Run(const std::string& tool, const std::vector<std::string>& arguments) const {
  const int error = OpenToWrite(Path(kErr));
  Outcome outcome;
  outcome.code = Wait(Start(tool, arguments, error));
  close(error);
  outcome.out = Content(Path(kOut));
  outcome.err = Content(Path(kErr));
  return outcome;
}

void ToolsTest::Succeed(const std::string& tool, const std::vector<std::string>& arguments) const {
  const Outcome outcome = Run(tool, arguments);
  ASSERT_EQ(outcome.code, 0) << tool << ": " << outcome.err;
}

void ToolsTest::MakeTubes(int triangles) const {
  Succeed("shape-body", {"tube", "--triangles", std::to_string(triangles), "--at", "0,60",
                         "--output", "tube%d.obj"});
}

std::vector<std::string> ToolsTest::Files() const {
  std::vector<std::string> files;
  const std::filesystem::path folder = Path("");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = std::filesystem::relative(entry.path(), folder).string();
    if (name != kOut && name != kErr) files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace shapespace::testing
