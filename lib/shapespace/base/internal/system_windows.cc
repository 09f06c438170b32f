#include <shapespace/base/internal/system.h>

#include <windows.h>
// What follows needs it.
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <shellapi.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cfloat>
#include <csignal>
#include <filesystem>

#include <shapespace/base/internal/text.h>

namespace shapespace::internal {
namespace {

constexpr DWORD kLongestName = 32768;  // of Windows

std::wstring Wide(const std::string& file) { return std::filesystem::u8path(file).wstring(); }

void (*handle_ending)(int signal) = nullptr;

// A handler of Windows is called once for each time that it is set.
void HandleSignal(int signal) {
  std::signal(signal, HandleSignal);
  handle_ending(signal);
}

// Called on a thread of its own, after whose end Windows ends the process.
BOOL WINAPI HandleClosing(DWORD event) {
  if (event != CTRL_CLOSE_EVENT && event != CTRL_LOGOFF_EVENT && event != CTRL_SHUTDOWN_EVENT) {
    return FALSE;
  }
  handle_ending(SIGTERM);
  Sleep(INFINITE);
  return TRUE;
}

}  // namespace

int CreateNewFile(const char* file) {
  int descriptor = -1;
  const errno_t error = _wsopen_s(&descriptor, Wide(file).c_str(),
                                  _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT,
                                  _SH_DENYNO, _S_IREAD | _S_IWRITE);
  errno = error;
  return error == 0 ? descriptor : -1;
}

void RemoveFile(const char* file) { _wunlink(Wide(file).c_str()); }

std::filesystem::path PlaceOf(const std::string& file, std::error_code* error) {
  namespace fs = std::filesystem;
  fs::path existing = fs::absolute(fs::u8path(file), *error).lexically_normal(), rest;
  if (*error) return existing;
  std::wstring place(kLongestName, L'\0');
  DWORD length = 0;
  while (true) {
    const HANDLE handle =
        CreateFileW(existing.c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                    nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    if (handle != INVALID_HANDLE_VALUE) {
      length = GetFinalPathNameByHandleW(handle, place.data(), kLongestName, 0);
      CloseHandle(handle);
      break;
    }
    if (!existing.has_relative_path()) break;
    rest = rest.empty() ? existing.filename() : existing.filename() / rest;
    existing = existing.parent_path();
  }
  if (length > 0 && length < kLongestName) existing = place.substr(0, length);
  place = (rest.empty() ? existing : existing / rest).wstring();
  CharLowerBuffW(place.data(), static_cast<DWORD>(place.size()));
  return place;
}

std::string ProblemWithName(const std::string& file) {
  // With any extension, too.
  static constexpr std::array<const char*, 4> kDevices = {"aux", "con", "nul", "prn"};
  const std::string name = std::filesystem::u8path(file).filename().u8string();
  const std::string stem = InSmallLetters(name.substr(0, name.find_first_of(". ")));
  const bool numbered = stem.size() == 4 && stem[3] >= '1' && stem[3] <= '9' &&
                        (stem.compare(0, 3, "com") == 0 || stem.compare(0, 3, "lpt") == 0);
  if (!numbered && std::find(kDevices.begin(), kDevices.end(), stem) == kDevices.end()) return {};
  return "Windows keeps the name " + stem + " for a device; choose another";
}

void PrepareProcess() {
  for (const int stream : {0, 1, 2}) _setmode(stream, _O_BINARY);
  SetConsoleOutputCP(CP_UTF8);
  for (const DWORD stream : {STD_OUTPUT_HANDLE, STD_ERROR_HANDLE}) {
    const HANDLE handle = GetStdHandle(stream);
    DWORD mode = 0;
    if (GetConsoleMode(handle, &mode) != 0) {
      SetConsoleMode(handle, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
    }
  }
}

void PrepareThread() { _fpreset(); }

int TerminalWidth() {
  CONSOLE_SCREEN_BUFFER_INFO info = {};
  const bool known = GetConsoleScreenBufferInfo(GetStdHandle(STD_ERROR_HANDLE), &info) != 0;
  return known ? info.srWindow.Right - info.srWindow.Left + 1 : 0;
}

bool StderrTakesText() { return true; }  // a pipe that is full cannot be found out

void HandleEndingSignals(void (*handle)(int signal)) {
  handle_ending = handle;
  for (const int signal : {SIGINT, SIGTERM, SIGBREAK}) {
    if (std::signal(signal, HandleSignal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  SetConsoleCtrlHandler(HandleClosing, TRUE);
}

void* FunctionOfProgram(const char* /*name*/) { return nullptr; }

bool ShowInBrowser(const std::string& file) {
  const HINSTANCE result =
      ShellExecuteW(nullptr, L"open", Wide(file).c_str(), nullptr, nullptr, SW_SHOWNORMAL);
  return reinterpret_cast<INT_PTR>(result) > 32;  // as documented
}

}  // namespace shapespace::internal
