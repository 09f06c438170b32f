#include "support/tool.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>

DEFINE_int32(threads, 0, "threads to use; 0 takes all cores (results do not depend on it)");

// gflags ends the process itself when it cannot read a flag, with a code of its own.
namespace GFLAGS_NAMESPACE {
extern void (*gflags_exitfunc)(int);
}

namespace shapespace::tools {
namespace {

std::atomic<bool> interrupted{false};

class Terminal final : public Progress {
 public:
  ~Terminal() override { Clear(); }
  bool Report(const std::string& stage, int done, int total) override {
    if (shown_) {
      std::string line = stage;
      if (total > 0) {
        line += ": " + std::to_string(done) + " of " + std::to_string(total);
      } else if (done > 0) {
        line += ": iteration " + std::to_string(done);
      }
      std::cerr << "\r\033[K" << line << std::flush;
      dirty_ = true;
    }
    return !interrupted;
  }
  void Clear() {
    if (dirty_) std::cerr << "\r\033[K" << std::flush;
    dirty_ = false;
  }

 private:
  const bool shown_ = isatty(STDERR_FILENO) != 0;
  bool dirty_ = false;
};

Terminal& TheTerminal() {
  static Terminal terminal;
  return terminal;
}

std::vector<gflags::CommandLineFlagInfo> FlagsOf(const std::string& source) {
  std::vector<gflags::CommandLineFlagInfo> all, flags;
  gflags::GetAllFlags(&all);
  for (const gflags::CommandLineFlagInfo& flag : all) {
    if (flag.filename.find(source) != std::string::npos) flags.push_back(flag);
  }
  return flags;
}

// The shortest form that reads back as the same number: gflags writes out 1.0000000000000001e-05.
std::string DefaultValue(const gflags::CommandLineFlagInfo& flag) {
  if (flag.type != "double") return flag.default_value;
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, std::stod(flag.default_value)).ptr};
}

// One flag of --help: its name and default on the left, the description beside it in lines.
void PrintFlag(std::string left, const std::string& description) {
  constexpr size_t kLeft = 30, kLine = 100;
  left.resize(std::max(left.size() + 1, kLeft), ' ');
  std::string line = left;
  std::istringstream words(description);
  for (std::string word; words >> word;) {
    if (line.size() + word.size() > kLine) {
      std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
      line = std::string(kLeft, ' ');
    }
    line += word + ' ';
  }
  std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
}

void PrintHelp(const Program& program) {
  std::cout << program.name << ": " << program.summary << "\n\n" << program.usage << "\n\nFlags:\n";
  std::vector<std::string> sources = program.flag_sources;
  sources.push_back("support/tool.cc");
  for (const std::string& source : sources) {
    for (const gflags::CommandLineFlagInfo& flag : FlagsOf(source)) {
      std::string left = "  --" + flag.name;
      if (flag.type != "bool") {
        left += " " + (flag.default_value.empty() ? "..." : DefaultValue(flag));
      }
      PrintFlag(left, flag.description);
    }
  }
  PrintFlag("  --help", "this text");
  PrintFlag("  --version", "version of shapespace");
}

}  // namespace

bool IsGiven(const char* flag) { return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default; }

std::vector<std::string> GivenFlags(const std::string& source) {
  std::vector<std::string> names;
  for (const gflags::CommandLineFlagInfo& flag : FlagsOf(source)) {
    if (!flag.is_default) names.push_back(flag.name);
  }
  return names;
}

Progress* TerminalProgress() { return &TheTerminal(); }

int RunTool(int argc, char** argv, const Program& program,
            const std::function<void(const std::vector<std::string>& arguments)>& body) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_ERROR;
  GFLAGS_NAMESPACE::gflags_exitfunc = [](int) {
    std::cerr << "Try --help\n";
    std::_Exit(2);
  };
  gflags::SetVersionString(SHAPESPACE_VERSION);
  gflags::ParseCommandLineNonHelpFlags(&argc, &argv, true);
  if (IsGiven("help")) {
    PrintHelp(program);
    return 0;
  }
  if (IsGiven("version")) {
    std::cout << program.name << " of shapespace " << SHAPESPACE_VERSION << '\n';
    return 0;
  }
  // The first Ctrl-C asks the solver to stop, which leaves nothing behind; the second kills.
  std::signal(SIGINT, [](int) {
    interrupted = true;
    std::signal(SIGINT, SIG_DFL);
  });
  const auto complain = [&](const std::string& message) {
    TheTerminal().Clear();
    std::cerr << program.name << ": " << message << '\n';
  };
  try {
    if (FLAGS_threads < 0) throw UsageError("--threads must be 0 or more");
    SetThreads(FLAGS_threads);
    body({argv + 1, argv + argc});
    if (!std::cout.flush() || std::fflush(stdout) != 0) {
      throw FileError("stdout: writing failed (is the disk full?)");
    }
    TheTerminal().Clear();
    return 0;
  } catch (const UsageError& error) {
    complain(error.what());
  } catch (const InvalidOptions& error) {
    complain("--" + std::string(error.what()));
  } catch (const std::bad_alloc&) {
    complain("out of memory");
    return 1;
  } catch (const std::exception& error) {
    complain(error.what());
    return 1;
  }
  std::cerr << "Try " << program.name << " --help\n";
  return 2;
}

}  // namespace shapespace::tools
