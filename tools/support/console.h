#ifndef SHAPESPACE_TOOLS_SUPPORT_CONSOLE_H_
#define SHAPESPACE_TOOLS_SUPPORT_CONSOLE_H_

#include <ostream>
#include <string>

namespace shapespace::tools {

/// Where results are told: stdout or, after `ResultsToStderr`, stderr.
std::ostream& Out();
void ResultsToStderr();

/// Where all else is told: stderr.
std::ostream& Err();

/// Tells stderr, in the program's name, what has gone wrong while the rest goes on: the exit code
/// will be 1.
void Complain(const std::string& message);
void SetProgramName(const std::string& name);
bool HasComplained();

/// Shows one line of progress: on a terminal in place of the one before, and gone as soon as `Out`
/// or `Err` is called; elsewhere a line in the program's name, every ten seconds at most.
void ShowProgress(const std::string& line);
void ClearProgress();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_CONSOLE_H_
