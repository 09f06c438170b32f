#ifndef SHAPESPACE_BASE_INTERNAL_SYSTEM_H_
#define SHAPESPACE_BASE_INTERNAL_SYSTEM_H_

#include <filesystem>
#include <string>
#include <system_error>

// What each system does in its own way: POSIX in system.cc, Windows in system_windows.cc. Names of
// files are UTF-8 there, and bytes of any kind on POSIX.

namespace shapespace::internal {

/// Creates a file and opens it for writing. Whatever has its name already, a link in particular, is
/// left alone. Returns its descriptor; -1 if there is none, for the reason in errno.
int CreateNewFile(const char* file);

/// Removes a file, if there is one. On POSIX, no memory is taken.
void RemoveFile(const char* file);

/// Why the system would not make a file of this name, although it does not say so: the name is kept
/// for devices. Empty if it would.
std::string ProblemWithName(const std::string& file);

/// Where a file is, or would be: one path for all names that it has, by links, with "..", or in
/// capital letters where they do not matter. What does not exist is where its folder is.
std::filesystem::path PlaceOf(const std::string& file, std::error_code* error);

/// For programs, before all else. Of stdin, stdout and stderr, those that are closed are opened
/// such that every use fails as before; otherwise the first file that is written would have their
/// number, and get the messages. A file that becomes larger than a limit is an error as on a full
/// disk, and no signal. On Windows, streams have no line ends of their own, and terminals show
/// UTF-8 and colours.
void PrepareProcess();

/// For threads that a library makes: from here on they compute as that of main does. On Windows,
/// x87, by which mingw-w64 computes exp() and the like, has another precision in each new thread.
void PrepareThread();

/// Columns of the terminal that stderr is; 0 if it is none.
int TerminalWidth();

/// Whether stderr takes text at once: not a terminal that Ctrl-S has stopped, or a pipe that nobody
/// reads.
bool StderrTakesText();

/// Calls `handle` when the process is to end: Ctrl-C (SIGINT), SIGTERM, SIGHUP or the closing of a
/// window of Windows; but not for signals that are ignored, by nohup or for a background job of a
/// script. It may do only what signal handlers may.
void HandleEndingSignals(void (*handle)(int signal));

/// A function of that name in the program, or null if there is none or this cannot be found out.
void* FunctionOfProgram(const char* name);

/// Shows a file in the browser. Returns false if there is none.
bool ShowInBrowser(const std::string& file);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_SYSTEM_H_
