#include "support/files.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/system.h>
#include <shapespace/files/write.h>
#include <shapespace/output/frames.h>
#include <shapespace/path/path_file.h>

#include "support/console.h"
#include "support/tool.h"

namespace shapespace::tools {
namespace {

bool IsFramePattern(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  return (IsWritableMesh(file) || extension == ".vtp" || extension == ".png") && IsNumbered(file);
}

}  // namespace

void CheckNothingIsOverwritten(const std::vector<std::string>& inputs,
                               const std::vector<FlagOutputs>& outputs) {
  namespace fs = std::filesystem;
  // Number of frame names that are checked; inputs are assumed to have lower numbers.
  constexpr std::int64_t kMaxNames = 20000;
  const auto key = [](const std::string& file) {
    std::error_code error;  // such as a cycle of links; opening the file will report it
    const fs::path path = internal::PlaceOf(file, &error);
    return error ? file : path.u8string();
  };
  std::map<std::string, std::string> read, written;  // by key: the name on the command line
  for (const std::string& input : inputs) read.emplace(key(input), input);
  for (const auto& [flag, files, frames] : outputs) {
    for (const std::string& file : files) {
      if (file == "-") continue;
      const bool is_pattern = frames > 0 && IsFramePattern(file);
      const std::string whole = "--" + flag + " " + file;
      for (std::int64_t i = 0; i < (is_pattern ? std::min(frames, kMaxNames) : 1); ++i) {
        const std::string name = is_pattern ? FrameName(file, static_cast<int>(i)) : file;
        const std::string makes = is_pattern ? whole + ": " + name : whole;
        if (const auto input = read.find(key(name)); input != read.end()) {
          throw UsageError(makes + " would overwrite " + input->second +
                           ", which is read; choose another name");
        }
        if (const auto [other, is_new] = written.emplace(key(name), whole); !is_new) {
          throw UsageError(makes + " would overwrite what " + other->second +
                           " writes; choose another name");
        }
      }
    }
  }
}

void CheckCanBeWritten(const std::string& file) {
  namespace fs = std::filesystem;
  if (file == "-") return;
  if (const std::string problem = internal::ProblemWithName(file); !problem.empty()) {
    throw FileError(file + ": " + problem);
  }
  const fs::path path = fs::u8path(file);
  std::error_code error;
  if (fs::is_directory(path, error)) throw FileError(file + ": cannot be written: it is a folder");
  fs::path folder = fs::absolute(path).parent_path();
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (!fs::is_directory(folder, error)) {
    throw FileError(file + ": cannot be written: " + folder.u8string() + " is not a folder");
  }
  // Tried, because permissions do not tell everything: /proc takes no file from anybody.
  std::string trial = (folder / ".shapespace-XXXXXX").u8string();
  const int descriptor = mkstemp(trial.data());
  if (descriptor < 0) {
    throw FileError(file + ": cannot be written: " + folder.u8string() + ": " +
                    std::strerror(errno));
  }
  close(descriptor);
  unlink(trial.c_str());
}

bool IsPathFile(const std::string& file) { return internal::FileExtension(file) == ".path"; }

bool IsPathAlone(const std::vector<std::string>& files) {
  const bool is_path = std::any_of(files.begin(), files.end(), IsPathFile);
  if (is_path ? files.size() != 1 : files.empty()) {
    throw UsageError("name at least two poses of one mesh, or one .path file alone");
  }
  return is_path;
}

Path ReadPathAndTell(const std::string& file) {
  Path path = ReadPath(file);
  if (!path.converged) {
    Warn(file, ": the solve that made it did not converge, or was stopped");
  }
  return path;
}

std::string Provenance(const char* program, const std::vector<std::string>& files) {
  std::string provenance = std::string(program) + " " SHAPESPACE_VERSION ":";
  for (const std::string& file : files) {
    const std::string name =
        file == "-" ? "stdin" : std::filesystem::u8path(file).filename().u8string();
    const bool has_blanks = name.find(' ') != name.npos;
    provenance += has_blanks ? " '" + name + "'" : " " + name;
  }
  return provenance;
}

}  // namespace shapespace::tools
