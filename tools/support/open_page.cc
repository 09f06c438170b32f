#include "support/open_page.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "support/tool.h"

namespace shapespace::tools {

void OpenPage(const std::string& file) {
  std::string program = "xdg-open", page = std::filesystem::absolute(file).string();
  char* const arguments[] = {program.data(), page.data(), nullptr};
  pid_t child = 0;
  int status = 0;
  const bool opened =
      posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) == 0 &&
      waitpid(child, &status, 0) == child && status == 0;
  if (!opened) Note(file, ": xdg-open shows it in no browser; open it in yours");
}

}  // namespace shapespace::tools
