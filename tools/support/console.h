#ifndef SHAPESPACE_TOOLS_SUPPORT_CONSOLE_H_
#define SHAPESPACE_TOOLS_SUPPORT_CONSOLE_H_

#include <optional>
#include <ostream>
#include <sstream>
#include <string>

namespace shapespace::tools {

/// The stream for results: stdout or, after `ResultsToStderr`, stderr. This one and `Err` escape
/// control characters other than tabs and ends of lines, which texts from files may contain.
std::ostream& Out();
void ResultsToStderr();

/// The stream for everything else: stderr.
std::ostream& Err();

/// Prints an error to stderr, after the program's name, without ending the program; the exit code
/// will be 1.
void Complain(const std::string& message);

/// Prints a line to stderr, unless it was printed before.
void TellOnce(const std::string& line);

/// Prints a warning, or a note, once: "warning: " and what the parts are as text.
template <typename... Parts>
void Warn(const Parts&... parts) {
  std::ostringstream text;
  ((text << "warning: ") << ... << parts);
  TellOnce(text.str());
}
template <typename... Parts>
void Note(const Parts&... parts) {
  std::ostringstream text;
  ((text << "note: ") << ... << parts);
  TellOnce(text.str());
}

void SetProgramName(const std::string& name);
bool HasComplained();

/// Shows one line of progress: on a terminal it replaces the one before, and is removed when `Out`
/// or `Err` is called; otherwise a line after the program's name, at most every ten seconds.
/// `share` is the part of the work that is done, from 0 to 1, if known.
void ShowProgress(const std::string& line, std::optional<double> share = {});
/// From now on progress is written for a program that reads it: lines "progress SHARE LINE", ten
/// a second at most, with "-" for an unknown share.
void ProgressForPrograms();
void ClearProgress();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_CONSOLE_H_
