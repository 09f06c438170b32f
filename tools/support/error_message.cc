#include "support/error_message.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>

#include <shapespace/base/internal/extension.h>
#include <shapespace/mesh/different_meshes.h>

#include "support/tool.h"

namespace shapespace::tools {
namespace {

// A word of a command line, such that a shell passes it on as it is.
std::string ForShell(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c >= 0x80 || (c != 0 && std::strchr("_-./+,:@%", c) != nullptr);
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

// A file as an argument of a tool.
std::string ArgumentOf(const std::string& file) {
  if (file == "stdin") return "-";
  return ForShell(file[0] == '-' ? "./" + file : file);
}

// The file's name, without what has a meaning in --output.
std::string StemOf(const std::string& file) {
  std::string stem = std::filesystem::u8path(file).stem().u8string();
  std::replace_if(
      stem.begin(), stem.end(), [](char c) { return c == ',' || c == '%'; }, '_');
  return stem[0] == '-' ? "_" + stem : stem;
}

bool IsMeshOrStdin(const std::string& name) {
  const std::string extension = internal::FileExtension(name);
  return name == "stdin" || (!extension.empty() && extension != ".path" && extension != ".modes");
}

// The command line that fits `first` onto `second`. Where the first is no file of a mesh, such as a
// .path, it says which mesh takes its place.
std::string FitCommand(const std::string& first, const std::string& second) {
  const bool is_mesh = IsMeshOrStdin(first);
  const std::string mesh = is_mesh ? first : "template.obj";
  return "this:\n  shape-correspond " + ArgumentOf(mesh) + " " + ArgumentOf(second) + " --output " +
         ForShell(StemOf(second) + "_as_" + StemOf(mesh) + ".obj") +
         (is_mesh ? "" : "\nwhere " + mesh + " is a mesh of " + first);
}

}  // namespace

std::string MessageOf(const Error& error) {
  if (const auto* meshes = dynamic_cast<const DifferentMeshes*>(&error)) {
    return meshes->MessageWith(FitCommand(meshes->first(), meshes->second()));
  }
  return error.what() + InFlags(error.option());
}

}  // namespace shapespace::tools
