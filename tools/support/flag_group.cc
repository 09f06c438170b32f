#include "support/flag_group.h"

#include <algorithm>
#include <charconv>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "support/lists.h"

namespace shapespace::tools {
namespace {

struct Group {
  std::string heading, file;
  std::vector<std::string> usual;
};

// Groups are registered before main() begins, in any order of the source files.
std::map<std::string, Group>& Groups() {
  static std::map<std::string, Group> groups;
  return groups;
}

const Group& Find(const std::string& name) {
  const auto found = Groups().find(name);
  if (found == Groups().end()) throw std::logic_error("no group of flags is called " + name);
  return found->second;
}

// The shortest text that represents the number: gflags prints 1.0000000000000001e-05.
std::string DefaultValue(const gflags::CommandLineFlagInfo& flag) {
  if (flag.type != "double") return flag.default_value;
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, std::stod(flag.default_value)).ptr};
}

// One flag of --help: name and default in the left column, the description beside it.
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

}  // namespace

FlagGroup::FlagGroup(const char* name, const char* heading, const char* usual, const char* file) {
  Groups().emplace(name, Group{heading, file, Split(usual)});
}

std::vector<gflags::CommandLineFlagInfo> FlagsOf(const std::string& group) {
  const std::string& file = Find(group).file;
  std::vector<gflags::CommandLineFlagInfo> all, flags;
  gflags::GetAllFlags(&all);
  for (const gflags::CommandLineFlagInfo& flag : all) {
    if (flag.filename == file) flags.push_back(flag);
  }
  return flags;
}

namespace {

void PrintFlag(const gflags::CommandLineFlagInfo& flag) {
  std::string left = (flag.name == "output" ? "  -o, --" : "  --") + flag.name;
  if (flag.type != "bool") {
    left += " " + (flag.default_value.empty() ? "..." : DefaultValue(flag));
  }
  const bool is_on = flag.type == "bool" && flag.default_value == "true";
  PrintFlag(left, flag.description + (is_on ? "; --no" + flag.name + " for not" : ""));
}

std::vector<gflags::CommandLineFlagInfo> Select(const std::string& group, FlagList list) {
  if (list == FlagList::kAll) return FlagsOf(group);
  std::vector<gflags::CommandLineFlagInfo> flags;
  for (const std::string& flag : Find(group).usual) {
    flags.push_back(gflags::GetCommandLineFlagInfoOrDie(flag.c_str()));
  }
  return flags;
}

}  // namespace

void PrintFlags(const std::vector<std::string>& groups, FlagList list) {
  // What a program does comes first, and how it runs last.
  std::vector<std::string> headings;
  for (const std::string& group : groups) headings.push_back(Find(group).heading);
  for (const char* heading : {"Input", "Path", "Metric", "Output", "Run"}) {
    const auto others = std::stable_partition(headings.begin(), headings.end(),
                                              [&](const std::string& h) { return h != heading; });
    headings.erase(others == headings.end() ? others : others + 1, headings.end());
  }
  for (const std::string& heading : headings) {
    std::vector<gflags::CommandLineFlagInfo> flags;
    for (const std::string& group : groups) {
      if (Find(group).heading != heading) continue;
      for (auto& flag : Select(group, list)) flags.push_back(std::move(flag));
    }
    if (!flags.empty()) std::cout << '\n' << heading << ":\n";
    for (const auto& flag : flags) PrintFlag(flag);
  }
  PrintFlag("  -h, --help", "what most people use");
  PrintFlag("  --help-all", "all flags");
  PrintFlag("  --version", "version of shapespace");
}

}  // namespace shapespace::tools
