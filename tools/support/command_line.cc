#include "support/command_line.h"

#include <algorithm>
#include <map>
#include <set>

#include <gflags/gflags.h>

#include "support/flag_group.h"
#include "support/nearest_word.h"
#include "support/tool.h"

DEFINE_bool(help_all, false, "all flags");

namespace shapespace::tools {
namespace {

// The values as typed, by flag.
std::map<std::string, std::string>& Typed() {
  static std::map<std::string, std::string> typed;
  return typed;
}

// What a value of this type has to be.
std::string Description(const std::string& type) {
  if (type == "bool") return "true or false";
  if (type == "double") return "a number";
  return type[0] == 'u' ? "an integer that is not negative" : "an integer";
}

class Parser {
 public:
  Parser(int argc, char** argv, const std::vector<std::string>& groups)
      : argv_(argv + 1, argv + argc), known_{"help", "help_all", "version"} {
    for (const std::string& group : groups) {
      for (const gflags::CommandLineFlagInfo& flag : FlagsOf(group)) known_.insert(flag.name);
    }
  }

  std::vector<std::string> Parse() {
    std::vector<std::string> arguments;
    while (next_ < argv_.size()) {
      const std::string& argument = argv_[next_++];
      if (argument == "--") {
        arguments.insert(arguments.end(), argv_.begin() + next_, argv_.end());
        break;
      }
      if (argument.size() < 2 || argument[0] != '-') {
        arguments.push_back(argument);
      } else {
        ParseFlag(argument);
      }
    }
    return arguments;
  }

 private:
  struct Flag {
    std::string name, type;  // the type is empty if there is no such flag
    bool negated = false;
  };

  Flag FlagOf(const std::string& argument) const {
    const size_t begin = argument.find_first_not_of('-'), equals = argument.find('=');
    Flag flag;
    if (begin == 1 || begin == 2) flag.name = argument.substr(begin, equals - begin);
    std::replace(flag.name.begin(), flag.name.end(), '-', '_');
    if (begin == 1 && flag.name == "o") flag.name = "output";
    if (begin == 1 && flag.name == "h") flag.name = "help";
    flag.negated =
        known_.count(flag.name) == 0 && flag.name.substr(0, 2) == "no" && equals == argument.npos;
    if (flag.negated) flag.name.erase(0, 2);
    if (known_.count(flag.name) == 0) return flag;
    const std::string type = gflags::GetCommandLineFlagInfoOrDie(flag.name.c_str()).type;
    if (!flag.negated || type == "bool") flag.type = type;
    return flag;
  }

  void ParseFlag(const std::string& argument) {
    const size_t equals = argument.find('=');
    const auto [name, type, negated] = FlagOf(argument);
    if (type.empty()) {
      throw UsageError(argument.substr(0, equals) + ": there is no such flag" + Hint(name));
    }
    if (equals != argument.npos) {
      Set(name, argument.substr(equals + 1), type);
    } else if (type == "bool") {
      Set(name, negated ? "false" : "true", type);
      Typed().erase(name);
    } else if (next_ == argv_.size()) {
      throw UsageError("--" + name + ": its value is missing");
    } else if (!FlagOf(argv_[next_]).type.empty()) {
      throw UsageError("--" + name + ": its value is missing before " + argv_[next_] +
                       "; a value that looks like a flag follows after '='");
    } else {
      Set(name, argv_[next_++], type);
    }
  }

  // What the user may have meant by a flag that is none.
  std::string Hint(const std::string& name) const {
    const std::string nearest = NearestWord(name, known_);
    if (!nearest.empty()) return "; did you mean --" + nearest + "?";
    const bool is_of_export = name == "frames" || name == "at";
    return is_of_export ? "; it is one of shape-export, which takes a .path" : "";
  }

  static void Set(const std::string& name, const std::string& value, const std::string& type) {
    if (gflags::SetCommandLineOption(name.c_str(), value.c_str()).empty()) {
      throw UsageError("--" + name + " " + value + ": must be " + Description(type));
    }
    Typed()[name] = value;
  }

  const std::vector<std::string> argv_;
  std::set<std::string> known_;
  size_t next_ = 0;
};

}  // namespace

std::vector<std::string> ParseCommandLine(int argc, char** argv,
                                          const std::vector<std::string>& groups) {
  return Parser(argc, argv, groups).Parse();
}

std::string AsTyped(const std::string& flag) {
  const auto typed = Typed().find(flag);
  return "--" + flag + (typed == Typed().end() ? "" : " " + typed->second);
}

}  // namespace shapespace::tools
