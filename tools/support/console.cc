#include "support/console.h"

#include <atomic>
#include <iostream>
#include <limits>
#include <set>
#include <streambuf>

#include <shapespace/base/internal/printable.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/internal/system.h>

namespace shapespace::tools {
namespace {

// Seconds between two lines of progress: on a terminal, otherwise, and for a program.
constexpr double kTerminalPause = 0.05, kPause = 10, kProgramPause = 0.1;

struct Console {
  const bool terminal = internal::TerminalWidth() > 0;
  const internal::Stopwatch stopwatch = {};
  double last = terminal ? -kTerminalPause : 0;  // time of the last line of progress
  std::string line;                              // the last line of progress
  std::atomic<bool> shown{false};                // it is visible on the terminal
  bool results_to_stderr = false;
  bool for_programs = false;
  bool has_complained = false;
  std::set<std::string> told;  // warnings and notes
  std::string name;
};

Console& TheConsole() {
  static Console console;
  return console;
}

// Passes text on to a stream, with control characters escaped.
class EscapingBuffer : public std::streambuf {
 public:
  explicit EscapingBuffer(std::ostream& to) : to_(to) {}

 protected:
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    to_ << internal::Printable({text, static_cast<size_t>(size)}, internal::kOfMessages);
    return to_ ? size : 0;
  }
  int_type overflow(int_type c) override {
    const char character = traits_type::to_char_type(c);
    return xsputn(&character, 1) == 1 ? traits_type::not_eof(c) : traits_type::eof();
  }
  int sync() override { return to_.flush() ? 0 : -1; }

 private:
  std::ostream& to_;
};

}  // namespace

std::ostream& Out() {
  if (TheConsole().results_to_stderr) return Err();
  ClearProgress();
  static EscapingBuffer buffer(std::cout);
  static std::ostream stream(&buffer);
  return stream;
}

void ResultsToStderr() { TheConsole().results_to_stderr = true; }

std::ostream& Err() {
  ClearProgress();
  std::cout << std::flush;  // keeps the order of lines if both go to the same place
  static EscapingBuffer buffer(std::cerr);
  static std::ostream stream(&buffer);
  return stream;
}

void Complain(const std::string& message) {
  TheConsole().has_complained = true;
  Err() << TheConsole().name + ": " + message + '\n';
}

void TellOnce(const std::string& line) {
  if (TheConsole().told.insert(line).second) Err() << line + '\n';
}

void SetProgramName(const std::string& name) { TheConsole().name = name; }

bool HasComplained() { return TheConsole().has_complained; }

void ProgressForPrograms() {
  TheConsole().for_programs = true;
  TheConsole().last = -kProgramPause;
}

void ShowProgress(const std::string& line, std::optional<double> share) {
  Console& console = TheConsole();
  const double now = console.stopwatch.Seconds();
  const double pause = console.for_programs ? kProgramPause
                       : console.terminal   ? kTerminalPause
                                            : kPause;
  if (now - console.last < pause) return;
  if (console.shown && line == console.line) return;
  console.last = now;
  console.line = line;
  if (console.for_programs) {
    Err() << "progress " + (share ? std::to_string(*share) : "-") + " " + line + '\n';
    return;
  }
  if (!console.terminal) {
    Err() << console.name + ": " + line + '\n';
    return;
  }
  // A line that wraps could not be cleared.
  std::cerr << "\r\033[K" + internal::Printable(line).substr(0, internal::TerminalWidth() - 1)
            << std::flush;
  console.shown = true;
}

void ClearProgress() {
  if (TheConsole().shown.exchange(false)) std::cerr << "\r\033[K" << std::flush;
}

}  // namespace shapespace::tools
