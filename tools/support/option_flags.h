#ifndef SHAPESPACE_TOOLS_SUPPORT_OPTION_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_OPTION_FLAGS_H_

#include <cctype>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include <gflags/gflags.h>

#include <shapespace/base/internal/fields.h>

#include "support/tool.h"

namespace shapespace::tools {

/// What the word `text` of a flag stands for.
/// \throw UsageError listing the words if it is none of the enumeration.
template <typename Enum>
Enum EnumFromFlag(const std::string& flag, const std::string& text) {
  const std::optional<Enum> value = internal::FromWord<Enum>(text);
  if (value) return *value;
  throw UsageError("--" + flag + " " + text + ": must be one of " + internal::ListWords<Enum>());
}

/// Command-line flags that set fields of a struct of options, with the defaults, descriptions and
/// words of enumerations that the library lists (base/internal/fields.h). An object of this class
/// stands where DEFINE_int32 and the like would, at the top of a source file.
template <typename Options>
class OptionFlags {
 public:
  /// Makes a flag for each of `names`. `file` is `__FILE__`.
  OptionFlags(const char* file, FlagNames names) : file_(file), names_(std::move(names)) {
    ForOptions(internal::Of<Options>(),
               [&](const std::string& field, auto get, const std::string& about) {
                 for (const auto& [own, flag] : names_) {
                   if (own == field) Define(flag, get, about);
                 }
               });
  }

  /// Sets the fields whose flags were given, or have another default in this program, and
  /// validates the options.
  /// \throw UsageError for a word that is none of its enumeration, or naming flags whose values are
  ///        invalid.
  void Set(Options* options) const {
    for (const Flag& flag : flags_) {
      const auto info = gflags::GetCommandLineFlagInfoOrDie(flag.name.c_str());
      if (!info.is_default || info.default_value != flag.initial) flag.set(options);
    }
    NamingFlags(names_, [&] { options->Validate(); });
  }

 private:
  // gflags keeps pointers to the texts.
  struct Flag {
    std::string name, description, initial;
    std::function<void(Options*)> set;
  };

  template <typename Get>
  void Define(const std::string& name, Get get, std::string about) {
    about[0] = static_cast<char>(std::tolower(about[0]));
    about.pop_back();  // the full stop
    const Options defaults;
    using T = std::decay_t<decltype(std::invoke(get, defaults))>;
    if constexpr (std::is_enum_v<T>) {
      const auto text = Register<std::string>(name, about + " (" + internal::ListWords<T>() + ")",
                                              internal::WordOf(std::invoke(get, defaults)));
      flags_.back().set = [name, get, text](Options* options) {
        std::invoke(get, *options) = EnumFromFlag<T>(name, *text);
      };
    } else if constexpr (std::is_arithmetic_v<T>) {
      const auto value = Register<T>(name, about, std::invoke(get, defaults));
      flags_.back().set = [get, value](Options* options) { std::invoke(get, *options) = *value; };
    } else {
      throw std::logic_error("--" + name + ": no flag can have the type of this field");
    }
  }

  // Where gflags puts the value.
  template <typename T>
  std::shared_ptr<const T> Register(const std::string& name, const std::string& description,
                                    const T& initial) {
    const auto values = std::make_shared<std::pair<T, T>>(initial, initial);
    Flag& flag = flags_.emplace_back(Flag{name, description, "", nullptr});
    gflags::FlagRegisterer(flag.name.c_str(), flag.description.c_str(), file_, &values->first,
                           &values->second);
    flag.initial = gflags::GetCommandLineFlagInfoOrDie(name.c_str()).default_value;
    return {values, &values->first};
  }

  const char* file_;
  FlagNames names_;
  std::deque<Flag> flags_;
};

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_OPTION_FLAGS_H_
