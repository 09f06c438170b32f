#include "support/tool.h"

#include <cstdio>
#include <iostream>

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/system.h>
#include <shapespace/base/parallel.h>

#include "support/command_line.h"
#include "support/error_message.h"
#include "support/flag_group.h"
#include "support/interrupt.h"

DEFINE_int32(threads, 0, "number of threads; 0: all cores (results do not depend on it)");
DEFINE_string(progress, "text",
              "on stderr: text, for people, or lines, for programs that show the progress of this "
              "one: 'progress SHARE TEXT', with a share from 0 to 1, or '-' if it is not known");
FLAG_GROUP(tool, "Run", "threads");

namespace shapespace::tools {
namespace {

// Those that it takes, and what every tool has.
std::vector<std::string> GroupsOf(const Program& program) {
  std::vector<std::string> groups = program.flag_groups;
  groups.push_back("tool");
  return groups;
}

// OpenBLAS starts its threads when it is loaded, and they first wait for work in busy loops, for
// longer than a small solve takes. The solvers keep BLAS to one thread (OneThread), so that these
// are of no use. Without OpenBLAS, or if it is built with OpenMP, there is nothing to end.
void EndThreadsOfBlas() {
  const auto limit =
      reinterpret_cast<void (*)(int)>(internal::FunctionOfProgram("openblas_set_num_threads"));
  const auto end =
      reinterpret_cast<int (*)()>(internal::FunctionOfProgram("blas_thread_shutdown_"));
  if (limit == nullptr || end == nullptr) return;
  limit(1);  // else the next call would start them again
  end();
}

void PrintHelp(const Program& program, FlagList list) {
  std::cout << program.name << ": " << program.summary << "\n\n" << program.usage << '\n';
  PrintFlags(GroupsOf(program), list);
  std::cout
      << "\nDashes serve for underscores. Exit codes: 0 done, 1 something failed, 2 the command "
         "line is wrong.\n";
}

}  // namespace

bool IsGiven(const char* flag) { return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default; }

void ClaimStdout(const std::string& flag) {
  static std::string owner;
  if (!owner.empty() && owner != flag) {
    throw UsageError("--" + owner + " - and --" + flag + " -: only one of them can go to stdout");
  }
  owner = flag;
  ResultsToStderr();
}

void RefuseFlags(const std::vector<std::string>& groups, const std::vector<std::string>& flags,
                 const std::string& reason, const std::string& but) {
  for (const std::string& group : groups) {
    for (const gflags::CommandLineFlagInfo& flag : FlagsOf(group)) {
      if (!flag.is_default && flag.name != but) throw UsageError("--" + flag.name + ": " + reason);
    }
  }
  for (const std::string& flag : flags) {
    if (IsGiven(flag.c_str())) throw UsageError("--" + flag + ": " + reason);
  }
}

std::string InFlags(const std::string& option) {
  return option.empty() ? "" : " (--" + option + ")";
}

void NamingFlags(const FlagNames& names, const std::function<void()>& body) {
  try {
    body();
  } catch (const InvalidOptions& error) {
    std::string flags;
    for (std::string field : error.fields()) {
      for (const auto& [own, flag] : names) {
        if (own == field) field = flag;
      }
      gflags::CommandLineFlagInfo info;
      const bool is_flag = gflags::GetCommandLineFlagInfo(field.c_str(), &info);
      flags += (flags.empty() ? "" : ", ") + (is_flag ? AsTyped(field) : field);
    }
    throw UsageError(flags.empty() ? error.problem() : flags + ": " + error.problem());
  }
}

namespace {

void FlushStdout() {
  if (!std::cout.flush() || std::fflush(stdout) != 0) {
    throw FileError("stdout: writing failed (is the disk full?)");
  }
}

// What the command line asks for.
void Perform(const Program& program, const std::vector<std::string>& arguments,
             const std::function<void(const std::vector<std::string>& arguments)>& body) {
  if (IsGiven("help_all")) return PrintHelp(program, FlagList::kAll);
  if (IsGiven("help")) return PrintHelp(program, FlagList::kUsual);
  if (IsGiven("version")) {
    std::cout << program.name << " of shapespace " << SHAPESPACE_VERSION << '\n';
    return;
  }
  NamingFlags({}, [&] {
    SetThreads(FLAGS_threads);
    if (FLAGS_progress != "text" && FLAGS_progress != "lines") {
      throw UsageError("--progress " + FLAGS_progress + ": must be text or lines");
    }
    if (FLAGS_progress == "lines") ProgressForPrograms();
    body(arguments);
  });
}

}  // namespace

int RunTool(int argc, char** argv, const Program& program,
            const std::function<void(const std::vector<std::string>& arguments)>& body) {
  internal::PrepareProcess();
  EndThreadsOfBlas();
  SetProgramName(program.name);
  HandleInterrupts([] {
    if (internal::StderrTakesText()) ClearProgress();
  });
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_FATAL;
  try {
    Perform(program, ParseCommandLine(argc, argv, GroupsOf(program)), body);
    FlushStdout();
  } catch (const UsageError& error) {
    Complain(error.what());
    Err() << "Try " << program.name << " --help\n";
    return 2;
  } catch (const Cancelled&) {
    Err() << program.name << ": interrupted before there was a result\n";
  } catch (const std::bad_alloc&) {
    Complain("out of memory");
  } catch (const Error& error) {
    Complain(MessageOf(error));
  } catch (const std::exception& error) {
    Complain(error.what());
  }
  EndIfInterrupted();
  ClearProgress();
  return HasComplained() ? 1 : 0;
}

}  // namespace shapespace::tools
