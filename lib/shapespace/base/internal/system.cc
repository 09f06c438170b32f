#include <shapespace/base/internal/system.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace shapespace::internal {

int CreateNewFile(const char* file) {
  constexpr mode_t kPermissions = 0666;  // less those of the umask, as for all new files
  return open(file, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kPermissions);
}

void RemoveFile(const char* file) { unlink(file); }

std::string ProblemWithName(const std::string& /*file*/) { return {}; }

std::filesystem::path PlaceOf(const std::string& file, std::error_code* error) {
  const std::filesystem::path path = std::filesystem::absolute(file, *error);
  return *error ? path : std::filesystem::weakly_canonical(path, *error);
}

void PrepareProcess() {
  for (const int stream : {0, 1, 2}) {
    if (fcntl(stream, F_GETFD) >= 0) continue;
    const int got =
        open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);  // the lowest that is free
    if (got < 0) break;
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

void PrepareThread() {}

int TerminalWidth() {
  constexpr int kUsual = 80;
  if (isatty(STDERR_FILENO) == 0) return 0;
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

bool StderrTakesText() {
  pollfd error = {STDERR_FILENO, POLLOUT, 0};
  return poll(&error, 1, 0) == 1 && (error.revents & POLLOUT) != 0;
}

void HandleEndingSignals(void (*handle)(int signal)) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action = {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;
    action.sa_handler = handle;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
  }
}

void* FunctionOfProgram(const char* name) { return dlsym(RTLD_DEFAULT, name); }

bool ShowInBrowser(const std::string& file) {
  std::string program = "xdg-open", page = file;
  char* const arguments[] = {program.data(), page.data(), nullptr};
  pid_t child = 0;
  int status = 0;
  return posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) == 0 &&
         waitpid(child, &status, 0) == child && status == 0;
}

}  // namespace shapespace::internal
